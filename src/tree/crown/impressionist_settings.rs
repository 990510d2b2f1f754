//! The settings of an impressionist crown; see [`impressionist`](super::impressionist).

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use super::{clamped_scale, profile::Profile};
use crate::{
    setting::{SettingError, require},
    texture::linear,
    tree::{
        bounds::MOST_ENLARGED,
        foliage::CLUSTERS_LIMIT,
        growth::{
            envelope::{Envelope, EnvelopeShape},
            trunk::Trunk,
        },
    },
};

/// Most limbs of one crown.
pub const LIMBS_LIMIT: u32 = 48;
/// Most branches of a limb.
pub const BRANCHES_LIMIT: u32 = 12;

/// Styles of crowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum CrownForm {
    /// A broad-leaved tree in summer.
    #[default]
    Normal,
    /// The same in winter: polygons are sprays of bare twigs, rising from the branches.
    Winter,
    /// A conifer: boughs in tiers, polygons pointing outwards and down.
    Conifer,
}

/// Settings of an impressionist crown, after the menus of the paper. Lengths are those of a grown individual.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ImpressionistCrown {
    /// Its style.
    pub form: CrownForm,
    /// Height of the tree, m: 0.5 to 120.
    pub height_m: f32,
    /// Greatest diameter of the crown, m: 0.2 to 120.
    pub diameter_m: f32,
    /// Height of the crown as a share of the tree's, 0.1 to 1.
    pub crown_size: f32,
    /// Height of the widest point as a share of the crown's, 0 to 0.9: below it the ellipsoid is cut where the crown
    /// ends.
    pub widest_at: f32,
    /// How much the crown is drawn out to a point: 0 round to 1, a cone.
    pub tip_point: f32,
    /// Fullness of the outline, 1 to 6: 1 is straight from widest point to top, 2 an ellipse, more a box.
    pub curve: f32,
    /// Number of polygons before gaps, 1 to 16384.
    pub polygons: u32,
    /// Length of a polygon at the top of the crown, m: 0.02 to 10.
    pub least_size_m: f32,
    /// The same at the widest point, m: 0.02 to 10.
    pub greatest_size_m: f32,
    /// Width of all polygons as a share of their length, 0.05 to 2.
    pub width: f32,
    /// How ragged their edges are: 0 plain triangles, as the paper's, to 1.
    pub raggedness: f32,
    /// How far the texture displaces polygons towards the middle, as a share of the way, 0 to 0.9.
    pub roughness: f32,
    /// Billows of the texture across the crown, 0.2 to 32.
    pub distortion: f32,
    /// Share of polygons left out, the deepest first: 0 none, 1 all.
    pub gaps: f32,
    /// Mean angle between polygons and the level, degrees: 0 to 90.
    pub inclination_deg: f32,
    /// Greatest deviation from that mean (uniform), degrees: 0 to 45.
    pub inclination_spread_deg: f32,
    /// Greatest turn of a normal from the way out (uniform), degrees: 0 to 90.
    pub azimuth_spread_deg: f32,
    /// Hue of the foliage (of the twigs in winter), degrees: 0 red, 120 green, to 360.
    pub hue_deg: f32,
    /// Saturation, 0 to 1.
    pub saturation: f32,
    /// Brightness (value) of the deepest polygons, sRGB: 0 to the greatest.
    pub least_brightness: f32,
    /// Brightness of the outermost, sRGB: 0 to 1.
    pub greatest_brightness: f32,
    /// Distance up to which all polygons are drawn, m: 1 to 10000. Lower levels of detail have as many as belong to the distance at
    /// which they begin.
    pub full_detail_m: f32,
    /// Radius of the trunk, m: 0.01 to 5.
    pub trunk_radius_m: f32,
    /// Limbs inside the crown, which carry the polygons in the wind: 1 to 48.
    pub limbs: u32,
    /// Branches of each limb, 0 to 12.
    pub branches: u32,
}

impl Default for ImpressionistCrown {
    /// A broad-leaved tree in summer; inclination and azimuth are the paper's.
    fn default() -> Self {
        Self {
            form: CrownForm::Normal,
            height_m: 14.0,
            diameter_m: 11.0,
            crown_size: 0.84,
            widest_at: 0.42,
            tip_point: 0.1,
            curve: 2.2,
            polygons: 2000,
            least_size_m: 0.6,
            greatest_size_m: 1.3,
            width: 0.9,
            raggedness: 0.55,
            roughness: 0.45,
            distortion: 4.6,
            gaps: 0.12,
            inclination_deg: 40.0,
            inclination_spread_deg: 8.0,
            azimuth_spread_deg: 20.0,
            hue_deg: 88.0,
            saturation: 0.6,
            least_brightness: 0.14,
            greatest_brightness: 0.46,
            full_detail_m: 40.0,
            trunk_radius_m: 0.32,
            limbs: 14,
            branches: 0,
        }
    }
}

