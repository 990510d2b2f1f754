//! The wind in a stand of trees, by that of which a table holds the responses.
//!
//! A table's wind is that of the open country. At a tree that an open share `e` of it reaches, loads are
//!
//! ```text
//! mean  = e r^2 + (1 - e) U sqrt(U^2 + 8/pi s^2) / sqrt(1 + 8/pi I^2)
//! gusts = e r   + (1 - e) g sqrt(U^2 + 2/pi s^2) / sqrt(1 + 2/pi I^2)
//! ```
//!
//! of those of the table, with `r` the mean speed over open country at the load's height, `U` that far inside the stand, `s` and `I` the
//! standard deviations of gusts there and in the table, all by the table's mean speed, and `g = s / I`. The roots are the mean of `|u| u`, and
//! half of its derivative, of a normal `u`: exact where the mean is 0 and where it is large, as between trees gusts are as strong
//! as the mean wind.
//!
//! The air above a forest is slowed by it. At 50 m, or 2.5 heights of tall trees, the wind is as over the open country: the height to which
//! a stand of half a kilometre is felt. (Its internal boundary layer grows as `0.28 z0 (x / z0)^0.8`: Elliott 1958, Trans. Am. Geophys. Union
//! 39, 1048; in forests of many kilometres the wind is weaker yet.)
//!
//! The mean load is never above that over open country, nor is a peak, `mean + 1.5 gusts` in the measure above: the bounds of trees stand on that.
//! It takes up to a third of its gusts from a tree half as high again as its stand, and nothing from others.
//!
//! What is left out: gusts in a stand have the spectrum of the table's, and come as often from above as from below. In truth they are
//! sweeps: strong ones are more seldom.

use super::mean_wind::MeanWind;
use crate::wind::{CanopyProfile, PackedCanopy, SUBLAYER, VON_KARMAN};
use bevy::math::{FloatExt, Vec2, Vec3};

/// The wind is as over open country at this height, m, or above taller stands at so many of their heights.
pub(crate) const BLENDING_HEIGHT_M: f32 = 50.0;
pub(crate) const BLENDING_HEIGHTS: f32 = 2.5;
/// Standard deviation of gusts along the wind over `u*`: at the tops of a stand, and over open ground (`wind/spectrum.rs`).
pub(crate) const GUSTS_AT_TOPS: f32 = 1.9;
pub(crate) const GUSTS_IN_OPEN: f32 = 2.449_5;
/// Exponent with which gusts fall below the tops, by that of the mean wind.
pub(crate) const GUST_ATTENUATION: f32 = 0.7;
/// Gusts travel through a stand with this multiple of the mean speed at its tops (Raupach, Finnigan & Brunet 1996).
pub(crate) const CONVECTION: f32 = 1.8;
/// Factors of the variance of gusts in the mean load and in its derivative: 8/pi and 2/pi.
pub(crate) const MEAN_LOAD_VARIANCE: f32 = 2.546_479;
pub(crate) const GUST_LOAD_VARIANCE: f32 = 0.636_619_75;

/// How many times the mean load the greatest gusts add over open country: twice the intensity of 0.21 times 3.5 deviations.
pub(crate) const PEAK_GUSTS: f32 = 1.5;

/// The wind at one tree, which may stand in a stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandWind {
    open: MeanWind,
    /// Of the open wind, what share reaches the tree.
    exposure: f32,
    canopy: CanopyProfile,
    /// `u*` above the stand by the table's mean speed.
    friction: f32,
}

/// Mean speed and standard deviation of gusts along the wind, by the mean speed of the table's wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Mean speed.
    pub mean: f32,
    /// Standard deviation of gusts.
    pub gusts: f32,
}

/// The wind at two heights of a tree, m/s: between these its leaves feel it in proportion to their height.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WindAtTree {
    /// At the top.
    pub high: Vec3,
    /// At [`LOW_SHARE`] of the height.
    pub low: Vec3,
}

/// Where [`WindAtTree::low`] is, as a share of the height.
pub(crate) const LOW_SHARE: f32 = 0.4;
/// Nearer to the ground than this share of the height the wind is as it is there.
pub(crate) const LEAST_SHARE: f32 = 0.1;

impl WindAtTree {
    /// The wind at a share of the tree's height.
    pub(crate) fn at(&self, height_share: f32) -> Vec3 {
        let share = if height_share < 1.0 { height_share.max(LEAST_SHARE) } else { 1.0 };
        self.low.lerp(self.high, (share - LOW_SHARE) / (1.0 - LOW_SHARE))
    }
}

/// Loads at a height by those of the table's wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandLoads {
    /// The mean load.
    pub mean: f32,
    /// What a gust adds.
    pub gusts: f32,
    /// The speed with which gusts pass, by the table's mean speed.
    pub convection: f32,
}

impl StandWind {
    /// In the open.
    #[must_use]
    pub fn open(open: MeanWind) -> Self {
        Self::new(open, crate::wind::Canopy::OPEN, Vec2::X)
    }

