//! The state of a tree that is touched, and how it goes on.

use super::beam::LiveBeam;
use crate::dynamics::{
    exact_step::{ExactStep, OscillatorState},
    oscillator_grid::{DAMPINGS, OscillatorGrid},
};
use bevy::math::Vec3A;
use std::f64::consts::TAU;

/// The greatest damping ratio that an oscillator has.
const MOST_DAMPING_RATIO: f64 = 0.99;
/// A shorter step is no step, s.
const LEAST_STEP_S: f64 = 1e-6;
/// A longer step, s, has seen all oscillators come to rest.
const LONGEST_STEP_S: f64 = 1000.0;
/// Free angles are kept below this, rad: far beyond what saturates.
const MOST_FREE_RAD: f32 = 20.0;

/// A step of all oscillators, of one length of time.
#[derive(Clone, Debug, Default)]
pub struct LiveSteps {
    steps: Vec<[ExactStep; DAMPINGS]>,
    omegas: Vec<f32>,
}

impl LiveSteps {
    /// The steps over `time_step_s` of the oscillators of a grid; none where no time passes. A step may be of any length.
    #[must_use]
    pub fn new(grid: &OscillatorGrid, time_step_s: f64) -> Option<Self> {
        let mut steps = Self::default();
        steps.renew(grid, time_step_s).then_some(steps)
    }

    /// Makes them those of another time step, in the memory that they have. Returns whether time passes.
    pub fn renew(&mut self, grid: &OscillatorGrid, time_step_s: f64) -> bool {
        self.steps.clear();
        self.omegas.clear();
        if time_step_s.is_nan() || time_step_s < LEAST_STEP_S {
            return false;
        }
        let time_step_s = time_step_s.min(LONGEST_STEP_S);
        let step = |omega: f32, damping: usize| {
            let ratio = f64::from(grid.damping_ratios[damping]).min(MOST_DAMPING_RATIO);
            ExactStep::new(f64::from(omega), ratio, time_step_s).ok()
        };
        self.omegas.extend(omegas(grid));
        self.steps.extend(self.omegas.iter().map_while(|omega| Some([step(*omega, 0)?, step(*omega, 1)?])));
        self.steps.len() == self.omegas.len()
    }
}

/// Natural angular frequencies of the classes that oscillate, rad/s.
fn omegas(grid: &OscillatorGrid) -> impl Iterator<Item = f32> {
    let classes = grid.classes;
    (0..classes.quasi_static().max(1)).map(move |class| {
        let hz = f64::from(classes.lowest_hz) * f64::from(classes.ratio).powi(class as i32);
        (TAU * hz) as f32
    })
}

/// What bends a beam during a step: static free angles, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamLoad {
    /// The load at the end of the step: within it, it is linear. None where it stays as it was.
    pub steady: Option<Vec3A>,
    /// The mean over the step of what comes and goes within it.
    pub pulse: Vec3A,
}

impl BeamLoad {
    /// No load.
    pub const NONE: Self = Self { steady: Some(Vec3A::ZERO), pulse: Vec3A::ZERO };
}

/// What is added to the angles of a tree's beams.
#[derive(Clone, Debug, Default)]
pub struct LiveTree {
    beams: Vec<LiveState>,
    /// What one body has bent so far, kept for the next.
    pub(super) bent: Vec<Vec3A>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LiveState {
    oscillators: [OscillatorState<Vec3A>; DAMPINGS],
    /// At the end of the last step.
    load: Vec3A,
    damped: f32,
    omega: f32,
}

impl LiveState {
    fn mixed(&self, of: impl Fn(&OscillatorState<Vec3A>) -> Vec3A) -> Vec3A {
        let [low, high] = self.oscillators.each_ref().map(of);
        low * (1.0 - self.damped) + high * self.damped
    }

    /// Its greatest free angle, were it left alone, rad.
    fn amplitude(&self) -> f32 {
        let of = |it: &OscillatorState<Vec3A>| it.displacement.length() + it.velocity.length() / self.omega;
        of(&self.oscillators[0]).max(of(&self.oscillators[1]))
    }