impl ImpressionistCrown {
    /// A crown of the given style with what suits it.
    #[must_use]
    pub fn of_form(form: CrownForm) -> Self {
        let summer = Self { form, ..Self::default() };
        match form {
            CrownForm::Normal => summer,
            CrownForm::Winter => Self {
                polygons: 1300,
                least_size_m: 0.8,
                greatest_size_m: 1.7,
                width: 0.75,
                gaps: 0.0,
                hue_deg: 25.0,
                saturation: 0.3,
                least_brightness: 0.22,
                greatest_brightness: 0.42,
                limbs: 18,
                branches: 8,
                ..summer
            },
            CrownForm::Conifer => Self {
                height_m: 18.0,
                diameter_m: 7.2,
                crown_size: 0.94,
                widest_at: 0.04,
                tip_point: 1.0,
                curve: 1.6,
                polygons: 2600,
                least_size_m: 0.25,
                greatest_size_m: 1.35,
                width: 0.8,
                distortion: 3.4,
                hue_deg: 128.0,
                saturation: 0.5,
                least_brightness: 0.1,
                greatest_brightness: 0.36,
                limbs: 24,
                ..summer
            },
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`SettingError`] for the first field outside its domain, NaN included.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("height_m", self.height_m, 0.5..=120.0)?;
        require("diameter_m", self.diameter_m, 0.2..=120.0)?;
        require("crown_size", self.crown_size, 0.1..=1.0)?;
        require("widest_at", self.widest_at, 0.0..=0.9)?;
        require("tip_point", self.tip_point, 0.0..=1.0)?;
        require("curve", self.curve, 1.0..=6.0)?;
        require("polygons", self.polygons as f32, 1.0..=CLUSTERS_LIMIT as f32)?;
        require("least_size_m", self.least_size_m, 0.02..=10.0)?;
        require("greatest_size_m", self.greatest_size_m, 0.02..=10.0)?;
        require("width", self.width, 0.05..=2.0)?;
        require("raggedness", self.raggedness, 0.0..=1.0)?;
        require("roughness", self.roughness, 0.0..=0.9)?;
        require("distortion", self.distortion, 0.2..=32.0)?;
        require("gaps", self.gaps, 0.0..=1.0)?;
        require("inclination_deg", self.inclination_deg, 0.0..=90.0)?;
        require("inclination_spread_deg", self.inclination_spread_deg, 0.0..=45.0)?;
        require("azimuth_spread_deg", self.azimuth_spread_deg, 0.0..=90.0)?;
        require("hue_deg", self.hue_deg, 0.0..=360.0)?;
        require("saturation", self.saturation, 0.0..=1.0)?;
        require("greatest_brightness", self.greatest_brightness, 0.0..=1.0)?;
        require("least_brightness", self.least_brightness, 0.0..=self.greatest_brightness)?;
        require("full_detail_m", self.full_detail_m, 1.0..=10_000.0)?;
        require("trunk_radius_m", self.trunk_radius_m, 0.01..=5.0)?;
        require("limbs", self.limbs as f32, 1.0..=LIMBS_LIMIT as f32)?;
        require("branches", self.branches as f32, 0.0..=BRANCHES_LIMIT as f32)
    }

    /// The same crown `scale` (0.02 to 50) times as large: younger, where less than 1.
    #[must_use]
    pub fn scaled(self, scale: f32) -> Self {
        let scale = clamped_scale(scale);
        Self {
            height_m: self.height_m * scale,
            diameter_m: self.diameter_m * scale,
            least_size_m: self.least_size_m * scale,
            greatest_size_m: self.greatest_size_m * scale,
            full_detail_m: self.full_detail_m * scale,
            trunk_radius_m: self.trunk_radius_m * scale,
            ..self
        }
    }

    /// Share of the polygons that are drawn from a distance, m: all near by, then as many as keep their number for each metre of the
    /// crown's width on the screen. They are enlarged, so that they cover as much, and the tree's bounds limit how far.
    #[must_use]
    pub fn polygon_share_at(&self, distance_m: f32) -> f32 {
        (self.full_detail_m / distance_m.max(self.full_detail_m)).clamp(MOST_ENLARGED.powi(-2), 1.0)
    }

    /// Light of polygons at a depth (0 outermost to 1) as a share of the outermost's, 0 to 1. Brightness runs linearly
    /// with depth as a value, which is sRGB; light is linear.
    #[must_use]
    pub fn light(&self, depth: f32) -> f32 {
        let value = self.greatest_brightness + depth * (self.least_brightness - self.greatest_brightness);
        let [own, outermost, _] = linear([value, self.greatest_brightness, 0.0]);
        if outermost > 0.0 { (own / outermost).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// The solid of the branching models that is most like this crown.
    #[must_use]
    pub fn envelope(&self) -> Envelope {
        let shape = if self.form == CrownForm::Conifer { EnvelopeShape::Cone } else { EnvelopeShape::Ellipsoid };
        let base_m = self.profile().base_m.min(0.95 * self.height_m);
        Envelope { shape, base_m, top_m: self.height_m, radius_m: 0.5 * self.diameter_m }
    }

    /// The trunk as the mesh of the wood wants it.
    #[must_use]
    pub fn trunk(&self) -> Trunk {
        Trunk { height_m: self.height_m, radius_m: self.trunk_radius_m, segments: 2, lean_deg: 0.0, ..Trunk::default() }
    }

    pub(super) fn profile(&self) -> Profile {
        Profile {
            base_m: self.height_m * (1.0 - self.crown_size),
            top_m: self.height_m,
            radius_m: 0.5 * self.diameter_m,
            widest_at: self.widest_at,
            tip_point: self.tip_point,
            curve: self.curve,
        }
    }
}
