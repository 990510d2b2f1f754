//! The camera that draws the panels, over whatever others draw to the same window or image.

use bevy::{
    camera::{CameraOutputMode, RenderTarget, visibility::RenderLayers},
    ecs::schedule::ScheduleLabel,
    prelude::*,
    render::{camera::CameraRenderGraph, render_resource::BlendState},
};
use bevy_egui::{EguiContexts, PrimaryEguiContext};

/// The camera of the panels.
#[derive(Component)]
pub(super) struct PanelCamera;

/// What is drawn for the camera of the panels: these alone. What Bevy does for any other camera costs as much as the panels themselves.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct DrawPanels;

/// How panels are laid over what others have drawn.
pub(super) const BLEND: BlendState = BlendState::ALPHA_BLENDING;
/// It draws after all others.
const ORDER: isize = 1000;
/// The window that panels are made for, points. In larger ones they grow by half as much as the window.
const MADE_FOR: Vec2 = Vec2::new(1280.0, 720.0);
const GROWTH: f32 = 0.5;
/// Steps of their size: letters are drawn anew for each.
const ZOOM_STEP: f32 = 0.25;

/// Spawns the camera when the workbench is opened for the first time.
pub(super) fn spawn_camera(
    mut commands: Commands,
    cameras: Query<(&RenderTarget, Option<&Msaa>), (With<Camera3d>, Without<PanelCamera>)>,
    panels: Query<(), With<PanelCamera>>,
) {
    let Some((target, msaa)) = cameras.iter().next().filter(|_| panels.is_empty()) else { return };
    commands.spawn((
        PanelCamera,
        PrimaryEguiContext,
        CameraRenderGraph::new(DrawPanels),
        Projection::Orthographic(OrthographicProjection::default_2d()),
        Camera {
            order: ORDER,
            output_mode: CameraOutputMode::Write { blend_state: Some(BLEND), clear_color: ClearColorConfig::None },
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
        target.clone(),
        msaa.copied().unwrap_or_default(),
        RenderLayers::none(),
    ));
}

/// Gives panels a size that suits the window.
pub(super) fn scale_panels(
    mut contexts: EguiContexts,
    panels: Query<&Camera, With<PanelCamera>>,
    mut zoom_before: Local<Option<f32>>,
) {
    let (Ok(camera), Ok(context)) = (panels.single(), contexts.ctx_mut()) else { return };
    let Some(size) = camera.physical_target_size() else { return };
    let native = camera.target_scaling_factor().unwrap_or(1.0);
    let zoom = zoom_for(size.as_vec2() / native);
    let before = zoom_before.replace(zoom);
    if before != Some(zoom) {
        // What a person has set by keys stays beside it.
        context.set_zoom_factor(context.zoom_factor() / before.unwrap_or(1.0) * zoom);
    }
}

fn zoom_for(size: Vec2) -> f32 {
    let larger = (size / MADE_FOR).min_element();
    let zoom = 1.0 + GROWTH * (larger - 1.0).max(0.0);
    if zoom.is_finite() { (zoom / ZOOM_STEP).floor() * ZOOM_STEP } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_grow_with_the_window() {
        let zooms = [(1280.0, 720.0), (640.0, 480.0), (1920.0, 1080.0), (3840.0, 2160.0), (3840.0, 720.0)];
        assert_eq!(zooms.map(|(width, height)| zoom_for(Vec2::new(width, height))), [1.0, 1.0, 1.25, 2.0, 1.0]);
    }
}
