//! Looks after the file, keeps unsaved work, asks before the program ends, freezes what is seen.

use super::workbench::Workbench;
use crate::{forest::ForestCulling, viewpoint::Viewpoint};
use bevy::{prelude::*, time::common_conditions::on_real_timer, window::WindowCloseRequested};
use std::time::Duration;

/// Between two looks at the file.
const LOOK: Duration = Duration::from_secs(1);
/// Unsaved work is kept so often.
const KEEP: Duration = Duration::from_secs(10);

/// Adds the systems.
pub(super) fn plugin(app: &mut App) {
    app.add_systems(
        Update,
        (
            look_at_disk.run_if(is_open).run_if(on_real_timer(LOOK)),
            keep_work.run_if(on_real_timer(KEEP)),
            end_program,
            freeze.run_if(resource_exists::<ForestCulling>),
            toggle,
        ),
    );
}

/// Whether the panels are there.
pub(super) fn is_open(workbench: Res<Workbench>) -> bool {
    workbench.is_open
}

fn look_at_disk(mut workbench: ResMut<Workbench>) {
    workbench.bypass_change_detection().files().into_iter().for_each(|(_, files)| files.look_at_disk());
}

fn keep_work(mut workbench: ResMut<Workbench>) {
    workbench.bypass_change_detection().files().into_iter().for_each(|(_, files)| files.keep());
}

/// Ends the program once nothing would be lost by it. Where Bevy closes windows by itself it is not asked.
fn end_program(
    mut requests: MessageReader<WindowCloseRequested>,
    mut workbench: ResMut<Workbench>,
    mut exit: MessageWriter<AppExit>,
) {
    let workbench = workbench.bypass_change_detection();
    if requests.read().count() > 0 {
        workbench.is_open = true;
        workbench.is_quitting = true;
    }
    // An answer that lets the program end is about one file: the others are asked for theirs.
    if std::mem::take(&mut workbench.is_quitting) && workbench.may_quit() {
        exit.write(AppExit::Success);
    }
}

/// F2 opens and closes the workbench.
fn toggle(keys: Option<Res<ButtonInput<KeyCode>>>, mut workbench: ResMut<Workbench>) {
    if keys.is_some_and(|keys| keys.just_pressed(KeyCode::F2)) {
        workbench.is_open ^= true;
    }
}

/// A place that stands for the cameras while everything is frozen.
#[derive(Component)]
struct FrozenViewpoint;

/// Freezes levels, streaming and culling: the cameras give up their viewpoints, and one stays behind.
fn freeze(
    mut commands: Commands,
    workbench: Res<Workbench>,
    mut culling: ResMut<ForestCulling>,
    cameras: Query<(Entity, &GlobalTransform), (With<Camera3d>, With<Viewpoint>)>,
    blind: Query<Entity, (With<Camera3d>, Without<Viewpoint>)>,
    frozen: Query<Entity, With<FrozenViewpoint>>,
) {
    let is_frozen = !frozen.is_empty();
    if workbench.is_frozen == is_frozen {
        return;
    }
    culling.is_frozen = workbench.is_frozen;
    if workbench.is_frozen {
        for (camera, at) in &cameras {
            commands.spawn((FrozenViewpoint, Viewpoint, at.compute_transform()));
            commands.entity(camera).remove::<Viewpoint>();
        }
    } else {
        frozen.iter().for_each(|place| commands.entity(place).despawn());
        for camera in &blind {
            commands.entity(camera).insert(Viewpoint);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f2_opens_and_closes_it() {
        let mut app = App::new();
        app.init_resource::<ButtonInput<KeyCode>>()
            .insert_resource(Workbench::new(None, None, None, false))
            .add_systems(Update, toggle);
        for is_open in [true, false, true] {
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.reset_all();
            keys.press(KeyCode::F2);
            app.update();
            assert_eq!(app.world().resource::<Workbench>().is_open, is_open);
            // What is held is not pressed again.
            app.world_mut().resource_mut::<ButtonInput<KeyCode>>().clear();
            app.update();
            assert_eq!(app.world().resource::<Workbench>().is_open, is_open);
        }
    }
}
