//! Where the wind takes hold of a tree, and how much each place moves the trunk's tip.

use super::SWAY_SEED;
use crate::{
    frame::of_tree::{chain, whole},
    skeleton::{GRAVITY_M_S2, SENSOR},
};
use bevy_windwood::{
    dynamics::{BeamDynamics, BeamSway, FrequencyClasses, NO_PARENT},
    tree::{Species, TreeModel},
};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Most cells that a crown is divided into. The wind is averaged within a cell.
const MOST_CELLS: usize = 96;
/// Places by which a cell is known.
const PLACES: usize = 8;
const SMALLEST_CELL_M: f64 = 0.05;

/// A tree as the wind sees it.
pub struct Crown {
    pub name: String,
    pub height_m: f32,
    /// Natural frequencies of the trunk by the product, not rounded to a class, Hz, and their shares of its deflection.
    pub frequencies_hz: [f64; 2],
    pub shares: [f64; 2],
    pub cells: Vec<Cell>,
    /// The trunk's beams as the product has them.
    pub trunk: Vec<BeamDynamics>,
}

/// A part of a crown.
pub struct Cell {
    /// Centre of what moves the trunk, m.
    pub at: Vector3<f64>,
    pub places: Vec<Vector3<f64>>,
    /// Displacement of the trunk for a pressure of 1 m^2/s^2 on all drag in the cell, s^2/m.
    pub weight: f64,
}

impl Crown {
    pub fn of(name: &str, species: &Species, years: f32) -> Self {
        // Quadratic drag, as the oracle has.
        let mut species = species.clone();
        (species.foliage.drag_exponent, species.wood.drag_exponent) = (0.0, 0.0);
        let species = &species;
        let model = TreeModel::bake(species, years, SWAY_SEED);
        let beams = chain(&model.skeleton, 0);
        let tree = whole(species, &model.skeleton, |_| 1.0);
        // A force at a lump moves the trunk as far as the same force on the trunk would move the lump (Maxwell). It is the
        // first mode that counts here, so it is not the tip that is asked, which may be a thin leader with a life of its own.
        let sensor = tree.place(&model.skeleton, &beams, SENSOR).node;
        let motions = tree.frame.factor(GRAVITY_M_S2).solve(&tree.frame.load_at(sensor, Vector3::x()));
        let pulls: Vec<(Vector3<f64>, f64)> = tree
            .frame
            .lumps
            .iter()
            .map(|lump| (lump.at, lump.drag_kg_m * tree.frame.displacement(&motions, lump.node, &lump.at).x))
            .filter(|(_, weight)| *weight > 0.0)
            .collect();
        let classes = FrequencyClasses::default();
        let BeamSway { class, second, .. } = model.beams[0].in_leaf;
        let frequency_hz = |class: f32| f64::from(classes.frequency_at_hz(class));
        Self {
            name: format!("{name} {years:.0}"),
            height_m: model.height_m(),
            frequencies_hz: [class, class + second.class_offset].map(frequency_hz),
            shares: [1.0 - second.share, second.share].map(f64::from),
            cells: cells(&pulls),
            trunk: trunk(&model, &beams),
        }
    }
}

/// The beams of a chain alone.
fn trunk(model: &TreeModel, beams: &[usize]) -> Vec<BeamDynamics> {
    let alone = |(index, &beam): (usize, &usize)| BeamDynamics {
        parent: if index == 0 { NO_PARENT } else { index as u32 - 1 },
        ..model.beams[beam]
    };
    beams.iter().enumerate().map(alone).collect()
}

/// Divides space into the smallest cubes of which no more than [`MOST_CELLS`] are taken.
fn cells(pulls: &[(Vector3<f64>, f64)]) -> Vec<Cell> {
    let mut size_m = SMALLEST_CELL_M;
    loop {
        let mut by_cube: BTreeMap<[i64; 3], Vec<(Vector3<f64>, f64)>> = BTreeMap::new();
        for pull in pulls {
            let cube = [0, 1, 2].map(|axis| (pull.0[axis] / size_m).floor() as i64);
            by_cube.entry(cube).or_default().push(*pull);
        }
        if by_cube.len() <= MOST_CELLS {
            return by_cube.values().map(|pulls| cell(pulls)).collect();
        }
        size_m *= 1.1;
    }
}

fn cell(pulls: &[(Vector3<f64>, f64)]) -> Cell {
    let weight: f64 = pulls.iter().map(|pull| pull.1).sum();
    let at = pulls.iter().map(|(at, weight)| at * *weight).sum::<Vector3<f64>>() / weight;
    // Each place stands for an equal part of the weight.
    let (mut places, mut passed) = (Vec::new(), 0.0);
    for (place, part) in pulls {
        passed += part;
        while places.len() < PLACES && passed >= weight * (places.len() as f64 + 0.5) / PLACES as f64 {
            places.push(*place);
        }
    }
    Cell { at, places, weight }
}
