//! The mesh of a fire: strips for the rhombs, the sparks, and the glow around all.
//!
//! The vertex shader turns tongues to face the camera: a rhomb seen from its edge would be invisible. Bases lie level, the
//! first as the bed of embers, those of copies where flames rise from their tongues.

use super::{
    components::Flames,
    rhombs::{Rhomb, RhombKind},
};
use bevy::{
    asset::RenderAssetUsages,
    camera::primitives::Aabb,
    mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexFormat},
    prelude::*,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

/// Longest diagonal and half of the shortest, m: `flame` of the shader.
pub(super) const ATTRIBUTE_FLAME: MeshVertexAttribute =
    MeshVertexAttribute::new("Flame", 0x464c_414d, VertexFormat::Float32x4);
/// Kind, phase, size as a share of the whole, order: `own` of the shader.
pub(super) const ATTRIBUTE_FLAME_OWN: MeshVertexAttribute =
    MeshVertexAttribute::new("FlameOwn", 0x464c_4f57, VertexFormat::Float32x4);

/// Kinds of strips, as the shader numbers them.
const BED: f32 = 0.0;
const TONGUE: f32 = 1.0;
const SPARK: f32 = 2.0;
const GLOW: f32 = 3.0;
const BASE: f32 = 4.0;

/// Rows of a strip: enough for a tongue to curve.
const ROWS: u32 = 5;
/// Breadth of a spark, as a share of the fire's size.
const SPARK_SHARE: f32 = 0.007;
/// Radius of the glow over the height of the fire.
const GLOW_SHARE: f32 = 1.5;
/// How far flames and sparks may be blown, in heights of the fire.
const REACH: f32 = 4.0;

#[derive(Default)]
struct Strips {
    starts: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    flames: Vec<[f32; 4]>,
    own: Vec<[f32; 4]>,
    indices: Vec<u32>,
}

impl Strips {
    fn add(&mut self, start: Vec3, along: Vec3, half_width_m: f32, own: [f32; 4]) {
        let first = self.starts.len() as u32;
        for row in 0..ROWS {
            for side in [-1.0, 1.0] {
                self.starts.push(start.to_array());
                self.uvs.push([side, row as f32 / (ROWS - 1) as f32]);
                self.flames.push(along.extend(half_width_m).to_array());
                self.own.push(own);
            }
        }
        let quads = (0..ROWS - 1).map(|row| first + 2 * row);
        self.indices.extend(quads.flat_map(|a| [a, a + 1, a + 2, a + 2, a + 1, a + 3]));
    }
}

pub(super) fn fire_mesh(flames: &Flames) -> Mesh {
    let shape = &flames.fire.shape;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(!shape.seed);
    let mut strips = Strips::default();
    let half_width = |rhomb: &Rhomb| 0.5 * rhomb.across.length();
    for rhomb in flames.rhombs.iter() {
        let share = match rhomb.kind {
            RhombKind::Base => rhomb.along.length() / shape.size_m,
            RhombKind::Tongue => rhomb.along.length() / (shape.size_m * shape.tongue_length),
        };
        match rhomb.kind {
            RhombKind::Base => {
                let kind = if rhomb.order == 0 { BED } else { BASE };
                let own = [kind, random.random(), share, rhomb.order as f32];
                strips.add(rhomb.start, rhomb.along, half_width(rhomb), own);
            }
            RhombKind::Tongue => {
                let own = [TONGUE, random.random(), share, rhomb.order as f32];
                strips.add(rhomb.start, rhomb.along, half_width(rhomb), own);
            }
        }
    }
    for _ in 0..flames.fire.look.embers {
        let place = Vec2::from_angle(random.random_range(0.0..std::f32::consts::TAU)) * random.random::<f32>();
        let start = Vec3::new(place.x, 0.0, place.y) * (0.3 * shape.size_m);
        strips.add(start, Vec3::Y * shape.size_m, SPARK_SHARE * shape.size_m, [SPARK, random.random(), 0.0, 0.0]);
    }
    if flames.fire.look.glow > 0.0 {
        let radius = GLOW_SHARE * flames.height_m;
        strips.add(Vec3::Y * (0.4 * flames.height_m), Vec3::Y * radius, radius, [GLOW, 0.0, 1.0, 0.0]);
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, strips.starts)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, strips.uvs)
        .with_inserted_attribute(ATTRIBUTE_FLAME, strips.flames)
        .with_inserted_attribute(ATTRIBUTE_FLAME_OWN, strips.own)
        .with_inserted_indices(Indices::U32(strips.indices))
}

/// A box that holds the fire and its sparks in a storm.
pub(super) fn bounds(flames: &Flames) -> Aabb {
    let reach = REACH * flames.height_m.max(flames.fire.shape.size_m);
    Aabb::from_min_max(Vec3::new(-reach, -0.5 * reach, -reach), Vec3::splat(reach))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fire::{Fire, FireLook, FireShape};
    use bevy::mesh::VertexAttributeValues;

    fn flames(look: FireLook) -> Flames {
        Flames::from(&Fire { shape: FireShape { seed: 5, ..FireShape::default() }, look })
    }

    /// How many strips there are of each kind.
    fn strips(mesh: &Mesh) -> [usize; 5] {
        let Some(VertexAttributeValues::Float32x4(own)) = mesh.attribute(ATTRIBUTE_FLAME_OWN) else {
            panic!("four floats for each vertex")
        };
        let mut counts = [0; 5];
        own.iter().step_by(2 * ROWS as usize).for_each(|own| counts[own[0] as usize] += 1);
        counts
    }

    #[test]
    fn every_rhomb_is_drawn_the_bases_of_copies_among_them() {
        let flames = flames(FireLook { embers: 7, glow: 0.2, ..FireLook::default() });
        let seeds = flames.rhombs.len() / 4;
        let [bed, tongues, sparks, glow, bases] = strips(&fire_mesh(&flames));
        assert_eq!([bed, tongues, bases], [1, 3 * seeds, seeds - 1]);
        assert_eq!([sparks, glow], [7, 1]);
    }

    #[test]
    fn a_base_is_a_level_strip_of_its_own_size() {
        let flames = flames(FireLook { embers: 0, glow: 0.0, ..FireLook::default() });
        let mesh = fire_mesh(&flames);
        let Some(VertexAttributeValues::Float32x4(drawn)) = mesh.attribute(ATTRIBUTE_FLAME) else {
            panic!("four floats for each vertex")
        };
        let stride = 2 * ROWS as usize;
        assert_eq!(drawn.len(), stride * flames.rhombs.len());
        for (rhomb, flame) in flames.rhombs.iter().zip(drawn.iter().step_by(stride)) {
            assert_eq!(Vec3::from_slice(flame), rhomb.along);
            assert_eq!(flame[3], 0.5 * rhomb.across.length());
            assert_eq!(rhomb.kind == RhombKind::Base, flame[1] == 0.0);
        }
    }
}
