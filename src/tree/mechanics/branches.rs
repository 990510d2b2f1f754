//! Cuts a skeleton into branches, each with the lumps of mass and drag that it carries.

use super::hinges::{Hinge, branch_hinges};
use crate::{
    constants::AIR_DENSITY_KG_M3,
    tree::{
        skeleton::{LeafCluster, Skeleton, SkeletonBeam},
        species::Species,
    },
};
use bevy::math::{DVec3, Vec3};
use std::f64::consts::PI;

/// Drag coefficient of a round branch across the flow below the drag crisis (Simiu & Scanlan 1978).
const BRANCH_DRAG_COEFFICIENT: f64 = 1.2;
/// A lump of mass and drag: a piece of the tree, taken together at one point of a branch.
#[derive(Clone, Copy)]
pub(super) struct Lump {
    /// Where it holds on: distance from the branch's root along the branch, m.
    pub attach_m: f64,
    /// Rigid arm from there to the lump, along the branch and beside it, m.
    pub arm_m: f64,
    pub beside_m: f64,
    pub mass_kg: f64,
    /// Drag for one m^2/s^2 of wind pressure |u|u where it is, kg/m.
    pub drag_kg_m: f64,
    /// Where it is, in the tree's coordinates, m, and the natural logarithm of its height.
    pub at: Vec3,
    pub log_height: f64,
    /// Whether it is of leaves, which may be shed.
    pub is_leaf: bool,
    /// Whether the branch bears it itself, and not a branch that it carries.
    pub is_own: bool,
    /// Its number among all lumps of the tree: those of a piece follow one another, from the branch that it is of to the stem.
    pub slot: u32,
}

/// A chain of beams, root first, with the lumps of all that it carries.
pub(super) struct LoadedBranch {
    pub beams: Vec<u32>,
    pub lumps: Vec<Lump>,
    /// Many hinges for its bend, and few for its sway.
    pub hinges: Vec<Hinge>,
    pub swaying_hinges: Vec<Hinge>,
    /// In which each of its beams bends less: none before it is found.
    pub stiff_axes: Vec<Vec3>,
    /// From its root on, at rest.
    pub direction: Vec3,
    /// Its root and its tip at rest, m.
    pub base: DVec3,
    pub tip: DVec3,
    /// Along its beams, m.
    pub length_m: f64,
    /// Whether it carries other branches, or is a stem, which might.
    pub bears: bool,
    /// What bears it; nothing but the ground a stem.
    pub carrier: Option<Carrier>,
}

/// The branch that bears another, and where on it.
#[derive(Clone, Copy)]
pub(super) struct Carrier {
    pub branch: usize,
    /// Distance from its root along it, m.
    pub attach_m: f64,
}

/// A tree as branches, and how its pieces hang on them.
pub(super) struct LoadedTree {
    pub branches: Vec<LoadedBranch>,
    /// The branch of each slot of a lump.
    pub branch_of_slot: Vec<u32>,
    /// The first slot of each piece, and the number of slots at the end.
    pub first_slots: Vec<u32>,
}

/// Cuts the skeleton into branches, and puts every beam and cluster as lumps on all branches that carry it.
pub(super) fn branches(species: &Species, skeleton: &Skeleton) -> LoadedTree {
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
                let carrier = beam.parent.map(|parent| {
                    let (branch, before_m) = places[parent as usize];
                    let attach_m = before_m + f64::from(skeleton.beams[parent as usize].length_m * beam.attach);
                    Carrier { branch, attach_m }
                });
                branches.push(LoadedBranch::growing(beam, carrier));
                (branches.len() - 1, 0.0)
            }
        };
        branches[place.0].extend(index, beam);
        places.push(place);
    }
    for index in 0..branches.len() {
        if let Some(carrier) = branches[index].carrier {
            branches[carrier.branch].bears = true;
        }
    }
    reserve_lumps(&mut branches, skeleton, |beam| places[beam as usize].0);
    let mut tree = LoadedTree { branches, branch_of_slot: Vec::new(), first_slots: Vec::new() };
    let put_on = |tree: &mut LoadedTree, mut carrier: u32, mut attach: f32, piece: Piece| {
        let Piece { at, mass_kg, drag_kg_m, is_leaf } = piece;
        let log_height = f64::from(at.y).ln();
        let mut is_own = true;
        loop {
            let beam = &skeleton.beams[carrier as usize];
            let arm = at - (beam.base + beam.direction * beam.length_m * attach);
            let (branch, before_m) = places[carrier as usize];
            let attach_m = before_m + f64::from(beam.length_m * attach);
            let arm_m = f64::from(arm.dot(beam.direction));
            let beside_m = f64::from(arm.reject_from_normalized(beam.direction).length());
            let slot = tree.branch_of_slot.len() as u32;
            tree.branch_of_slot.push(branch as u32);
            tree.branches[branch].lumps.push(Lump {
                attach_m,
                arm_m,
                beside_m,
                mass_kg,
                drag_kg_m,
                at,
                log_height,
                is_leaf,
                is_own,
                slot,
            });
            is_own = false;
            let root = &skeleton.beams[tree.branches[branch].beams[0] as usize];
            let Some(parent) = root.parent else { return };
            (carrier, attach) = (parent, root.attach);
        }
    };
    for (carrier, attach, piece) in pieces(species, skeleton) {
        tree.first_slots.push(tree.branch_of_slot.len() as u32);
        put_on(&mut tree, carrier, attach, piece);
    }
    tree.first_slots.push(tree.branch_of_slot.len() as u32);
    for branch in &mut tree.branches {
        branch.lumps.sort_by(|a, b| a.attach_m.total_cmp(&b.attach_m));
        branch.hinge(species, skeleton);
    }
    tree
}

