//! Frames of whole trees and of single branches, on the assumptions that the product makes too (`tree::mechanics`): wood
//! inside the bark, rocking roots, clusters of leaves as lumps. The figures are written again here.

use super::{Frame, Lump, element::Rod};
use bevy::math::Vec3;
use bevy_windwood::tree::{
    Species,
    skeleton::{LeafCluster, Skeleton, SkeletonBeam},
};
use nalgebra::Vector3;

const AIR_DENSITY_KG_M3: f64 = 1.225;
/// Of a round branch below the drag crisis (Simiu & Scanlan 1978).
const BRANCH_DRAG_COEFFICIENT: f64 = 1.2;
/// Bark as a share of the radius. It bears nothing.
const BARK_SHARE: f64 = 0.06;
/// Shear modulus over Young's modulus of wood: 0.06 of spruces to 0.09 of oaks (Wood Handbook 2010, table 5-1).
const SHEAR_SHARE: f64 = 0.07;
/// Root plate of six stem radii on soil of a shear modulus of 1e6 Pa and a Poisson ratio of 0.4 (a rigid disc that rocks:
/// Borowicka 1943).
const PLATE_RADII: f64 = 6.0;
const SOIL_SHEAR_PA: f64 = 1e6;
const SOIL_POISSON: f64 = 0.4;
/// Pieces of a beam whose wood is a lump each, in the middle of the piece.
const PIECES: usize = 6;
/// Radius, as a share of the chain's thickest, down to which weight pulls a trunk or a branch over. A thinner leader, as it is
/// drawn, would hardly stand under sprays that are lumps; what it bears weighs on the wood below, on a rigid arm.
const WEIGHED_SHARE: f32 = 0.2;
/// Rods shorter than this share of their beam would serve nothing but rounding.
const SHORTEST_ROD: f64 = 0.01;

/// A frame, and where the beams of its skeleton are in it.
pub struct TreeFrame {
    pub frame: Frame,
    /// Nodes on each beam that is in the frame, by their place on it, 0 to 1. The first is the node that bears the beam.
    pub nodes: Vec<Vec<(f64, usize)>>,
}

/// A place on a chain of beams that is a node of the frame.
#[derive(Clone, Copy)]
pub struct Place {
    pub beam: usize,
    /// On that beam, 0 to 1.
    pub s: f64,
    pub node: usize,
}

impl TreeFrame {
    /// The node nearest to a share of the length of a chain of beams, 0 to 1.
    pub fn place(&self, skeleton: &Skeleton, beams: &[usize], share: f64) -> Place {
        let length_m = |beam: &usize| f64::from(skeleton.beams[*beam].length_m);
        let mut left_m = share * beams.iter().map(length_m).sum::<f64>();
        let mut beam = beams[0];
        for &next in beams {
            beam = next;
            if left_m <= length_m(&beam) {
                break;
            }
            left_m -= length_m(&beam);
        }
        let node = nearest(&self.nodes[beam], left_m / length_m(&beam));
        let s = self.nodes[beam].iter().find(|(_, other)| *other == node).map_or(1.0, |(s, _)| *s);
        Place { beam, s, node }
    }
}

/// A whole tree on its roots. Weight pulls over the trunk, with all that it bears. The moduli of each beam are multiplied by `stiffening`.
pub fn whole(species: &Species, skeleton: &Skeleton, stiffening: impl Fn(usize) -> f64) -> TreeFrame {
    let all = vec![true; skeleton.beams.len()];
    build(species, skeleton, &all, |beam| Some(root_stiffness_nm_rad(beam)), stiffening)
}

/// A branch, from its `first` beam, with all that it bears, held fast where it grows. Weight pulls on its own chain.
pub fn branch(species: &Species, skeleton: &Skeleton, first: usize, stiffening: impl Fn(usize) -> f64) -> TreeFrame {
    build(species, skeleton, &borne_by(skeleton, first), |_| None, stiffening)
}

/// Which beams are `first` or borne by it.
pub fn borne_by(skeleton: &Skeleton, first: usize) -> Vec<bool> {
    let mut borne = vec![false; skeleton.beams.len()];
    for (index, beam) in skeleton.beams.iter().enumerate() {
        borne[index] = index == first || beam.parent.is_some_and(|parent| borne[parent as usize]);
    }
    borne
}

