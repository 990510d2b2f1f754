//! A wood that is edited: its plan, what is chosen of it, and the tool in hand.

mod mask_file;

use std::sync::Arc;

use bevy::math::Vec2;

use super::{
    brush::{Brush, Stroke},
    fields::Section,
    plan_document::area_table,
    plan_element::{Element, as_mask, as_polygon, new_area, rounded},
    session::Session,
    steps::Steps,
};
use crate::scatter::{
    ForestPlan,
    plan::{Area, KeepOut, Place, Shape},
};

/// Between the points of a path that is drawn, as a share of the brush's radius, and at least, m.
const PATH_STEP: f32 = 0.6;
const LEAST_PATH_STEP_M: f32 = 1.0;

/// What a drag in the picture does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Drags corners.
    #[default]
    Move,
    /// Adds density to the chosen area's mask.
    Thicken,
    /// Takes density away.
    Thin,
    /// Keeps free what it passes: a path as wide as the brush.
    KeepFree,
}

impl Tool {
    /// All of them, with their names and what they do.
    pub const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::Move, "Move", "Drag corners; elsewhere, turn the view"),
        (Self::Thicken, "Thicken", "Paint density into the chosen area, which has to be a mask"),
        (Self::Thin, "Thin", "Take density away from the chosen area, which has to be a mask"),
        (Self::KeepFree, "Keep free", "Draw a path on which nothing grows; a click makes a clearing"),
    ];
}

/// What the pointer holds.
#[derive(Clone, Debug, PartialEq)]
enum Grip {
    Handle(Element, usize),
    Stroke(usize, Stroke),
    /// The plan before, and the points of the path.
    Path(Box<ForestPlan>, Vec<Place>),
}

/// A wood that is edited.
pub struct Woods {
    pub session: Session<ForestPlan>,
    pub chosen: Option<Element>,
    /// The corner of the chosen element that was held last.
    pub corner: Option<usize>,
    pub tool: Tool,
    pub brush: Brush,
    /// Where the chosen area's mask is saved and loaded, as it was typed.
    pub mask_path: String,
    /// Why it was not.
    pub mask_error: Option<String>,
    grip: Option<Grip>,
    /// Whether it is held without a pointer.
    pub is_held_by_keys: bool,
    table: Option<(Element, f32, Area, Arc<Section>)>,
}

impl Woods {
    pub fn new(session: Session<ForestPlan>) -> Self {
        let chosen = Element::all(session.document()).next();
        Self {
            session,
            chosen,
            corner: None,
            tool: Tool::default(),
            brush: Brush::default(),
            mask_path: String::new(),
            mask_error: None,
            grip: None,
            is_held_by_keys: false,
            table: None,
        }
    }

    pub fn plan(&self) -> &ForestPlan {
        self.session.document()
    }

    /// What is chosen; nothing that undoing has taken away.
    pub fn chosen(&self) -> Option<Element> {
        self.chosen.filter(|element| element.exists(self.plan()))
    }

    pub fn choose(&mut self, element: Element) {
        if self.chosen != Some(element) {
            (self.chosen, self.corner) = (Some(element), None);
            self.mask_error = None;
        }
    }

    /// The table of the chosen area's fields; of the last one that was valid, if it is not.
    pub fn area_table(&mut self) -> Option<Arc<Section>> {
        let element = self.chosen()?;
        let Element::Area(number) = element else { return None };
        let plan = self.session.document();
        // The outline has no fields: a drag of a corner leaves the table.
        let area = Area { shape: Shape::default(), ..plan.areas[number].clone() };
        let is_known = self
            .table
            .as_ref()
            .is_some_and(|(of, cell_m, known, _)| (*of, *cell_m, known) == (element, plan.cell_m, &area));
        let is_same_area = self.table.as_ref().is_some_and(|(of, ..)| *of == element);
        if !is_known && (plan.validate().is_ok() || !is_same_area) {
            let table = area_table(plan, number)?;
            self.table = Some((element, plan.cell_m, area, table.into()));
        }
        self.table.as_ref().map(|(.., table)| table.clone())
    }

    /// The chosen area's mask can be painted.
    pub fn can_paint(&self) -> bool {
        self.chosen_area().is_some_and(|number| matches!(self.plan().areas[number].shape, Shape::Mask { .. }))
    }

    fn chosen_area(&self) -> Option<usize> {
        match self.chosen()? {
            Element::Area(number) => Some(number),
            Element::KeepOut(_) => None,
        }
    }

    /// Takes hold of a handle.
    pub fn take(&mut self, element: Element, handle: usize) {
        self.choose(element);
        self.corner = Some(handle);
        self.grip = Some(Grip::Handle(element, handle));
    }

