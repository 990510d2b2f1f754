//! Grass all over the ground about the camera: blades near by, broad tufts farther out, and only clumps of it under the trees.

use crate::{small, support::landscape::Landscape};
use bevy::{light::NotShadowCaster, math::DVec2, prelude::*};
use bevy_windwood::prelude::*;
use noise::{NoiseFn, OpenSimplex};
use std::sync::Arc;

/// Distance between clumps of grass in the wood, m.
const CLUMP_M: f64 = 2.6;
/// Noise above which grass grows in the wood: half of the ground.
const SHADE: f64 = 0.0;

/// Spawns the meadow of a wood of so many trees.
pub fn spawn_meadow(commands: &mut Commands, landscape: &Landscape, trees: u32, seed: u64) {
    let near = Sward { width_m: 8.0, depth_m: 8.0, tufts_per_m2: 11.0, tuft: short(), seed, ..default() };
    let far = Sward { width_m: 20.0, depth_m: 20.0, tufts_per_m2: 1.2, tuft: broad(), seed: seed + 1, ..default() };
    let (near_look, far_look) = (look(9.0, 30.0), look(25.0, 100.0));
    for (sward, look) in [(near, near_look), (far, far_look)] {
        let (landscape, half_m) = (landscape.clone(), f64::from(small::half_side_m(trees)));
        let clumps = OpenSimplex::new(seed as u32);
        let height_m = move |at: DVec2| {
            let is_in_wood = at.abs().max_element() < half_m;
            if is_in_wood && clumps.get((at / CLUMP_M).to_array()) < SHADE {
                return f64::NAN;
            }
            f64::from(landscape.height_m(at.x as f32, at.y as f32))
        };
        let patch = GrassPatch { sward, look, ..default() };
        let shade = GrassShade(Arc::new(small::Floor::new(trees)));
        let field = GrassField { patch, patches_per_frame: 16 };
        commands.spawn((field, GrassGround(Arc::new(height_m)), shade, NotShadowCaster));
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
fn look(thins_from_m: f32, vanishes_at_m: f32) -> GrassLook {
    GrassLook {
        root_colour: [0.035, 0.055, 0.016],
        tip_colour: [0.125, 0.19, 0.05],
        dry_colour: [0.22, 0.20, 0.10],
        thins_from_m,
        vanishes_at_m,
        ..default()
    }
}
