//! The picture without a pointer: with the focus on it, keys turn, shift and approach, and put the tool down in its middle.

use bevy::math::Vec2;
use bevy_egui::egui::{Color32, EventFilter, Key, Response, Stroke, StrokeKind, Ui, WidgetInfo, WidgetType, vec2};

/// What one press of an arrow drags, and what one of a page key is of the wheel, points.
const DRAG: f32 = 24.0;
const WHEEL: f32 = 60.0;
/// What the cross in the middle is drawn with, in both themes: half its size, points.
const CROSS: f32 = 9.0;
const LINE: Color32 = Color32::from_rgb(250, 250, 245);
const SHADE: Color32 = Color32::from_black_alpha(150);

/// What keys do to the picture in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureKeys {
    /// As a drag by so many points.
    pub drag: Vec2,
    /// Whether Shift is held: the drag shifts the view.
    pub is_shifted: bool,
    /// As so many points of the wheel.
    pub wheel: f32,
    /// Whether Space was pressed.
    pub is_space: bool,
    /// Whether the picture has the focus.
    pub has_focus: bool,
}

/// Reads the keys, if the picture has the focus, and shows that it has. `hint` tells screen readers what it is.
pub fn picture_keys(ui: &Ui, response: &Response, hint: &str) -> PictureKeys {
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, hint));
    if !response.has_focus() {
        return PictureKeys::default();
    }
    let filter = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let frame = response.rect.shrink(2.0);
    ui.painter().rect_stroke(frame, 2.0, Stroke::new(4.0, SHADE), StrokeKind::Inside);
    ui.painter().rect_stroke(frame.shrink(1.0), 2.0, Stroke::new(2.0, LINE), StrokeKind::Inside);
    ui.input(|input| {
        let presses = |key: Key| input.num_presses(key) as f32;
        let axis = |less: Key, more: Key| presses(more) - presses(less);
        PictureKeys {
            drag: DRAG * Vec2::new(axis(Key::ArrowRight, Key::ArrowLeft), axis(Key::ArrowDown, Key::ArrowUp)),
            is_shifted: input.modifiers.shift,
            wheel: WHEEL * axis(Key::PageDown, Key::PageUp),
            is_space: input.key_pressed(Key::Space),
            has_focus: true,
        }
    })
}

/// A cross in the middle of the picture, where the tool is put down.
pub fn cross(ui: &Ui, response: &Response) {
    let middle = response.rect.center();
    for (width, colour) in [(4.0, SHADE), (2.0, LINE)] {
        let line = |a, b| ui.painter().line_segment([middle + a, middle + b], Stroke::new(width, colour));
        line(vec2(-CROSS, 0.0), vec2(CROSS, 0.0));
        line(vec2(0.0, -CROSS), vec2(0.0, CROSS));
    }
}

/// The middle of the picture, points.
pub fn middle(response: &Response) -> Vec2 {
    let at = response.rect.center();
    Vec2::new(at.x, at.y)
}
