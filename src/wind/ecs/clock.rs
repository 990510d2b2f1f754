//! The clock that all motion reads: now, and one frame ago.

use bevy::prelude::*;

/// Time of the wind. It follows the virtual [`Time`], so pausing or slowing that pauses or slows the wind.
///
/// Set `time_s` to jump: poses are pure functions of time and place, so nothing is simulated in between. A jump of more than a quarter of a
/// second is no motion: `previous_s` is set to it as well, before anything is drawn. Smaller ones, as of a client that follows a server's
/// clock, are.
///
/// In double precision it is exact to a nanosecond for 1,000 hours and far beyond.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Resource, Default)]
pub struct WindClock {
    /// Now, s.
    pub time_s: f64,
    /// One frame ago, s; what motion vectors are made from.
    pub previous_s: f64,
}

/// Moves the clock on by the frame's time.
pub(in crate::wind) fn advance_clock(mut clock: ResMut<WindClock>, time: Res<Time>) {
    clock.previous_s = clock.time_s;
    clock.time_s += time.delta_secs_f64();
}

/// A clock that is set farther than this from where it would be has jumped, s.
const LONGEST_CORRECTION_S: f64 = 0.25;

/// Where a game has let the clock jump, there is no motion from one frame to the next.
pub(in crate::wind) fn note_jumps(mut clock: ResMut<WindClock>, time: Res<Time>) {
    let WindClock { time_s, previous_s } = *clock;
    let is_steady = |corrected_s: f64| corrected_s.abs() <= LONGEST_CORRECTION_S;
    if previous_s != time_s && !is_steady(time_s - previous_s - time.delta_secs_f64()) {
        // What is no time is the beginning.
        let time_s = if time_s.is_finite() { time_s } else { 0.0 };
        *clock = WindClock { time_s, previous_s: time_s };
    }
}
