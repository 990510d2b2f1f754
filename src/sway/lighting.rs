//! By what trees are lit.

use super::material::SwayMaterial;
use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// Which lights trees and their cards are lit by. It may be changed at any time.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Resource, Default)]
pub enum TreeLighting {
    /// All that Bevy knows.
    #[default]
    AllLights,
    /// Directional lights, with their shadows, and the ambient light: no point lights, no spot lights, no environment maps.
    /// In such light trees look as they do under all lights. A processor that draws is some times as fast, as it runs every
    /// branch of a shader; other machines gain a little.
    SunOnly,
}

impl TreeLighting {
    /// The names that `sway/shaders/light.wgsl` asks for.
    pub(crate) fn names(self) -> &'static [&'static str] {
        match self {
            Self::AllLights => &[],
            Self::SunOnly => &["WINDWOOD_SUN_ONLY"],
        }
    }
}

/// Lights what is there by other lights.
pub(super) fn relight(lighting: Res<TreeLighting>, mut materials: ResMut<Assets<SwayMaterial>>) {
    for (_, material) in materials.iter_mut() {
        material.extension.lighting = *lighting;
    }
}
