//! The ground: a gently rolling meadow with a fireplace in it.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use noise::{NoiseFn, OpenSimplex};

/// Radius of the bare ground around the fire, m.
pub const FIREPLACE_M: f32 = 0.85;
/// How far the ground reaches, m.
const REACH_M: f32 = 300.0;

/// Height of the ground at world (x, z), m.
pub fn height_m(at: Vec2) -> f32 {
    let noise = OpenSimplex::new(5);
    let octave = |length_m: f32| noise.get([at.x, at.y].map(|c| f64::from(c / length_m))) as f32;
    // Level at the fireplace.
    let rolling = smooth(1.0, 5.0, at.length()) * (0.12 * octave(4.0) + 0.3 * octave(14.0));
    rolling + 3.0 * smooth(25.0, 120.0, at.length()) * (0.6 + octave(60.0))
}

fn smooth(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Height of the ground where grass grows: not in the fireplace.
pub fn meadow_height_m(at: Vec2) -> f32 {
    if at.length() < FIREPLACE_M { f32::NAN } else { height_m(at) }
}

/// One mesh, finer in the middle than at its edges.
pub fn mesh() -> Mesh {
    const LINES: usize = 161;
    let line_m = |line: usize| {
        let t = line as f32 / (LINES - 1) as f32 * 2.0 - 1.0;
        22.0 * t + (REACH_M - 22.0) * t.powi(5)
    };
    let lines: Vec<f32> = (0..LINES).map(line_m).collect();
    let noise = OpenSimplex::new(9);
    let (mut positions, mut normals, mut colours) = (Vec::new(), Vec::new(), Vec::new());
    for &z in &lines {
        for &x in &lines {
            let at = Vec2::new(x, z);
            let rise = |step: Vec2| height_m(at + step) - height_m(at - step);
            let normal = Vec3::new(-rise(Vec2::X * 0.5), 1.0, -rise(Vec2::Y * 0.5)).normalize();
            positions.push([x, height_m(at), z]);
            normals.push(normal.to_array());
            colours.push(colour(at, &noise));
        }
    }
    let quads = (0..LINES - 1).flat_map(|row| (0..LINES - 1).map(move |column| (row * LINES + column) as u32));
    let lines = LINES as u32;
    let indices = quads.flat_map(|a| [a, a + lines, a + 1, a + 1, a + lines, a + lines + 1]).collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
        .with_inserted_indices(Indices::U32(indices))
}

/// Earth and moss under the blades, the colour of grass beyond them, ash in the fireplace.
fn colour(at: Vec2, noise: &OpenSimplex) -> [f32; 4] {
    let octave = |length_m: f32| noise.get([at.x, at.y].map(|c| f64::from(c / length_m))) as f32;
    let mottled = 1.0 + 0.25 * octave(0.9) + 0.2 * octave(7.0);
    let under = Vec3::new(0.030, 0.040, 0.012);
    let far = Vec3::new(0.075, 0.105, 0.028);
    let ash = Vec3::new(0.035, 0.030, 0.026);
    let meadow = under.lerp(far, smooth(4.0, 18.0, at.length())) * mottled;
    let colour = ash.lerp(meadow, smooth(0.7 * FIREPLACE_M, 1.1 * FIREPLACE_M, at.length()));
    [colour.x, colour.y, colour.z, 1.0]
}
