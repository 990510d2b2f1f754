//! Boxes around trees in the wind.
//!
//! The wind's strength bounds how far each beam's tip turns, `Theta`, and with that how far anything is moved. Where a beam
//! is attached, its parent has moved by at most `D` and turned by at most `R`; a point of the beam's axis at `s`, at a
//! distance `r` from there, moves by at most `D + R r + L Theta H_1(s)` and turns by at most `R + Theta h(s)`, in whatever
//! direction the loads are (`h` and `H_1` of `dynamics/bend.rs`: the axis turns by `Theta h`, and so leaves its place by no
//! more than the integral). In a great storm that sum is far more than the saturating beams can reach, and the box is that
//! of the limit, which is found by bending the tree.

use super::vertices::{LeafVertices, WoodVertices};
use crate::dynamics::{
    beam::BeamDynamics,
    beam_pose::BeamPose,
    bend::{SLOPE_TIP, mode_shape},
    pose::TreePoser,
};
use bevy::math::{Vec3, Vec3A};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwayBounds {
    /// Least corner, m.
    pub min: Vec3,
    /// Greatest corner, m.
    pub max: Vec3,
}

impl SwayBounds {
    /// The box of the tree's origin alone.
    const ORIGIN: Self = Self { min: Vec3::ZERO, max: Vec3::ZERO };

    /// Grows to hold all within `reach_m` of a place.
    fn include(&mut self, place: Vec3, reach_m: f32) {
        self.min = self.min.min(place - reach_m);
        self.max = self.max.max(place + reach_m);
    }

    /// What both boxes have in common.
    fn intersection(self, other: Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }
}

/// The strength of a wind in steps: of the pressure that it has at most. A box is made for each when a tree is baked, so that
/// nothing has to be computed for thousands of models in the frame in which another wind begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PressureStep(pub(super) u8);

impl PressureStep {
    /// Pressure of step 0, m²/s²: a breath of air.
    const LEAST: f32 = 0.1;
    /// From one step to the next: tip angles and boxes grow by no more.
    const RATIO: f32 = 1.3;
    /// Beyond the last step with a box of its own, of 8,000 m²/s², beams have come to their limit, or may have.
    pub const LIMIT: Self = Self(44);

    /// The least step whose pressure is not below one; that of one that is no number is the limit.
    pub fn of(pressure: f32) -> Self {
        let steps = (pressure.max(Self::LEAST) / Self::LEAST).ln() / Self::RATIO.ln();
        // Not beyond by a rounding.
        let step = (steps - 1e-4).ceil();
        if pressure.is_finite() && step < f32::from(Self::LIMIT.0) { Self(step as u8) } else { Self::LIMIT }
    }

    /// No wind of this step presses harder, m²/s².
    fn pressure(self) -> f32 {
        // More by the rounding of above.
        Self::LEAST * Self::RATIO.powf(f32::from(self.0) + 2e-4)
    }
}

/// Steps below the limit.
const STEPS: usize = PressureStep::LIMIT.0 as usize;

/// A value for each step.
type BySteps = [f32; STEPS];

/// The box around all that is bound to the beams at each step below the limit, of which the box is known.
pub(super) fn bounds_by_step(beams: &[BeamDynamics], reaches_m: &[f32], limit: SwayBounds) -> Box<[SwayBounds]> {
    let pressures: BySteps = std::array::from_fn(|step| PressureStep(step as u8).pressure());
    let mut bounds = [SwayBounds::ORIGIN; STEPS];
    let mut carried: Vec<Carried> = Vec::with_capacity(beams.len());
    for (beam, reach_m) in beams.iter().zip(reaches_m) {
        let own = Carried::new(beam, beams, &carried, &pressures);
        for s in [0.0, 0.5, 1.0] {
            let (place, moved_m) = own.at(beam, s);
            for (bounds, moved_m) in bounds.iter_mut().zip(moved_m) {
                bounds.include(place, moved_m + reach_m);
            }
        }
        carried.push(own);
    }
    bounds.into_iter().map(|bounds| bounds.intersection(limit)).collect()
}

/// How far the root of a beam has been moved, m, and turned, rad, at most, about a place of its parent.
struct Carried {
    about: Vec3,
    moved_m: BySteps,
    turned_rad: BySteps,
    /// By how much its own tip turns at most.
    tip_rad: BySteps,
}

