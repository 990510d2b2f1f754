//! Diagrams of a tree: its triangles, its skeleton, the frequencies of its branches, its levels of detail, the area of its leaves.
//!
//! Each is a mesh with a colour at every vertex, at rest, and a legend of what the colours mean.

use std::collections::BTreeMap;

use bevy::{math::Vec3, reflect::Reflect};

use super::tip_motion::frequency_hz;
use crate::{
    lod::{Decimation, decimate},
    texture::linear,
    tree::{
        TreeModel,
        vertices::{LeafVertices, WoodVertices},
    },
};

/// What is shown of a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
pub enum View {
    /// As it is drawn in a game.
    #[default]
    Lit,
    /// The edges of its triangles.
    Wireframe,
    /// Its beams, by order of branching.
    Skeleton,
    /// Its wood by natural frequency.
    Frequencies,
    /// Its levels of detail, side by side.
    Levels,
    /// Its foliage by leaf area density.
    LeafArea,
}

impl View {
    /// All of them, with their names and what they are good for.
    pub const ALL: [(Self, &'static str, &'static str); 6] = [
        (Self::Lit, "Lit", "The tree as a game draws it"),
        (Self::Wireframe, "Wireframe", "The edges of its triangles, at rest"),
        (Self::Skeleton, "Skeleton", "Its beams, by order of branching"),
        (Self::Frequencies, "Frequencies", "Its wood, by the natural frequency of each branch"),
        (Self::Levels, "Levels", "Its levels of detail, side by side"),
        (Self::LeafArea, "Leaf area", "Its foliage, by the area of leaves in a cubic metre"),
    ];
}

/// A mesh of lines or of triangles, and its legend.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagram {
    /// m, in the tree's coordinates.
    pub positions: Vec<[f32; 3]>,
    /// Linear RGBA.
    pub colours: Vec<[f32; 4]>,
    pub indices: Vec<u32>,
    /// Two indices for each line, or three for each triangle.
    pub is_lines: bool,
    /// What the colours mean, in sRGB.
    pub legend: Vec<(String, [f32; 3])>,
}

/// Viridis (Smith & van der Walt 2015) at five places, sRGB: even in lightness, and for those who see few colours.
const VIRIDIS: [[f32; 3]; 5] =
    [[0.267, 0.005, 0.329], [0.229, 0.322, 0.546], [0.128, 0.567, 0.551], [0.369, 0.789, 0.383], [0.993, 0.906, 0.144]];
const WOOD: [f32; 3] = [0.62, 0.50, 0.38];
const LEAVES: [f32; 3] = [0.42, 0.66, 0.30];
/// Side of the cubes in which leaf area is counted, m.
const CUBE_M: f32 = 1.0;
/// The light of shaded diagrams comes from here.
const LIGHT: Vec3 = Vec3::new(0.5, 0.75, 0.43);
/// Frequencies of the legend, Hz, the first and the last being the ends of the colours.
const FREQUENCIES_HZ: [f32; 5] = [0.1, 0.3, 1.0, 3.0, 10.0];

/// A diagram of a tree; none for the lit view, which is no diagram. `levels` are those below the grown tree.
pub fn diagram(model: &TreeModel, view: View, levels: &[Decimation], leaf_share: f32) -> Option<Diagram> {
    match view {
        View::Lit => None,
        View::Wireframe => Some(wireframe(model)),
        View::Skeleton => Some(skeleton(model)),
        View::Frequencies => Some(frequencies(model, leaf_share)),
        View::Levels => Some(side_by_side(model, levels)),
        View::LeafArea => Some(leaf_area(model)),
    }
}

impl Diagram {
    /// Adds vertices of one colour each, and indices among them.
    fn add(&mut self, positions: &[[f32; 3]], indices: &[u32], offset: Vec3, colour: impl Fn(usize) -> [f32; 3]) {
        let first = self.positions.len() as u32;
        self.positions.extend(positions.iter().map(|at| (Vec3::from(*at) + offset).to_array()));
        let rgba = |srgb| {
            let [red, green, blue] = linear(srgb);
            [red, green, blue, 1.0]
        };
        self.colours.extend((0..positions.len()).map(|vertex| rgba(colour(vertex))));
        self.indices.extend(indices.iter().map(|index| first + index));
    }
}

