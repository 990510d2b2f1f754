//! The panel of a wood: its plan, the tools, and the fields of what is chosen.

use bevy::math::Vec2;
use bevy_egui::egui::{Align, Button, CollapsingHeader, ComboBox, DragValue, Layout, ScrollArea, TextEdit, Ui, vec2};

use super::{
    dialogs::Dialog,
    file_bar::{file_buttons, undo_buttons, warnings},
    rows::Rows,
    session_rows::session_rows,
    theme::{ROW, palette},
    value_rows::{labelled, slider},
};
use crate::{
    editor::{
        fields::{Row, Section},
        land_pose::LandPose,
        plan_element::Element,
        woods::{Tool, Woods},
    },
    scatter::{
        ForestPlan,
        plan::{KeepOut, Shape},
    },
};

/// Draws the panel.
pub fn woods_panel(ui: &mut Ui, woods: &mut Woods, pose: &mut LandPose, dialog: &mut Option<Dialog>) {
    file_buttons(ui, &mut woods.session, dialog);
    ui.horizontal(|ui| {
        undo_buttons(ui, &mut woods.session);
        if ui.button("Show all").on_hover_text("Look at the whole plan").clicked() {
            let plan = woods.plan();
            pose.show(Element::all(plan).flat_map(|element| element.handles(plan)).collect::<Vec<_>>());
        }
    });
    warnings(ui, &mut woods.session, "forest");
    tools(ui, woods);
    chosen(ui, woods, pose.middle);
    ui.separator();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| fields(ui, woods));
}

fn tools(ui: &mut Ui, woods: &mut Woods) {
    ui.horizontal(|ui| {
        for (tool, name, hint) in Tool::ALL {
            if ui.selectable_label(woods.tool == tool, name).on_hover_text(hint).clicked() {
                woods.tool = tool;
            }
        }
    });
    if woods.tool == Tool::Move {
        return;
    }
    let brush = &mut woods.brush;
    slider(ui, ("Brush", "Radius of the brush"), &mut brush.radius_m, 1.0..=200.0, " m");
    if woods.tool == Tool::KeepFree {
        return;
    }
    slider(ui, ("Strength", "What one dab adds or takes, of the full density"), &mut brush.strength, 0.05..=1.0, "");
    let falloff = ("Falloff", "Share of the radius over which the strength falls to nothing");
    slider(ui, falloff, &mut brush.falloff, 0.0..=1.0, "");
    if !woods.can_paint() {
        ui.weak("Choose an area that is a mask, or make it one.");
    }
}

/// Which element is chosen, and what can be done with its outline.
fn chosen(ui: &mut Ui, woods: &mut Woods, middle: Vec2) {
    let names: Vec<(Element, String)> =
        Element::all(woods.plan()).map(|element| (element, element.name(woods.plan()))).collect();
    let now = woods.chosen().map_or_else(|| "nothing".to_owned(), |element| element.name(woods.plan()));
    labelled(ui, "Chosen", "What is edited below; its corners can be dragged", |ui, named| {
        let combo = ComboBox::from_id_salt("element").selected_text(now).width(ui.available_width());
        let shown = combo.show_ui(ui, |ui| {
            for (element, name) in &names {
                if ui.selectable_label(woods.chosen() == Some(*element), name).clicked() {
                    woods.choose(*element);
                }
            }
        });
        shown.response.labelled_by(named.id);
    });
    let shape = match woods.chosen() {
        Some(Element::Area(number)) => woods.plan().areas.get(number).map(|area| area.shape.clone()),
        _ => None,
    };
    ui.horizontal(|ui| {
        if ui.button("New area").on_hover_text("A hectare in the middle of the view").clicked() {
            woods.add_area(middle);
        }
        if ui.add_enabled(woods.chosen().is_some(), Button::new("Remove")).clicked() {
            woods.remove_chosen();
        }
        let is_polygon = matches!(shape, Some(Shape::Polygon { .. }));
        let to_mask = Button::new("To mask");
        if ui.add_enabled(shape.is_some() && woods.chosen().is_some() && !woods.can_paint(), to_mask).clicked() {
            woods.convert(true);
        }
        if ui.add_enabled(shape.is_some() && !is_polygon, Button::new("To polygon")).clicked() {
            woods.convert(false);
        }
    });
    mask_file(ui, woods);
    corner(ui, woods);
}

/// The picture that the chosen area's mask is saved to and loaded from, and why it was not.
fn mask_file(ui: &mut Ui, woods: &mut Woods) {
    let Some(Element::Area(_)) = woods.chosen() else { return };
    ui.horizontal(|ui| {
        ui.set_height(ROW);
        let named = ui.label("Mask file").on_hover_text("A PNG, a pixel a point: white is full density, north is up");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let has_path = !woods.mask_path.trim().is_empty();
            let load = ui.add_enabled(has_path, Button::new("Load mask"));
            if load.on_hover_text("The area becomes the mask of this picture, over the bounds that it has").clicked() {
                woods.load_mask();
            }
            if woods.can_paint() {
                let save = ui.add_enabled(has_path, Button::new("Save mask"));
                if save.on_hover_text("A picture of this name is replaced").clicked() {
                    woods.save_mask();
                }
            }
            let edit = TextEdit::singleline(&mut woods.mask_path).desired_width(f32::INFINITY);
            ui.add(edit.hint_text("Path of a PNG")).labelled_by(named.id);
        });
    });
    if let Some(error) = &woods.mask_error {
        ui.colored_label(palette(ui.visuals()).bad, error);
    }
}

