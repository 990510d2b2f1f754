//! The panel of the ground: random fields, control points, and real maps.

use bevy::math::{DVec2, Vec2};
use bevy_egui::egui::{Button, ComboBox, DragValue, ProgressBar, ScrollArea, TextEdit, Ui, vec2};

use super::{
    dialogs::Dialog,
    file_bar::{file_buttons, undo_buttons, warnings},
    session_rows::session_rows,
    theme::ROW,
    value_rows::{labelled, slider},
};
use crate::{
    editor::{
        ground_desk::{Fitting, GroundDesk, GroundKind},
        land_pose::LandPose,
        map_fit::MapFit,
        spline_points::control_points,
    },
    terrain::Fit,
};

/// Draws the panel.
pub fn ground_panel(ui: &mut Ui, ground: &mut GroundDesk, pose: &mut LandPose, dialog: &mut Option<Dialog>) {
    ui.horizontal(|ui| {
        for (kind, name, hint) in GroundKind::ALL {
            if ui.selectable_label(ground.kind == kind, name).on_hover_text(hint).clicked() {
                ground.kind = kind;
            }
        }
    });
    ui.checkbox(&mut ground.is_shown, "Stands in the world")
        .on_hover_text("The terrain that is drawn becomes this ground, and the forest stands on it");
    ui.separator();
    if ground.kind == GroundKind::Map {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| map(ui, ground, pose));
        return;
    }
    file_buttons(ui, ground.session(), dialog);
    ui.horizontal(|ui| {
        undo_buttons(ui, ground.session());
        if ui.button("Show all").on_hover_text("Look at some hills, or at all patches").clicked() {
            show_all(ground, pose);
        }
    });
    warnings(ui, ground.session(), "ground");
    ui.separator();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match ground.kind {
        GroundKind::Random | GroundKind::Map => {
            let table = ground.random.table().clone();
            session_rows(ui, &mut ground.random, |ui, rows| rows.section_open(ui, &table));
        }
        GroundKind::Spline => spline(ui, ground),
    });
}

fn show_all(ground: &GroundDesk, pose: &mut LandPose) {
    match ground.kind {
        GroundKind::Spline => {
            let points = control_points(ground.spline.document());
            pose.show(points.into_iter().map(|(_, at)| Vec2::new(at.x, at.z)));
        }
        GroundKind::Random => {
            let half_m = 3.0 * ground.random.document().scale_m as f32;
            pose.show([-1.0, 1.0].map(|side| Vec2::splat(side * half_m)));
        }
        GroundKind::Map => {
            let Some(fit) = &ground.fit else { return };
            let corner = fit.map.placement();
            let corner = DVec2::new(corner.west_m, corner.north_m).as_vec2();
            pose.show([corner, -corner]);
        }
    }
}

fn spline(ui: &mut Ui, ground: &mut GroundDesk) {
    let points: usize = ground.spline.document().patches.iter().map(|patch| patch.heights_m.len()).sum();
    let patches = ground.spline.document().patches.len();
    ui.label(format!("{patches} patches of {points} points. Drag a point up or down in the picture."));
    ui.add_space(4.0);
    if let Some((point, height_m)) = ground.point.zip(ground.point_height_m()) {
        let mut wanted_m = height_m;
        let label = format!("Patch {}, point {}", point.patch + 1, point.number + 1);
        labelled(ui, &label, "Height of the point that was held last", |ui, named| {
            let drag =
                DragValue::new(&mut wanted_m).suffix(" m").max_decimals(1).speed(0.5).update_while_editing(false);
            ui.add_sized(vec2(100.0, ROW - 4.0), drag).labelled_by(named.id);
        });
        if wanted_m != height_m {
            ground.raise_to(wanted_m);
        }
    } else {
        ui.weak("No point is chosen.");
    }
    ui.horizontal(|ui| {
        if ui.button("New patch").on_hover_text("Four by four level points, to the east of all others").clicked() {
            ground.add_patch();
        }
        let hint = "That of the chosen point, or else the last";
        if ui.add_enabled(patches > 0, Button::new("Remove patch")).on_hover_text(hint).clicked() {
            ground.remove_patch();
        }
    });
    ui.add_space(4.0);
    let table = ground.spline.table().clone();
    session_rows(ui, &mut ground.spline, |ui, rows| rows.section(ui, &table));
}

fn map(ui: &mut Ui, ground: &mut GroundDesk, pose: &mut LandPose) {
    let request = &mut ground.request;
    labelled(ui, "File", "GeoTIFF, ESRI ASCII grid, SRTM tile or PNG", |ui, named| {
        let edit = TextEdit::singleline(&mut request.path).desired_width(f32::INFINITY).hint_text("Path of a map");
        ui.add(edit).labelled_by(named.id);
    });
    let own = "0 where the file says it; a PNG does not";
    slider(ui, ("Cell, east", own), &mut request.cell_x_m, 0.0..=1000.0, " m");
    slider(ui, ("Cell, south", own), &mut request.cell_z_m, 0.0..=1000.0, " m");
    slider(
        ui,
        ("Metres of a unit", "Rise for each unit of a sample"),
        &mut request.metres_per_unit,
        0.001..=10.0,
        " m",
    );
    ui.horizontal(|ui| match &ground.fitting {
        Fitting::Idle => {
            let has_path = !ground.request.path.trim().is_empty();
            let hint = "Reads the map, measures its variogram, and fits all models to it";
            if ui.add_enabled(has_path, Button::new("Fit")).on_hover_text(hint).clicked() {
                ground.fitting = Fitting::Wanted;
            }
        }
        Fitting::Wanted => {
            ui.spinner();
        }
        Fitting::Running(progress) => {
            if ui.button("Cancel").clicked() {
                progress.cancel();
            }
            ui.add(ProgressBar::new(progress.share()).show_percentage().desired_width(ui.available_width()));
        }
    });
    let Some(fit) = ground.fit.clone() else { return };
    ui.separator();
    fits(ui, ground, &fit);
    ui.horizontal(|ui| {
        if ui
            .button("More of its kind")
            .on_hover_text("Random ground with this variogram; another seed is another ground")
            .clicked()
        {
            ground.make_more();
            show_all(ground, pose);
        }
        if ui.button("Show all").on_hover_text("Look at the whole map").clicked() {
            show_all(ground, pose);
        }
    });
    for notice in &fit.notices {
        ui.weak(notice);
    }
}

fn fits(ui: &mut Ui, ground: &mut GroundDesk, fit: &MapFit) {
    let name = |fit: &Fit| format!("{}, error {:.3}", fit.model.name(), fit.residual);
    let now = fit.fits.get(ground.chosen_fit).map_or_else(String::new, name);
    labelled(ui, "Model", "The best comes first; the error is relative", |ui, named| {
        let combo = ComboBox::from_id_salt("fit").selected_text(now).width(ui.available_width());
        let shown = combo.show_ui(ui, |ui| {
            for (number, fit) in fit.fits.iter().enumerate() {
                if ui.selectable_label(ground.chosen_fit == number, name(fit)).clicked() {
                    ground.chosen_fit = number;
                }
            }
        });
        shown.response.labelled_by(named.id);
    });
}
