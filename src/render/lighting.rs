//! Which lights trees are lit by.

use bevy::{
    pbr::{ExtendedMaterial, MaterialExtension},
    prelude::*,
};
use serde::{Deserialize, Serialize};

/// Which lights trees and their impostors are lit by. It may be changed at any time.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Resource, Default)]
pub enum TreeLighting {
    /// All that Bevy knows.
    #[default]
    AllLights,
    /// Directional lights, with their shadows, and the ambient light: no point lights, no spot lights, no environment maps.
    /// In such light trees look as they do under all lights. A software renderer runs every branch of a shader, so it is several
    /// times as fast; a GPU gains a little.
    SunOnly,
}

/// What the shaders of trees are compiled for: they have no code for lights that there are not.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct TreeLights {
    lighting: TreeLighting,
    /// Whether a sun has shadows; looked up only under [`TreeLighting::SunOnly`].
    shadows: bool,
}

impl TreeLights {
    /// The flags of `render/shaders/lighting.wesl`.
    pub(crate) fn flags(self) -> &'static [&'static str] {
        match self {
            Self { lighting: TreeLighting::AllLights, .. } => &[],
            Self { shadows: false, .. } => &["WINDWOOD_SUN_ONLY"],
            Self { shadows: true, .. } => &["WINDWOOD_SUN_ONLY", "WINDWOOD_SHADOWS"],
        }
    }
}

/// Finds out which lights there are.
pub(crate) fn find_lights(lighting: Res<TreeLighting>, suns: Query<&DirectionalLight>, mut lights: ResMut<TreeLights>) {
    let shadows = *lighting == TreeLighting::SunOnly && suns.iter().any(|sun| sun.shadow_maps_enabled);
    lights.set_if_neq(TreeLights { lighting: *lighting, shadows });
}

/// A material that is lit as trees are.
pub(crate) trait LitAsTrees: MaterialExtension {
    /// The lights that it is compiled for.
    fn lights_mut(&mut self) -> &mut TreeLights;
}

/// Compiles the shaders of materials for other lights.
pub(crate) fn update_material_lights<E: LitAsTrees>(
    lights: Res<TreeLights>,
    mut materials: ResMut<Assets<ExtendedMaterial<StandardMaterial, E>>>,
) {
    for (_, material) in materials.iter_mut() {
        *material.extension.lights_mut() = *lights;
    }
}
