//! Which beams become joints: those that move the vertices most.
//!
//! A beam whose tip turns by `Theta` moves what it carries, a vertex at `p`, by about `Theta |p - c|`, with `c` the place about which the
//! tip turns, 0.27 of the length from the root. The sum of the squares over all vertices beyond its root is what the beam is worth.

use super::surface::BeamPlace;
use crate::{dynamics::SLOPE_TIP, tree::TreeModel};
use bevy::math::Vec3;

/// The `most` beams that are worth most, in ascending order, by the mean square of each beam's tip angle, rad².
pub(super) fn chosen_beams(model: &TreeModel, mean_square_angles: &[f32], most: usize) -> Vec<u32> {
    let worth = worth(model, mean_square_angles);
    let mut beams: Vec<u32> = (0..model.beams.len() as u32).filter(|beam| worth[*beam as usize] > 0.0).collect();
    beams.sort_by(|a, b| worth[*b as usize].total_cmp(&worth[*a as usize]).then(a.cmp(b)));
    beams.truncate(most);
    beams.sort_unstable();
    beams
}

/// The number of the vertices that a beam carries, the sum of their places, and of the squares of their distances from the origin.
#[derive(Clone, Copy, Default)]
struct Carried {
    count: f64,
    sum: Vec3,
    squares: f64,
}

impl Carried {
    fn add(&mut self, other: Self) {
        self.count += other.count;
        self.sum += other.sum;
        self.squares += other.squares;
    }

    /// The sum of the squares of the distances from a place.
    fn about(&self, centre: Vec3) -> f64 {
        let across = 2.0 * f64::from(centre.dot(self.sum));
        (self.squares - across + self.count * f64::from(centre.length_squared())).max(0.0)
    }
}

fn worth(model: &TreeModel, mean_square_angles: &[f32]) -> Vec<f64> {
    let mut carried = vec![Carried::default(); model.beams.len()];
    let wood = model.wood.positions.iter().zip(&model.wood.sway);
    let leaves = model.leaves.positions.iter().zip(&model.leaves.sway);
    for (position, sway) in wood.chain(leaves) {
        let (position, place) = (Vec3::from_array(*position), BeamPlace { beam: sway[0] as u32, at: sway[1] });
        let squares = f64::from(position.length_squared());
        carried[place.beam as usize].add(Carried { count: 1.0, sum: position, squares });
    }
    for index in (0..model.beams.len()).rev() {
        let parent = model.beams[index].parent as usize;
        if parent < index {
            let own = carried[index];
            carried[parent].add(own);
        }
    }
    let of_beam = |(index, beam): (usize, &crate::dynamics::BeamDynamics)| {
        let centre = beam.base + beam.direction * (beam.length_m * (1.0 - SLOPE_TIP.recip()));
        f64::from(mean_square_angles[index]) * carried[index].about(centre)
    };
    model.beams.iter().enumerate().map(of_beam).collect()
}
