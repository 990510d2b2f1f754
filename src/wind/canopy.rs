//! A stand of trees as the wind feels it: how high and dense it is, and how open to each side.
//!
//! Far inside a stand of height `h` whose trees show the wind the frontal area `lambda` by ground area, the mean wind is that of
//! Raupach (1994, Boundary-Layer Meteorol. 71, 211) above the tops, and falls exponentially below them (Cionco 1965, J. Appl.
//! Meteorol. 4, 517):
//!
//! ```text
//! d / h   = 1 - (1 - exp(-s)) / s,                     s = sqrt(2 * 7.5 lambda)
//! u*/ U_h = min(sqrt(0.003 + 0.3 lambda), 0.3)
//! U(z)    = u*/kappa (ln((z - d) / (h - d)) + kappa U_h / u* - psi(z))    above h
//! U(z)    = U_h exp(-a (1 - z / h)),   a = (u* / U_h) / (kappa c_w (1 - d / h))    below
//! ```
//!
//! `a` makes the gradient at the tops the same on both sides, with `c_w = 2`. The roughness sublayer, in which the tops mix the
//! air better than the logarithmic law says, reaches as far above the tops as these are above `d`: there `psi` grows from 0 to
//! 0.193 (Raupach's `Psi_h`; its growth with height is taken as linear, a choice).
//!
//! Gusts, as standard deviations: `1.9 u*` at the tops, within the 1.7 to 2.2 of many canopies, and `2.45 u*` above the sublayer as over open
//! ground (Raupach, Finnigan & Brunet 1996, Boundary-Layer Meteorol. 78, 351; Finnigan 2000, Annu. Rev. Fluid Mech. 32, 519). Below
//! they fall by the exponent `0.7 a`: more slowly than the mean wind, so that the air is the gustier the lower. The share of
//! 0.7 is fitted to those measurements.
//!
//! Into a stand the open wind reaches as far as the drag of its trees lets it: behind a path `s` through drag of the density
//! `c_d lambda_h = 2 c_d lambda / h`, a share `exp(-int c_d lambda_h ds)` of its difference to the wind far inside is left. That is the
//! length `L_c = 1 / (c_d lambda_h)` of Belcher, Jerram & Hunt (2003, J. Fluid Mech. 488, 369), with `c_d = 0.25` (Katul et al. 2004). In a
//! clearing the wind comes back within some ten heights: [`UpwindPath`].

use super::profile::VON_KARMAN;
use bevy::{
    math::{FloatExt, Vec2},
    reflect::Reflect,
};
use std::f32::consts::TAU;

/// Directions in which a canopy knows its exposure: every 45 degrees.
pub const EXPOSURE_DIRECTIONS: usize = 8;

/// `Psi_h` of Raupach 1994: `ln c_w - 1 + 1 / c_w` for a `c_w` of 2.
pub(crate) const SUBLAYER: f32 = 0.193;
/// `c_w`.
const SUBLAYER_DEPTH: f32 = 2.0;
/// `2 c_d1` of Raupach 1994: of the displacement height.
const DISPLACEMENT_DRAG: f32 = 15.0;
/// `C_S` and `C_R` of Raupach 1994, and the greatest `u*/U_h`.
const GROUND_DRAG: f32 = 0.003;
const TREE_DRAG: f32 = 0.3;
const MOST_FRICTION: f32 = 0.3;
/// Drag coefficient `c_d` of plant area.
const PLANT_DRAG: f32 = 0.25;
/// Below this frontal area index trees stand in the open and not in a stand: chosen.
const SPARSE: f32 = 0.05;
/// Heights of a stand after which the wind has come back behind it: to 1 - 1/e in five, 90% in some twelve (Gash 1986 and others
/// found ten).
const RECOVERY_HEIGHTS: f32 = 5.0;

/// The greatest values that are packed.
const MOST_HEIGHT_M: f32 = 127.5;
const MOST_SPEED_BY_FRICTION: f32 = 20.0;
const MOST_ATTENUATION: f32 = 5.0;

/// The stand about a tree, as the wind feels it.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub struct Canopy {
    /// Height of the trees about, the larger ones counting for more. units: m, domain: \[0, 127.5\]; 0 for none.
    pub height_m: f32,
    /// Frontal area of the trees by ground area; half the leaf area index of a closed stand. domain: \[0, 10\]; 0 for none.
    pub frontal_area_index: f32,
    /// How open the tree is to winds that blow towards x, then 45 degrees on towards z, and so on: 1 as in the open, 0 as far inside
    /// the stand. domain: \[0, 1\].
    pub exposure: [f32; EXPOSURE_DIRECTIONS],
}

impl Default for Canopy {
    /// Open country.
    fn default() -> Self {
        Self { height_m: 0.0, frontal_area_index: 0.0, exposure: [1.0; EXPOSURE_DIRECTIONS] }
    }
}

/// The horizontal direction (x, z) of an exposure's number.
pub(crate) fn exposure_direction(number: usize) -> Vec2 {
    Vec2::from_angle(TAU * number as f32 / EXPOSURE_DIRECTIONS as f32)
}

