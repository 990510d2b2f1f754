//! When panels are laid out anew: egui's layout of all of them is dear, and from most frames to the next nothing in them changes.
//!
//! They are laid out when there is input, when egui asks for it (as while something fades in, or where a cursor blinks), when a program has
//! changed the workbench, when the picture under handles moves, and some times a second for what changes by itself: counts, plots, progress.
//! In between their camera rests, and the picture of what was painted last is shown (`panel_picture.rs`).

use super::{camera::PanelCamera, egui_rest::is_needed, workbench::Workbench};
use bevy::{camera::RenderTarget, prelude::*};
use bevy_egui::{
    EguiContextSettings, EguiFullOutput, EguiInput, EguiOutput, EguiPostUpdateSet, EguiPreUpdateSet,
    egui::{FullOutput, PlatformOutput, Rect, ViewportId},
};
use std::time::Duration;

/// What changes by itself is shown so often: a number that changes faster cannot be read.
const REFRESH: Duration = Duration::from_millis(200);

/// The layout of the panels.
#[derive(Resource, Default)]
struct PanelLayout {
    /// What egui told the window after the last layout.
    told: PlatformOutput,
    /// The clock at the next layout, if nothing else asks for one.
    next: Duration,
    /// The window and the picture under the panels as they were laid out for them.
    screen: Option<Rect>,
    picture: Mat4,
}

/// Adds the systems.
pub(super) fn plugin(app: &mut App) {
    app.init_resource::<PanelLayout>()
        .add_systems(
            PreUpdate,
            decide.after(EguiPreUpdateSet::ProcessInput).before(EguiPreUpdateSet::BeginPass).run_if(is_needed),
        )
        .add_systems(
            PostUpdate,
            keep_output.after(EguiPostUpdateSet::EndPass).before(EguiPostUpdateSet::ProcessOutput).run_if(is_needed),
        );
}

/// Decides whether the panels are laid out and drawn in this frame. While the workbench is closed they are laid out for input alone, which
/// egui must not miss. Where nobody else draws to their window, they are in every frame.
fn decide(
    time: Res<Time<Real>>,
    workbench: Res<Workbench>,
    mut layout: ResMut<PanelLayout>,
    mut panels: Query<(&mut Camera, &RenderTarget, &mut EguiContextSettings, &EguiInput), With<PanelCamera>>,
    others: Query<(&Camera, &RenderTarget), Without<PanelCamera>>,
) {
    let Ok((mut camera, target, mut settings, input)) = panels.single_mut() else { return };
    let has_input = !input.events.is_empty() || !input.hovered_files.is_empty() || !input.dropped_files.is_empty();
    let has_handles = workbench.has_turntable || workbench.panel.is_of_land();
    let picture = workbench.land.view.as_ref().filter(|_| has_handles);
    let picture = picture.map_or(Mat4::IDENTITY, |view| view.clip_from_world);
    let has_moved = workbench.is_open && (picture != layout.picture || input.screen_rect != layout.screen);
    let is_alone = !others.iter().any(|(other, drawn_to)| other.is_active && is_same(drawn_to, target));
    let is_waiting = has_input || workbench.is_changed() || has_moved || time.elapsed() >= layout.next;
    let is_due = is_waiting || (is_alone && workbench.is_open);
    if is_due {
        (layout.picture, layout.screen) = (picture, input.screen_rect);
    }
    if settings.run_manually == is_due {
        settings.run_manually = !is_due;
    }
    let is_drawn = is_due && workbench.is_open;
    if camera.is_active != is_drawn {
        camera.is_active = is_drawn;
    }
}

/// Whether two cameras draw to the same. There is one primary window.
fn is_same(one: &RenderTarget, other: &RenderTarget) -> bool {
    let primary = Some(Entity::PLACEHOLDER);
    one.normalize(primary) == other.normalize(primary)
}

