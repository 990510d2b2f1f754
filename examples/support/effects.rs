//! What a camera adds to the picture: shade where things meet, a glow about what is bright, and in a window smooth edges over time.

use bevy::{
    anti_alias::taa::TemporalAntiAliasing,
    ecs::lifecycle::Add,
    pbr::{ScreenSpaceAmbientOcclusion, ScreenSpaceAmbientOcclusionQualityLevel},
    post_process::bloom::Bloom,
    prelude::*,
};

/// Things shade one another up to so far, m: as far as the branches of a crown lie apart.
const SHADE_M: f32 = 1.6;
/// Share of the light that the glow takes.
const GLOW: f32 = 0.06;

/// Gives the effects to every camera. Pictures that stand alone have no frames before them, from which edges could become smooth.
pub fn give_to_cameras(app: &mut App, is_in_window: bool) {
    app.add_observer(move |camera: On<Add<Camera3d>>, mut commands: Commands| {
        let shade = ScreenSpaceAmbientOcclusion {
            quality_level: ScreenSpaceAmbientOcclusionQualityLevel::Medium,
            radius: SHADE_M,
            ..default()
        };
        let mut camera = commands.entity(camera.entity);
        camera.insert((Msaa::Off, shade, Bloom { intensity: GLOW, ..Bloom::NATURAL }));
        if is_in_window {
            camera.insert(TemporalAntiAliasing::default());
        }
    });
}