fn wireframe(model: &TreeModel) -> Diagram {
    let mut out = Diagram { is_lines: true, ..Diagram::default() };
    let parts = [
        (&model.wood.positions, &model.wood.indices, WOOD, "wood"),
        (&model.leaves.positions, &model.leaves.indices, LEAVES, "leaves"),
    ];
    for (positions, triangles, colour, name) in parts {
        let edge = |corners: &[u32]| [[corners[0], corners[1]], [corners[1], corners[2]], [corners[2], corners[0]]];
        let mut edges: Vec<[u32; 2]> = triangles.chunks_exact(3).flat_map(edge).collect();
        edges.iter_mut().for_each(|edge| edge.sort_unstable());
        edges.sort_unstable();
        edges.dedup();
        out.add(positions, edges.as_flattened(), Vec3::ZERO, |_| colour);
        out.legend.push((format!("{} triangles of {name}", triangles.len() / 3), colour));
    }
    out
}

fn skeleton(model: &TreeModel) -> Diagram {
    /// Pieces of a bowed beam.
    const PIECES: u32 = 3;
    let mut out = Diagram { is_lines: true, ..Diagram::default() };
    let mut counts: BTreeMap<u8, usize> = BTreeMap::new();
    let lines: Vec<u32> = (0..PIECES).flat_map(|piece| [piece, piece + 1]).collect();
    let colour = |order: u8| viridis(1.0 - f32::from(order) / 4.0);
    for beam in &model.skeleton.beams {
        let points: Vec<[f32; 3]> =
            (0..=PIECES).map(|piece| beam.path(piece as f32 / PIECES as f32).to_array()).collect();
        out.add(&points, &lines, Vec3::ZERO, |_| colour(beam.order));
        *counts.entry(beam.order).or_default() += 1;
    }
    out.legend =
        counts.into_iter().map(|(order, count)| (format!("order {order}: {count} beams"), colour(order))).collect();
    out
}

fn frequencies(model: &TreeModel, leaf_share: f32) -> Diagram {
    let place = |hz: f32| (hz / FREQUENCIES_HZ[0]).ln() / (FREQUENCIES_HZ[4] / FREQUENCIES_HZ[0]).ln();
    let of_beam: Vec<[f32; 3]> =
        model.beams.iter().map(|beam| viridis(place(frequency_hz(beam, leaf_share)))).collect();
    let mut out = Diagram::default();
    let WoodVertices { positions, sway, normals, indices, .. } = &*model.wood;
    let colour = |vertex: usize| {
        let beam = of_beam.get(sway[vertex][0] as usize).copied().unwrap_or(WOOD);
        beam.map(|channel| channel * shade(normals[vertex]))
    };
    out.add(positions, indices, Vec3::ZERO, colour);
    out.legend = FREQUENCIES_HZ.map(|hz| (format!("{hz} Hz"), viridis(place(hz)))).to_vec();
    out
}

fn side_by_side(model: &TreeModel, levels: &[Decimation]) -> Diagram {
    let reach_m = |at: &[f32; 3]| at[0].hypot(at[2]);
    let all = model.wood.positions.iter().chain(&model.leaves.positions);
    let apart_m = 2.15 * all.map(reach_m).fold(0.5, f32::max);
    let mut out = Diagram::default();
    let mut add = |number: usize, wood: &WoodVertices, leaves: &LeafVertices| {
        let offset = Vec3::X * apart_m * (number as f32 - 0.5 * levels.len() as f32);
        let shaded = |normals: &[[f32; 3]], colour: [f32; 3], vertex: usize| {
            let shade = shade(normals[vertex]);
            colour.map(|channel| channel * shade)
        };
        out.add(&wood.positions, &wood.indices, offset, |vertex| shaded(&wood.normals, WOOD, vertex));
        out.add(&leaves.positions, &leaves.indices, offset, |vertex| shaded(&leaves.normals, LEAVES, vertex));
        let triangles = (wood.indices.len() + leaves.indices.len()) / 3;
        let name = if number == 0 { "grown".to_owned() } else { format!("level {number}") };
        out.legend.push((format!("{name}: {triangles} triangles"), LEAVES));
    };
    add(0, &model.wood, &model.leaves);
    for (number, level) in (1..).zip(levels) {
        let meshes = decimate(model, level);
        add(number, &meshes.wood, &meshes.leaves);
    }
    out
}

