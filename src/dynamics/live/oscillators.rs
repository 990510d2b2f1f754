//! The state of a tree that is touched, and how it goes on.

use super::beam::{LiveBeam, LiveSecond};
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
    /// The second mode of each beam. Apart, since most beams have none: those are not looked at.
    seconds: Vec<LiveMode>,
    /// What one body has bent so far, kept for the next.
    pub(super) bent: Vec<Vec3A>,
}

/// A beam: its first mode, as if that were all of its motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LiveState {
    first: LiveMode,
    /// At the end of the last step.
    load: Vec3A,
    /// Of the motion, of the second mode.
    second_share: f32,
}

/// A natural frequency of a beam. The angles are those of all of its load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LiveMode {
    oscillators: [OscillatorState<Vec3A>; DAMPINGS],
    damped: f32,
    omega: f32,
}

impl LiveState {
    /// The angle of a beam, with that of its second mode.
    fn angle(&self, second: &LiveMode) -> Vec3A {
        let first = self.first.angle();
        if self.second_share > 0.0 { first.lerp(second.angle(), self.second_share) } else { first }
    }

    /// Both modes; of a beam with one alone that.
    fn modes<'a>(&'a mut self, second: &'a mut LiveMode) -> impl Iterator<Item = &'a mut LiveMode> {
        let has_second = self.second_share > 0.0;
        std::iter::once(&mut self.first).chain(has_second.then_some(second))
    }
}

impl LiveMode {
    fn angle(&self) -> Vec3A {
        let [low, high] = self.oscillators.each_ref().map(|it| it.displacement);
        low * (1.0 - self.damped) + high * self.damped
    }

    /// Carries it over a step, for the loads at its beginning and at its end.
    fn step(&mut self, steps: &LiveSteps, class: usize, loads: [Vec3A; 2]) {
        let Some((steps, omega)) = steps.steps.get(class).zip(steps.omegas.get(class)) else { return };
        let [before, after] = loads.map(|load| load * (omega * omega));
        self.oscillators = std::array::from_fn(|d| steps[d].advance(self.oscillators[d], before, after));
        *self = self.bounded();
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
        self.seconds.resize(beams.len(), LiveMode::default());
        let omega = |class: usize| omegas[class.min(omegas.len() - 1)];
        for ((state, second), beam) in self.beams.iter_mut().zip(&mut self.seconds).zip(beams) {
            let LiveSecond { class, damped, share } = beam.second;
            (state.first.damped, state.first.omega) = (beam.damped, omega(beam.class));
            (second.damped, second.omega) = (damped, omega(class));
            // One that comes with a season begins as the first moves; one that has gone does not come back as it was.
            if state.second_share == 0.0 || share == 0.0 {
                second.oscillators = state.first.oscillators;
            }
            state.second_share = share;
        }
    }

    /// Carries it over one step. `load` says what bends each beam, by its number.
    pub fn step(&mut self, beams: &[LiveBeam], steps: &LiveSteps, mut load: impl FnMut(usize, &LiveBeam) -> BeamLoad) {
        let states = self.beams.iter_mut().zip(&mut self.seconds).zip(beams);
        for (index, ((state, second), beam)) in states.enumerate() {
            let BeamLoad { steady, pulse } = load(index, beam);
            let steady = steady.unwrap_or(state.load);
            let loads = [state.load + pulse, steady + pulse];
            state.first.step(steps, beam.class, loads);
            if state.second_share > 0.0 {
                second.step(steps, beam.second.class, loads);
            }
            state.load = steady;
        }
    }

    /// What is added to the free angle of a beam, rad.
    #[must_use]
    pub fn angle(&self, beam: usize) -> Vec3A {
        self.beams.get(beam).zip(self.seconds.get(beam)).map_or(Vec3A::ZERO, |(state, second)| state.angle(second))
    }

    /// The same for all beams.
    pub fn angles(&self) -> impl Iterator<Item = Vec3A> {
        self.beams.iter().zip(&self.seconds).map(|(state, second)| state.angle(second))
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
        self.beams.iter().zip(&self.seconds).all(|(state, second)| {
            let is_still = state.load.length() < angle_rad && state.first.amplitude() < angle_rad;
            is_still && (state.second_share == 0.0 || second.amplitude() < angle_rad)
        })
    }

    /// Strikes a beam: `static_rad_s` is the static free angle under a force, times the time for which that acts, rad s.
    pub(super) fn strike(&mut self, beam: usize, static_rad_s: Vec3A) {
        let Some((state, second)) = self.beams.get_mut(beam).zip(self.seconds.get_mut(beam)) else { return };
        for mode in state.modes(second) {
            mode.oscillators.iter_mut().for_each(|it| it.velocity += static_rad_s * (mode.omega * mode.omega));
            *mode = mode.bounded();
        }
    }

    /// Bends a beam further by an angle, but along that one not beyond `most_rad` in all, and takes away its motion against it. Returns by
    /// how much it was bent, rad.
    pub(super) fn push(&mut self, beam: usize, angle: Vec3A, most_rad: f32) -> Vec3A {
        let Some((state, second)) = self.beams.get_mut(beam).zip(self.seconds.get_mut(beam)) else {
            return Vec3A::ZERO;
        };
        let along = angle.normalize_or_zero();
        let now_rad = state.angle(second).dot(along);
        let pushed = along * (angle.length().min((most_rad - now_rad).max(0.0)));
        for mode in state.modes(second) {
            for it in &mut mode.oscillators {
                it.displacement += pushed;
                it.velocity -= along * it.velocity.dot(along).min(0.0);
            }
            *mode = mode.bounded();
        }
        pushed
    }
}

#[cfg(test)]
mod tests;
