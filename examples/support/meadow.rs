//! Grass all over the ground about the camera: blades near by, and broad tufts farther out.

use bevy::{light::NotShadowCaster, math::DVec2, prelude::*};
use bevy_windwood::{prelude::*, terrain::Cover};
use std::sync::Arc;

/// Spawns the meadow on ground of that height, m; where it is not a number, no grass grows. `cover` tells where it is in the shade of trees.
pub fn spawn_meadow(
    commands: &mut Commands,
    height_m: impl Fn(DVec2) -> f64 + Send + Sync + 'static,
    cover: Option<Arc<dyn Cover>>,
    seed: u64,
) {
    let ground = Arc::new(height_m);
    let near = Sward { width_m: 8.0, depth_m: 8.0, tufts_per_m2: 19.0, tuft: short(), seed, ..default() };
    let far = Sward { width_m: 20.0, depth_m: 20.0, tufts_per_m2: 2.0, tuft: broad(), seed: seed + 1, ..default() };
    let near_look = GrassLook { thins_from_m: 9.0, vanishes_at_m: 32.0, ..default() };
    let far_look = GrassLook { appears_from_m: 26.0, thins_from_m: 30.0, vanishes_at_m: 140.0, ..default() };
    for (sward, look) in [(near, near_look), (far, far_look)] {
        let patch = GrassPatch { sward, look, ..default() };
        let field = GrassField { patch, patches_per_frame: 16 };
        let mut field = commands.spawn((field, GrassGround(ground.clone()), NotShadowCaster));
        if let Some(cover) = &cover {
            field.insert(GrassShade(cover.clone()));
        }
    }
}

fn short() -> Tuft {
    Tuft {
        blades: 14,
        shortest_m: 0.12,
        longest_m: 0.46,
        narrowest_m: 0.01,
        widest_m: 0.026,
        radius_m: 0.18,
        ..default()
    }
}

/// Tufts that are seen from afar: as much grass in fewer blades.
fn broad() -> Tuft {
    Tuft { blades: 12, narrowest_m: 0.05, widest_m: 0.1, radius_m: 0.45, ..short() }
}
