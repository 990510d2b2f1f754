//! The envelope of the crown over the picture of the tree, and the pointer on its handles.

use bevy::math::{Vec2, Vec3};
use bevy_egui::egui::{Color32, Pos2, Response, Shape, Stroke, Ui};

use super::land_view::{from_egui, handle, label, to_egui};
use crate::{
    editor::{
        envelope_handles::{EnvelopeHandle, envelope_of, handles, outline, with_handle_at},
        scene_view::SceneView,
        session::Session,
        stage::{Arrangement, Stage},
    },
    tree::Species,
};

/// How near the pointer has to be to a handle, points.
const REACH: f32 = 12.0;
const LINE: Color32 = Color32::from_rgb(255, 196, 60);
const SHADE: Color32 = Color32::from_black_alpha(110);

/// Draws the envelope, and drags what the pointer holds. Returns whether the main button is free for the view.
pub fn envelope_in_picture(
    ui: &Ui,
    response: &Response,
    view: &SceneView,
    stage: &Stage,
    held: &mut Option<EnvelopeHandle>,
    session: &mut Session<Species>,
) -> bool {
    // Of a row nobody could tell whose it is.
    let is_alone = stage.arrangement == Arrangement::One && !stage.compares;
    let envelope = envelope_of(session.document(), stage.age_share).filter(|_| stage.shows_envelope && is_alone);
    let Some(envelope) = envelope else {
        *held = None;
        return true;
    };
    // Its outline is seen in the plane through the trunk that faces the eye.
    let towards = Vec3::new(view.eye.x, 0.0, view.eye.z).normalize_or(Vec3::Z);
    let side = Vec3::Y.cross(towards);
    let pointed = response.interact_pointer_pos().or(response.hover_pos()).map(from_egui);
    let (is_down, is_pressed) = ui.input(|input| (input.pointer.primary_down(), input.pointer.primary_pressed()));
    if is_pressed && response.is_pointer_button_down_on() {
        let near = handles(&envelope, side).into_iter().filter_map(|(handle, at)| {
            let distance = view.screen(at)?.distance(pointed?);
            (distance < REACH).then_some((distance, handle))
        });
        *held = near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, handle)| handle);
    } else if !is_down {
        *held = None;
    }
    if let Some((handle, at)) = held.zip(pointed)
        && let Some(to_m) = dragged_to_m(view, towards, side, handle, at)
        && let Some(changed) = with_handle_at(session.document(), stage.age_share, handle, to_m)
    {
        session.change(changed, "Envelope");
    }
    draw(ui, response, view, &envelope, side, *held);
    held.is_none()
}

/// The height, or the distance from the trunk, m, that a point of the screen shows.
fn dragged_to_m(view: &SceneView, towards: Vec3, side: Vec3, handle: EnvelopeHandle, at: Vec2) -> Option<f32> {
    if handle != EnvelopeHandle::Radius {
        return view.height_at(Vec2::ZERO, at);
    }
    let direction = view.direction(at);
    let way_m = -view.eye.dot(towards) / direction.dot(towards);
    let radius_m = (view.eye + way_m * direction).dot(side);
    (way_m > 0.0 && radius_m.is_finite()).then(|| radius_m.max(0.0))
}

fn draw(
    ui: &Ui,
    response: &Response,
    view: &SceneView,
    envelope: &crate::tree::growth::envelope::Envelope,
    side: Vec3,
    held: Option<EnvelopeHandle>,
) {
    let painter = ui.painter().with_clip_rect(response.rect);
    for side in [side, -side] {
        let points: Vec<Pos2> =
            outline(envelope, side).into_iter().filter_map(|at| view.screen(at)).map(to_egui).collect();
        painter.add(Shape::line(points.clone(), Stroke::new(3.6, SHADE)));
        painter.add(Shape::line(points, Stroke::new(1.6, LINE)));
    }
    for (which, at) in handles(envelope, side) {
        let Some(on_screen) = view.screen(at) else { continue };
        let is_held = held == Some(which);
        handle(&painter, on_screen, if is_held { Color32::WHITE } else { LINE });
        if is_held {
            let size_m = if which == EnvelopeHandle::Radius { envelope.radius_m } else { at.y };
            label(&painter, on_screen, &format!("{size_m:.1} m"));
        }
    }
}
