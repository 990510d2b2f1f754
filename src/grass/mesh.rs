//! The mesh of a meadow: each blade a tapered strip of [`LINKS`] links.

use super::{
    blades::Blade,
    components::Meadow,
    settings::GrassLook,
    spine::{LINKS, axis},
};
use bevy::{
    asset::RenderAssetUsages,
    camera::primitives::Aabb,
    mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexFormat},
    prelude::*,
};

/// Length, width at the base, dryness, rank: `form` of the shader.
pub(super) const ATTRIBUTE_BLADE: MeshVertexAttribute =
    MeshVertexAttribute::new("Blade", 0x424c_4144, VertexFormat::Float32x4);
/// Azimuth, lean, droop, phase: `turn` of the shader.
pub(super) const ATTRIBUTE_BLADE_TURN: MeshVertexAttribute =
    MeshVertexAttribute::new("BladeTurn", 0x424c_5455, VertexFormat::Float32x4);

/// Share of the ground that is under trees: `under_trees` of the shader.
pub(super) const ATTRIBUTE_UNDER_TREES: MeshVertexAttribute =
    MeshVertexAttribute::new("UnderTrees", 0x554e_4452, VertexFormat::Float32);

/// Vertices of a blade: two at each joint, one at the tip.
const VERTICES: u32 = 2 * LINKS as u32 + 1;

/// The golden ratio less 1. Its multiples modulo 1 are spread evenly, so neighbours in rank flutter out of phase.
const GOLDEN: f32 = 0.618_034;

/// Side and joint of each vertex of a blade: `uv` of the shader.
fn corners() -> impl Iterator<Item = [f32; 2]> {
    (0..LINKS).flat_map(|joint| [[-1.0, joint as f32], [1.0, joint as f32]]).chain([[0.0, LINKS as f32]])
}

fn indices(blades: u32) -> Indices {
    let tip = VERTICES - 1;
    let strip = (0..LINKS as u32 - 1).flat_map(|joint| {
        let a = 2 * joint;
        [a, a + 1, a + 2, a + 2, a + 1, a + 3]
    });
    let blade: Vec<u32> = strip.chain([tip - 2, tip - 1, tip]).collect();
    Indices::U32((0..blades).flat_map(|number| blade.iter().map(move |index| number * VERTICES + index)).collect())
}

/// The mesh whose blades the vertex shader bends: each vertex knows its whole blade.
pub(super) fn swaying_mesh(blades: &[Blade]) -> Mesh {
    let each = |row: &dyn Fn(usize, &Blade) -> [f32; 4]| -> Vec<[f32; 4]> {
        let rows = blades.iter().enumerate().map(|(number, blade)| row(number, blade));
        rows.flat_map(|row| std::iter::repeat_n(row, VERTICES as usize)).collect()
    };
    let shapes = each(&|_, blade| [blade.length_m, blade.width_m, blade.dryness, blade.rank]);
    let turns =
        each(&|number, blade| [blade.azimuth_rad, blade.lean_rad, blade.droop_rad, (number as f32 * GOLDEN).fract()]);
    let roots = blades.iter().flat_map(|blade| std::iter::repeat_n(blade.root.to_array(), VERTICES as usize));
    let shares = blades.iter().flat_map(|blade| std::iter::repeat_n(blade.under_trees, VERTICES as usize));
    let uvs = blades.iter().flat_map(|_| corners());
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, roots.collect::<Vec<_>>())
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs.collect::<Vec<_>>())
        .with_inserted_attribute(ATTRIBUTE_BLADE, shapes)
        .with_inserted_attribute(ATTRIBUTE_BLADE_TURN, turns)
        .with_inserted_attribute(ATTRIBUTE_UNDER_TREES, shares.collect::<Vec<_>>())
        .with_inserted_indices(indices(blades.len() as u32))
}

/// The mesh for devices whose vertex shaders cannot read the wind: blades as they stand in still air.
pub(super) fn still_mesh(blades: &[Blade], look: &GrassLook) -> Mesh {
    let (mut positions, mut normals, mut colours) = (Vec::new(), Vec::new(), Vec::new());
    for blade in blades {
        let spine = blade.spine(Vec2::ZERO);
        for [side, joint] in corners() {
            let s = joint / LINKS as f32;
            let across = Vec2::from_angle(blade.azimuth_rad).perp();
            let half_width = 0.5 * blade.width_m * (1.0 - s * s);
            let off = Vec3::new(across.x, 0.0, across.y) * (side * half_width);
            positions.push((spine[joint as usize] + off).to_array());
            normals.push((Vec3::Y + 0.3 * axis(blade.angle_at(s, Vec2::ZERO))).normalize().to_array());
            colours.push(colour(blade, look, s));
        }
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
        .with_inserted_indices(indices(blades.len() as u32))
}

/// `colour` of the shader, without what differs from blade to blade.
fn colour(blade: &Blade, look: &GrassLook, s: f32) -> [f32; 4] {
    let [root, tip, dry] = [look.root_colour, look.tip_colour, look.dry_colour].map(Vec3::from_array);
    root.lerp(tip, s).lerp(dry * 0.2_f32.lerp(1.0, s), blade.dryness).extend(1.0).to_array()
}

/// A box that holds the meadow in every wind.
pub(super) fn bounds(meadow: &Meadow) -> Aabb {
    let reach = Vec3::splat(meadow.patch.sward.tuft.longest_m);
    let roots = || meadow.blades.iter().map(|blade| blade.root);
    let least = roots().reduce(Vec3::min).unwrap_or_default();
    let greatest = roots().reduce(Vec3::max).unwrap_or_default();
    Aabb::from_min_max(least - reach, greatest + reach)
}

#[cfg(test)]
mod tests {
    use super::{
        super::{blades::layout_blades, components::GrassPatch, settings::Sward},
        *,
    };
    use bevy::math::DVec2;
    use std::sync::Arc;

    fn meadow() -> Meadow {
        let sward = Sward { width_m: 2.0, depth_m: 2.0, ..Sward::default() };
        let patch = GrassPatch { sward, ..GrassPatch::default() };
        Meadow { blades: Arc::new(layout_blades(&patch.sward, &|at: DVec2| at.x)), patch }
    }

    #[test]
    fn meshes_have_the_vertices_and_triangles_of_every_blade() {
        let meadow = meadow();
        let blades = meadow.blades.len();
        for mesh in [swaying_mesh(&meadow.blades), still_mesh(&meadow.blades, &meadow.patch.look)] {
            assert_eq!(mesh.count_vertices(), blades * VERTICES as usize);
            let indices: Vec<usize> = mesh.indices().expect("it has some").iter().collect();
            assert_eq!(indices.len(), blades * 3 * (2 * LINKS - 1));
            assert_eq!(indices.iter().max(), Some(&(mesh.count_vertices() - 1)));
        }
    }

    #[test]
    fn bounds_contain_every_blade_in_every_wind() {
        let meadow = meadow();
        let (least, greatest) = (Vec3::from(bounds(&meadow).min()), Vec3::from(bounds(&meadow).max()));
        for blade in meadow.blades.iter() {
            for k in 0..8 {
                let tip = blade.spine(Vec2::from_angle(k as f32) * 1.2)[LINKS];
                assert!(tip.cmpge(least).all() && tip.cmple(greatest).all());
            }
        }
    }
}
