//! The control points of a spline ground in the picture, and the pointer on them.

use bevy::math::{Vec2, Vec3};
use bevy_egui::egui::{Color32, Response, Stroke, Ui};

use super::{
    land_view::{from_egui, handle, label, to_egui},
    picture_keys::{PictureKeys, cross, middle},
};
use crate::editor::{
    ground_desk::GroundDesk,
    scene_view::SceneView,
    spline_points::{ControlPoint, control_points},
};

/// How near the pointer has to be to a point, points of the screen.
const REACH: f32 = 12.0;
/// Points that are drawn, at most.
const MOST_POINTS: usize = 2000;

const POINT: Color32 = Color32::from_rgb(255, 196, 60);
const STEM: Color32 = Color32::from_rgba_premultiplied(120, 92, 28, 140);

/// Points and their stems; and what the pointer does with them. Returns whether the main button is free for the view.
pub fn spline_in_picture(
    ui: &Ui,
    response: &Response,
    view: &SceneView,
    keys: &PictureKeys,
    ground: &mut GroundDesk,
) -> bool {
    let pointed = response.interact_pointer_pos().or(response.hover_pos()).map(from_egui);
    let (is_down, is_pressed) = ui.input(|input| (input.pointer.primary_down(), input.pointer.primary_pressed()));
    let points = control_points(ground.spline.document());
    if keys.has_focus {
        cross(ui, response);
    }
    // Space chooses the point in the middle, whose height is a field of the panel then.
    if keys.is_space {
        ground.point = point_at(view, &points, middle(response)).or(ground.point);
    }
    if is_pressed && response.is_pointer_button_down_on() {
        if let Some(point) = pointed.and_then(|at| point_at(view, &points, at)) {
            ground.take(point);
        }
    } else if ground.is_held && is_down {
        let place = points.iter().find(|(point, _)| Some(*point) == ground.point).map(|(_, at)| Vec2::new(at.x, at.z));
        if let Some(height_m) = place.zip(pointed).and_then(|(place, at)| view.height_at(place, at)) {
            ground.raise_to(height_m.clamp(-1e5, 1e5));
        }
    } else if !is_down {
        ground.release();
    }
    draw(ui, response, view, ground, &points);
    !ground.is_held
}

fn point_at(view: &SceneView, points: &[(ControlPoint, Vec3)], at: Vec2) -> Option<ControlPoint> {
    let near = points.iter().filter_map(|(point, place)| {
        let distance = view.screen(*place)?.distance(at);
        (distance < REACH).then_some((distance, *point))
    });
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
}

fn draw(ui: &Ui, response: &Response, view: &SceneView, ground: &GroundDesk, points: &[(ControlPoint, Vec3)]) {
    let painter = ui.painter().with_clip_rect(response.rect);
    let surface = ground.spline_ground();
    for (point, at) in points.iter().take(MOST_POINTS) {
        let Some(head) = view.screen(*at) else { continue };
        // A point draws the surface towards itself; a stem leads to where the surface is.
        let foot_m = surface.as_ref().map_or(0.0, |ground| ground.height_m(Vec2::new(at.x, at.z).as_dvec2()) as f32);
        if let Some(foot) = view.screen(Vec3::new(at.x, foot_m, at.z)) {
            painter.line_segment([to_egui(head), to_egui(foot)], Stroke::new(2.0, STEM));
        }
        let is_chosen = ground.point == Some(*point);
        handle(&painter, head, if is_chosen { Color32::WHITE } else { POINT });
        if is_chosen {
            label(&painter, head, &format!("{:.1} m", at.y));
        }
    }
}
