//! How fast a branch sways with all that it carries, and how drag damps it.
//!
//! The frequency is that of its resonance (`resonance.rs`), where it may have two, or, where that is too fast to be looked for and for
//! branches that bear leaves alone, that of Rayleigh's method for rigid arms. For the damping its shape is that under the forces `m` along an axis across
//! the branch, which bend it and every branch that it carries. A piece moves by the sum over all branches between it and
//! this one's root,
//!
//! ```text
//! u = sum_k y_k (e - (e . d_k) d_k)          y_k deflection of branch k at the piece, d_k its direction
//! damping by drag for 1 m/s = sum c |u|^2 / (w sum m |u|^2)
//! ```
//!
//! A branch that sways more slowly than the one that carries it does not follow it: it counts as rigid, with its mass.

use super::{
    branches::{LoadedBranch, LoadedTree},
    hinges::outer,
    lag_curve::{Resonance, SecondResonance},
    resonance::resonances,
    response::BranchResponse,
};
use bevy::math::{DMat3, DVec3};
use std::f64::consts::TAU;

/// A branch's natural frequencies, and what drag adds to its damping.
#[derive(Clone, Copy, Debug)]
pub(super) struct CompositeSway {
    pub frequency_hz: f64,
    /// Damping ratio by drag for each m/s of wind, s/m, at that frequency.
    pub drag_damping_s_m: f64,
    pub second: Option<SecondResonance>,
}

/// Sums over the pieces of a branch, of `m |u|^2` and `c |u|^2`.
#[derive(Clone, Copy, Default)]
struct Sums {
    inertia: f64,
    drag: f64,
}

/// The sway of every branch of a tree, given the responses of all, which may lack lumps that are shed.
pub(super) fn composite_sways(
    tree: &LoadedTree,
    branches: &[LoadedBranch],
    responses: &[BranchResponse],
) -> Vec<CompositeSway> {
    let slots = slots(tree, branches, responses);
    let found: Vec<Resonance> = resonances(branches, responses)
        .into_iter()
        .zip(branches.iter().zip(responses))
        .map(|(found, (branch, response))| {
            found.unwrap_or_else(|| Resonance { frequency_hz: response.sway.rigid_hz(branch), second: None })
        })
        .collect();
    let bends =
        |branch: usize, carrier: usize| branch == carrier || found[branch].frequency_hz >= found[carrier].frequency_hz;
    let sums = sums(tree, branches, &slots, bends);
    sums.iter()
        .zip(responses)
        .zip(&found)
        .map(|((sums, response), &Resonance { frequency_hz, second })| CompositeSway {
            frequency_hz,
            second,
            drag_damping_s_m: sums.drag / (TAU * frequency_hz * (sums.inertia + 2.0 * response.sway.turning)),
        })
        .collect()
}

/// The sums of every branch, over what it carries. `bends` tells whether a branch (first) bends while another sways.
fn sums(
    tree: &LoadedTree,
    branches: &[LoadedBranch],
    slots: &[Slot],
    bends: impl Fn(usize, usize) -> bool,
) -> Vec<Sums> {
    let directions: Vec<DVec3> = branches.iter().map(|branch| branch.direction.as_dvec3()).collect();
    // Of an axis the part across each branch.
    let across: Vec<DMat3> =
        directions.iter().map(|direction| DMat3::IDENTITY - outer(*direction, *direction)).collect();
    let mut sums = vec![Sums::default(); branches.len()];
    for ends in tree.first_slots.windows(2) {
        let (first, end) = (ends[0] as usize, ends[1] as usize);
        let Slot { mass_kg, drag_kg_m, .. } = slots[first];
        if mass_kg == 0.0 {
            continue;
        }
        for last in first..end {
            let carrier = tree.branch_of_slot[last] as usize;
            let bent = |slot: usize| {
                let branch = tree.branch_of_slot[slot] as usize;
                let share = if bends(branch, carrier) { slots[slot].deflection_m } else { 0.0 };
                across[branch] * share
            };
            let moved: DMat3 = (first..=last).map(bent).sum();
            // Of both axes across the carrier: the square of all columns without that along it.
            let all: f64 = moved.to_cols_array().iter().map(|component| component * component).sum();
            let square = all - (moved * directions[carrier]).length_squared();
            sums[carrier].inertia += mass_kg * square;
            sums[carrier].drag += drag_kg_m * square;
        }
    }
    sums
}

/// What is known of a lump; nothing where it has been shed.
#[derive(Clone, Copy, Default)]
struct Slot {
    deflection_m: f64,
    mass_kg: f64,
    drag_kg_m: f64,
}

fn slots(tree: &LoadedTree, branches: &[LoadedBranch], responses: &[BranchResponse]) -> Vec<Slot> {
    let mut slots = vec![Slot::default(); tree.branch_of_slot.len()];
    for (branch, response) in branches.iter().zip(responses) {
        for (lump, deflection_m) in branch.lumps.iter().zip(&response.sway.deflections_m) {
            let (mass_kg, drag_kg_m) = (lump.mass_kg, lump.drag_kg_m);
            slots[lump.slot as usize] = Slot { deflection_m: *deflection_m, mass_kg, drag_kg_m };
        }
    }
    slots
}
