//! What can be chosen about lower levels of detail, and the limits that keep every choice finite.

use crate::setting::{SettingError, require};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Most reductions of one tree.
const REDUCTIONS_LIMIT: usize = 8;

/// All lower levels of a tree.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevelSettings {
    /// Thinned meshes, from the finest to the coarsest: none to 8.
    pub reductions: Vec<Reduction>,
    /// The envelope of leaves.
    pub cylinder: CylinderSettings,
    /// The atlas of views.
    pub views: ViewSettings,
}

/// How the meshes of a tree are thinned.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Reduction {
    /// Branches whose root is thinner are left out, and all that grows on them; radius, m: 0 (none) to 10.
    pub least_radius_m: f32,
    /// Share of the sprays that stay, enlarged so that they have the area of all: 0.02 to 1.
    pub leaf_share: f32,
}

/// The envelope of leaves, its texture and the cone of the trunk.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CylinderSettings {
    /// Texels around the crown: a power of two, 8 to 1024.
    pub width_texels: u32,
    /// Texels along its height, in each image: a power of two, 8 to 1024.
    pub height_texels: u32,
    /// Images in the sequence of its sway: 1 (at rest) to 16.
    pub images: u32,
    /// Rays of a texel, each way: 1 to 8.
    pub rays: u32,
    /// Share of the crown that the envelope, while it is smooth, encloses: 0.5 to 1.
    pub enclosed: f32,
    /// Vertices around the envelope, 3 to 64.
    pub sides: u32,
    /// Stretches of the envelope from its base to its top, 2 to 64.
    pub stretches: u32,
    /// How far its vertices leave the smooth envelope at random, to both sides, as a share of the radius: 0 to 0.5.
    pub roughness: f32,
    /// Another seed is another roughness.
    pub seed: u64,
}

/// The atlas of views from the upper hemisphere.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ViewSettings {
    /// Views each way: a power of two, 2 to 32.
    pub across: u32,
    /// Longer side of a view, texels: a power of two, 16 to 512. Its outline has twice as many.
    pub view_texels: u32,
    /// Rays of a texel of the outline, each way: 1 to 4.
    pub rays: u32,
}

impl Default for LevelSettings {
    /// Two reductions, for trees of half and a quarter of a screen, before the envelope and the views.
    fn default() -> Self {
        Self {
            reductions: vec![
                Reduction { least_radius_m: 0.02, leaf_share: 0.5 },
                Reduction { least_radius_m: 0.05, leaf_share: 0.2 },
            ],
            cylinder: CylinderSettings::default(),
            views: ViewSettings::default(),
        }
    }
}

impl Default for Reduction {
    /// The full tree.
    fn default() -> Self {
        Self { least_radius_m: 0.0, leaf_share: 1.0 }
    }
}

impl Default for CylinderSettings {
    fn default() -> Self {
        Self {
            width_texels: 128,
            height_texels: 64,
            images: 4,
            rays: 2,
            enclosed: 0.95,
            sides: 12,
            stretches: 8,
            roughness: 0.08,
            seed: 0,
        }
    }
}

impl Default for ViewSettings {
    /// Views some 15 degrees apart.
    fn default() -> Self {
        Self { across: 8, view_texels: 64, rays: 1 }
    }
}

impl LevelSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        if self.reductions.len() > REDUCTIONS_LIMIT {
            let allowed = format!("at most {REDUCTIONS_LIMIT} long");
            return Err(SettingError::new("reductions", format!("{} long", self.reductions.len()), allowed));
        }
        for (index, reduction) in self.reductions.iter().enumerate() {
            reduction.validate().map_err(|error| error.inside(&format!("reductions[{index}]")))?;
        }
        self.cylinder.validate().map_err(|error| error.inside("cylinder"))?;
        self.views.validate().map_err(|error| error.inside("views"))
    }
}

impl Reduction {
    fn validate(&self) -> Result<(), SettingError> {
        require("least_radius_m", self.least_radius_m, 0.0..=10.0)?;
        require("leaf_share", self.leaf_share, 0.02..=1.0)
    }
}

impl CylinderSettings {
    fn validate(&self) -> Result<(), SettingError> {
        require_power_of_two("width_texels", self.width_texels, 8..=1024)?;
        require_power_of_two("height_texels", self.height_texels, 8..=1024)?;
        require("images", self.images as f32, 1.0..=16.0)?;
        require("rays", self.rays as f32, 1.0..=8.0)?;
        require("enclosed", self.enclosed, 0.5..=1.0)?;
        require("sides", self.sides as f32, 3.0..=64.0)?;
        require("stretches", self.stretches as f32, 2.0..=64.0)?;
        require("roughness", self.roughness, 0.0..=0.5)
    }
}

impl ViewSettings {
    fn validate(&self) -> Result<(), SettingError> {
        require_power_of_two("across", self.across, 2..=32)?;
        require_power_of_two("view_texels", self.view_texels, 16..=512)?;
        require("rays", self.rays as f32, 1.0..=4.0)
    }
}

fn require_power_of_two(field: &str, value: u32, allowed: RangeInclusive<u32>) -> Result<(), SettingError> {
    if allowed.contains(&value) && value.is_power_of_two() {
        return Ok(());
    }
    let allowed = format!("a power of two, {} to {}", allowed.start(), allowed.end());
    Err(SettingError::new(field, value, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_valid() {
        LevelSettings::default().validate().unwrap();
    }

    #[test]
    fn what_is_wrong_is_named_with_its_path() {
        let mut settings = LevelSettings::default();
        settings.views.view_texels = 100;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`views.view_texels` is 100, but must be a power of two, 16 to 512");
        settings.cylinder.enclosed = f32::NAN;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`cylinder.enclosed` is NaN, but must be 0.5 to 1");
        settings.cylinder.images = 17;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`cylinder.images` is 17, but must be 1 to 16");
        settings.cylinder.images = 0;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`cylinder.images` is 0, but must be 1 to 16");
        settings.reductions[1].leaf_share = 0.0;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`reductions[1].leaf_share` is 0, but must be 0.02 to 1");
        settings.reductions = vec![Reduction::default(); 9];
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`reductions` is 9 long, but must be at most 8 long");
    }

    #[test]
    fn settings_survive_writing_and_reading() {
        let settings = LevelSettings::default();
        let written = ron::to_string(&settings).unwrap();
        assert_eq!(ron::from_str::<LevelSettings>(&written).unwrap(), settings);
        assert_eq!(ron::from_str::<LevelSettings>("()").unwrap(), settings);
    }
}
