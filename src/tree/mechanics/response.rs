//! How a branch bends under drag, and how it would sway if all that it carries were rigid.

use super::{
    branches::{LoadedBranch, Lump},
    skew::posed_m,
    statics::{Beyond, influence, softening, winds},
};
use crate::{dynamics::bend::SLOPE_TIP, tree::skeleton::Skeleton};
use bevy::math::{DVec3, Vec3};
use std::f64::consts::TAU;

/// Roughness lengths of open country and of land with scattered trees, m ("roughly open" and "rough" in Davenport's
/// classes; Wieringa 1992, J. Wind Eng. Ind. Aerodyn. 41): the pressure at a load's height is right over both.
const ROUGHNESS_M: [f64; 2] = [0.1, 0.3];

/// The most that a beam turns for the sake of its tip's place, by what its wood turns in a level wind or in one from below, whichever is more:
/// it would be more where the beam points so that its turn hardly moves the branch's tip.
const MOST_TURN: f64 = 2.0;

/// What a branch does under load.
pub(super) struct BranchResponse {
    /// One a beam.
    pub loads: Vec<BeamLoad>,
    pub sway: BranchSway,
}

/// A branch's deflection under the forces `m` on all that it carries, which are taken as rigid beyond it.
pub(super) struct BranchSway {
    /// Of each lump, in the order of the branch's lumps, m.
    pub deflections_m: Vec<f64>,
    /// Squares of what turning adds to a lump's motion, sum of `m (r slope)^2`.
    pub turning: f64,
    /// Deflection under the drag, by what it would be without weight; 1 where weight is left out.
    pub softening: f64,
}

/// How a beam bends under the drag of all that it carries, and where that is.
#[derive(Clone, Copy, Debug)]
pub(super) struct BeamLoad {
    /// s^2/m^2.
    pub gain: f64,
    /// Height at which the wind presses as on the whole of it, m.
    pub height_m: f64,
    /// Standard deviations of its places, in the mean of the two horizontal directions and in height, m.
    pub horizontal_m: f64,
    pub vertical_m: f64,
}

impl BranchSway {
    /// Natural frequency if all that the branch carries were rigid, by Rayleigh's method, Hz.
    pub fn rigid_hz(&self, branch: &LoadedBranch) -> f64 {
        let sum = |of: fn(f64) -> f64| -> f64 {
            branch.lumps.iter().zip(&self.deflections_m).map(|(lump, y)| lump.mass_kg * of(*y)).sum()
        };
        (sum(|y| y) / self.softening / (sum(|y| y * y) + self.turning)).sqrt() / TAU
    }
}

impl LoadedBranch {
    pub fn response(&self, skeleton: &Skeleton) -> BranchResponse {
        let winds = winds(self);
        // Limp twigs hang by their weight. That of branches which bear others is left out.
        let is_weighed = self.carrier.is_none() || !self.bears;
        let softening = if is_weighed { self.softening(&winds) } else { 1.0 };
        let mut loads = self.loads(skeleton, &winds);
        for load in &mut loads {
            load.gain *= softening;
        }
        BranchResponse { loads, sway: BranchSway { softening, ..self.sway() } }
    }

    /// Deflection under the drag, by what it would be without weight.
    fn softening(&self, winds: &[DVec3]) -> f64 {
        let mass = Beyond::sums(self, &self.hinges, |lump| [lump.mass_kg]);
        let drag = Beyond::sums(self, &self.hinges, |lump| [lump.drag_kg_m]);
        softening(&self.hinges, &drag, &mass, self.tip, winds)
    }

    /// The branch's deflection under the forces `m`.
    pub fn sway(&self) -> BranchSway {
        let turns = self.turns();
        let mut turning = 0.0;
        let mut deflections_m = Vec::with_capacity(self.lumps.len());
        // Slope, and first moment of the turns, of all hinges before the lump.
        let (mut slope, mut first_moment) = (0.0, 0.0);
        let mut ahead = self.hinges.iter().zip(turns).peekable();
        for lump in &self.lumps {
            while let Some((hinge, turn)) = ahead.next_if(|(hinge, _)| hinge.along_m < lump.attach_m) {
                slope += turn;
                first_moment += turn * hinge.along_m;
            }
            deflections_m.push(slope * (lump.attach_m + lump.arm_m) - first_moment);
            turning += lump.mass_kg * (lump.beside_m * slope).powi(2);
        }
        BranchSway { deflections_m, turning, softening: 1.0 }
    }

    /// By how much each hinge turns under the forces `m`, rad.
    fn turns(&self) -> Vec<f64> {
        // Of all lumps that hold on beyond the hinge: mass, and its first moment about the branch's root.
        let (mut mass, mut first_moment) = (0.0, 0.0);
        let mut before = self.lumps.iter().rev().peekable();
        let mut turns: Vec<f64> = self
            .hinges
            .iter()
            .rev()
            .map(|hinge| {
                while let Some(lump) = before.next_if(|lump| lump.attach_m > hinge.along_m) {
                    mass += lump.mass_kg;
                    first_moment += lump.mass_kg * (lump.attach_m + lump.arm_m);
                }
                (first_moment - mass * hinge.along_m) * hinge.bend_compliance
            })
            .collect();
        turns.reverse();
        turns
    }

