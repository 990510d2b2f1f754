//! How trees bend and how fast they sway, against finite elements of whole skeletons.
//!
//! The product takes a tree apart into branches, each held fast where it grows and loaded by rigid lumps. `frame` solves the
//! same tree, of the same wood and leaves, in one piece: all branches flexible, bent, twisted and weighed at once.
//!
//! - *Static*: a small uniform wind pressure. Trunks: where the tip goes, from the two horizontal directions. Main branches:
//!   where the tip goes as seen from the branch's root, with the wind level and across the branch. The error is the length of
//!   the difference of the two vectors, over that of the finite elements' vector. Beside it is reported the same for a wind along the
//!   branch.
//! - *First frequency*: that of the trunk with all that it bears, at two thirds of its length, where it is measured on real
//!   trees. Branches as fast as their trunk divide its mode in many, so it is that of the peaks which they make together.
//!   Where there are several of about the same strength, the product may have two, and all are compared ([`resonances`]). Beside it is
//!   reported how the trunk answers slow gusts ([`onset_hz`]), and the error for those modes alone that move it furthest in gusts, which are
//!   weaker the faster they are.
//! - *Second frequency*: the product's next, which is that of the main branches. Each is held fast where it grows, the wind
//!   blows across it, and the rest is as for the trunk.

mod elements;
mod product;
mod pruning;
mod resonances;

use crate::{
    frame::{
        closed_forms,
        modes::Mode,
        of_tree::{TreeFrame, branch, chain, vector, whole},
    },
    report::Report,
    trees::shipped,
};
use bevy::math::Vec3;
use bevy_windwood::tree::{Species, TreeModel, skeleton::Skeleton};
use elements::{Motion, modes, onset_hz, strongest};
use nalgebra::Vector3;
use product::Product;
use resonances::Resonances;

const SPECIES: [&str; 6] = ["oak", "birch", "beech", "norway_spruce", "fir", "scots_pine"];
/// Ages as shares of the mature age.
const AGES: [f32; 3] = [0.25, 0.5, 1.0];
const SEED: u64 = 1;
/// Gravity, m/s^2 (standard).
pub const GRAVITY_M_S2: f64 = 9.806_65;
/// Main branches of a tree that are looked at: those that bear most.
const MAIN_BRANCHES: usize = 5;
/// Where on a chain its frequency is measured, as a share of its length.
pub const SENSOR: f64 = 2.0 / 3.0;
/// Factor on the moduli of branches that are to be rigid.
const STIFF: f64 = 1e5;

pub fn run() -> Report {
    let mut report = Report::default();
    report.at_most("finite_elements_worst_error", closed_forms::worst_error(), 0.005, "against seven closed forms");
    let mut all = Vec::new();
    println!("  errors (product / elements - 1)        trunk: tip  weightless  two thirds   branch tips");
    println!("                       m       Hz  elements  (share)    onset     rigid  branches     rigid  first");
    for name in SPECIES {
        let species = match shipped(name) {
            Ok(species) => species,
            Err(error) => {
                eprintln!("{error}");
                report.at_most("tip_deflection_error_worst", f64::NAN, 0.1, "could not be measured");
                return report;
            }
        };
        for age in AGES {
            let found = Comparison::of(&species, age * species.age.mature_years);
            found.print(&format!("{name} {:.0}", age * species.age.mature_years));
            all.push(found);
        }
    }
    summarise(&mut report, &all);
    pruning::measure(&mut report);
    report
}

