//! The vertices of trees as the GPU has them: 20 bytes for one of wood and 28 for one of leaves, where floats would take 48 and 80.
//!
//! Positions (16 bits along each side of the mesh's box), normals (octahedral, twice 16 bits) and texture coordinates (16 bits over their
//! range) are in the formats of Bevy's compressed meshes, so that its own materials draw them, too. What is ours is packed here, and
//! unpacked by `render/shaders/packed_vertex.wesl`.

use bevy::{
    math::Vec3,
    mesh::{Mesh, MeshVertexAttribute, VertexAttributeValues, VertexFormat},
};

/// Beam (16 bits), and two shares: `sway` of the shader. For wood brightness of its green (8) and light (8), for leaves phase (10) and light
/// (6). The place on the beam is the fourth component of the position.
pub(super) const ATTRIBUTE_SWAY: MeshVertexAttribute =
    MeshVertexAttribute::new("Sway", 0x5357_4159, VertexFormat::Uint32);
/// Main axis of a leaf at rest, and its tint: `axis` of the shader.
pub(super) const ATTRIBUTE_LEAF_AXIS: MeshVertexAttribute =
    MeshVertexAttribute::new("LeafAxis", 0x4c41_5849, VertexFormat::Snorm8x4);
/// From where a leaf hangs to the vertex, over a length of which the fourth component is the logarithm: `reach` of the shader.
pub(super) const ATTRIBUTE_LEAF_REACH: MeshVertexAttribute =
    MeshVertexAttribute::new("LeafReach", 0x4c41_5245, VertexFormat::Snorm8x4);

const BEAM_BITS: u32 = 16;
const GREEN_BITS: u32 = 8;
const PHASE_BITS: u32 = 10;
/// Reaches are from a 2^-8th of a metre to 2^8 m long.
const REACH_DOUBLINGS: u32 = 8;

/// The layout as constants of the shaders.
pub(super) const PACKED_LAYOUT: [(&str, u32); 4] = [
    ("VERTEX_BEAM_BITS", BEAM_BITS),
    ("VERTEX_GREEN_BITS", GREEN_BITS),
    ("VERTEX_PHASE_BITS", PHASE_BITS),
    ("VERTEX_REACH_DOUBLINGS", REACH_DOUBLINGS),
];

/// The sway of a vertex: beam, place on it, a share (green of wood or phase of a leaf), light.
type Sway = [f32; 4];

/// Packs a mesh of wood, which has positions, normals and texture coordinates.
pub(super) fn pack_wood(mesh: Mesh, sway: &[Sway]) -> Mesh {
    let words: Vec<u32> = sway.iter().map(|sway| sway_word(sway, GREEN_BITS)).collect();
    packed(mesh, sway).with_inserted_attribute(ATTRIBUTE_SWAY, words)
}

/// Packs a mesh of leaves with the given anchors, m, and axes with tints.
pub(super) fn pack_leaves(mesh: Mesh, sway: &[Sway], axes: &[[f32; 4]], anchors: &[[f32; 4]]) -> Mesh {
    let words: Vec<u32> = sway.iter().map(|sway| sway_word(sway, PHASE_BITS)).collect();
    let reaches: Vec<[i8; 4]> = match mesh.attribute(Mesh::ATTRIBUTE_POSITION) {
        Some(VertexAttributeValues::Float32x3(positions)) => {
            let ends = positions.iter().zip(anchors);
            ends.map(|(to, from)| packed_reach(Vec3::from_array(*to) - Vec3::from_slice(from))).collect()
        }
        _ => Vec::new(),
    };
    let axes: Vec<[i8; 4]> = axes.iter().map(|axis| axis.map(snorm8)).collect();
    packed(mesh, sway)
        .with_inserted_attribute(ATTRIBUTE_SWAY, words)
        .with_inserted_attribute(ATTRIBUTE_LEAF_AXIS, VertexAttributeValues::Snorm8x4(axes))
        .with_inserted_attribute(ATTRIBUTE_LEAF_REACH, VertexAttributeValues::Snorm8x4(reaches))
}