/// Makes room for the lumps of all branches, given the branch of each beam.
fn reserve_lumps(branches: &mut [LoadedBranch], skeleton: &Skeleton, branch_of: impl Fn(u32) -> usize) {
    let mut counts: Vec<usize> = branches.iter().map(|branch| BEAM_LUMPS.len() * branch.beams.len()).collect();
    skeleton.clusters.iter().for_each(|cluster| counts[branch_of(cluster.beam)] += 1);
    // Branches come after those that carry them.
    for (index, branch) in branches.iter_mut().enumerate().rev() {
        branch.lumps.reserve_exact(counts[index]);
        if let Some(carrier) = branch.carrier {
            counts[carrier.branch] += counts[index];
        }
    }
}

impl LoadedBranch {
    /// Gives it its hinges, for which its lumps must be there.
    pub fn hinge(&mut self, species: &Species, skeleton: &Skeleton) {
        [self.hinges, self.swaying_hinges] = branch_hinges(species, skeleton, &self.beams, self.bears);
    }

    /// A branch that has no beam yet.
    fn growing(first: &SkeletonBeam, carrier: Option<Carrier>) -> Self {
        let base = first.base.as_dvec3();
        Self {
            beams: Vec::new(),
            lumps: Vec::new(),
            hinges: Vec::new(),
            swaying_hinges: Vec::new(),
            stiff_axes: Vec::new(),
            direction: first.direction,
            base,
            tip: base,
            length_m: 0.0,
            bears: carrier.is_none(),
            carrier,
        }
    }

    fn extend(&mut self, index: u32, beam: &SkeletonBeam) {
        self.beams.push(index);
        self.stiff_axes.push(Vec3::ZERO);
        self.tip = (beam.base + beam.direction * beam.length_m).as_dvec3();
        self.length_m += f64::from(beam.length_m);
    }

    /// The same branch without its leaves.
    pub fn without_leaves(&self) -> Self {
        let lumps = self.lumps.iter().filter(|lump| !lump.is_leaf).copied().collect();
        Self {
            beams: self.beams.clone(),
            lumps,
            hinges: self.hinges.clone(),
            swaying_hinges: self.swaying_hinges.clone(),
            stiff_axes: self.stiff_axes.clone(),
            ..*self
        }
    }
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

/// A piece of a tree.
#[derive(Clone, Copy)]
pub(crate) struct Piece {
    /// Where it is, in the tree's coordinates, m.
    pub at: Vec3,
    pub mass_kg: f64,
    /// Drag for one m^2/s^2 of wind pressure |u|u, kg/m.
    pub drag_kg_m: f64,
    pub is_leaf: bool,
}

/// All pieces of a tree: wood, then leaves; each with the beam that carries it and where on that.
fn pieces(species: &Species, skeleton: &Skeleton) -> impl Iterator<Item = (u32, f32, Piece)> {
    let wood = (0u32..).zip(&skeleton.beams).flat_map(move |(index, beam)| {
        BEAM_LUMPS.into_iter().map(move |(s, share)| (index, s, wood_piece(species, beam, s, share)))
    });
    let leaf = move |cluster: &LeafCluster| (cluster.beam, cluster.at, leaf_piece(species, cluster));
    wood.chain(skeleton.clusters.iter().map(leaf))
}

/// The masses and drags that a tree is made of.
pub(crate) fn tree_pieces(species: &Species, skeleton: &Skeleton) -> impl Iterator<Item = Piece> {
    pieces(species, skeleton).map(|(.., piece)| piece)
}

fn wood_piece(species: &Species, beam: &SkeletonBeam, s: f32, share: f64) -> Piece {
    let radius_m = f64::from(beam.radius_m(s));
    let length_m = share * f64::from(beam.length_m);
    let at = beam.base + beam.direction * beam.length_m * s;
    let mass_kg = PI * radius_m * radius_m * length_m * f64::from(species.wood.density_kg_m3);
    let area_m2 = 2.0 * radius_m * length_m;
    Piece { at, mass_kg, drag_kg_m: 0.5 * AIR_DENSITY_KG_M3 * BRANCH_DRAG_COEFFICIENT * area_m2, is_leaf: false }
}

fn leaf_piece(species: &Species, cluster: &LeafCluster) -> Piece {
    let area_m2 = f64::from(cluster.size_m * cluster.size_m);
    Piece {
        at: cluster.anchor + cluster.axis * cluster.size_m * 0.5,
        mass_kg: area_m2 * f64::from(species.foliage.mass_per_area_kg_m2),
        drag_kg_m: 0.5 * AIR_DENSITY_KG_M3 * f64::from(species.foliage.drag_coefficient) * area_m2,
        is_leaf: true,
    }
}
