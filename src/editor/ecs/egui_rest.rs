//! When egui rests: while the workbench is closed and nobody else draws with it. Its systems have nothing to do then, but to run them all the
//! same takes about half a percent of a forest's frame.

use super::{camera::PanelCamera, workbench::Workbench};
use bevy::{
    ecs::schedule::{IntoSystemSet, ScheduleCleanupPolicy, ScheduleError},
    input::touch::Touches,
    prelude::*,
    render::{Render, RenderApp, RenderSystems},
};
use bevy_egui::{
    EguiContext, EguiPostUpdateSet, EguiPreUpdateSet,
    render::{
        EguiViewTarget,
        systems::{
            prepare_egui_render_target_data_system, prepare_egui_transforms_system, queue_bind_groups_system,
            queue_pipelines_system,
        },
    },
};

/// Frames after the workbench is closed in which egui lays out that there are no panels, and gives back the pointer and the keyboard.
const CLOSING_FRAMES: u8 = 2;

/// What egui has to do while the workbench is closed.
#[derive(Resource, Default)]
pub(super) struct ClosedEgui {
    /// Whether it runs.
    is_awake: bool,
    /// Frames since the workbench was closed, up to [`CLOSING_FRAMES`].
    frames: u8,
}

/// Lets egui's systems run only where they are needed. For a plugin of egui that is ours: that of a game is the game's.
pub(super) struct EguiRestPlugin;

impl Plugin for EguiRestPlugin {
    fn build(&self, app: &mut App) {
        use {EguiPostUpdateSet as Post, EguiPreUpdateSet as Pre};
        app.init_resource::<ClosedEgui>()
            .add_systems(First, watch_closed_egui)
            .configure_sets(PreUpdate, (Pre::InitContexts, Pre::ProcessInput, Pre::BeginPass).run_if(is_needed))
            .configure_sets(
                PostUpdate,
                (Post::EndPass, Post::ProcessOutput, Post::PostProcessOutput).run_if(is_needed),
            );
    }

    // After egui's plugin has added the last of its systems.
    fn cleanup(&self, app: &mut App) {
        let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
        if let Err(error) = let_renderer_rest(render) {
            warn!("egui's renderer runs while the workbench is closed: {error}");
        }
    }
}

/// Has egui's renderer prepare something only where a camera shows it. Its systems are in no set of their own that could be told so, so they
/// are taken out and added again.
fn let_renderer_rest(render: &mut SubApp) -> Result<(), ScheduleError> {
    remove(render, prepare_egui_transforms_system)?;
    remove(render, prepare_egui_render_target_data_system)?;
    remove(render, queue_bind_groups_system)?;
    remove(render, queue_pipelines_system)?;
    let prepare = (prepare_egui_transforms_system, prepare_egui_render_target_data_system);
    let queue = (queue_bind_groups_system, queue_pipelines_system);
    render.add_systems(
        Render,
        (prepare.in_set(RenderSystems::Prepare), queue.in_set(RenderSystems::Queue))
            .run_if(any_with_component::<EguiViewTarget>),
    );
    Ok(())
}

fn remove<M>(render: &mut SubApp, system: impl IntoSystemSet<M>) -> Result<(), ScheduleError> {
    render.remove_systems_in_set(Render, system, ScheduleCleanupPolicy::RemoveSystemsOnly).map(drop)
}

/// Whether egui runs in this frame. A plugin that the game has added always does.
pub(super) fn is_needed(workbench: Res<Workbench>, closed: Option<Res<ClosedEgui>>) -> bool {
    workbench.is_open || closed.is_none_or(|closed| closed.is_awake)
}

/// Has egui rest once it has closed the panels and has seen the release of all that was held meanwhile: else it would take that for held when
/// they open again. Another interface that the game draws with the same plugin keeps it awake.
fn watch_closed_egui(
    workbench: Res<Workbench>,
    mut closed: ResMut<ClosedEgui>,
    others: Query<(), (With<EguiContext>, Without<PanelCamera>)>,
    keys: Option<Res<ButtonInput<KeyCode>>>,
    buttons: Option<Res<ButtonInput<MouseButton>>>,
    touches: Option<Res<Touches>>,
) {
    closed.frames = if workbench.is_open { 0 } else { (closed.frames + 1).min(CLOSING_FRAMES) };
    let is_held = keys.is_some_and(|keys| keys.get_pressed().len() > 0)
        || buttons.is_some_and(|buttons| buttons.get_pressed().len() > 0)
        || touches.is_some_and(|touches| touches.iter().next().is_some());
    let is_closing = closed.frames < CLOSING_FRAMES || (closed.is_awake && is_held);
    closed.is_awake = is_closing || !others.is_empty();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An app whose workbench is closed, and what was asked of egui since.
    fn app() -> App {
        let mut app = App::new();
        app.init_resource::<ButtonInput<KeyCode>>()
            .init_resource::<ClosedEgui>()
            .insert_resource(Workbench::new(None, None, None, false))
            .add_systems(First, watch_closed_egui);
        app
    }

    fn frame(app: &mut App) -> bool {
        app.update();
        app.world_mut().run_system_cached(is_needed).expect("it runs")
    }

    fn frames(app: &mut App) -> [bool; 4] {
        [(); 4].map(|()| frame(app))
    }

    fn set_open(app: &mut App, is_open: bool) {
        app.world_mut().resource_mut::<Workbench>().is_open = is_open;
    }

    #[test]
    fn egui_runs_while_the_workbench_is_open_and_until_its_panels_are_gone() {
        let mut app = app();
        assert_eq!(frames(&mut app), [true, false, false, false]);
        set_open(&mut app, true);
        assert!(app.world_mut().run_system_cached(is_needed).expect("it runs"), "in the very frame");
        assert_eq!(frames(&mut app), [true; 4]);
        set_open(&mut app, false);
        assert_eq!(frames(&mut app), [true, false, false, false]);
    }

    #[test]
    fn what_is_held_while_the_workbench_closes_is_seen_to_be_released() {
        let mut app = app();
        set_open(&mut app, true);
        app.world_mut().resource_mut::<ButtonInput<KeyCode>>().press(KeyCode::F2);
        frame(&mut app);
        set_open(&mut app, false);
        assert_eq!(frames(&mut app), [true; 4]);
        app.world_mut().resource_mut::<ButtonInput<KeyCode>>().release(KeyCode::F2);
        assert_eq!(frames(&mut app), [false; 4]);
        // What is pressed for the game later wakes nobody.
        app.world_mut().resource_mut::<ButtonInput<KeyCode>>().press(KeyCode::KeyW);
        assert_eq!(frames(&mut app), [false; 4]);
    }

    #[test]
    fn an_interface_of_the_game_keeps_egui_awake() {
        let mut app = app();
        frames(&mut app);
        let other = app.world_mut().spawn(EguiContext::default()).id();
        assert_eq!(frames(&mut app), [true; 4]);
        app.world_mut().despawn(other);
        assert_eq!(frames(&mut app), [false; 4]);
    }
}