fn build(
    species: &Species,
    skeleton: &Skeleton,
    included: &[bool],
    rocking_nm_rad: impl Fn(&SkeletonBeam) -> Option<f64>,
    stiffening: impl Fn(usize) -> f64,
) -> TreeFrame {
    let mut frame = Frame::default();
    let mut nodes: Vec<Vec<(f64, usize)>> = vec![Vec::new(); skeleton.beams.len()];
    let cuts = cuts(skeleton, included);
    let first = included.iter().position(|included| *included).unwrap_or(0);
    let main = chain(skeleton, first);
    for (index, beam) in skeleton.beams.iter().enumerate().filter(|(index, _)| included[*index]) {
        let bearer = beam.parent.map(|parent| parent as usize).filter(|parent| included[*parent]);
        let root = match bearer {
            Some(parent) => nearest(&nodes[parent], f64::from(beam.attach)),
            None => frame.stand(vector(beam.base), rocking_nm_rad(beam)),
        };
        nodes[index].push((0.0, root));
        let (mut from, mut before) = (root, 0.0);
        for &cut in &cuts[index] {
            let rod = rod(species, beam, before, cut, stiffening(index));
            let node = frame.extend(from, on(beam, before), on(beam, cut), rod);
            let least_m = WEIGHED_SHARE * skeleton.beams[first].base_radius_m;
            if !main.contains(&index) || beam.radius_m(cut as f32) < least_m {
                frame.unweigh(node);
            }
            nodes[index].push((cut, node));
            (from, before) = (node, cut);
        }
        for middle in MIDDLES {
            frame.lumps.push(wood(species, beam, nearest(&nodes[index], middle), middle));
        }
    }
    for cluster in skeleton.clusters.iter().filter(|cluster| included[cluster.beam as usize]) {
        let node = nearest(&nodes[cluster.beam as usize], f64::from(cluster.at));
        frame.lumps.push(leaves(species, cluster, node));
    }
    TreeFrame { frame, nodes }
}

/// Middles of the pieces of a beam.
const MIDDLES: [f64; PIECES] = [1.0 / 12.0, 3.0 / 12.0, 5.0 / 12.0, 7.0 / 12.0, 9.0 / 12.0, 11.0 / 12.0];

/// Where each beam is cut into rods: wherever it bears something, so that no rod is bent by what it does not bear.
fn cuts(skeleton: &Skeleton, included: &[bool]) -> Vec<Vec<f64>> {
    let mut cuts = vec![MIDDLES.to_vec(); skeleton.beams.len()];
    for (beam, _) in skeleton.beams.iter().zip(included).filter(|(_, included)| **included) {
        if let Some(parent) = beam.parent {
            cuts[parent as usize].push(f64::from(beam.attach));
        }
    }
    for cluster in &skeleton.clusters {
        cuts[cluster.beam as usize].push(f64::from(cluster.at));
    }
    for places in &mut cuts {
        places.sort_by(f64::total_cmp);
        let mut last = 0.0;
        places.retain(|&place| {
            let kept = place - last >= SHORTEST_ROD && 1.0 - place >= SHORTEST_ROD;
            last = if kept { place } else { last };
            kept
        });
        places.push(1.0);
    }
    cuts
}

fn nearest(nodes: &[(f64, usize)], place: f64) -> usize {
    let distance = |node: &&(f64, usize)| (node.0 - place).abs();
    nodes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a beam has nodes").1
}

fn rod(species: &Species, beam: &SkeletonBeam, from: f64, to: f64, stiffening: f64) -> Rod {
    let wood_radius_m = |place: f64| (1.0 - BARK_SHARE) * f64::from(beam.radius_m(place as f32));
    let young_modulus_pa = stiffening * f64::from(species.wood.young_modulus_pa);
    Rod {
        start_radius_m: wood_radius_m(from),
        end_radius_m: wood_radius_m(to),
        young_modulus_pa,
        shear_modulus_pa: SHEAR_SHARE * young_modulus_pa,
    }
}

/// A piece of a beam's wood.
fn wood(species: &Species, beam: &SkeletonBeam, node: usize, middle: f64) -> Lump {
    let radius_m = f64::from(beam.radius_m(middle as f32));
    let length_m = f64::from(beam.length_m) / PIECES as f64;
    Lump {
        node,
        at: on(beam, middle),
        mass_kg: std::f64::consts::PI * radius_m.powi(2) * length_m * f64::from(species.wood.density_kg_m3),
        drag_kg_m: 0.5 * AIR_DENSITY_KG_M3 * BRANCH_DRAG_COEFFICIENT * 2.0 * radius_m * length_m,
    }
}

fn leaves(species: &Species, cluster: &LeafCluster, node: usize) -> Lump {
    let area_m2 = f64::from(cluster.size_m).powi(2);
    Lump {
        node,
        at: vector(cluster.anchor + cluster.axis * (0.5 * cluster.size_m)),
        mass_kg: area_m2 * f64::from(species.foliage.mass_per_area_kg_m2),
        drag_kg_m: 0.5 * AIR_DENSITY_KG_M3 * f64::from(species.foliage.drag_coefficient) * area_m2,
    }
}

fn root_stiffness_nm_rad(beam: &SkeletonBeam) -> f64 {
    let plate_m = PLATE_RADII * f64::from(beam.base_radius_m);
    8.0 * SOIL_SHEAR_PA * plate_m.powi(3) / (3.0 * (1.0 - SOIL_POISSON))
}

/// A place on a beam's axis.
fn on(beam: &SkeletonBeam, place: f64) -> Vector3<f64> {
    vector(beam.base) + vector(beam.direction) * (f64::from(beam.length_m) * place)
}

pub fn vector(v: Vec3) -> Vector3<f64> {
    Vector3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

/// The beams of the chain that begins with `first`, each continuing the one before.
pub fn chain(skeleton: &Skeleton, first: usize) -> Vec<usize> {
    let next = skeleton.continuations();
    std::iter::successors(Some(first), |&beam| next[beam].map(|beam| beam as usize)).collect()
}