impl Carried {
    /// Of a beam whose parents are known, if they come before it.
    fn new(beam: &BeamDynamics, beams: &[BeamDynamics], carried: &[Self], pressures: &BySteps) -> Self {
        let free_rad = SLOPE_TIP * greatest_gain(beam);
        let tip_rad = pressures.map(|pressure| (free_rad * pressure).min(beam.angle_limit_rad));
        let Some(parent) = carried.get(beam.parent as usize) else {
            return Self { about: beam.base, moved_m: [0.0; STEPS], turned_rad: [0.0; STEPS], tip_rad };
        };
        let (bearer, s) = (&beams[beam.parent as usize], beam.attach);
        let (about, moved_m) = parent.at(bearer, s);
        let [h, ..] = mode_shape(s);
        let turned_rad = std::array::from_fn(|step| parent.turned_rad[step] + parent.tip_rad[step] * h);
        Self { about, moved_m, turned_rad, tip_rad }
    }

    /// The place at `s` of the axis, and how far that is moved at most, m.
    fn at(&self, beam: &BeamDynamics, s: f32) -> (Vec3, BySteps) {
        let [_, h1, ..] = mode_shape(s);
        let place = beam.base + beam.direction * (beam.length_m * s);
        let (distance_m, by_tip_m) = (place.distance(self.about), beam.length_m * h1);
        let moved_m = std::array::from_fn(|step| {
            self.moved_m[step] + self.turned_rad[step] * distance_m + by_tip_m * self.tip_rad[step]
        });
        (place, moved_m)
    }
}

/// Of a beam in leaf or bare, s^2/m^2.
fn greatest_gain(beam: &BeamDynamics) -> f32 {
    beam.in_leaf.greatest_gain().max(beam.bare.greatest_gain())
}

/// Directions into which the whole tree is bent to its limit to find its bounds.
const BOUND_DIRECTIONS: usize = 8;
/// Share by which the box is widened for poses between those directions and for points between the places on a beam.
const BOUND_MARGIN: f32 = 0.08;
/// Places on a beam whose surroundings are enclosed; its root lies on its parent.
const BOUND_PLACES: [f32; 2] = [0.5, 1.0];
/// A free tip angle at which beams have saturated, rad.
const HURRICANE_RAD: f32 = 1e3;

/// Bends every beam to its limit into each of a ring of directions, and takes the box around all that is bound to it.
pub(super) fn limit_bounds(beams: &[BeamDynamics], reaches_m: &[f32]) -> SwayBounds {
    let mut bounds = SwayBounds::ORIGIN;
    let mut poses = vec![BeamPose::REST; beams.len()];
    let poser = TreePoser::bent(beams, |_| Vec3::ZERO);
    for step in 0..=BOUND_DIRECTIONS {
        let azimuth = step as f32 / BOUND_DIRECTIONS as f32 * std::f32::consts::TAU;
        // The last step is the tree at rest.
        let lean = if step == BOUND_DIRECTIONS { Vec3::ZERO } else { Vec3::new(azimuth.cos(), 0.0, azimuth.sin()) };
        let to_the_limit = |beam: &BeamDynamics| {
            Vec3A::from(lean.reject_from_normalized(beam.direction).normalize_or_zero() * HURRICANE_RAD)
        };
        let free: Vec<Vec3A> = beams.iter().map(to_the_limit).collect();
        poser.pose_free(&free, Vec3::ZERO, &mut poses);
        for ((beam, pose), reach_m) in beams.iter().zip(&poses).zip(reaches_m) {
            for s in BOUND_PLACES {
                bounds.include(pose.carry_axis(beam, s), *reach_m);
            }
        }
    }
    let margin = (bounds.max - bounds.min) * BOUND_MARGIN;
    SwayBounds { min: bounds.min - margin, max: bounds.max + margin }
}

/// Where a tree is drawn with fewer leaves, those that are left are larger, at most by this factor.
pub(crate) const MOST_ENLARGED: f32 = 2.3;