fn summarise(report: &mut Report, all: &[Comparison]) {
    let sorted = |of: fn(&Comparison) -> &[f64]| {
        let mut errors: Vec<f64> = all.iter().flat_map(of).map(|error| error.abs()).collect();
        errors.sort_by(f64::total_cmp);
        errors
    };
    let worst = |of| sorted(of).last().copied().unwrap_or(f64::NAN);
    let median = |of| sorted(of)[sorted(of).len() / 2];
    let (trunk, branches) = (worst(|tree| &tree.trunk), worst(|tree| &tree.branches));
    report.at_most("tip_deflection_error_worst", trunk.max(branches), 0.1, "trunks and main branches");
    report.record("trunk_tip_error_worst", trunk, "trunks alone");
    report.record("trunk_tip_error_median", median(|tree| &tree.trunk), "trunks alone");
    report.record("trunk_tip_weightless_worst", worst(|tree| &tree.weightless), "the same if weight did not pull");
    report.record("trunk_two_thirds_error_worst", worst(|tree| &tree.sensor), "at two thirds of the trunk's length");
    report.record("trunk_two_thirds_error_median", median(|tree| &tree.sensor), "at two thirds of the trunk's length");
    report.record("branch_tip_error_worst", branches, "main branches alone");
    report.record("branch_tip_error_median", median(|tree| &tree.branches), "main branches alone");
    let along = "the same in a level wind along them, by what one across them does";
    report.record("branch_tip_along_worst", worst(|tree| &tree.along), along);
    report.record("branch_tip_along_median", median(|tree| &tree.along), along);
    report.at_most("first_frequency_error_worst", worst(|tree| &tree.first), 0.1, "trunk, all that it bears flexible");
    report.record("first_frequency_error_median", median(|tree| &tree.first), "the same");
    let in_gusts = "of the modes alone that move it furthest in gusts";
    report.record("first_frequency_in_gusts_worst", worst(|tree| &tree.first_in_gusts), in_gusts);
    report.record("first_onset_error_worst", worst(|tree| &tree.onset), "against the answer to slow gusts");
    report.record("first_onset_error_median", median(|tree| &tree.onset), "the same");
    report.record("first_rigid_error_worst", worst(|tree| &tree.rigid), "if all that the trunk bears were rigid");
    report.at_most(
        "second_frequency_error_worst",
        worst(|tree| &tree.second),
        0.2,
        "main branches, held at their roots",
    );
    report.record("second_frequency_error_median", median(|tree| &tree.second), "the same");
    report.record("second_frequency_in_gusts_worst", worst(|tree| &tree.second_in_gusts), in_gusts);
    report.record("second_frequency_in_gusts_median", median(|tree| &tree.second_in_gusts), in_gusts);
    let right = |of| {
        let errors = sorted(of);
        errors.iter().filter(|error| **error <= 0.2).count() as f64 / errors.len() as f64
    };
    report.record(
        "second_frequency_right",
        right(|tree| &tree.second),
        "the share of branches that are right to 0.2 with all peaks",
    );
    let with_two = worst(|tree| &tree.second_of_two);
    report.record("second_frequency_two_peaks_worst", with_two, "branches with two peaks that matter at most");
    let count = |of| sorted(of).len() as f64;
    let many = 1.0 - count(|tree| &tree.second_of_two) / count(|tree| &tree.second);
    report.record("second_frequency_more_peaks", many, "the share of branches with more");
    report.record(
        "second_frequency_in_gusts_right",
        right(|tree| &tree.second_in_gusts),
        "the share of branches that are right to 0.2 with these",
    );
    report.record("mode_share_error_worst", worst(|tree| &tree.shares), "share of the second of two peaks, difference");
    report.record("mode_share_error_median", median(|tree| &tree.shares), "the same");
    report.record(
        "mode_share_beams",
        count(|tree| &tree.shares),
        "trunks and main branches with two frequencies, of 108",
    );
    report.record("second_rigid_error_worst", worst(|tree| &tree.second_rigid), "if all that they bear were rigid");
}

/// What the product says of a tree, over what the finite elements say, less one.
struct Comparison {
    height_m: f32,
    frequency_hz: f64,
    peak: Mode,
    onset_hz: f64,
    trunk: Vec<f64>,
    weightless: Vec<f64>,
    sensor: Vec<f64>,
    branches: Vec<f64>,
    along: Vec<f64>,
    first: Vec<f64>,
    first_in_gusts: Vec<f64>,
    onset: Vec<f64>,
    rigid: Vec<f64>,
    second: Vec<f64>,
    /// Of branches with no more than two peaks that matter.
    second_of_two: Vec<f64>,
    second_in_gusts: Vec<f64>,
    second_rigid: Vec<f64>,
    /// Of trunk and branches.
    shares: Vec<f64>,
}

impl Comparison {
    fn of(species: &Species, years: f32) -> Self {
        let model = TreeModel::bake(species, years, SEED);
        let skeleton = &model.skeleton;
        let product = Product::new(&model);
        let trunk = chain(skeleton, 0);
        let tree = whole(species, skeleton, |_| 1.0);
        let rigid = whole(species, skeleton, |beam| if trunk.contains(&beam) { 1.0 } else { STIFF });
        let [tip, sensor] = [1.0, SENSOR].map(|share| tree.place(skeleton, &trunk, share));
        let winds = [Vector3::x(), Vector3::z()];
        let [loaded, weightless] =
            [GRAVITY_M_S2, 0.0].map(|gravity| winds.map(|wind| Motion::of(&tree, wind, gravity)));
        let errors = |motions: &[Motion; 2], place| {
            let error = |(motion, wind): (&Motion, &Vector3<f64>)| {
                relative(&product.deflection(place, *wind), &motion.deflection(&tree, place))
            };
            motions.iter().zip(&winds).map(error).collect()
        };
        let frequency_hz = product.frequency_hz(0);
        let [flexible, rigid] = [&tree, &rigid].map(|tree| winds.map(|wind| modes(tree, sensor.node, wind)));
        let resonances = Resonances::compare(&product.modes(0), &flexible);
        let onsets_hz = winds.map(|wind| onset_hz(&tree, sensor.node, wind));
        let over = |theirs_hz: f64| frequency_hz / theirs_hz - 1.0;
        let over_onset = |theirs_hz: f64| product.onset_hz(0) / theirs_hz - 1.0;
        let mut found = Self {
            height_m: model.height_m(),
            frequency_hz,
            peak: strongest(&flexible[0])[0],
            onset_hz: onsets_hz[0],
            trunk: errors(&loaded, tip),
            weightless: errors(&weightless, tip),
            sensor: errors(&loaded, sensor),
            branches: Vec::new(),
            along: Vec::new(),
            first: vec![resonances.error],
            first_in_gusts: vec![resonances.in_gusts],
            onset: onsets_hz.map(over_onset).to_vec(),
            rigid: rigid.map(|modes| over(strongest(&modes)[0].frequency_hz)).to_vec(),
            second: Vec::new(),
            second_of_two: Vec::new(),
            shares: resonances.share_error.into_iter().collect(),
            second_in_gusts: Vec::new(),
            second_rigid: Vec::new(),
        };
        for first in main_branches(skeleton, &tree, &trunk) {
            found.add_branch(species, skeleton, &product, (&tree, &loaded), first);
        }
        found
    }

