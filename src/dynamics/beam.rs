//! What a beam's motion depends on, and how it answers a wind.

use super::{
    mean_wind::MeanWind,
    oscillator_grid::{GridMode, OscillatorGrid, RowWeights},
    second_mode::SecondMode,
    stand_wind::{StandLoads, StandWind},
};
use bevy::math::{FloatExt, Vec3};

/// The parent index of a beam that stands on the ground.
pub const NO_PARENT: u32 = u32::MAX;

/// Mean wind speed for which drag coefficients, and with them gains, are given, m/s.
pub const DRAG_SPEED_M_S: f32 = 10.0;

/// In slower winds leaves and twigs do not fold away, m/s: crowns keep their drag coefficient up to some 4 m/s (wind tunnel,
/// Vollsinger et al. 2005).
pub(crate) const FOLDING_SPEED_M_S: f32 = 4.0;

/// What a beam's motion depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamDynamics {
    /// Root at rest, in metres, in the tree's coordinates.
    pub base: Vec3,
    /// Length in metres.
    pub length_m: f32,
    /// Unit direction at rest, from root to tip.
    pub direction: Vec3,
    /// Place on the parent's axis where this beam is attached, 0 (root) to 1 (tip).
    pub attach: f32,
    /// Index of the parent, which must be lower than the beam's own, or [`NO_PARENT`].
    pub parent: u32,
    /// Angle that its tip approaches in an ever stronger wind, in radians: [`TIP_ANGLE_LIMIT`](super::TIP_ANGLE_LIMIT) for a
    /// branch of one beam; beams that continue one another share it, by how far they bend.
    pub angle_limit_rad: f32,
    /// Direction across the beam in which it bends less in a level wind, in the tree's coordinates; its length is the square root of the
    /// share by which it does (0: alike in all directions, 1: not at all in this one). Crooked branches move askew of the wind by it.
    pub stiff_axis: Vec3,
    /// Turn of its tip under a moment that bends it along its whole length, of a stem with its roots, rad/(N m).
    pub compliance_rad_n_m: f32,
    /// While the tree is in leaf.
    pub in_leaf: BeamSway,
    /// While it is bare. Evergreens never are.
    pub bare: BeamSway,
}

impl BeamDynamics {
    /// The load that bends a beam without a stiff axis as this one bends the beam.
    #[must_use]
    pub fn effective_load(&self, load: Vec3) -> Vec3 {
        load - self.stiff_axis * self.stiff_axis.dot(load)
    }

    /// How it sways with that share of its leaves, 0 to 1.
    #[must_use]
    pub fn sway(&self, leaf_share: f32) -> BeamSway {
        let share = if leaf_share > 0.0 { leaf_share.min(1.0) } else { 0.0 };
        let mix = |of: fn(&BeamSway) -> f32| of(&self.bare).lerp(of(&self.in_leaf), share);
        BeamSway {
            gain: mix(|sway| sway.gain),
            class: mix(|sway| sway.class),
            averaging_speed_m_s: mix(|sway| sway.averaging_speed_m_s),
            drag_damping_s_m: mix(|sway| sway.drag_damping_s_m),
            load_height_m: mix(|sway| sway.load_height_m),
            drag_exponent: mix(|sway| sway.drag_exponent),
            second: SecondMode {
                class_offset: mix(|sway| sway.second.class_offset),
                share: mix(|sway| sway.second.share),
            },
        }
    }
}

/// How a beam sways, with what it carries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BeamSway {
    /// Tip deflection by length and by the wind's pressure `|u| u` at the load's height, in s^2/m^2, in a wind of
    /// [`DRAG_SPEED_M_S`].
    pub gain: f32,
    /// Natural frequency as a [coordinate](super::FrequencyClasses::coordinate) of the classes, not rounded. Of two that by which
    /// gusts move it further.
    pub class: f32,
    /// Natural frequency times the size of what bends the beam ([`equivalent_size_m`](super::equivalent_size_m)), in m/s:
    /// the slower the wind beside it, the less of its gusts is felt.
    pub averaging_speed_m_s: f32,
    /// Damping ratio by drag, for each m/s of mean wind, in s/m, in a wind of [`DRAG_SPEED_M_S`].
    pub drag_damping_s_m: f32,
    /// Height above the tree's foot at which the wind presses as on all that bends the beam, in metres.
    pub load_height_m: f32,
    /// `V`: the load grows with the speed to the power `2 + V` (Vogel 1989). -1 to 0.
    pub drag_exponent: f32,
    /// Its second natural frequency. Most beams have none.
    pub second: SecondMode,
}

/// A wind and its table, as beams feel them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamWind {
    /// The wind at the tree.
    pub stand: StandWind,
    /// The oscillators of the table.
    pub grid: OscillatorGrid,
}