    fn bounded(mut self) -> Self {
        for it in &mut self.oscillators {
            let is_finite = it.displacement.is_finite() && it.velocity.is_finite();
            let bound = |vector: Vec3A, most: f32| if is_finite { vector.clamp_length_max(most) } else { Vec3A::ZERO };
            it.displacement = bound(it.displacement, MOST_FREE_RAD);
            it.velocity = bound(it.velocity, MOST_FREE_RAD * self.omega);
        }
        self
    }
}

impl LiveTree {
    /// A tree of these beams, at rest. `grid` is that for which they are prepared.
    #[must_use]
    pub fn new(beams: &[LiveBeam], grid: &OscillatorGrid) -> Self {
        let mut tree = Self::default();
        tree.prepare(beams, grid);
        tree
    }

    /// Takes over the beams of another wind or season. Their motion goes on.
    pub fn prepare(&mut self, beams: &[LiveBeam], grid: &OscillatorGrid) {
        let omegas: Vec<f32> = omegas(grid).collect();
        self.beams.resize(beams.len(), LiveState::default());
        for (state, beam) in self.beams.iter_mut().zip(beams) {
            (state.damped, state.omega) = (beam.damped, omegas[beam.class.min(omegas.len() - 1)]);
        }
    }

    /// Carries it over one step. `load` says what bends each beam, by its number.
    pub fn step(&mut self, beams: &[LiveBeam], steps: &LiveSteps, mut load: impl FnMut(usize, &LiveBeam) -> BeamLoad) {
        for (index, (state, beam)) in self.beams.iter_mut().zip(beams).enumerate() {
            let Some((steps, omega)) = steps.steps.get(beam.class).zip(steps.omegas.get(beam.class)) else { continue };
            let BeamLoad { steady, pulse } = load(index, beam);
            let steady = steady.unwrap_or(state.load);
            let square = omega * omega;
            let [before, after] = [state.load + pulse, steady + pulse].map(|load| load * square);
            state.oscillators = std::array::from_fn(|d| steps[d].advance(state.oscillators[d], before, after));
            state.load = steady;
            *state = state.bounded();
        }
    }

    /// What is added to the free angle of a beam, rad.
    #[must_use]
    pub fn angle(&self, beam: usize) -> Vec3A {
        self.beams.get(beam).map_or(Vec3A::ZERO, |state| state.mixed(|it| it.displacement))
    }

    /// The same for all beams.
    pub fn angles(&self) -> impl Iterator<Item = Vec3A> {
        self.beams.iter().map(|state| state.mixed(|it| it.displacement))
    }

    /// Number of beams.
    #[must_use]
    pub fn len(&self) -> usize {
        self.beams.len()
    }

    /// Whether it has no beams.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.beams.is_empty()
    }

    /// Whether no beam is, or comes, farther than a small angle, rad, by a load or by itself.
    #[must_use]
    pub fn is_still(&self, angle_rad: f32) -> bool {
        self.beams.iter().all(|state| state.load.length() < angle_rad && state.amplitude() < angle_rad)
    }

    /// Strikes a beam: `static_rad_s` is the static free angle under a force, times the time for which that acts, rad s.
    pub(super) fn strike(&mut self, beam: usize, static_rad_s: Vec3A) {
        let Some(state) = self.beams.get_mut(beam) else { return };
        state.oscillators.iter_mut().for_each(|it| it.velocity += static_rad_s * (state.omega * state.omega));
        *state = state.bounded();
    }

    /// Bends a beam further by an angle, but along that one not beyond `most_rad` in all, and takes away its motion against it. Returns by
    /// how much it was bent, rad.
    pub(super) fn push(&mut self, beam: usize, angle: Vec3A, most_rad: f32) -> Vec3A {
        let Some(state) = self.beams.get_mut(beam) else { return Vec3A::ZERO };
        let along = angle.normalize_or_zero();
        let now_rad = state.mixed(|it| it.displacement).dot(along);
        let pushed = along * (angle.length().min((most_rad - now_rad).max(0.0)));
        for it in &mut state.oscillators {
            it.displacement += pushed;
            it.velocity -= along * it.velocity.dot(along).min(0.0);
        }
        *state = state.bounded();
        pushed
    }
}

#[cfg(test)]
mod tests;