    fn add_branch(
        &mut self,
        species: &Species,
        skeleton: &Skeleton,
        product: &Product,
        (tree, loaded): (&TreeFrame, &[Motion; 2]),
        first: usize,
    ) {
        let beams = chain(skeleton, first);
        let across = across(skeleton, &beams);
        let along = across.cross(&Vector3::y());
        let tip = tree.place(skeleton, &beams, 1.0);
        let theirs = Motion::combined(loaded, across).bend(tree, first, tip);
        self.branches.push(relative(&product.bend(first, tip, across), &theirs));
        let theirs_along = Motion::combined(loaded, along).bend(tree, first, tip);
        self.along.push((product.bend(first, tip, along) - theirs_along).norm() / theirs.norm());
        let modes = |stiffening: f64| {
            let alone = branch(species, skeleton, first, |beam| if beams.contains(&beam) { 1.0 } else { stiffening });
            let sensor = alone.place(skeleton, &beams, SENSOR);
            modes(&alone, sensor.node, across)
        };
        let resonances = Resonances::compare(&product.modes(first), &[modes(1.0)]);
        self.second.push(resonances.error);
        if resonances.peaks <= 2 {
            self.second_of_two.push(resonances.error);
        }
        self.second_in_gusts.push(resonances.in_gusts);
        self.shares.extend(resonances.share_error);
        self.second_rigid.push(product.frequency_hz(first) / strongest(&modes(STIFF))[0].frequency_hz - 1.0);
    }

    fn print(&self, name: &str) {
        let worst =
            |errors: &[f64]| errors.iter().fold(0.0, |worst: f64, e| if e.abs() > worst.abs() { *e } else { worst });
        println!(
            "  {name:<37} {:>12.3} {:>11.3} {:>11.3} {:>13.3}",
            worst(&self.trunk),
            worst(&self.weightless),
            worst(&self.sensor),
            worst(&self.branches),
        );
        println!(
            "                   {:>5.1} {:>8.3} {:>9.3} ({:>6.2}) {:>8.3} {:>+9.3} {:>+9.3} {:>+9.3}  {:+.3}",
            self.height_m,
            self.frequency_hz,
            self.peak.frequency_hz,
            self.peak.share,
            self.onset_hz,
            worst(&self.rigid),
            worst(&self.second),
            worst(&self.second_rigid),
            worst(&self.first),
        );
    }
}

/// The branches that grow from the trunk and bear most.
fn main_branches(skeleton: &Skeleton, tree: &TreeFrame, trunk: &[usize]) -> Vec<usize> {
    let (masses, _) = tree.frame.borne();
    let from_trunk = |beam: &usize| {
        let parent = skeleton.beams[*beam].parent;
        parent.is_some_and(|parent| trunk.contains(&(parent as usize))) && !trunk.contains(beam)
    };
    let mut branches: Vec<usize> = (0..skeleton.beams.len()).filter(from_trunk).collect();
    let mass = |beam: &usize| masses[tree.nodes[*beam][1].1];
    branches.sort_by(|a, b| mass(b).total_cmp(&mass(a)));
    branches.truncate(MAIN_BRANCHES);
    branches
}

/// The level direction across a chain.
fn across(skeleton: &Skeleton, beams: &[usize]) -> Vector3<f64> {
    let (first, last) = (&skeleton.beams[beams[0]], &skeleton.beams[beams[beams.len() - 1]]);
    let chord = last.base + last.direction * last.length_m - first.base;
    vector(chord.cross(Vec3::Y).try_normalize().unwrap_or(Vec3::X))
}

fn relative(ours: &Vector3<f64>, theirs: &Vector3<f64>) -> f64 {
    (ours - theirs).norm() / theirs.norm()
}
