//! The frames of an envelope's animation.

use super::{grown, ray_oracles::RayCaster, small};
use crate::{
    dynamics::beam_pose::BeamPose,
    lod::{
        EnvelopeLevel, EnvelopeSettings, Scene,
        bake::{
            scene::TreeParts,
            texels::{Alpha, Sample, TexelGrid},
        },
        paper::{
            cylindrical::{CylindricalRaster, outwards},
            envelope::render_frames,
            profile::{CrownProfile, crown_points},
            sway_frames,
        },
    },
    texture::TextureData,
    tree::TreeModel,
};
use bevy::math::{Vec2, Vec3};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::sync::Arc;

const FIELD: [usize; 2] = [256, 128];

fn profile_of(model: &TreeModel) -> CrownProfile {
    CrownProfile::around(&crown_points(model), 8, 0.95).unwrap()
}

fn all_rays() -> impl Iterator<Item = (usize, usize)> {
    (0..FIELD[1]).flat_map(|row| (0..FIELD[0]).map(move |column| (column, row)))
}

/// The share of rays, of those that hit anything, that hit something else in two rasters.
fn unlike(one: &CylindricalRaster, other: &CylindricalRaster) -> f32 {
    let (mut unlike, mut hits) = (0, 0);
    for (column, row) in all_rays() {
        let pair = (one.sample(column, row, 1e3), other.sample(column, row, 1e3));
        let is_alike = match pair {
            // 2 cm, half a degree.
            (Some(one), Some(other)) => {
                (one.depth - other.depth).abs() < 2e-5 && one.normal.distance(other.normal) < 0.01
            }
            (one, other) => one.is_none() == other.is_none(),
        };
        hits += usize::from(pair.0.is_some());
        unlike += usize::from(!is_alike);
    }
    unlike as f32 / hits as f32
}

#[test]
fn a_cylindrical_raster_equals_single_rays() {
    for name in ["oak", "birch", "fir", "billows"] {
        let (species, model, textures) = grown(name, 0.4);
        let scene = Scene::new(&species, &model, &textures);
        let profile = profile_of(&model);
        let raster = CylindricalRaster::new(&scene, &profile, FIELD);
        let caster = RayCaster::new(&scene);
        let reach_m = 100.0;
        let (mut unlike, mut hits) = (0, 0);
        for (column, row) in all_rays() {
            let outwards = outwards((column as f32 + 0.5) / FIELD[0] as f32);
            let down = (row as f32 + 0.5) / FIELD[1] as f32;
            let height_m = profile.top_m + (profile.base_m - profile.top_m) * down;
            let from = Vec3::new(profile.axis.x, height_m, profile.axis.y) + outwards * reach_m;
            let ray = caster.cast(from, -outwards, reach_m, TreeParts::Crown);
            let is_alike = match (raster.sample(column, row, reach_m), ray) {
                (Some(seen), Some(hit)) => {
                    let depth = 1.0 - hit.distance_m / reach_m;
                    (seen.depth - depth).abs() < 1e-5 && seen.translucency == hit.surface.translucency
                }
                (seen, ray) => seen.is_none() == ray.is_none(),
            };
            unlike += usize::from(!is_alike);
            hits += usize::from(ray.is_some());
        }
        // Rays along an edge, of a triangle or of a texel, may fall to either side.
        assert!(hits > 5000 && unlike * 200 < hits, "{name}: {unlike} of {hits}");
    }
}

#[test]
fn a_single_frame_shows_the_tree_at_rest() {
    let (species, model, textures) = grown("oak", 0.5);
    let scene = Scene::new(&species, &model, &textures);
    let profile = profile_of(&model);
    let settings = EnvelopeSettings { frames: 1, rays: 1, width_texels: 256, height_texels: 128, ..small().envelope };
    let texels = render_frames(&scene, &model, &profile, &settings);
    let reach = |place: &Vec3| Vec2::new(place.x, place.z).distance(profile.axis);
    let reach_m = scene.vertices.iter().map(|vertex| reach(&vertex.position)).fold(0.0, f32::max);
    let raster = CylindricalRaster::new(&scene, &profile, FIELD);
    let mut expected = TexelGrid::new(FIELD[0], FIELD[1]);
    expected.add_rays([0, 0], FIELD, 1, |column, row| raster.sample(column, row, reach_m));
    assert_eq!(texels, expected);
}

/// A model whose vertices are moved one by one, from each beam down to the root.
fn moved(model: &TreeModel, poses: &[BeamPose]) -> TreeModel {
    let mut moved = model.clone();
    let carry = |(sway, (position, normal)): (&[f32; 4], (&mut [f32; 3], &mut [f32; 3]))| {
        let mut bound_to = Some((sway[0] as usize, sway[1]));
        while let Some((beam, at)) = bound_to {
            let bent = BeamPose { tip_angle: poses[beam].tip_angle, ..BeamPose::REST };
            let (carried, rotation) = bent.carry(&model.beams[beam], at, Vec3::from_array(*position));
            *position = carried.to_array();
            *normal = (rotation * Vec3::from_array(*normal)).to_array();
            let parent = model.skeleton.beams[beam].parent;
            bound_to = parent.map(|parent| (parent as usize, model.skeleton.beams[beam].attach));
        }
    };
    let (wood, leaves) = (Arc::make_mut(&mut moved.wood), Arc::make_mut(&mut moved.leaves));
    model.wood.sway.iter().zip(wood.positions.iter_mut().zip(&mut wood.normals)).for_each(carry);
    model.leaves.sway.iter().zip(leaves.positions.iter_mut().zip(&mut leaves.normals)).for_each(carry);
    moved
}

