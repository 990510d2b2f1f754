//! By what trees are lit.

use super::material::SwayExtension;
use bevy::{
    pbr::{ExtendedMaterial, MaterialExtension},
    prelude::*,
};
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

/// What the shaders of trees are made for: they hold no code for lights that there are not.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct TreeLights {
    lighting: TreeLighting,
    /// Whether a sun throws shadows; told only under [`TreeLighting::SunOnly`].
    shadows: bool,
}

impl TreeLights {
    /// The names that `render/shaders/lighting.wesl` asks for.
    pub(crate) fn names(self) -> &'static [&'static str] {
        match self {
            Self { lighting: TreeLighting::AllLights, .. } => &[],
            Self { shadows: false, .. } => &["WINDWOOD_SUN_ONLY"],
            Self { shadows: true, .. } => &["WINDWOOD_SUN_ONLY", "WINDWOOD_SHADOWS"],
        }
    }
}

/// Finds out which lights there are.
pub(super) fn find_lights(lighting: Res<TreeLighting>, suns: Query<&DirectionalLight>, mut lights: ResMut<TreeLights>) {
    let shadows = *lighting == TreeLighting::SunOnly && suns.iter().any(|sun| sun.shadow_maps_enabled);
    lights.set_if_neq(TreeLights { lighting: *lighting, shadows });
}

/// A material that is lit as trees are.
pub(crate) trait LitAsTrees: MaterialExtension {
    /// The lights that it is made for.
    fn lights_mut(&mut self) -> &mut TreeLights;
}

impl LitAsTrees for SwayExtension {
    fn lights_mut(&mut self) -> &mut TreeLights {
        &mut self.lights
    }
}

/// Lights what is there by other lights.
pub(crate) fn relight<E: LitAsTrees>(
    lights: Res<TreeLights>,
    mut materials: ResMut<Assets<ExtendedMaterial<StandardMaterial, E>>>,
) {
    for (_, material) in materials.iter_mut() {
        *material.extension.lights_mut() = *lights;
    }
}