fn leaf_area(model: &TreeModel) -> Diagram {
    let leaves = &*model.leaves;
    let corner = |index: u32| Vec3::from(leaves.positions[index as usize]);
    let cube = |at: Vec3| (at / CUBE_M).floor().as_ivec3().to_array();
    let mut areas_m2: BTreeMap<[i32; 3], f32> = BTreeMap::new();
    let mut total_m2 = 0.0;
    for triangle in leaves.indices.chunks_exact(3) {
        let [a, b, c] = [corner(triangle[0]), corner(triangle[1]), corner(triangle[2])];
        let area_m2 = 0.5 * (b - a).cross(c - a).length();
        *areas_m2.entry(cube((a + b + c) / 3.0)).or_default() += area_m2;
        total_m2 += area_m2;
    }
    let densities = areas_m2.values().map(|area| area / CUBE_M.powi(3));
    let densest = densities.fold(1e-3, f32::max);
    let mut out = Diagram::default();
    let density = |vertex: usize| {
        let anchor = Vec3::from_slice(&leaves.anchor[vertex]);
        let own = areas_m2.get(&cube(anchor)).or_else(|| areas_m2.get(&cube(Vec3::from(leaves.positions[vertex]))));
        viridis(own.copied().unwrap_or(0.0) / densest)
    };
    out.add(&leaves.positions, &leaves.indices, Vec3::ZERO, density);
    let stop = |share: f32| (format!("{:.1} m²/m³", share * densest), viridis(share));
    out.legend = [0.0, 0.5, 1.0].map(stop).to_vec();
    out.legend.push((format!("{total_m2:.0} m² of cards in all"), LEAVES));
    out
}

/// Light on a surface, 0 to 1, from both sides.
fn shade(normal: [f32; 3]) -> f32 {
    0.45 + 0.55 * Vec3::from(normal).dot(LIGHT).max(0.0)
}

/// A colour of the scale at 0 to 1, sRGB.
fn viridis(share: f32) -> [f32; 3] {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f32;
    let low = (place as usize).min(VIRIDIS.len() - 2);
    let between = |channel: usize| {
        VIRIDIS[low][channel] + (place - low as f32) * (VIRIDIS[low + 1][channel] - VIRIDIS[low][channel])
    };
    [between(0), between(1), between(2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{lod::LodBakeSettings, tree::Species};

    #[test]
    fn every_view_of_every_growth_is_a_mesh_with_a_legend() {
        let levels = LodBakeSettings::default().decimations;
        for name in ["oak", "fir", "billows", "impression_winter", "dead_tree"] {
            let path = format!("{}/assets/species/{name}.species.ron", env!("CARGO_MANIFEST_DIR"));
            let species = Species::from_ron(&std::fs::read_to_string(path).unwrap()).unwrap();
            let model = TreeModel::bake(&species, 15.0, 3);
            assert_eq!(diagram(&model, View::Lit, &levels, 1.0), None);
            for (view, label, _) in View::ALL.into_iter().skip(1) {
                let drawn = diagram(&model, view, &levels, 1.0).unwrap();
                let corners = if drawn.is_lines { 2 } else { 3 };
                assert!(drawn.indices.len().is_multiple_of(corners), "{name}, {label}");
                assert!(drawn.indices.iter().all(|index| (*index as usize) < drawn.positions.len()), "{name}, {label}");
                assert_eq!(drawn.positions.len(), drawn.colours.len());
                assert!(drawn.colours.iter().flatten().all(|channel| (0.0..=1.0).contains(channel)), "{name}, {label}");
                assert!(!drawn.legend.is_empty() && drawn.positions.iter().flatten().all(|at| at.is_finite()));
            }
        }
    }

    #[test]
    fn levels_stand_side_by_side_and_get_simpler() {
        let model = TreeModel::bake(&Species::default(), 60.0, 1);
        let drawn = diagram(&model, View::Levels, &LodBakeSettings::default().decimations, 1.0).unwrap();
        let triangles = |(text, _): &(String, [f32; 3])| {
            text.split_whitespace().find_map(|word| word.parse::<usize>().ok().filter(|count| *count > 9)).unwrap()
        };
        let counts: Vec<usize> = drawn.legend.iter().map(triangles).collect();
        assert!(counts.len() == 3 && counts[0] > counts[1] && counts[1] > counts[2], "{counts:?}");
    }

    #[test]
    fn the_scale_of_colours_gets_lighter() {
        let lightness =
            |share: f32| linear(viridis(share)).into_iter().zip([0.21, 0.72, 0.07]).map(|(a, b)| a * b).sum::<f32>();
        assert!((0..20).all(|step| lightness(step as f32 / 20.0) < lightness((step + 1) as f32 / 20.0)));
    }
}
