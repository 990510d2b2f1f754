//! The shape of an envelope of leaves.

use super::{grown, small};
use crate::lod::{EnvelopeLevel, EnvelopeSettings, Scene, paper::profile::crown_points};
use bevy::math::Vec3;

#[test]
fn the_smooth_envelope_encloses_the_share_asked_for() {
    for name in ["oak", "fir", "poplar", "hazel"] {
        let (species, model, textures) = grown(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let settings = EnvelopeSettings { roughness: 0.0, ..small().envelope };
        let level = EnvelopeLevel::bake(&scene, &species, &model, &settings).unwrap();
        let points = crown_points(&model);
        let inside = points.iter().filter(|point| level.profile.encloses(**point)).count() as f32;
        assert!((inside / points.len() as f32 - settings.enclosed).abs() < 2e-3, "{name}: {inside}");
        assert!((0.2..=1.0).contains(&level.coverage), "{name}: {}", level.coverage);
        assert_eq!(level.profile.is_conical(), name == "fir", "{name}");
    }
}

#[test]
fn the_envelope_hangs_on_the_stem_and_closes() {
    let (species, model, textures) = grown("oak", 1.0);
    let scene = Scene::new(&species, &model, &textures);
    let level = EnvelopeLevel::bake(&scene, &species, &model, &small().envelope).unwrap();
    let order = |sway: &[f32; 4]| model.skeleton.beams[sway[0] as usize].order;
    assert!(level.envelope.sway.iter().chain(&level.trunk.sway).all(|sway| order(sway) == 0));
    // The volume that a closed surface encloses, seen from outside counter-clockwise, is positive (divergence theorem).
    let volume = |positions: &[[f32; 3]], indices: &[u32]| -> f32 {
        let corner = |index: u32| Vec3::from_array(positions[index as usize]);
        indices
            .chunks_exact(3)
            .map(|triple| corner(triple[0]).dot(corner(triple[1]).cross(corner(triple[2]))) / 6.0)
            .sum()
    };
    let profile = &level.profile;
    let step_m = (profile.top_m - profile.base_m) / (profile.radii_m.len() - 1) as f32;
    let expected: f32 = profile
        .radii_m
        .windows(2)
        .map(|pair| std::f32::consts::PI * step_m * (pair[0] * pair[0] + pair[0] * pair[1] + pair[1] * pair[1]) / 3.0)
        .sum();
    let found = volume(&level.envelope.positions, &level.envelope.indices);
    assert!((found / expected - 1.0).abs() < 0.25, "{found} for {expected}");
    assert!(volume(&level.trunk.positions, &level.trunk.indices) > 0.0);
}
