//! How far a leaf turns at most while the wind or its branch turns by one degree.

use super::{FULLY_TURNING, angle_between_rad, axes, directions, tilts, winds};
use bevy::math::Quat;
use bevy_windwood::{
    dynamics::{LeafResponse, RestingLeaf},
    sway::FLUTTER_PERIOD_S,
};

const STEP_DEG: f32 = 1.0;
/// From a calm through onset and full speed to a storm.
const SPEEDS_M_S: [f32; 8] = [1.0, 2.4, 3.5, 5.0, 8.0, 12.0, 25.0, 60.0];
const AXES: usize = 60;
const WINDS: usize = 250;

/// The largest turns of a leaf, in degrees.
#[derive(Default)]
pub struct WorstTurns {
    /// While the wind swings.
    pub wind: f64,
    /// While the branch turns.
    pub branch: f64,
}

pub fn worst_turns_deg() -> WorstTurns {
    let mut worst = WorstTurns::default();
    let steps: Vec<Quat> = tilts(STEP_DEG.to_radians()).collect();
    for (k, (axis, about)) in axes(AXES).zip(directions(AXES).cycle()).enumerate() {
        // The leaf is carried to `axis`; where it rests is another place each time.
        let carried = Quat::from_axis_angle(about, 0.4 + 0.05 * (k % 40) as f32);
        let leaf = RestingLeaf { axis: carried.inverse() * axis, phase: (0.618 * k as f32).fract() };
        for response in [LeafResponse::default(), FULLY_TURNING] {
            for (number, direction) in winds(axis, WINDS).enumerate() {
                let speed = SPEEDS_M_S[(number + k) % SPEEDS_M_S.len()];
                let time_s = 1.7 * number as f32 % FLUTTER_PERIOD_S as f32;
                let at = |carried, wind| response.rotation(&leaf, carried, wind, time_s, FLUTTER_PERIOD_S as f32);
                let (wind, now) = (speed * direction, at(carried, speed * direction));
                for step in &steps {
                    let turned = |then| angle_between_rad(now, then).to_degrees();
                    worst.wind = worst.wind.max(turned(at(carried, *step * wind)));
                    worst.branch = worst.branch.max(turned(at(*step * carried, wind)));
                }
            }
        }
    }
    worst
}
