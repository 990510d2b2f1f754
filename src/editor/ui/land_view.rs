//! The picture of a wood or of ground: what is edited of it as lines and handles, and the pointer on it.

use bevy::math::Vec2;
use bevy_egui::egui::{
    Align2, Color32, FontId, Id, Painter, PointerButton, Pos2, Rect, Response, Sense, Shape, Stroke, Ui,
};

use super::{
    picture_keys::{PictureKeys, cross, middle},
    theme::palette,
};
use crate::editor::{
    land_pose::LandPose,
    plan_element::{Element, disc},
    scene_view::SceneView,
    stage::Stage,
    woods::{Tool, Woods},
};

/// How near the pointer has to be to a handle, points.
const REACH: f32 = 11.0;
const HANDLE_RADIUS: f32 = 5.0;
/// Handles of a line with more corners are not drawn: they would cover it.
const MOST_HANDLES: usize = 200;
/// Lines of more elements are not drawn.
const MOST_LINES: usize = 300;

/// What is drawn over pictures, in both themes.
const LINE: Color32 = Color32::from_rgb(250, 250, 245);
const KEPT_FREE: Color32 = Color32::from_rgb(120, 205, 255);
const CHOSEN: Color32 = Color32::from_rgb(255, 196, 60);
const SHADE: Color32 = Color32::from_black_alpha(150);

/// The pointer on the picture: it is the whole of it, under all panels.
pub fn pointer(ui: &Ui, picture: Rect) -> Response {
    ui.interact(picture, Id::new("windwood picture"), Sense::click_and_drag())
}

/// Turns, shifts and approaches. `is_free` says whether the main button turns, too.
pub fn move_view(ui: &Ui, response: &Response, pose: &mut LandPose, keys: &PictureKeys, is_free: bool) {
    if keys.is_shifted {
        pose.shift(keys.drag, response.rect.height());
    } else {
        pose.turn(keys.drag);
    }
    pose.approach(keys.wheel);
    let drag = from_egui(response.drag_delta().to_pos2());
    let is_shifted = ui.input(|input| input.modifiers.shift);
    if response.dragged_by(PointerButton::Middle)
        || (is_free && is_shifted && response.dragged_by(PointerButton::Primary))
    {
        pose.shift(drag, response.rect.height());
    } else if response.dragged_by(PointerButton::Secondary) || (is_free && response.dragged_by(PointerButton::Primary))
    {
        pose.turn(drag);
    }
    if response.hovered() {
        pose.approach(ui.input(|input| input.smooth_scroll_delta.y));
    }
}

/// Turns and approaches the trees of the turntable. `is_free` says whether the pointer turns.
pub fn move_stage(ui: &Ui, response: &Response, stage: &mut Stage, keys: &PictureKeys, is_free: bool) {
    let drag = if is_free { from_egui(response.drag_delta().to_pos2()) } else { Vec2::ZERO };
    stage.turn(drag + keys.drag);
    let wheel = if response.hovered() { ui.input(|input| input.smooth_scroll_delta.y) } else { 0.0 };
    stage.approach(wheel + keys.wheel);
}

/// Lines, handles and the brush of a wood; and what the pointer does with them. Returns whether the main button is free for the view.
pub fn wood_in_picture(ui: &Ui, response: &Response, view: &SceneView, keys: &PictureKeys, woods: &mut Woods) -> bool {
    if keys.has_focus {
        tool_by_keys(view, woods, middle(response), keys.is_space);
        cross(ui, response);
    } else if woods.is_held_by_keys {
        woods.release();
    }
    let pointed = response.interact_pointer_pos().or(response.hover_pos()).map(from_egui);
    let held = ui.input(|input| input.pointer.primary_down());
    if response.is_pointer_button_down_on()
        && held
        && !woods.is_held()
        && ui.input(|input| input.pointer.primary_pressed())
    {
        press(view, woods, pointed);
    } else if woods.is_held_by_keys {
        // The pointer has no part in it.
    } else if woods.is_held() && held {
        if let Some(place) = pointed.and_then(|at| view.place(at)) {
            woods.drag(place);
        }
    } else if !held {
        woods.release();
    }
    let painter = ui.painter().with_clip_rect(response.rect);
    draw_lines(&painter, view, woods);
    if woods.tool != Tool::Move && response.hovered() {
        draw_brush(&painter, view, woods, pointed);
    }
    woods.tool == Tool::Move && !woods.is_held()
}

/// Space puts the tool down in the middle of the picture, and lifts it again; meanwhile it goes where the view is moved to.
fn tool_by_keys(view: &SceneView, woods: &mut Woods, middle: Vec2, is_space: bool) {
    match (is_space, woods.is_held()) {
        (true, true) => woods.release(),
        (true, false) => {
            press(view, woods, Some(middle));
            woods.is_held_by_keys = woods.is_held();
        }
        (false, _) if woods.is_held_by_keys => view.place(middle).into_iter().for_each(|place| woods.drag(place)),
        (false, _) => {}
    }
}