/// The corner that was held last.
fn corner(ui: &mut Ui, woods: &mut Woods) {
    let Some(element) = woods.chosen() else { return };
    let handles = element.handles(woods.plan());
    let number = woods.corner.unwrap_or(0).min(handles.len().saturating_sub(1));
    let Some(place) = handles.get(number) else { return };
    let mut wanted = *place;
    let mut chosen = number + 1;
    labelled(ui, "Corner", "The one that was held last", |ui, named| {
        let drag = DragValue::new(&mut chosen).range(1..=handles.len()).suffix(format!(" of {}", handles.len()));
        ui.add_sized(vec2(84.0, ROW - 4.0), drag.speed(0.1)).labelled_by(named.id);
        if ui.button("Split").on_hover_text("One more corner behind this one").clicked() {
            woods.add_corner();
        }
        if ui.button("Drop").on_hover_text("Remove this corner").clicked() {
            woods.corner = Some(number);
            woods.remove_corner();
        }
    });
    if chosen != number + 1 {
        woods.corner = Some(chosen - 1);
        return;
    }
    labelled(ui, "Its place", "x and z; drag it in the picture, or put the tool *Move* down on it", |ui, named| {
        for (axis, value) in [("x ", &mut wanted.x), ("z ", &mut wanted.y)] {
            let drag = DragValue::new(value).prefix(axis).suffix(" m").max_decimals(1).update_while_editing(false);
            ui.add_sized(vec2(84.0, ROW - 4.0), drag).labelled_by(named.id);
        }
    });
    if wanted != *place
        && let Some(plan) = element.with_handle_at(woods.plan(), number, wanted)
    {
        woods.corner = Some(number);
        woods.session.change(plan, "Move a corner");
    }
}

fn fields(ui: &mut Ui, woods: &mut Woods) {
    match woods.chosen() {
        Some(Element::Area(number)) => {
            let Some(table) = woods.area_table() else { return };
            let species: Vec<String> =
                woods.plan().areas[number].stock.iter().map(|stock| stock.species.clone()).collect();
            session_rows(ui, &mut woods.session, |ui, rows| area_rows(ui, rows, &table, &species));
        }
        Some(Element::KeepOut(number)) => kept_free(ui, woods, number),
        None => {
            ui.weak("The plan has no areas yet.");
        }
    }
    let table = woods.session.table().clone();
    CollapsingHeader::new("The whole plan").show(ui, |ui| {
        session_rows(ui, &mut woods.session, |ui, rows| rows.section(ui, &table));
    });
}

/// The fields of an area; each species under its name.
fn area_rows(ui: &mut Ui, rows: &mut Rows, table: &Section, species: &[String]) {
    for row in &table.rows {
        match row {
            Row::Section(stock) if stock.path.ends_with(".stock") => {
                for (number, row) in stock.rows.iter().enumerate() {
                    let Row::Section(of_species) = row else { continue };
                    let title = species.get(number).cloned().unwrap_or_else(|| of_species.title.clone());
                    rows.folded(ui, &Section { title, ..of_species.clone() }, number == 0);
                }
                rows.section(ui, &Section { rows: Vec::new(), ..stock.clone() });
            }
            Row::Section(inside) => rows.folded(ui, inside, inside.path.ends_with(".pattern")),
            Row::Field(field) => rows.field(ui, field),
        }
    }
}

/// The sizes of a shape that is kept free.
fn kept_free(ui: &mut Ui, woods: &mut Woods, number: usize) {
    let mut plan: ForestPlan = woods.plan().clone();
    let is_changed = match &mut plan.keep_out[number] {
        KeepOut::Path { width_m, .. } => slider(ui, ("Width", "0.1 m to 1000 m"), width_m, 0.1..=100.0, " m"),
        KeepOut::Disc { radius_m, .. } => slider(ui, ("Radius", "0.1 m to 10 km"), radius_m, 0.1..=1000.0, " m"),
        KeepOut::House { size_m, turn_deg, .. } => {
            let [long_m, wide_m] = size_m;
            let long = slider(ui, ("Length", "Its first side"), long_m, 0.1..=200.0, " m");
            let wide = slider(ui, ("Width", "Its second side"), wide_m, 0.1..=200.0, " m");
            let turn = ("Turn", "Of its first side against the x axis, towards z");
            slider(ui, turn, turn_deg, -360.0..=360.0, "°") || long || wide
        }
        KeepOut::Water { shore_m } => {
            ui.weak(format!("Its shore has {} corners, which can be dragged.", shore_m.len()));
            false
        }
    };
    if is_changed {
        woods.session.change(plan, "Size");
    }
}
