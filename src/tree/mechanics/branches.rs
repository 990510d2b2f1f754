//! Cuts a skeleton into branches, each with the lumps of mass and drag that it carries.

use crate::{
    constants::{AIR_DENSITY_KG_M3, REFERENCE_HEIGHT_M},
    tree::{
        skeleton::{LeafCluster, Skeleton, SkeletonBeam},
        species::Species,
    },
};
use bevy::math::Vec3;
use std::f64::consts::PI;

/// Drag coefficient of a round branch across the flow below the drag crisis (Simiu & Scanlan 1978).
const BRANCH_DRAG_COEFFICIENT: f64 = 1.2;
/// Roughness length with which heights are weighted, m: open woodland (Simiu & Scanlan 1978 give 0.01 to 1). The model is
/// baked once for all winds; over the heights of a crown other roughness changes the weights by a few per cent.
const ROUGHNESS_M: f64 = 0.3;

/// A lump of mass and drag: a piece of the tree, taken together at one point of a branch.
#[derive(Clone, Copy)]
pub(super) struct Lump {
    /// Where it holds on: distance from the branch's root along the branch, m.
    pub attach_m: f64,
    /// Rigid arm from there to the lump, along the branch and beside it, m.
    pub arm_m: f64,
    pub beside_m: f64,
    pub mass_kg: f64,
    /// Drag for one m^2/s^2 of wind pressure |u|u at the reference height, kg/m.
    pub drag_kg_m: f64,
}

/// A chain of beams, root first, with the lumps of all that it carries.
pub(super) struct LoadedBranch {
    pub beams: Vec<u32>,
    pub lumps: Vec<Lump>,
}

/// Cuts the skeleton into branches, and puts every beam and cluster as lumps on all branches that carry it.
pub(super) fn branches(species: &Species, skeleton: &Skeleton) -> Vec<LoadedBranch> {
    let mut branches: Vec<LoadedBranch> = Vec::new();
    // For each beam its branch, and the length of the branch before it.
    let mut places: Vec<(usize, f64)> = Vec::with_capacity(skeleton.beams.len());
    let continuations = skeleton.continuations();
    for (index, beam) in (0u32..).zip(&skeleton.beams) {
        let continued = beam.parent.filter(|&parent| continuations[parent as usize] == Some(index));
        let place = match continued {
            Some(parent) => {
                let (branch, before_m) = places[parent as usize];
                (branch, before_m + f64::from(skeleton.beams[parent as usize].length_m))
            }
            None => {
                branches.push(LoadedBranch { beams: Vec::new(), lumps: Vec::new() });
                (branches.len() - 1, 0.0)
            }
        };
        branches[place.0].beams.push(index);
        places.push(place);
    }
    let put_on = |branches: &mut [LoadedBranch], mut carrier: u32, mut attach: f32, at: Vec3, mass_kg, drag_kg_m| loop {
        let beam = &skeleton.beams[carrier as usize];
        let arm = at - (beam.base + beam.direction * beam.length_m * attach);
        let (branch, before_m) = places[carrier as usize];
        let attach_m = before_m + f64::from(beam.length_m * attach);
        let arm_m = f64::from(arm.dot(beam.direction));
        let beside_m = f64::from(arm.reject_from_normalized(beam.direction).length());
        branches[branch].lumps.push(Lump { attach_m, arm_m, beside_m, mass_kg, drag_kg_m });
        let root = &skeleton.beams[branches[branch].beams[0] as usize];
        let Some(parent) = root.parent else { return };
        (carrier, attach) = (parent, root.attach);
    };
    for (index, beam) in (0u32..).zip(&skeleton.beams) {
        for (s, share) in BEAM_LUMPS {
            let (at, mass_kg, drag_kg_m) = beam_lump(species, beam, s, share);
            put_on(&mut branches, index, s, at, mass_kg, drag_kg_m);
        }
    }
    for cluster in &skeleton.clusters {
        let (at, mass_kg, drag_kg_m) = cluster_lump(species, cluster);
        put_on(&mut branches, cluster.beam, cluster.at, at, mass_kg, drag_kg_m);
    }
    branches
}

/// A beam's own wood as lumps: place on the beam, and share of its length.
const BEAM_LUMPS: [(f32, f64); 6] = {
    let share = 1.0 / 6.0;
    [
        (1.0 / 12.0, share),
        (3.0 / 12.0, share),
        (5.0 / 12.0, share),
        (7.0 / 12.0, share),
        (9.0 / 12.0, share),
        (11.0 / 12.0, share),
    ]
};

fn beam_lump(species: &Species, beam: &SkeletonBeam, s: f32, share: f64) -> (Vec3, f64, f64) {
    let radius_m = f64::from(beam.radius_m(s));
    let length_m = share * f64::from(beam.length_m);
    let at = beam.base + beam.direction * beam.length_m * s;
    let mass_kg = PI * radius_m * radius_m * length_m * f64::from(species.wood.density_kg_m3);
    let area_m2 = 2.0 * radius_m * length_m;
    (at, mass_kg, 0.5 * AIR_DENSITY_KG_M3 * BRANCH_DRAG_COEFFICIENT * area_m2 * pressure_ratio(at.y))
}

fn cluster_lump(species: &Species, cluster: &LeafCluster) -> (Vec3, f64, f64) {
    let area_m2 = f64::from(cluster.size_m * cluster.size_m);
    let at = cluster.anchor + cluster.axis * cluster.size_m * 0.5;
    let coefficient = f64::from(species.foliage.drag_coefficient);
    let drag_kg_m = 0.5 * AIR_DENSITY_KG_M3 * coefficient * area_m2 * pressure_ratio(at.y);
    (at, area_m2 * f64::from(species.foliage.mass_per_area_kg_m2), drag_kg_m)
}

/// Wind pressure at a height over that at the reference height: the log law (eq. 10), squared.
fn pressure_ratio(height_m: f32) -> f64 {
    let log = |z: f64| (z / ROUGHNESS_M).max(1.0).ln();
    (log(f64::from(height_m)) / log(f64::from(REFERENCE_HEIGHT_M))).powi(2)
}
