//! Draws the wind at every wind cell as an arrow.

use super::components::WindCell;
use bevy::{gizmos::GizmoPlugin, prelude::*};

/// Draws an arrow for every [`WindCell`] while [`WindGizmos::enabled`] is set. Without a gizmo renderer it does nothing.
pub struct WindGizmoPlugin;

/// Settings of the arrows.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct WindGizmos {
    /// Whether arrows are drawn.
    pub enabled: bool,
    /// Length of an arrow for a wind of 1 m/s, m.
    pub metres_per_m_s: f32,
    /// Colour of a calm.
    pub calm: Color,
    /// Colour of a wind of `full_speed_m_s` or more.
    pub strong: Color,
    /// Speed that has the full colour, m/s.
    pub full_speed_m_s: f32,
}

impl Default for WindGizmos {
    fn default() -> Self {
        Self {
            enabled: false,
            metres_per_m_s: 0.5,
            calm: Color::srgb(0.5, 0.8, 1.0),
            strong: Color::srgb(1.0, 0.3, 0.1),
            full_speed_m_s: 20.0,
        }
    }
}

impl Plugin for WindGizmoPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<WindGizmos>().init_resource::<WindGizmos>();
    }

    /// Whether there are gizmos is known only when all plugins have been added.
    fn finish(&self, app: &mut App) {
        if app.is_plugin_added::<GizmoPlugin>() {
            let draw = draw_arrows.after(TransformSystems::Propagate);
            app.add_systems(PostUpdate, draw.run_if(|settings: Res<WindGizmos>| settings.enabled));
        }
    }
}

fn draw_arrows(settings: Res<WindGizmos>, cells: Query<(&WindCell, &GlobalTransform)>, mut gizmos: Gizmos) {
    for (cell, place) in &cells {
        let start = place.translation();
        let strength = (cell.velocity.length() / settings.full_speed_m_s).clamp(0.0, 1.0);
        let colour = settings.calm.mix(&settings.strong, strength);
        gizmos.arrow(start, start + cell.velocity * settings.metres_per_m_s, colour);
    }
}
