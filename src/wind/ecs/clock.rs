//! The clock that all motion reads: now, and one frame ago.

use bevy::prelude::*;

/// Time of the wind. It follows the virtual [`Time`], so pausing or slowing that pauses or slows the wind.
///
/// Set `time_s` to jump: poses are pure functions of time and place, so nothing is simulated in between.
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