/// How a beam answers a wind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BeamAnswer {
    /// Tip deflection by length and by the mean load of the table's wind, in s^2/m^2.
    pub mean_gain: f32,
    /// The same by the load's moving part.
    pub gust_gain: f32,
    /// The rows of the table that it follows.
    pub read: RowWeights,
}

/// The wind at a beam's load, and what that does to the beam.
struct LocalWind {
    /// Loads by those of the table's wind.
    loads: StandLoads,
    /// Drag coefficient over that at [`DRAG_SPEED_M_S`]: crowns fold away in the wind.
    folded: f32,
    /// Derivative of the load, which grows as `U^(2 + V)`, by that of `U^2`.
    gusts: f32,
    /// Damping ratio by drag.
    drag_damping: f32,
}

impl BeamSway {
    /// The answer of a beam of an instance of some scale: that makes a tree sway more slowly and reach higher winds, and
    /// leaves the angles as they are (stiffness grows with its fourth power, as do the load's moments).
    ///
    /// With `r` the mean speed at the load's height over that of the table's wind, mean loads go with `r^2` in the open, and
    /// gusts, whose strength does not change with height, with `r`: a gust `u'` in a wind `U` adds `2 U u'` to the pressure.
    /// Between other trees both are less: [`StandWind`].
    #[must_use]
    pub fn answer(&self, wind: &BeamWind, scale: f32) -> BeamAnswer {
        let LocalWind { loads, folded, gusts, drag_damping } = self.local_wind(wind, scale);
        let grid = &wind.grid;
        let shift = grid.classes.shift(scale);
        let [first, second] = self.modes(grid, drag_damping).map(|mode| GridMode {
            class: mode.class + shift,
            // The grid's sizes are for the table's wind.
            averaging_speed_m_s: mode.averaging_speed_m_s / loads.convection,
            ..mode
        });
        let read = if self.second.is_there() {
            grid.weights_of_two([first, second], self.second.share)
        } else {
            grid.weights(first.class, first.averaging_speed_m_s, first.damping_ratio)
        };
        let finite = |gain: f32| if gain.is_finite() { gain } else { 0.0 };
        BeamAnswer {
            mean_gain: finite(self.gain * folded * loads.mean),
            gust_gain: finite(self.gain * gusts * loads.gusts),
            read,
        }
    }

    /// Damping ratio of the first mode of an instance of some scale in a wind: that of the wood and the roots, and what drag adds.
    #[must_use]
    pub fn damping_ratio(&self, wind: &BeamWind, scale: f32) -> f32 {
        self.damping_ratios(wind, scale)[0]
    }

    /// The same of both modes.
    #[must_use]
    pub fn damping_ratios(&self, wind: &BeamWind, scale: f32) -> [f32; 2] {
        self.modes(&wind.grid, self.local_wind(wind, scale).drag_damping).map(|mode| mode.damping_ratio)
    }

    /// Both modes, the first with that damping ratio by drag. What bends the beam, and so its size, is the same for both. Drag takes as much
    /// of a motion in each second, the ratio of drag to mass: of a slower mode it is more by the period.
    fn modes(&self, grid: &OscillatorGrid, drag_damping: f32) -> [GridMode; 2] {
        let structure = grid.damping_ratios[0];
        let faster = grid.classes.ratio.powf(self.second.class_offset);
        [(0.0, 1.0), (self.second.class_offset, faster)].map(|(offset, faster)| GridMode {
            class: self.class + offset,
            averaging_speed_m_s: self.averaging_speed_m_s * faster,
            damping_ratio: structure + drag_damping / faster,
        })
    }

    fn local_wind(&self, wind: &BeamWind, scale: f32) -> LocalWind {
        let loads = wind.stand.loads(self.load_height_m * scale);
        let speed_m_s = loads.mean.sqrt() * wind.stand.table_speed_m_s();
        let folded = drag_share(speed_m_s, self.drag_exponent);
        let gusts = (1.0 + 0.5 * self.drag_exponent) * folded;
        LocalWind { loads, folded, gusts, drag_damping: gusts * speed_m_s * self.drag_damping_s_m }
    }

    /// The same beam with its second mode as the first. `ratio` is that of neighbouring classes.
    #[must_use]
    pub(crate) fn in_other_order(&self, ratio: f32) -> Self {
        let SecondMode { class_offset, share } = self.second;
        let faster = ratio.powf(class_offset);
        Self {
            class: self.class + class_offset,
            averaging_speed_m_s: self.averaging_speed_m_s * faster,
            drag_damping_s_m: self.drag_damping_s_m / faster,
            second: SecondMode::rounded(-class_offset, 1.0 - share),
            ..*self
        }
    }

    /// Tip deflection by length in a steady wind over open country, by its pressure `|u| u` at 10 m, s^2/m^2: for pictures
    /// that serve all winds.
    #[must_use]
    pub(crate) fn open_country_gain(&self) -> f32 {
        self.gain * MeanWind::open_country(1.0).ratio(self.load_height_m).powi(2)
    }

