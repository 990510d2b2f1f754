//! Lets egui rest while the workbench is closed: its systems would take some hundredths of a small frame.

use super::workbench::Workbench;
use bevy::prelude::*;
use bevy_egui::{EguiPostUpdateSet, EguiPreUpdateSet};

/// Whether egui runs in this frame. It is decided once a frame, because a pass that is begun has to be ended.
#[derive(Resource, Default)]
struct EguiFrames {
    runs: bool,
    was_open: bool,
}

/// To be added where the workbench alone has panels of egui.
pub(super) fn plugin(app: &mut App) {
    app.init_resource::<EguiFrames>().add_systems(First, decide);
    for set in [EguiPreUpdateSet::InitContexts, EguiPreUpdateSet::ProcessInput, EguiPreUpdateSet::BeginPass] {
        app.configure_sets(PreUpdate, set.run_if(runs));
    }
    for set in [EguiPostUpdateSet::EndPass, EguiPostUpdateSet::ProcessOutput, EguiPostUpdateSet::PostProcessOutput] {
        app.configure_sets(PostUpdate, set.run_if(runs));
    }
}

/// After it was closed it runs for a frame more, in which it lets go of the pointer and the keyboard.
fn decide(workbench: Res<Workbench>, mut frames: ResMut<EguiFrames>) {
    frames.runs = workbench.is_open || frames.was_open;
    frames.was_open = workbench.is_open;
}

fn runs(frames: Res<EguiFrames>) -> bool {
    frames.runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_that_is_begun_is_ended_and_an_empty_one_follows() {
        #[derive(Resource, Default)]
        struct Passes([u32; 2]);
        let mut app = App::new();
        app.insert_resource(Workbench::new(None, None, None, false))
            .init_resource::<Passes>()
            .add_plugins(plugin)
            .add_systems(PreUpdate, (|mut passes: ResMut<Passes>| passes.0[0] += 1).in_set(EguiPreUpdateSet::BeginPass))
            .add_systems(
                PostUpdate,
                (|mut passes: ResMut<Passes>| passes.0[1] += 1).in_set(EguiPostUpdateSet::EndPass),
            );
        // It is opened and closed while frames go on, as by a key.
        let toggle = |mut workbench: ResMut<Workbench>, mut frame: Local<u32>| {
            workbench.is_open = (2..5).contains(&*frame);
            *frame += 1;
        };
        app.add_systems(Update, toggle);
        let passes: Vec<[u32; 2]> = (0..9)
            .map(|_| {
                app.update();
                app.world().resource::<Passes>().0
            })
            .collect();
        // Opened in frame 2 and closed in frame 5: there are passes from frame 3 to frame 6.
        assert_eq!(passes, [0, 0, 0, 1, 2, 3, 4, 4, 4].map(|passes| [passes; 2]));
    }
}