/// Keeps what egui tells after a layout; without one, has it tell the same.
fn keep_output(
    time: Res<Time<Real>>,
    workbench: Res<Workbench>,
    mut layout: ResMut<PanelLayout>,
    mut panels: Query<(&EguiContextSettings, &EguiOutput, &mut EguiFullOutput), With<PanelCamera>>,
) {
    let Ok((settings, known, mut output)) = panels.single_mut() else { return };
    if settings.run_manually {
        output.0 = Some(FullOutput {
            platform_output: layout.told.clone(),
            pixels_per_point: known.pixels_per_point,
            ..FullOutput::default()
        });
    } else if let Some(output) = &output.0 {
        let asked = output.viewport_output.get(&ViewportId::ROOT).map_or(Duration::MAX, |root| root.repaint_delay);
        let refresh = if workbench.is_open { REFRESH } else { Duration::MAX };
        layout.next = time.elapsed().saturating_add(asked.min(refresh));
        // What happened once is not told again. What screen readers know is: else Bevy would tell them of its own interface in between.
        layout.told = PlatformOutput { commands: Vec::new(), events: Vec::new(), ..output.platform_output.clone() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use bevy_egui::egui::{Event, Pos2};

    const FRAME: Duration = Duration::from_millis(10);

    /// An app in which a frame takes 10 ms, and egui's part is played by `frame`.
    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, plugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(FRAME))
            .insert_resource(Workbench::new(None, None, None, false));
        app.world_mut().resource_mut::<Workbench>().is_open = true;
        app.world_mut().spawn(Camera::default());
        app.world_mut().spawn((
            PanelCamera,
            Camera::default(),
            EguiContextSettings::default(),
            EguiInput::default(),
            EguiOutput::default(),
            EguiFullOutput::default(),
        ));
        app
    }

    /// A frame, and whether panels were laid out in it. If they were, egui asks to be called again after `delay`.
    fn frame(app: &mut App, delay: Duration) -> bool {
        let world = app.world_mut();
        world.run_schedule(First);
        world.run_schedule(PreUpdate);
        let is_open = world.resource::<Workbench>().is_open;
        let mut panels = world.query::<(&Camera, &EguiContextSettings, &mut EguiInput, &mut EguiFullOutput)>();
        let (camera, settings, mut input, mut output) = panels.single_mut(world).expect("a camera");
        let is_laid_out = !settings.run_manually;
        assert_eq!(camera.is_active, is_laid_out && is_open);
        if is_laid_out {
            input.take();
            let mut laid_out = FullOutput::default();
            laid_out.viewport_output.entry(ViewportId::ROOT).or_insert_with(viewport).repaint_delay = delay;
            output.0 = Some(laid_out);
        }
        world.run_system_cached(keep_output).expect("it runs");
        let output = world.query::<&EguiFullOutput>().single(world).expect("a camera");
        assert!(output.0.is_some(), "egui always takes something");
        is_laid_out
    }

    fn viewport() -> bevy_egui::egui::ViewportOutput {
        bevy_egui::egui::Context::default()
            .run_ui(default(), |_| ())
            .viewport_output
            .remove(&ViewportId::ROOT)
            .expect("the root")
    }

    fn layouts(app: &mut App, frames: usize) -> usize {
        (0..frames).filter(|_| frame(app, Duration::MAX)).count()
    }

    #[test]
    fn panels_are_laid_out_five_times_a_second() {
        let mut app = app();
        assert!(frame(&mut app, Duration::MAX));
        assert_eq!(layouts(&mut app, 200), 10);
    }

    #[test]
    fn input_and_what_egui_asks_for_and_a_changed_workbench_are_not_waited_for() {
        let mut app = app();
        layouts(&mut app, 5);
        assert!(!frame(&mut app, Duration::MAX));
        let world = app.world_mut();
        let mut inputs = world.query::<&mut EguiInput>();
        inputs.single_mut(world).expect("a camera").events.push(Event::PointerMoved(Pos2::ZERO));
        // Asks at once, and then after 30 ms.
        assert!(frame(&mut app, Duration::ZERO) && frame(&mut app, 3 * FRAME));
        assert_eq!([(); 3].map(|()| frame(&mut app, Duration::MAX)), [false, false, true]);
        assert!(!frame(&mut app, Duration::MAX));
        app.world_mut().resource_mut::<Workbench>().panel = crate::editor::ui::Panel::Wind;
        assert!(frame(&mut app, Duration::MAX));
    }

    #[test]
    fn panels_that_nobody_else_draws_beneath_are_drawn_in_every_frame() {
        let mut app = app();
        layouts(&mut app, 5);
        let world = app.world_mut();
        let mut others = world.query_filtered::<&mut Camera, Without<PanelCamera>>();
        others.single_mut(world).expect("another camera").is_active = false;
        assert_eq!(layouts(&mut app, 20), 20);
    }

    #[test]
    fn closed_panels_are_laid_out_for_input_alone() {
        let mut app = app();
        layouts(&mut app, 5);
        app.world_mut().resource_mut::<Workbench>().is_open = false;
        // Now they are gone.
        assert!(frame(&mut app, Duration::MAX));
        assert_eq!(layouts(&mut app, 100), 0);
        let world = app.world_mut();
        let mut inputs = world.query::<&mut EguiInput>();
        inputs.single_mut(world).expect("a camera").events.push(Event::PointerGone);
        assert_eq!(layouts(&mut app, 10), 1);
    }
}