    /// No wind over open country bends an instance of up to [`TALLEST_SCALE`] further, by its pressure at 10 m and
    /// [`most_pressure_share`]: loads go with the ratio `r` of the mean speeds to the power `2 + V`, gusts with `1 + V`.
    #[must_use]
    pub(crate) fn greatest_gain(&self) -> f32 {
        let ratio = MeanWind::open_country(1.0).ratio(self.load_height_m.max(LEAST_HEIGHT_M) * TALLEST_SCALE);
        self.gain * ratio.powf(1.0 + self.drag_exponent) * ratio.max(1.0)
    }
}

/// Drag coefficient at a speed, m/s, over that at [`DRAG_SPEED_M_S`]: crowns fold away as a power of the speed, and not below
/// [`FOLDING_SPEED_M_S`].
#[must_use]
pub(super) fn drag_share(speed_m_s: f32, drag_exponent: f32) -> f32 {
    (speed_m_s.max(FOLDING_SPEED_M_S) / DRAG_SPEED_M_S).powf(drag_exponent)
}

/// Bounds hold for instances up to this scale.
const TALLEST_SCALE: f32 = 2.0;
/// Loads nearer to the ground count as at this height, m, for bounds.
const LEAST_HEIGHT_M: f32 = 0.5;

/// By how much a wind may press harder on a beam than its pressure at the table's height tells
/// [`greatest_gain`](BeamSway::greatest_gain): other profiles than that of open country, and crowns that have not folded yet in
/// a wind below [`DRAG_SPEED_M_S`] (an exponent of -1 at most).
#[must_use]
pub(crate) fn most_pressure_share(mean: &MeanWind) -> f32 {
    mean.most_by_open_country() * (DRAG_SPEED_M_S / mean.speed_m_s.max(FOLDING_SPEED_M_S)).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::test_beams::{OAK, wind};

    /// Loads grow with the speed to the power 2 + V, as the deflection in a steady wind does.
    #[test]
    fn mean_loads_follow_vogels_exponent() {
        let deflection = |speed_m_s: f32| OAK.answer(&wind(speed_m_s), 1.0).mean_gain * speed_m_s * speed_m_s;
        let exponent = (deflection(20.0) / deflection(8.0)).ln() / (20.0_f32 / 8.0).ln();
        assert!((exponent - 1.65).abs() < 1e-3, "{exponent}");
        assert!((OAK.answer(&wind(DRAG_SPEED_M_S), 1.0).mean_gain / OAK.gain - 1.0).abs() < 1e-5);
    }

    /// The change of the mean deflection with the speed is what a slow gust does.
    #[test]
    fn a_slow_gust_bends_as_a_faster_mean_wind_does() {
        let deflection = |speed_m_s: f32| OAK.answer(&wind(speed_m_s), 1.0).mean_gain * speed_m_s * speed_m_s;
        let slope = (deflection(8.1) - deflection(7.9)) / 0.2;
        let gust = OAK.answer(&wind(8.0), 1.0).gust_gain * 2.0 * 8.0;
        assert!((gust / slope - 1.0).abs() < 1e-3, "{gust} against {slope}");
    }

    #[test]
    fn high_loads_feel_more_mean_wind_than_gusts() {
        let high = BeamSway { load_height_m: 20.0, ..OAK };
        let [low, high] = [OAK, high].map(|sway| BeamSway { drag_exponent: 0.0, ..sway }.answer(&wind(8.0), 1.0));
        let ratio = 200f32.ln() / 100f32.ln();
        assert!((high.mean_gain / low.mean_gain - ratio * ratio).abs() < 1e-4);
        assert!((high.gust_gain / low.gust_gain - ratio).abs() < 1e-4);
    }

    #[test]
    fn answers_are_finite_for_any_beam_and_wind() {
        let odd = [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0, 1e30, f32::INFINITY];
        for value in odd {
            for sway in [
                BeamSway { gain: value, ..OAK },
                BeamSway { class: value, ..OAK },
                BeamSway { averaging_speed_m_s: value, ..OAK },
                BeamSway { drag_damping_s_m: value, ..OAK },
                BeamSway { load_height_m: value, ..OAK },
                BeamSway { drag_exponent: value, ..OAK },
                BeamSway { second: SecondMode { class_offset: value, share: 0.5 }, ..OAK },
                BeamSway { second: SecondMode { class_offset: 3.0, share: value }, ..OAK },
            ] {
                for scale in [f32::NAN, 0.0, 1.0] {
                    let answer = sway.answer(&wind(8.0), scale);
                    assert!(answer.mean_gain.is_finite() && answer.gust_gain.is_finite(), "{sway:?} {answer:?}");
                    assert!(answer.read.weights.iter().all(|weight| weight.is_finite()), "{sway:?} {answer:?}");
                }
            }
        }
    }
}