/// For each beam the greatest distance of what is bound to it from the place on its axis that carries it, m; a leaf may
/// turn anywhere about its anchor, and be enlarged about it.
pub(super) fn reaches_m(beams: &[BeamDynamics], wood: &WoodVertices, leaves: &LeafVertices) -> Vec<f32> {
    let mut reaches = vec![0.0_f32; beams.len()];
    let mut reach = |sway: &[f32; 4], at: Vec3, beyond_m: f32| {
        let index = sway[0] as usize;
        let beam = &beams[index];
        let axis = beam.base + beam.direction * (beam.length_m * sway[1]);
        reaches[index] = reaches[index].max(at.distance(axis) + beyond_m);
    };
    for (sway, position) in wood.sway.iter().zip(&wood.positions) {
        reach(sway, Vec3::from_array(*position), 0.0);
    }
    for (sway, (position, anchor)) in leaves.sway.iter().zip(leaves.positions.iter().zip(&leaves.anchor)) {
        let anchor = Vec3::from_slice(anchor);
        reach(sway, anchor, MOST_ENLARGED * Vec3::from_array(*position).distance(anchor));
    }
    reaches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{Species, TreeModel};
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// Whether all wood is in a box while every beam is bent by some free angle, rad.
    fn holds(bounds: SwayBounds, model: &TreeModel, mut free_angle: impl FnMut(&BeamDynamics) -> Vec3) -> bool {
        let angles: Vec<Vec3> = model.beams.iter().map(&mut free_angle).collect();
        // `bent` asks for the beams in their order.
        let next = std::cell::Cell::new(0);
        let angle = |_: &BeamDynamics| angles[next.replace(next.get() + 1)];
        let mut poses = vec![BeamPose::REST; model.beams.len()];
        TreePoser::bent(&model.beams, angle).pose(&[], Vec3::ZERO, &mut poses);
        model.wood.sway.iter().zip(&model.wood.positions).all(|(sway, at)| {
            let beam = sway[0] as usize;
            let (carried, _) = poses[beam].carry(&model.beams[beam], sway[1], Vec3::from_array(*at));
            carried.cmpge(bounds.min).all() && carried.cmple(bounds.max).all()
        })
    }

    fn odd(random: &mut Xoshiro256PlusPlus) -> Vec3 {
        let mut odd = || random.random_range(-1.0..1.0);
        Vec3::new(odd(), odd(), odd())
    }

    /// Trees whose beams are bent at random, to the limit and all over the place, stay in their box.
    #[test]
    fn no_pose_leaves_the_bounds() {
        for seed in 0..3 {
            let model = TreeModel::bake(&Species::default(), 120.0, seed);
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            for _ in 0..20 {
                let wind = odd(&mut random).with_y(0.3);
                assert!(holds(model.bounds, &model, |beam| {
                    let free = wind + 0.5 * odd(&mut random);
                    free.reject_from_normalized(beam.direction) * random.random_range(0.0..100.0)
                }));
            }
        }
    }

    /// Nor do they leave the box of a wind, whose pressure all or some of their beams feel from one side or from any.
    #[test]
    fn no_pose_in_a_wind_leaves_its_bounds() {
        for seed in 0..3 {
            let model = TreeModel::bake(&Species::default(), 120.0, seed);
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            for pressure in [0.0, 3.0, 30.0, 300.0, 3000.0] {
                let bounds = model.bounds_under(pressure);
                for round in 0..30_u8 {
                    let wind = odd(&mut random).with_y(0.0);
                    let chaos = f32::from(round % 3) * 0.5;
                    assert!(holds(bounds, &model, |beam| {
                        let load = (wind + chaos * odd(&mut random)).normalize_or_zero() * pressure;
                        load.reject_from_normalized(beam.direction) * (SLOPE_TIP * greatest_gain(beam))
                    }));
                }
            }
        }
    }

    #[test]
    fn pressures_are_never_rounded_down() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        for _ in 0..10_000 {
            let pressure = 10.0_f32.powf(random.random_range(-3.0..3.8));
            let stepped = PressureStep::of(pressure).pressure();
            assert!(stepped >= pressure && stepped <= 1.31 * pressure.max(PressureStep::LEAST), "{pressure} {stepped}");
        }
        assert_eq!(PressureStep::of(0.0), PressureStep(0));
        assert_eq!([1e5, f32::INFINITY, f32::NAN].map(PressureStep::of), [PressureStep::LIMIT; 3]);
        for step in (0..PressureStep::LIMIT.0).map(PressureStep) {
            let next = PressureStep(step.0 + 1);
            assert_eq!(PressureStep::of(0.5 * (step.pressure() + next.pressure())), next);
        }
    }

    #[test]
    fn a_stronger_wind_has_a_larger_box_up_to_that_of_the_limit() {
        let model = TreeModel::bake(&Species::default(), 120.0, 1);
        let size = |pressure: f32| {
            let SwayBounds { min, max } = model.bounds_under(pressure);
            max - min
        };
        let sizes = [0.0, 30.0, 300.0, 3e4, f32::INFINITY].map(size);
        assert!(sizes.windows(2).all(|pair| pair[0].cmple(pair[1]).all()), "{sizes:?}");
        assert!(sizes[0].x < 0.8 * sizes[4].x, "{sizes:?}");
        assert_eq!(model.bounds_under(f32::INFINITY), model.bounds);
        assert_eq!(model.bounds_under(f32::NAN), model.bounds);
    }
}