/// What all vertices have in common. An empty mesh stays as it is: nothing of it is drawn.
fn packed(mut mesh: Mesh, sway: &[Sway]) -> Mesh {
    if mesh.count_vertices() == 0 {
        return mesh;
    }
    let is_packed = mesh.compress_positions().is_ok() && mesh.compress_normals().is_ok() && mesh.compress_uv0().is_ok();
    debug_assert!(is_packed, "trees have positions, normals and texture coordinates of floats");
    mesh.compress_indices();
    if let Some(VertexAttributeValues::Snorm16x4(positions)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        positions.iter_mut().zip(sway).for_each(|(position, sway)| position[3] = snorm16(sway[1]));
    }
    mesh
}

/// Lowest bits first: the beam, a share in `share_bits`, and the light in the rest.
fn sway_word([beam, _, share, light]: &Sway, share_bits: u32) -> u32 {
    let steps = |share: f32, bits: u32| {
        let most = (1_u32 << bits) - 1;
        (share.clamp(0.0, 1.0) * most as f32).round() as u32
    };
    let beam = (beam.round() as u32).min((1 << BEAM_BITS) - 1);
    beam | steps(*share, share_bits) << BEAM_BITS
        | steps(*light, u32::BITS - BEAM_BITS - share_bits) << (BEAM_BITS + share_bits)
}

/// A reach, m, over the shortest of the lengths `2^(8 k / 127)` m that no component exceeds, and `k`.
fn packed_reach(reach_m: Vec3) -> [i8; 4] {
    let longest_m = reach_m.abs().max_element();
    let step = (longest_m.log2() * 127.0 / REACH_DOUBLINGS as f32).ceil().clamp(-127.0, 127.0);
    let scaled = reach_m / reach_length_m(step);
    [snorm8(scaled.x), snorm8(scaled.y), snorm8(scaled.z), step as i8]
}

fn reach_length_m(step: f32) -> f32 {
    (REACH_DOUBLINGS as f32 * step / 127.0).exp2()
}

fn snorm8(value: f32) -> i8 {
    (value.clamp(-1.0, 1.0) * 127.0).round() as i8
}