    /// Puts the tool down at a place (x, z), m. Returns whether it does anything there.
    pub fn press(&mut self, place: Vec2) -> bool {
        self.grip = match self.tool {
            Tool::Move => None,
            Tool::Thicken | Tool::Thin => self.chosen_area().and_then(|number| {
                let stroke = Stroke::begin(&self.plan().areas[number].shape)?;
                Some(Grip::Stroke(number, stroke))
            }),
            Tool::KeepFree => Some(Grip::Path(Box::new(self.plan().clone()), Vec::new())),
        };
        self.drag(place);
        self.grip.is_some()
    }

    /// Whether something is held.
    pub fn is_held(&self) -> bool {
        self.grip.is_some()
    }

    /// Moves what is held to a place (x, z), m.
    pub fn drag(&mut self, place: Vec2) {
        let brush = self.painting_brush();
        match &mut self.grip {
            None => {}
            Some(Grip::Handle(element, handle)) => {
                if let Some(plan) = element.with_handle_at(self.session.document(), *handle, place) {
                    self.session.change(plan, "Move a corner");
                }
            }
            Some(Grip::Stroke(number, stroke)) => {
                stroke.move_to(&brush, place);
                let mut plan = self.session.document().clone();
                plan.areas[*number].shape = stroke.shape();
                self.session.change(plan, "Paint density");
            }
            Some(Grip::Path(before, points)) => {
                let step_m = (PATH_STEP * brush.radius_m).max(LEAST_PATH_STEP_M);
                if points.last().is_some_and(|last| place.distance(Vec2::from(*last)) < step_m) {
                    return;
                }
                points.push(rounded(place).into());
                let mut plan = (**before).clone();
                plan.keep_out.push(free_of(points, brush.radius_m));
                self.chosen = Some(Element::KeepOut(plan.keep_out.len() - 1));
                self.session.change(plan, "Keep free");
            }
        }
    }

    /// Lets go.
    pub fn release(&mut self) {
        self.is_held_by_keys = false;
        if self.grip.take().is_some() {
            self.session.end_gesture();
        }
    }

    fn painting_brush(&self) -> Brush {
        let strength = self.brush.strength.abs();
        Brush { strength: if self.tool == Tool::Thin { -strength } else { strength }, ..self.brush }
    }
}

/// Changes by buttons: each is a step.
impl Woods {
    fn step(&mut self, plan: ForestPlan, step: &str) {
        self.session.change(plan, step);
        self.session.end_gesture();
    }

    /// One more area, of a hectare about a place (x, z), m.
    pub fn add_area(&mut self, place: Vec2) {
        let mut plan = self.plan().clone();
        plan.areas.push(new_area(&plan, place));
        let added = Element::Area(plan.areas.len() - 1);
        self.step(plan, "Add an area");
        self.choose(added);
    }

    /// Takes the chosen element away.
    pub fn remove_chosen(&mut self) {
        let Some(element) = self.chosen() else { return };
        self.step(element.removed(self.plan()), "Remove");
        self.chosen = Element::all(self.plan()).next();
    }

    /// One more corner, in the middle of the edge behind the corner that was held last.
    pub fn add_corner(&mut self) {
        let Some(element) = self.chosen() else { return };
        let handles = element.handles(self.plan());
        let Some(from) = handles.get(self.corner.unwrap_or(0)) else { return };
        let next = handles[(self.corner.unwrap_or(0) + 1) % handles.len()];
        if let Some((plan, corner)) = element.with_corner_near(self.plan(), 0.5 * (*from + next)) {
            self.step(plan, "Add a corner");
            self.corner = Some(corner);
        }
    }

    /// Takes the corner away that was held last.
    pub fn remove_corner(&mut self) {
        let Some((element, corner)) = self.chosen().zip(self.corner) else { return };
        if let Some(plan) = element.without_corner(self.plan(), corner) {
            self.step(plan, "Remove a corner");
            self.corner = None;
        }
    }

    /// Makes the chosen area's outline a mask, or a polygon.
    pub fn convert(&mut self, is_to_mask: bool) {
        let Some(number) = self.chosen_area() else { return };
        let mut plan = self.plan().clone();
        let shape = &mut plan.areas[number].shape;
        // Only a valid outline can be asked which ground it covers.
        let is_valid = self.plan().validate().is_ok();
        let converted = if is_to_mask { as_mask(shape).filter(|_| is_valid) } else { as_polygon(shape) };
        let Some(converted) = converted else { return };
        *shape = converted;
        self.corner = None;
        self.step(plan, if is_to_mask { "Make it a mask" } else { "Make it a polygon" });
    }
}

/// What a stroke keeps free: a path, or a clearing where it has not moved.
fn free_of(points: &[Place], radius_m: f32) -> KeepOut {
    let radius_m = rounded(Vec2::X * radius_m).x.max(0.1);
    match points {
        [only] => KeepOut::Disc { centre_m: *only, radius_m },
        _ => KeepOut::Path { points_m: points.to_vec(), width_m: 2.0 * radius_m },
    }
}

#[cfg(test)]
mod tests;
