//! What a beam has to do with the wind of a source.

use crate::{
    dynamics::{
        beam::{BeamDynamics, BeamWind, drag_share},
        bend::SLOPE_TIP,
    },
    wind::cross_flow_pressure,
};
use bevy::math::{Vec3, Vec3A};

/// A beam of a tree that is touched, prepared for one wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveBeam {
    /// Where the wind presses as on all that bends it, in the tree's coordinates, m.
    pub load_at: Vec3,
    /// How far what bends it is spread about there, as a standard deviation in each direction, m.
    pub spread_m: f32,
    direction: Vec3,
    stiff_axis: Vec3,
    /// Free tip angle by pressure, rad s^2/m^2.
    gain: f32,
    drag_exponent: f32,
    /// Class of its natural frequency: one that has an oscillator.
    pub class: usize,
    /// Share of the more strongly damped oscillator.
    pub(super) damped: f32,
    /// Its second frequency.
    pub(super) second: LiveSecond,
}

/// The second frequency of a beam: class and share of the more strongly damped oscillator, and its share of the motion, 0 where the beam has
/// none. Oscillators have the damping ratio of each mode: unlike that of the table's rows
/// ([`oscillator_grid`](crate::dynamics::oscillator_grid)) it has not to make up for a size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LiveSecond {
    pub class: usize,
    pub damped: f32,
    pub share: f32,
}

/// Place on its axis where a beam is loaded, unless its height tells otherwise.
const LOADED_AT: f32 = 0.6;

impl LiveBeam {
    /// A beam of a tree of some scale that has a share of its leaves, 0 to 1.
    #[must_use]
    pub fn new(beam: &BeamDynamics, wind: &BeamWind, scale: f32, leaf_share: f32) -> Self {
        let (sway, grid) = (beam.sway(leaf_share), &wind.grid);
        let finite = |value: f32| if value.is_finite() { value } else { 0.0 };
        let own_hz = grid.classes.frequency_at_hz(sway.class);
        let oscillating = grid.classes.quasi_static().max(1) - 1;
        let class_of = |coordinate: f32| grid.classes.nearest(coordinate + grid.classes.shift(scale)).min(oscillating);
        let [damped, second_damped] = sway.damping_ratios(wind, scale).map(|ratio| grid.damped_share(ratio));
        let along = beam.base + beam.direction * (LOADED_AT * beam.length_m);
        Self {
            load_at: along.with_y(finite(sway.load_height_m)),
            spread_m: finite(sway.averaging_speed_m_s / own_hz).max(0.0),
            direction: beam.direction,
            stiff_axis: beam.stiff_axis,
            gain: finite(SLOPE_TIP * sway.gain),
            drag_exponent: finite(sway.drag_exponent).clamp(-1.0, 0.0),
            class: class_of(sway.class),
            damped,
            second: LiveSecond {
                class: class_of(sway.class + sway.second.class_offset),
                damped: second_damped,
                share: if sway.second.is_there() { sway.second.share.min(1.0) } else { 0.0 },
            },
        }
    }

    /// The static free angle, rad, by which a source's velocity bends it further than the wind there does alone; both m/s in the
    /// tree's axes. Drag grows with less than the square of the speed, as in any wind.
    #[must_use]
    pub fn load(&self, wind: Vec3, source: Vec3) -> Vec3A {
        if source == Vec3::ZERO {
            return Vec3A::ZERO;
        }
        let pressure = |velocity: Vec3| {
            cross_flow_pressure(velocity, self.direction) * drag_share(velocity.length(), self.drag_exponent)
        };
        let load = pressure(wind + source) - pressure(wind);
        // The stiff axis is that of level winds: what blows down on a branch bends it down.
        let level = 1.0 - (source.y / source.length()).powi(2);
        let angle = self.gain * (load - self.stiff_axis * (self.stiff_axis.dot(load) * level));
        if angle.is_finite() { angle.into() } else { Vec3A::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{
        beam::BeamSway,
        second_mode::SecondMode,
        test_beams::{OAK, upright, wind},
    };

    const LENGTH_M: f32 = 14.0;

    /// The table's own answer to the mean wind, at the height at which that is given.
    #[test]
    fn a_steady_source_bends_a_beam_as_so_much_more_wind_does() {
        let table = |speed_m_s: f32| SLOPE_TIP * OAK.answer(&wind(speed_m_s), 1.0).mean_gain * speed_m_s * speed_m_s;
        let live = LiveBeam::new(&upright(OAK, LENGTH_M), &wind(6.0), 1.0, 1.0);
        for source_m_s in [-3.0, 2.0, 14.0] {
            let added = live.load(Vec3::X * 6.0, Vec3::X * source_m_s);
            let expected = table(6.0 + source_m_s) - table(6.0);
            assert!((added.x / expected - 1.0).abs() < 1e-4, "{source_m_s}: {added} against {expected}");
            assert_eq!((added.y, added.z), (0.0, 0.0));
        }
        assert_eq!(live.load(Vec3::X * 6.0, Vec3::Y * 9.0).y, 0.0, "what blows along a beam does not bend it");
    }

    #[test]
    fn spreads_are_sizes_and_do_not_depend_on_the_wind() {
        let own_hz = 0.05 * 1.22_f32.powi(8);
        let live = LiveBeam::new(&upright(OAK, LENGTH_M), &wind(6.0), 1.0, 1.0);
        assert!((live.spread_m - 0.9 / own_hz).abs() < 1e-4);
        assert_eq!(live.load_at, Vec3::Y * 10.0);
        // A tree twice as large sways half as fast: between three and four classes.
        assert_eq!(LiveBeam::new(&upright(OAK, LENGTH_M), &wind(6.0), 2.0, 1.0).class, 5);
    }

    #[test]
    fn any_beam_in_any_wind_has_a_finite_load() {
        for odd in [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30] {
            for sway in [
                BeamSway { gain: odd, ..OAK },
                BeamSway { class: odd, ..OAK },
                BeamSway { averaging_speed_m_s: odd, ..OAK },
                BeamSway { load_height_m: odd, ..OAK },
                BeamSway { drag_exponent: odd, ..OAK },
                BeamSway { second: SecondMode { class_offset: odd, share: odd }, ..OAK },
            ] {
                let live = LiveBeam::new(&upright(sway, LENGTH_M), &wind(6.0), odd, odd);
                assert!(live.load_at.is_finite() && live.spread_m >= 0.0 && live.damped.is_finite(), "{live:?}");
                assert!(live.second.damped.is_finite() && (0.0..=1.0).contains(&live.second.share), "{live:?}");
                assert!(live.load(Vec3::X, Vec3::splat(odd)).is_finite());
            }
        }
    }
}
