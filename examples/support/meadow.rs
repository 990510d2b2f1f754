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
    let near = Sward { width_m: 8.0, depth_m: 8.0, tufts_per_m2: 11.0, tuft: short(), seed, ..default() };
    let far = Sward { width_m: 20.0, depth_m: 20.0, tufts_per_m2: 1.2, tuft: broad(), seed: seed + 1, ..default() };
    for (sward, look) in [(near, look(9.0, 30.0)), (far, look(25.0, 100.0))] {
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
        narrowest_m: 0.006,
        widest_m: 0.014,
        radius_m: 0.16,
        ..default()
    }
}

/// Tufts that are seen from afar: as much grass in fewer blades.
fn broad() -> Tuft {
    Tuft { blades: 12, narrowest_m: 0.02, widest_m: 0.04, radius_m: 0.4, ..short() }
}

/// The colours of the ground's own grass.
pub fn look(thins_from_m: f32, vanishes_at_m: f32) -> GrassLook {
    GrassLook {
        root_colour: [0.035, 0.055, 0.016],
        tip_colour: [0.125, 0.19, 0.05],
        dry_colour: [0.22, 0.20, 0.10],
        thins_from_m,
        vanishes_at_m,
        ..default()
    }
}