impl Canopy {
    /// Open country, in the form in which shaders read canopies.
    pub(crate) const OPEN: PackedCanopy = PackedCanopy { profile: 0, exposure: u32::MAX };

    /// The same in 64 bits.
    #[must_use]
    pub(crate) fn pack(&self) -> PackedCanopy {
        let profile = CanopyProfile::of_stand(self.height_m, self.frontal_area_index);
        let byte = |value: f32, most: f32| u32::from((value / most * 255.0).round() as u8);
        // Few trees are no stand.
        let closure = 1.0 - (-self.frontal_area_index.max(0.0) / SPARSE).exp();
        let closure = if self.height_m > 0.0 { closure } else { 0.0 };
        let exposure = self.exposure.iter().rev().fold(0, |word, &exposure| {
            let open = 1.0 - closure * (1.0 - if exposure < 1.0 { exposure.max(0.0) } else { 1.0 });
            let open = if open.is_finite() { open } else { 1.0 };
            word << 4 | (open * 15.0).round() as u32
        });
        PackedCanopy {
            profile: byte(profile.height_m, MOST_HEIGHT_M)
                | byte(profile.speed_by_friction, MOST_SPEED_BY_FRICTION) << 8
                | byte(profile.attenuation, MOST_ATTENUATION) << 16
                | byte(profile.displacement_share, 1.0) << 24,
            exposure,
        }
    }
}

/// A [`Canopy`] in the form in which shaders read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PackedCanopy {
    /// Four bytes: height, `U_h/u*`, `a`, `d/h`, as shares of the greatest that they may be.
    pub profile: u32,
    /// Eight times four bits: how open it is.
    pub exposure: u32,
}

impl PackedCanopy {
    pub(crate) fn profile(self) -> CanopyProfile {
        let [height, speed, attenuation, displacement] = self.profile.to_le_bytes().map(|byte| f32::from(byte) / 255.0);
        CanopyProfile {
            height_m: height * MOST_HEIGHT_M,
            speed_by_friction: speed * MOST_SPEED_BY_FRICTION,
            attenuation: attenuation * MOST_ATTENUATION,
            displacement_share: displacement,
        }
    }

    /// How open it is to a wind that blows in a horizontal direction (x, z): between the two next directions that are known.
    pub(crate) fn exposure_to(self, direction: Vec2) -> f32 {
        let place = direction.to_angle() / TAU * EXPOSURE_DIRECTIONS as f32;
        let place = if place < 0.0 { place + EXPOSURE_DIRECTIONS as f32 } else { place };
        let number = place as usize;
        let open = |number: usize| (self.exposure >> (4 * (number % EXPOSURE_DIRECTIONS)) & 15) as f32 / 15.0;
        open(number).lerp(open(number + 1), place - number as f32)
    }
}

/// The mean wind far inside a stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CanopyProfile {
    /// Of the tops, m.
    pub height_m: f32,
    /// `U_h / u*`.
    pub speed_by_friction: f32,
    /// `a`.
    pub attenuation: f32,
    /// `d / h`, below 1.
    pub displacement_share: f32,
}

impl CanopyProfile {
    /// Of a stand of some height and frontal area index.
    pub(crate) fn of_stand(height_m: f32, frontal_area_index: f32) -> Self {
        let index = if frontal_area_index > 0.0 { frontal_area_index.min(10.0) } else { 0.0 };
        let s = (DISPLACEMENT_DRAG * index).sqrt().max(1e-3);
        let displacement_share = 1.0 - (1.0 - (-s).exp()) / s;
        let friction = (GROUND_DRAG + TREE_DRAG * index).sqrt().min(MOST_FRICTION);
        Self {
            height_m: if height_m > 0.0 { height_m.min(MOST_HEIGHT_M) } else { 0.0 },
            speed_by_friction: 1.0 / friction,
            attenuation: (friction / (VON_KARMAN * SUBLAYER_DEPTH * (1.0 - displacement_share))).min(MOST_ATTENUATION),
            displacement_share,
        }
    }
}

/// How open a place is to the wind along a path that comes from upwind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UpwindPath {
    exposure: f32,
}

impl UpwindPath {
    /// Begins in the open.
    pub(crate) fn from_open() -> Self {
        Self { exposure: 1.0 }
    }

    /// Goes on for `length_m` through a stand, or where `frontal_area_index` is 0 through the open behind one of that height.
    pub(crate) fn pass(&mut self, length_m: f32, height_m: f32, frontal_area_index: f32) {
        if height_m <= 0.0 {
            return;
        }
        // How dense it is decides how much is lost, and how much comes back.
        let lost = 2.0 * PLANT_DRAG * frontal_area_index / height_m;
        let gained = (-frontal_area_index / SPARSE).exp() / (RECOVERY_HEIGHTS * height_m);
        // The exact solution of e' = gained (1 - e) - lost e over the length.
        let rate = lost + gained;
        if rate > 0.0 {
            let rest = gained / rate;
            self.exposure = rest + (self.exposure - rest) * (-rate * length_m).exp();
        }
    }

    pub(crate) fn exposure(self) -> f32 {
        self.exposure
    }
}

#[cfg(test)]
mod tests;
