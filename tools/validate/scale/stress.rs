//! Worse for a forest than a steady flight: a viewer who turns quickly or is teleported, and a change of the wind.
//!
//! A system that spawns a task may lose its core to it, and on a machine with two cores often does. With a renderer teleports are
//! therefore measured again by CPU time, which does not pass while a thread waits.

use super::{SIDE_M, flight::Flight, system_costs::median_and_p99};
use crate::{cpu_clock::CPU_CLOCK, report::Report};
use bevy::prelude::*;
use bevy_windwood::{SystemTimes, prelude::*};

/// Repetitions of each. The slowest frame of each counts: the median of them is not disturbed by other work of the machine, and
/// the worst is recorded too.
const REPETITIONS: usize = 5;
/// Frames of a whole turn.
const TURN_FRAMES: usize = 15;
/// Frames after a teleport, in which most near trees appear.
const JUMP_FRAMES: usize = 40;
/// The first of the winds, m/s. Each is faster than the one before, so that the bounds of trees change.
const FIRST_WIND_M_S: f32 = 6.0;
/// Time in which a wind fades in, s.
const FADE_S: f32 = 0.5;
/// Greatest number of frames until a wind is synthesised and has faded in.
const WIND_FRAMES: usize = 300;

/// An app whose viewer and wind change abruptly. `run_frame` runs one frame.
pub struct StressTest<'a, F> {
    pub app: &'a mut App,
    pub flight: &'a mut Flight,
    pub run_frame: F,
}

/// Slowest frames of one action, ms: the median of all repetitions, and the worst.
pub type Slowest = [f64; 2];

impl<F: FnMut(&mut App)> StressTest<'_, F> {
    /// Slowest frames of a turn by 24 degrees per frame, after a teleport, and during a change of the wind.
    pub fn slowest_frames_ms(&mut self) -> [Slowest; 3] {
        [self.slowest_of(Self::turn), self.slowest_of(Self::teleport), self.slowest_of(Self::change_wind)]
    }

    fn slowest_of(&mut self, action: fn(&mut Self, usize) -> f64) -> Slowest {
        let of_each: Vec<f64> = (0..REPETITIONS).map(|repetition| action(self, repetition)).collect();
        [median_and_p99(&of_each)[0], of_each.iter().copied().fold(0.0, f64::max)]
    }

    /// Slowest frames after teleports by CPU time, or none where the system has no such clock. From then on all times are CPU times.
    pub fn slowest_teleport_cpu_ms(&mut self) -> Option<Slowest> {
        let clock = CPU_CLOCK?;
        self.app.world().resource::<SystemTimes>().use_clock(clock);
        Some(self.slowest_of(Self::teleport))
    }

    /// Time of our systems in a frame, ms.
    fn frame_ms(&mut self) -> f64 {
        (self.run_frame)(self.app);
        self.app.world().resource::<SystemTimes>().total().as_secs_f64() * 1e3
    }

    fn turn(&mut self, _: usize) -> f64 {
        let mut frame_ms = |_| {
            self.flight.place(self.app, |at| at.rotate_y(24_f32.to_radians()));
            self.frame_ms()
        };
        (0..TURN_FRAMES).map(&mut frame_ms).fold(0.0, f64::max)
    }

    fn teleport(&mut self, repetition: usize) -> f64 {
        self.flight.place(self.app, |at| {
            at.translation.x = place_m(repetition, 0.754_877_7);
            at.translation.z = place_m(repetition, 0.569_840_3);
        });
        (0..JUMP_FRAMES).map(|_| self.frame_ms()).fold(0.0, f64::max)
    }

    fn change_wind(&mut self, repetition: usize) -> f64 {
        let mut wind = self.app.world_mut().resource_mut::<Wind>();
        (wind.speed, wind.fade_s) = (FIRST_WIND_M_S + 2.0 * repetition as f32, FADE_S);
        let (mut worst_ms, mut was_new) = (0.0_f64, false);
        for _ in 0..WIND_FRAMES {
            worst_ms = worst_ms.max(self.frame_ms());
            let is_settled = self.app.world().resource::<ActiveSway>().is_settled();
            if was_new && is_settled {
                break;
            }
            was_new |= !is_settled;
        }
        worst_ms
    }
}

/// Records turns, teleports and winds with these keys: the median, and the worst.
pub fn record(report: &mut Report, keys: [[&'static str; 2]; 3], slowest_ms: [Slowest; 3]) {
    let notes = [
        "the slowest frame of a quick turn on the spot, median of five",
        "the slowest frame after a teleport of kilometres, median of five",
        "the slowest frame during a change of the wind, median of five",
    ];
    for (([median_key, worst_key], [median_ms, worst_ms]), note) in keys.into_iter().zip(slowest_ms).zip(notes) {
        report.at_most(median_key, median_ms, 2.0, note);
        report.record(worst_key, worst_ms, "the worst of the five");
    }
}

/// Places spread evenly over the inner forest (the R2 sequence of Roberts 2018), m.
fn place_m(index: usize, step: f32) -> f32 {
    ((0.5 + step * (index + 1) as f32).fract() - 0.5) * 0.8 * SIDE_M
}