    /// In a stand, with a wind that blows in a horizontal direction (x, z).
    #[must_use]
    pub(crate) fn new(open: MeanWind, canopy: PackedCanopy, direction: Vec2) -> Self {
        let exposure = canopy.exposure_to(direction);
        let canopy = canopy.profile();
        let blending_m = BLENDING_HEIGHT_M.max(BLENDING_HEIGHTS * canopy.height_m);
        let above_m = canopy.height_m * (1.0 - canopy.displacement_share);
        let log = VON_KARMAN * canopy.speed_by_friction - SUBLAYER
            + ((blending_m - canopy.displacement_share * canopy.height_m) / above_m.max(LEAST_DEPTH_M)).ln();
        let friction = VON_KARMAN * open.ratio(blending_m) / log.max(1.0);
        Self { open, exposure, canopy, friction }
    }

    /// Mean speed of the table's wind, m/s.
    #[must_use]
    pub fn table_speed_m_s(&self) -> f32 {
        self.open.speed_m_s
    }

    /// Friction velocity above the stand, by the mean speed of the table's wind.
    #[must_use]
    pub fn friction(&self) -> f32 {
        self.friction
    }

    /// The wind far inside the stand, at a height above ground.
    #[must_use]
    pub fn inside(&self, height_m: f32) -> Speeds {
        let CanopyProfile { height_m: top_m, speed_by_friction, attenuation, displacement_share } = self.canopy;
        let below = (1.0 - height_m / top_m.max(LEAST_DEPTH_M)).clamp(0.0, 1.0);
        let depth_m = (top_m * (1.0 - displacement_share)).max(LEAST_DEPTH_M);
        // Depths above the tops: 1 at the end of the sublayer.
        let above = ((height_m - top_m) / depth_m).max(0.0);
        let sublayer = above.min(1.0);
        let log = (1.0 + above).ln() / VON_KARMAN - SUBLAYER / VON_KARMAN * sublayer;
        Speeds {
            mean: self.friction * (speed_by_friction + log) * (-attenuation * below).exp(),
            gusts: self.friction
                * GUSTS_AT_TOPS.lerp(GUSTS_IN_OPEN, sublayer)
                * (-GUST_ATTENUATION * attenuation * below).exp(),
        }
    }

    /// The wind at the tree, at a height above ground.
    #[must_use]
    pub fn speeds(&self, height_m: f32) -> Speeds {
        let inside = self.inside(height_m);
        Speeds {
            mean: inside.mean.lerp(self.open.ratio(height_m), self.exposure),
            gusts: inside.gusts.lerp(self.open_gusts(), self.exposure),
        }
    }

    /// The velocity at a height, m/s in wind coordinates, where the table's wind has one.
    #[must_use]
    pub fn velocity(&self, height_m: f32, velocity: Vec3) -> Vec3 {
        let speeds = self.speeds(height_m);
        let mean = Vec3::X * self.open.speed_m_s;
        let local = mean * speeds.mean + (velocity - mean) * (speeds.gusts / self.open_gusts());
        if local.is_finite() { local } else { Vec3::ZERO }
    }

    /// Loads at a height above ground.
    #[must_use]
    pub(crate) fn loads(&self, height_m: f32) -> StandLoads {
        let height_m = if height_m > 0.0 { height_m.min(GREATEST_HEIGHT_M) } else { 0.0 };
        let ratio = self.open.ratio(height_m);
        let Speeds { mean, gusts } = self.inside(height_m);
        let intensity = self.open_gusts();
        let root = |share: f32, mean: f32, gusts: f32| (mean * mean + share * gusts * gusts).sqrt();
        let mean_load = mean * root(MEAN_LOAD_VARIANCE, mean, gusts) / root(MEAN_LOAD_VARIANCE, 1.0, intensity);
        let gust_load =
            gusts / intensity * root(GUST_LOAD_VARIANCE, mean, gusts) / root(GUST_LOAD_VARIANCE, 1.0, intensity);
        let mean_load = mean_load.min(ratio * ratio);
        let gust_load = gust_load.min(ratio + (ratio * ratio - mean_load) / PEAK_GUSTS);
        let convection = CONVECTION * self.friction * self.canopy.speed_by_friction;
        StandLoads {
            mean: mean_load.lerp(ratio * ratio, self.exposure),
            gusts: gust_load.lerp(ratio, self.exposure),
            convection: convection.lerp(ratio, self.exposure),
        }
    }

    /// Standard deviation of the table's gusts, by its mean speed.
    fn open_gusts(&self) -> f32 {
        GUSTS_IN_OPEN * VON_KARMAN * self.open.inverse_log
    }
}

/// Far above all trees, m.
const GREATEST_HEIGHT_M: f32 = 1e4;
/// Keeps quotients finite where there is no stand, m.
const LEAST_DEPTH_M: f32 = 0.01;

#[cfg(test)]
mod tests;