fn snorm16(value: f32) -> i16 {
    (value.clamp(-1.0, 1.0) * 32_767.0).round() as i16
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::{
        asset::RenderAssetUsages,
        mesh::{Indices, PrimitiveTopology},
    };
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// As the shader unpacks it.
    fn unpacked_word(word: u32, share_bits: u32) -> [f32; 3] {
        let share = |from: u32, bits: u32| ((word >> from) & ((1 << bits) - 1)) as f32 / ((1 << bits) - 1) as f32;
        let light = share(BEAM_BITS + share_bits, u32::BITS - BEAM_BITS - share_bits);
        [(word & 0xffff) as f32, share(BEAM_BITS, share_bits), light]
    }

    fn unpacked_reach_m([x, y, z, step]: [i8; 4]) -> Vec3 {
        Vec3::new(x.into(), y.into(), z.into()) / 127.0 * reach_length_m(step.into())
    }

    #[test]
    fn beams_are_exact_and_shares_are_off_by_half_a_step() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        for (share_bits, light_bits) in [(GREEN_BITS, 8), (PHASE_BITS, 6)] {
            for _ in 0..10_000 {
                let (beam, share, light) = (random.random_range(0..65_536_u32), random.random(), random.random());
                let sway = [beam as f32, 0.5, share, light];
                let [beam_back, share_back, light_back] = unpacked_word(sway_word(&sway, share_bits), share_bits);
                assert_eq!(beam_back, beam as f32);
                let half_step = |bits: u32| 0.5 / ((1 << bits) - 1) as f32 + 1e-6;
                assert!((share_back - share).abs() <= half_step(share_bits), "{share} is {share_back}");
                assert!((light_back - light).abs() <= half_step(light_bits), "{light} is {light_back}");
            }
        }
        // Bark is told from green wood by a brightness of 0.
        assert_eq!(unpacked_word(sway_word(&[7.0, 0.0, 0.0, 1.0], GREEN_BITS), GREEN_BITS), [7.0, 0.0, 1.0]);
    }

    #[test]
    fn bad_numbers_are_packed_as_something() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e30] {
            let [beam, share, light] = unpacked_word(sway_word(&[bad; 4], PHASE_BITS), PHASE_BITS);
            assert!(beam <= 65_535.0 && (0.0..=1.0).contains(&share) && (0.0..=1.0).contains(&light));
            assert!(unpacked_reach_m(packed_reach(Vec3::splat(bad))).is_finite());
        }
    }

    #[test]
    fn reaches_are_off_by_half_a_percent_of_the_longest_side() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
        for _ in 0..10_000 {
            let scale_m = 2.0_f32.powf(random.random_range(-7.0..7.0));
            let reach_m = scale_m * Vec3::from_array([(); 3].map(|()| random.random_range(-1.0..1.0)));
            let error_m = (unpacked_reach_m(packed_reach(reach_m)) - reach_m).abs().max_element();
            // Half of a 127th, of a length that is a 127th of eight doublings too long at most; the shortest is 2^-8 m.
            let longest_m = reach_m.abs().max_element();
            let bound_m = 0.5 / 127.0 * (2.0_f32.powf(8.0 / 127.0) * longest_m).max(2.0_f32.powi(-8));
            assert!(error_m <= 1.001 * bound_m, "{reach_m} is off by {error_m} m");
        }
        assert_eq!(unpacked_reach_m(packed_reach(Vec3::ZERO)), Vec3::ZERO, "the vertex where a leaf hangs");
    }

    /// A mesh of three vertices in a box of 10 x 20 x 4 m.
    fn triangle() -> Mesh {
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(
                Mesh::ATTRIBUTE_POSITION,
                vec![[-5.0, 0.0, 1.0], [5.0, 20.0, -3.0], [0.1, 7.3, 0.9]],
            )
            .with_inserted_attribute(
                Mesh::ATTRIBUTE_NORMAL,
                vec![[0.6, 0.0, 0.8], [0.0, -1.0, 0.0], [-0.48, 0.6, -0.64]],
            )
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0, 3.0], [2.0, 43.0], [1.0, 17.2]])
            .with_inserted_indices(Indices::U32(vec![0, 1, 2]))
    }

    const SWAY: [Sway; 3] = [[0.0, 0.0, 0.0, 1.0], [300.0, 0.37, 0.5, 0.2], [65_535.0, 1.0, 1.0, 0.0]];

    #[test]
    fn a_vertex_of_wood_has_20_bytes_and_one_of_leaves_28() {
        let wood = pack_wood(triangle(), &SWAY);
        assert_eq!(wood.get_vertex_buffer_size(), 3 * 20);
        assert_eq!(wood.get_index_buffer_bytes().map(<[u8]>::len), Some(3 * 2));
        let leaves = pack_leaves(triangle(), &SWAY, &[[1.0, 0.0, 0.0, 0.5]; 3], &[[0.0, 7.0, 0.0, 0.0]; 3]);
        assert_eq!(leaves.get_vertex_buffer_size(), 3 * 28);
    }

    #[test]
    fn positions_are_off_by_half_a_step_of_the_box() {
        let wood = pack_wood(triangle(), &SWAY);
        let Some(VertexAttributeValues::Snorm16x4(packed)) = wood.attribute(Mesh::ATTRIBUTE_POSITION) else {
            panic!("positions are packed");
        };
        let (centre, half) = (Vec3::new(0.0, 10.0, -1.0), Vec3::new(5.0, 10.0, 2.0));
        let unpacked = |[x, y, z, _]: [i16; 4]| centre + half * Vec3::new(x.into(), y.into(), z.into()) / 32_767.0;
        let expected = [Vec3::new(-5.0, 0.0, 1.0), Vec3::new(5.0, 20.0, -3.0), Vec3::new(0.1, 7.3, 0.9)];
        for (vertex, expected) in expected.into_iter().enumerate() {
            let error = (unpacked(packed[vertex]) - expected).abs();
            assert!(error.cmple(0.51 * half / 32_767.0 + Vec3::splat(1e-6)).all(), "{error}");
            let place = f32::from(packed[vertex][3]) / 32_767.0;
            assert!((place - SWAY[vertex][1]).abs() < 1.6e-5, "{place}");
        }
    }

    #[test]
    fn a_mesh_without_vertices_stays_empty() {
        let empty = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, Vec::<[f32; 3]>::new());
        assert_eq!(pack_wood(empty, &[]).count_vertices(), 0);
    }
}
