//! Which lights trees are lit by.

use super::capabilities::RenderCapabilities;
use bevy::{
    light::{AtmosphereEnvironmentMapLight, GeneratedEnvironmentMapLight, LightProbe},
    pbr::{ContactShadows, ExtendedMaterial, MaterialExtension},
    prelude::*,
};
use serde::{Deserialize, Serialize};

/// Which lights trees and their impostors are lit by. It may be changed at any time.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Resource, Default)]
pub enum TreeLighting {
    /// All that Bevy knows. On a software renderer shaders are compiled as under [`SunOnly`](Self::SunOnly) for as long as the app has no
    /// other light, which changes no picture.
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

/// What trees are lit by beside suns and the ambient light.
type OtherLight = Or<(
    With<PointLight>,
    With<SpotLight>,
    With<RectLight>,
    With<LightProbe>,
    With<EnvironmentMapLight>,
    With<GeneratedEnvironmentMapLight>,
    With<AtmosphereEnvironmentMapLight>,
    With<ContactShadows>,
)>;

/// Finds out which lights there are. A GPU has the shaders of all of them at once: it gains little by fewer, and while it compiled others,
/// when the first lamp is lit, there would be no trees.
pub(crate) fn find_lights(
    lighting: Res<TreeLighting>,
    capabilities: Res<RenderCapabilities>,
    suns: Query<&DirectionalLight>,
    others: Query<(), OtherLight>,
    mut lights: ResMut<TreeLights>,
) {
    let lighting = if capabilities.is_software && others.is_empty() { TreeLighting::SunOnly } else { *lighting };
    let shadows = lighting == TreeLighting::SunOnly && suns.iter().any(|sun| sun.shadow_maps_enabled);
    lights.set_if_neq(TreeLights { lighting, shadows });
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
