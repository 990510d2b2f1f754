//! The coarse body of a tree against rays through its triangles and masks.

use super::{grown, ray_oracles::RayCaster};
use crate::{
    lod::{Scene, bake::scene::TreeParts},
    tree::body::BodyRay,
};
use bevy::math::Vec3;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

/// Mean share of rays through the crown that the tree's triangles stop, and that its body does.
fn blocked(name: &str) -> [f32; 2] {
    const RAYS: usize = 1500;
    let (species, model, textures) = grown(name, 1.0);
    let scene = Scene::new(&species, &model, &textures);
    let caster = RayCaster::new(&scene);
    let posed = model.body.at_rest();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let (height_m, envelope) = (model.height_m(), &model.skeleton.envelope);
    let mut sums = [0.0; 2];
    for _ in 0..RAYS {
        let mut spread = |size: f32| random.random_range(-size..size);
        let (radius_m, middle_m) = (envelope.radius_m, 0.5 * (envelope.base_m + envelope.top_m));
        let target = Vec3::new(spread(0.6 * radius_m), middle_m + spread(0.3 * height_m), spread(0.6 * radius_m));
        let way = Vec3::new(spread(1.0), spread(0.6), spread(1.0)).normalize_or(Vec3::X);
        let (origin, reach_m) = (target - 2.0 * height_m * way, 4.0 * height_m);
        sums[0] += f32::from(u8::from(caster.cast(origin, way, reach_m, TreeParts::All).is_some()));
        let ray = BodyRay { origin, direction: way, part_m: [0.0, reach_m] };
        let is_hit = model.body.hit(&posed, &ray).is_some();
        sums[1] += if is_hit { 1.0 } else { 1.0 - model.body.transmittance(&posed, &ray, 1.0) };
    }
    sums.map(|sum| sum / RAYS as f32)
}

#[test]
fn a_body_blocks_as_many_rays_as_the_tree_that_is_drawn() {
    for name in ["oak", "birch", "fir", "scots_pine", "hazel"] {
        let [drawn, body] = blocked(name);
        println!("{name}: {drawn:.3} drawn, {body:.3} by its body");
        assert!((drawn - body).abs() < 0.05, "{name}: {drawn} drawn, {body} by its body");
    }
}

/// Crowns of polygons and of ellipsoids have no leaves: a coarser match.
#[test]
fn impressions_of_crowns_block_about_as_many_rays() {
    for name in ["impression_summer", "billows", "zaharia_oak"] {
        let [drawn, body] = blocked(name);
        println!("{name}: {drawn:.3} drawn, {body:.3} by its body");
        assert!((drawn - body).abs() < 0.15, "{name}: {drawn} drawn, {body} by its body");
    }
}
