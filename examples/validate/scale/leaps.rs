//! What is worse for a forest than a viewer who flies: one who whirls about on the spot, or leaps across the woods, and
//! another wind.
//!
//! A system that sends a task away may lose its core to it, and on a machine with two of them often does: with a renderer
//! leaps are made once more by a clock that stands still meanwhile.

use super::{Flight, SIDE_M, dearest::median_and_p99};
use crate::report::Report;
use bevy::prelude::*;
use bevy_windwood::{SystemTimes, prelude::*};
use std::time::Duration;

/// How often each is done; the slowest frame of each time counts. The median of these leaves out what else the machine does
/// now and then, and the worst is told beside it.
const TIMES: usize = 5;
/// Frames of a whole turn.
const TURN_FRAMES: usize = 15;
/// Frames after a leap, in which most of what is near comes.
const LEAP_FRAMES: usize = 40;
/// The first of some winds that follow one another, m/s: each is another step of what boxes of trees have room for.
const FIRST_WIND_M_S: f32 = 6.0;
/// A wind takes so long to be felt in full, s, and not more frames than these to be made and felt.
const FADE_S: f32 = 0.5;
const WIND_FRAMES: usize = 300;

/// Frames in which something is done to an app, each of which `pass` lets pass.
pub struct Acts<'a, F> {
    pub app: &'a mut App,
    pub flight: &'a mut Flight,
    pub pass: F,
}

/// The slowest frames of one act, ms: the median of all times, and the worst.
pub type Slowest = [f64; 2];

impl<F: FnMut(&mut App)> Acts<'_, F> {
    /// The slowest frames of a turn by 24 degrees a frame, after a leap, and while another wind comes.
    pub fn slowest_ms(&mut self) -> [Slowest; 3] {
        [self.slowest_of(Self::turn), self.slowest_of(Self::leap), self.slowest_of(Self::change_the_wind)]
    }

    fn slowest_of(&mut self, act: fn(&mut Self, usize) -> f64) -> Slowest {
        let of_each: Vec<f64> = (0..TIMES).map(|time| act(self, time)).collect();
        [median_and_p99(&of_each)[0], of_each.iter().copied().fold(0.0, f64::max)]
    }

    /// The slowest frames after leaps by the time that the processor spends on our systems; none where the system has no such
    /// clock. From then on all times are by it.
    pub fn slowest_leap_by_processor_ms(&mut self) -> Option<Slowest> {
        let clock = PROCESSOR_CLOCK?;
        self.app.world().resource::<SystemTimes>().use_clock(clock);
        Some(self.slowest_of(Self::leap))
    }

    /// What our systems take in a frame, ms.
    fn frame_ms(&mut self) -> f64 {
        (self.pass)(self.app);
        self.app.world().resource::<SystemTimes>().total().as_secs_f64() * 1e3
    }

    fn turn(&mut self, _: usize) -> f64 {
        let mut frame_ms = |_| {
            self.flight.place(self.app, |at| at.rotate_y(24_f32.to_radians()));
            self.frame_ms()
        };
        (0..TURN_FRAMES).map(&mut frame_ms).fold(0.0, f64::max)
    }

    fn leap(&mut self, time: usize) -> f64 {
        self.flight.place(self.app, |at| {
            at.translation.x = spot_m(time, 0.754_877_7);
            at.translation.z = spot_m(time, 0.569_840_3);
        });
        (0..LEAP_FRAMES).map(|_| self.frame_ms()).fold(0.0, f64::max)
    }

    fn change_the_wind(&mut self, time: usize) -> f64 {
        let mut wind = self.app.world_mut().resource_mut::<Wind>();
        (wind.speed, wind.fade_s) = (FIRST_WIND_M_S + 2.0 * time as f32, FADE_S);
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

/// Tells of turns, leaps and winds under these keys: the median, and the worst.
pub fn tell(report: &mut Report, keys: [[&'static str; 2]; 3], slowest_ms: [Slowest; 3]) {
    let notes = [
        "the slowest frame of a quick turn on the spot, median of five",
        "the slowest frame after a leap of kilometres, median of five",
        "the slowest frame while another wind comes, median of five",
    ];
    for (([median_key, worst_key], [median_ms, worst_ms]), note) in keys.into_iter().zip(slowest_ms).zip(notes) {
        report.at_most(median_key, median_ms, 2.0, note);
        report.tell(worst_key, worst_ms, "the worst of the five");
    }
}

/// Tells what the time is that the processor has spent on a thread, where there is such a clock.
#[cfg(unix)]
const PROCESSOR_CLOCK: Option<fn() -> Duration> = Some(|| {
    use rustix::time::{ClockId, clock_gettime};
    Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default()
});
#[cfg(not(unix))]
const PROCESSOR_CLOCK: Option<fn() -> Duration> = None;

/// Spots that are spread evenly over the inner woods (the R2 sequence of Roberts 2018), m.
fn spot_m(time: usize, step: f32) -> f32 {
    ((0.5 + step * (time + 1) as f32).fract() - 0.5) * 0.8 * SIDE_M
}
