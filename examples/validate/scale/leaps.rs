//! What a viewer does that is worse than to fly: to whirl about on the spot, and to leap across the woods.

use super::{Flight, SIDE_M, dearest::median_and_p99};
use crate::report::Report;
use bevy::prelude::*;
use bevy_windwood::SystemTimes;

/// How often each is done; the slowest frame of each time counts. The median of these leaves out what else the machine does
/// now and then, and the worst is told beside it.
const TIMES: usize = 5;
/// Frames of a whole turn; and those after a leap, in which most of what is near comes.
const FRAMES: [usize; 2] = [15, 40];

/// The slowest frame of a turn by 24 degrees a frame, and after a leap, ms: of each the median, and the worst. `frame` lets one
/// pass.
pub fn slowest_ms(app: &mut App, flight: &mut Flight, mut frame: impl FnMut(&mut App)) -> [[f64; 2]; 2] {
    let mut slowest = |frames, act: &mut dyn FnMut(&mut Transform, usize, usize)| {
        let of_each: Vec<f64> = (0..TIMES)
            .map(|time| {
                let times_ms = (0..frames).map(|number| {
                    flight.place(app, |at| act(at, time, number));
                    frame(app);
                    app.world().resource::<SystemTimes>().total().as_secs_f64() * 1e3
                });
                times_ms.fold(0.0, f64::max)
            })
            .collect();
        [median_and_p99(&of_each)[0], of_each.iter().copied().fold(0.0, f64::max)]
    };
    let turning_ms = slowest(FRAMES[0], &mut |at, _, _| at.rotate_y(24_f32.to_radians()));
    let leaping_ms = slowest(FRAMES[1], &mut |at, time, number| {
        if number == 0 {
            at.translation.x = spot_m(time, 0.754_877_7);
            at.translation.z = spot_m(time, 0.569_840_3);
        }
    });
    [turning_ms, leaping_ms]
}

/// Tells what [`slowest_ms`] found under these keys: both medians, then both of the worst.
pub fn tell(report: &mut Report, keys: [&'static str; 4], [[turn, worst_turn], [leap, worst_leap]]: [[f64; 2]; 2]) {
    report.at_most(keys[0], turn, 2.0, "the slowest frame of a quick turn on the spot, median of five");
    report.at_most(keys[1], leap, 2.0, "the slowest frame after a leap of kilometres, median of five");
    report.tell(keys[2], worst_turn, "the worst of the five");
    report.tell(keys[3], worst_leap, "the worst of the five");
}

/// Spots that are spread evenly over the inner woods (the R2 sequence of Roberts 2018), m.
fn spot_m(time: usize, step: f32) -> f32 {
    ((0.5 + step * (time + 1) as f32).fract() - 0.5) * 0.8 * SIDE_M
}
