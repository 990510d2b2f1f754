//! The studio while a wood or ground is shown: no floor, and a wider sky.

use bevy::prelude::*;
use bevy_windwood::editor::Workbench;

/// How much wider the sky is then.
const WIDER: f32 = 30.0;

/// A part of the studio.
#[derive(Component, Clone, Copy, PartialEq, Eq)]
enum StudioPart {
    Floor,
    Sky,
}

/// Has the studio follow the panel.
pub fn plugin(app: &mut App) {
    app.add_systems(PostStartup, mark_parts).add_systems(Update, follow_panel);
}

/// The floor is a disc that was laid flat; the sky stands as it was made.
fn mark_parts(mut commands: Commands, parts: Query<(Entity, &Transform), With<Mesh3d>>) {
    for (part, at) in &parts {
        let kind = if at.rotation == Quat::IDENTITY { StudioPart::Sky } else { StudioPart::Floor };
        commands.entity(part).insert(kind);
    }
}

fn follow_panel(workbench: Res<Workbench>, mut parts: Query<(&StudioPart, &mut Visibility, &mut Transform)>) {
    let is_of_land = workbench.panel.is_of_land();
    for (part, mut visibility, mut transform) in &mut parts {
        match part {
            StudioPart::Floor => {
                let wanted = if is_of_land { Visibility::Hidden } else { Visibility::Inherited };
                visibility.set_if_neq(wanted);
            }
            StudioPart::Sky => {
                let wanted = Vec3::splat(if is_of_land { WIDER } else { 1.0 });
                if transform.scale != wanted {
                    transform.scale = wanted;
                }
            }
        }
    }
}