#[test]
fn frames_show_the_swaying_tree() {
    for name in ["oak", "fir", "hazel"] {
        let (species, model, textures) = grown(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let profile = profile_of(&model);
        for frame in 0..3 {
            let poses = sway_frames::poses(&model, frame, 3);
            let (fast, slow) = (scene.posed(&model, &poses), Scene::new(&species, &moved(&model, &poses), &textures));
            let fast = CylindricalRaster::new(&fast, &profile, FIELD);
            let share = unlike(&fast, &CylindricalRaster::new(&slow, &profile, FIELD));
            assert!(share < 0.001, "{name}, {frame}: {share}");
        }
    }
}

/// The rows of one frame in a mip of a texture.
fn frame_of(texture: &TextureData, frame: usize, frames: usize, mip: usize) -> &[u8] {
    let bytes = texture.mips[mip].len() / frames;
    &texture.mips[mip][frame * bytes..(frame + 1) * bytes]
}

#[test]
fn frames_do_not_mix_in_mips() {
    const TILE: [usize; 2] = [32, 16];
    const FRAMES: usize = 3;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut stack = TexelGrid::new(TILE[0], FRAMES * TILE[1]);
    // The middle one stays empty.
    for (place, texel) in stack.texels.iter_mut().enumerate() {
        let frame = place / (TILE[0] * TILE[1]);
        if frame != 1 && random.random_bool(0.4) {
            let mut share = || random.random_range(0.0..1.0_f32);
            let normal = Vec3::new(share(), share(), share() - 1.0).normalize();
            let colour = [frame as f32 / 2.0, share(), share()];
            texel.add(&Sample { colour, normal, translucency: share(), depth: share() }, share());
        }
    }
    let alone: Vec<TexelGrid> = stack
        .texels
        .chunks(TILE[0] * TILE[1])
        .map(|texels| TexelGrid { width: TILE[0], height: TILE[1], texels: texels.to_vec() })
        .collect();
    let stack = stack.with_mips(TILE, 4, Alpha::Mask);
    let (colour, surface) = (stack.colour_texture(), stack.surface_texture());
    assert_eq!(colour.mips.len(), 3, "16 to 4 texels");
    for (frame, grid) in alone.into_iter().enumerate() {
        let alone = grid.with_mips(TILE, 4, Alpha::Mask);
        let (alone_colour, alone_surface) = (alone.colour_texture(), alone.surface_texture());
        for mip in 0..3 {
            assert_eq!(frame_of(&colour, frame, FRAMES, mip), alone_colour.mips[mip], "{frame} {mip}");
            assert_eq!(frame_of(&surface, frame, FRAMES, mip), alone_surface.mips[mip], "{frame} {mip}");
        }
    }
}

/// Where a place `uv` of the envelope lies in the texture, in a frame of the animation (it repeats). In `mip` and all finer
/// ones a linear filter there takes nothing of other frames: v keeps half a texel of the mip from the border. The shader
/// does the same.
fn place_in_frame(level: &EnvelopeLevel, frame: u32, uv: Vec2, mip: u32) -> Vec2 {
    let coarsest = level.colour.mips.len() as u32 - 1;
    let texel = level.frames as f32 / (level.colour.height >> mip.min(coarsest)) as f32;
    let v = uv.y.clamp(0.5 * texel, 1.0 - 0.5 * texel);
    Vec2::new(uv.x, ((frame % level.frames) as f32 + v) / level.frames as f32)
}

#[test]
fn clamped_places_keep_a_linear_filter_in_their_frame() {
    let (species, model, textures) = grown("hazel", 0.5);
    let scene = Scene::new(&species, &model, &textures);
    let settings = EnvelopeSettings { frames: 3, ..small().envelope };
    let level = EnvelopeLevel::bake(&scene, &species, &model, &settings).unwrap();
    assert_eq!((level.colour.width, level.colour.height), (32, 48));
    for (frame, mip) in (0..3).flat_map(|frame| (0..3).map(move |mip| (frame, mip))) {
        for v in (0..=100).map(|step| step as f32 / 100.0) {
            let place = place_in_frame(&level, frame + 3, Vec2::new(0.3, v), mip);
            for finer in 0..=mip {
                let rows = (48 >> finer) as f32;
                let above = place.y * rows - 0.5;
                let own = frame as f32 * rows / 3.0;
                assert!(above > own - 1e-4 && above < own + rows / 3.0 - 1.0 + 1e-4, "{frame} {mip} {v}: {above}");
            }
        }
        let middle = place_in_frame(&level, frame, Vec2::new(0.3, 0.5), mip);
        assert!(middle.distance(Vec2::new(0.3, (frame as f32 + 0.5) / 3.0)) < 1e-6);
    }
}

#[test]
fn means_are_those_of_all_frames() {
    let (species, model, textures) = grown("birch", 1.0);
    let scene = Scene::new(&species, &model, &textures);
    let settings = small().envelope;
    let level = EnvelopeLevel::bake(&scene, &species, &model, &settings).unwrap();
    let texels = render_frames(&scene, &model, &level.profile, &settings);
    let frames =
        texels.texels.chunks(32 * 16).map(|texels| TexelGrid { width: 32, height: 16, texels: texels.to_vec() });
    let means: Vec<(f32, Vec3)> =
        frames.map(|frame| (frame.coverage(), Vec3::from_array(frame.mean_colour()))).collect();
    assert!(means.len() == 4 && means.windows(2).all(|pair| pair[0] != pair[1]));
    let cover: f32 = means.iter().map(|(cover, _)| cover).sum();
    let colour = means.iter().map(|(cover, colour)| *cover * *colour).sum::<Vec3>() / cover;
    assert!((level.coverage - cover / 4.0).abs() < 1e-5);
    assert!(colour.distance(Vec3::from_array(level.mean_colour)) < 1e-5);
}

#[test]
fn masks_of_successive_frames_differ_a_little() {
    for name in ["oak", "fir", "birch", "poplar", "billows"] {
        let (species, model, textures) = grown(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let level = EnvelopeLevel::bake(&scene, &species, &model, &EnvelopeSettings::default()).unwrap();
        let mask = |frame: usize| frame_of(&level.colour, frame % 4, 4, 0).chunks_exact(4).map(|texel| texel[3] >= 128);
        for frame in 0..4 {
            let differing = mask(frame).zip(mask(frame + 1)).filter(|(one, other)| one != other).count();
            let share = differing as f32 / (128.0 * 64.0);
            assert!((0.001..0.15).contains(&share), "{name}, {frame}: {share}");
        }
    }
}

/// The share of places that a mask has otherwise than the same mask so many rays aside, or as many rays down.
fn unlike_its_shift(hits: &[bool], [columns, rows]: [usize; 2], rays: usize) -> f32 {
    let at = |column: usize, row: usize| hits[row * columns + column % columns];
    let mut unlike = 0;
    for (column, row) in (0..rows - rays).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        unlike += usize::from(at(column, row) != at(column + rays, row));
        unlike += usize::from(at(column, row) != at(column, row + rays));
    }
    unlike as f32 / (2 * columns * (rows - rays)) as f32
}

/// What the sway should change follows from the tree at rest and from how far its vertices move: as much as when the frame
/// at rest is shifted so far.
#[test]
fn frames_differ_as_much_as_the_crown_moves() {
    const FINE: [usize; 2] = [1024, 256];
    const FARTHEST: usize = 16;
    // Vertices stand for what is seen: in broad crowns most are.
    for name in ["oak", "birch"] {
        let (species, model, textures) = grown(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let profile = profile_of(&model);
        let hits = |scene: &Scene| -> Vec<bool> {
            let raster = CylindricalRaster::new(scene, &profile, FINE);
            (0..FINE[0] * FINE[1]).map(|ray| raster.sample(ray % FINE[0], ray / FINE[0], 1.0).is_some()).collect()
        };
        let rest = hits(&scene);
        let shifts: Vec<f32> = (0..=FARTHEST).map(|rays| unlike_its_shift(&rest, FINE, rays)).collect();
        let unlike_by = |rays: f32| {
            let rays = rays.min(FARTHEST as f32 - 1.0);
            shifts[rays as usize] + rays.fract() * (shifts[rays as usize + 1] - shifts[rays as usize])
        };
        let [one, other] = [0, 1].map(|frame| scene.posed(&model, &sway_frames::poses(&model, frame, 4)));
        let step_m = (profile.top_m - profile.base_m) / FINE[1] as f32;
        let moved_by = |vertex: usize| {
            let way = other.vertices[vertex].position - one.vertices[vertex].position;
            let from_axis =
                (one.vertices[vertex].position - Vec3::new(profile.axis.x, 0.0, profile.axis.y)).with_y(0.0);
            let around_m = from_axis.normalize_or(Vec3::X).cross(Vec3::Y).dot(way);
            let column_m = std::f32::consts::TAU * from_axis.length().max(0.1) / FINE[0] as f32;
            (around_m / column_m).hypot(way.y / step_m)
        };
        let leaves = model.wood.positions.len()..scene.vertices.len();
        let expected = leaves.clone().map(|vertex| unlike_by(moved_by(vertex))).sum::<f32>() / leaves.len() as f32;
        let pairs = hits(&one).into_iter().zip(hits(&other));
        let found = pairs.filter(|(one, other)| one != other).count() as f32 / rest.len() as f32;
        assert!((0.7..1.4).contains(&(found / expected)), "{name}: {found} for {expected}");
    }
}