    /// The bend of each beam under the drag.
    ///
    /// Beams are posed along the first mode of a beam with a free tip, whose deflection is right for one turn only: each is bent by as
    /// much as moves the branch's tip as far as its hinges do.
    fn loads(&self, skeleton: &Skeleton, winds: &[DVec3]) -> Vec<BeamLoad> {
        let sums = Beyond::sums(self, &self.hinges, load_moments);
        let mut moved = vec![[0.0; MOMENTS]; self.beams.len()];
        // In a level wind, and in one from below.
        let mut turned = vec![[0.0; 2]; self.beams.len()];
        for (hinge, sum) in self.hinges.iter().zip(&sums) {
            for &wind in winds {
                let influence = influence(hinge, self.tip, wind);
                for (n, moved) in moved[hinge.beam].iter_mut().enumerate() {
                    *moved += sum.about(hinge.at, n).dot(influence);
                }
                turned[hinge.beam][0] += hinge.turn(sum.about(hinge.at, 0).cross(wind)).length() / winds.len() as f64;
            }
            turned[hinge.beam][1] += hinge.turn(sum.about(hinge.at, 0).cross(DVec3::Y)).length();
        }
        let posed = |(&beam, stiff_axis): (&u32, &Vec3)| {
            let (beam, stiff_axis) = (&skeleton.beams[beam as usize], stiff_axis.as_dvec3());
            let along_wind = |&wind: &DVec3| {
                let across = wind.reject_from_normalized(beam.direction.as_dvec3());
                posed_m(beam, self.tip, across - stiff_axis * stiff_axis.dot(across)).dot(wind)
            };
            winds.iter().map(along_wind).sum::<f64>()
        };
        let posed = self.beams.iter().zip(&self.stiff_axes).map(posed);
        let turns = moved.iter().zip(posed).zip(turned);
        turns
            .map(|((moved, posed_m), [level, below]): (_, [f64; 2])| {
                BeamLoad::of(moved, posed_m, MOST_TURN * level.max(below))
            })
            .collect()
    }

    /// Radius at a distance from the root, m; beyond its end that of the tip.
    pub fn radius_m(&self, skeleton: &Skeleton, along_m: f32) -> f32 {
        let mut left_m = along_m;
        let mut radius_m = 0.0;
        for &index in &self.beams {
            let beam = &skeleton.beams[index as usize];
            radius_m = beam.radius_m((left_m / beam.length_m).min(1.0));
            if left_m <= beam.length_m {
                break;
            }
            left_m -= beam.length_m;
        }
        radius_m
    }
}

/// Number of sums that tell how large a beam's load is, and where.
const MOMENTS: usize = 8;

/// A lump's drag, and the moments of its place with the drag as weight: the wind's pressure there over two roughnesses, the three
/// coordinates, the square of the horizontal ones, the square of the height.
fn load_moments(lump: &Lump) -> [f64; MOMENTS] {
    let [x, y, z] = lump.at.to_array().map(f64::from);
    let [open, rough] = ROUGHNESS_M.map(|roughness_m| (lump.log_height - roughness_m.ln()).max(0.0).powi(2));
    [1.0, open, rough, x, y, z, x * x + z * z, y * y].map(|moment| lump.drag_kg_m * moment)
}

impl BeamLoad {
    /// From how far the tip moves by each moment, m, and for a turn of the beam by 1 rad; and the most that it may turn, rad.
    fn of(moments: &[f64; MOMENTS], posed_m: f64, most_rad: f64) -> Self {
        let [drag, open, rough, ..] = *moments;
        let (height_m, share) = load_height(open / drag, rough / drag);
        let turn = (drag / posed_m).min(most_rad) * share;
        // Boughs that reach back past their root would bend a beam against the wind: it is kept still instead.
        if !(drag > 0.0 && turn > 0.0) {
            return Self { gain: 0.0, height_m: 0.0, horizontal_m: 0.0, vertical_m: 0.0 };
        }
        let [x, y, z, horizontal, vertical] = [3, 4, 5, 6, 7].map(|moment: usize| moments[moment] / drag);
        // Of loads on both sides of the root some count as negative: what is left of a spread is at least none.
        let deviation = |variance: f64| variance.max(0.0).sqrt();
        Self {
            gain: turn / f64::from(SLOPE_TIP),
            height_m,
            horizontal_m: deviation(0.5 * (horizontal - x * x - z * z)),
            vertical_m: deviation(vertical - y * y),
        }
    }
}

/// The height, m, and the share of the drag that must be there for the wind to press as on all of it, with the squares of
/// `ln (y / z0)` over both roughnesses.
fn load_height(open: f64, rough: f64) -> (f64, f64) {
    let [open_m, rough_m] = ROUGHNESS_M;
    let speed = (rough_m / open_m).ln() / ((open / rough).sqrt() - 1.0);
    if speed.is_finite() && speed > 0.0 && rough > 0.0 {
        (rough_m * speed.exp(), rough / (speed * speed))
    } else {
        // Hardly any of it is higher than the roughness.
        (open_m * open.max(0.0).sqrt().exp(), 1.0)
    }
}