fn press(view: &SceneView, woods: &mut Woods, pointed: Option<Vec2>) {
    let Some(at) = pointed else { return };
    if woods.tool == Tool::Move {
        if let Some((element, handle)) = handle_at(view, woods, at) {
            woods.take(element, handle);
        }
    } else if let Some(place) = view.place(at) {
        woods.press(place);
    }
}

/// The handle at a point of the screen: of what is chosen, or else of another element.
fn handle_at(view: &SceneView, woods: &Woods, at: Vec2) -> Option<(Element, usize)> {
    let plan = woods.plan();
    let nearest = |element: Element| {
        let handles = element.handles(plan).into_iter().enumerate();
        let distances = handles.filter_map(|(number, place)| {
            let distance = view.screen(view.on_ground(place))?.distance(at);
            (distance < REACH).then_some((distance, element, number))
        });
        distances.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let of_chosen = woods.chosen().and_then(nearest);
    let others = || Element::all(plan).take(MOST_LINES).filter_map(nearest).min_by(|a, b| a.0.total_cmp(&b.0));
    of_chosen.or_else(others).map(|(_, element, number)| (element, number))
}

fn draw_lines(painter: &Painter, view: &SceneView, woods: &Woods) {
    let plan = woods.plan();
    let chosen = woods.chosen();
    for element in Element::all(plan).take(MOST_LINES).filter(|element| Some(*element) != chosen) {
        let colour = if matches!(element, Element::Area(_)) { LINE } else { KEPT_FREE };
        line(painter, view, &element.outline(plan), 1.4, colour);
    }
    let Some(element) = chosen else { return };
    line(painter, view, &element.outline(plan), 2.6, CHOSEN);
    let handles = element.handles(plan);
    for (number, place) in handles.iter().enumerate().take(MOST_HANDLES) {
        let Some(at) = view.screen(view.on_ground(*place)) else { continue };
        let is_held = woods.corner == Some(number);
        handle(painter, at, if is_held { Color32::WHITE } else { CHOSEN });
    }
    // Beside a corner that is in sight, and away from the edge behind which it would be cut off.
    let inner = painter.clip_rect().shrink2(bevy_egui::egui::vec2(90.0, 24.0));
    let places = handles.iter().filter_map(|place| view.screen(view.on_ground(*place)));
    if let Some(at) = places.into_iter().find(|at| inner.contains(to_egui(*at))) {
        label(painter, at, &element.name(plan));
    }
}

fn line(painter: &Painter, view: &SceneView, (places, is_closed): &(Vec<Vec2>, bool), width: f32, colour: Color32) {
    for part in view.line(places, *is_closed) {
        let points: Vec<Pos2> = part.into_iter().map(to_egui).collect();
        painter.add(Shape::line(points.clone(), Stroke::new(width + 2.0, SHADE)));
        painter.add(Shape::line(points, Stroke::new(width, colour)));
    }
}

/// A handle that can be dragged.
pub fn handle(painter: &Painter, at: Vec2, colour: Color32) {
    painter.circle(to_egui(at), HANDLE_RADIUS, colour, Stroke::new(1.5, Color32::from_black_alpha(220)));
}

/// A word beside a handle.
pub fn label(painter: &Painter, at: Vec2, text: &str) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(12.5), LINE);
    let at = Align2::LEFT_CENTER.anchor_size(to_egui(at + Vec2::new(12.0, -12.0)), galley.size());
    painter.rect_filled(at.expand2(bevy_egui::egui::vec2(5.0, 2.0)), 3.0, SHADE);
    painter.galley(at.min, galley, LINE);
}

fn draw_brush(painter: &Painter, view: &SceneView, woods: &Woods, pointed: Option<Vec2>) {
    let Some(place) = pointed.and_then(|at| view.place(at)) else { return };
    let inner_m = woods.brush.radius_m * (1.0 - woods.brush.falloff);
    let colour = if woods.tool == Tool::KeepFree { KEPT_FREE } else { CHOSEN };
    line(painter, view, &(disc(place, woods.brush.radius_m), true), 1.6, colour);
    if woods.tool != Tool::KeepFree && inner_m > 0.5 {
        line(painter, view, &(disc(place, inner_m), true), 0.8, colour);
    }
}

/// Tells that there is nothing to be seen.
pub fn empty_picture(ui: &Ui, picture: Rect, text: &str) {
    let colour = palette(ui.visuals()).warning;
    ui.painter().text(picture.center(), Align2::CENTER_CENTER, text, FontId::proportional(14.0), colour);
}

pub fn from_egui(at: Pos2) -> Vec2 {
    Vec2::new(at.x, at.y)
}

pub fn to_egui(at: Vec2) -> Pos2 {
    Pos2::new(at.x, at.y)
}
