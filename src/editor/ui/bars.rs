//! The bars around the picture: which panel, which view, which age and season.

use bevy_egui::egui::{
    Align, DragValue, Id, Label, Layout, RichText, Slider, SliderClamping, ThemePreference, Ui, WidgetInfo, WidgetType,
    vec2,
};

use super::{dialogs::Dialog, theme::ROW};
use crate::{
    editor::{
        diagram::View,
        land_pose::LandPose,
        live_settings::LiveSettings,
        stage::{Arrangement, Stage},
    },
    tree::Season,
    wind::Wind,
};

/// Which panel is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Panel {
    /// Fields of a species.
    #[default]
    Species,
    /// The plan of a forest.
    Woods,
    /// The ground.
    Ground,
    /// The wind, and what it is like.
    Wind,
    /// Levels of detail, and what everything costs.
    Levels,
}

impl Panel {
    /// All of them, with their names.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Species, "Species"),
        (Self::Woods, "Woods"),
        (Self::Ground, "Ground"),
        (Self::Wind, "Wind"),
        (Self::Levels, "Levels and cost"),
    ];

    /// Whether the picture is of a wood or of ground, and not of a tree.
    #[must_use]
    pub fn is_of_land(self) -> bool {
        matches!(self, Self::Woods | Self::Ground)
    }
}

/// The bar on top.
pub fn top_bar(ui: &mut Ui, panel: &mut Panel, dialog: &mut Option<Dialog>) {
    ui.horizontal(|ui| {
        ui.set_height(ROW + 4.0);
        for (one, name) in Panel::ALL {
            if ui.selectable_label(*panel == one, RichText::new(name).size(15.0)).clicked() {
                *panel = one;
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button("?").on_hover_text("Shortcuts").clicked() {
                *dialog = Some(Dialog::Shortcuts);
            }
            let is_dark = ui.visuals().dark_mode;
            let (name, other) = if is_dark { ("☀", ThemePreference::Light) } else { ("🌙", ThemePreference::Dark) };
            let hint = if is_dark { "Light colours" } else { "Dark colours" };
            let button = ui.button(name).on_hover_text(hint);
            button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, hint));
            if button.clicked() {
                ui.ctx().set_theme(other);
            }
        });
    });
}

/// The bar under the picture: views and rows, age, season and wind.
pub fn stage_bar(
    ui: &mut Ui,
    panel: Panel,
    stage: &mut Stage,
    season: &mut Season,
    wind: &mut LiveSettings<Wind>,
    mature_years: f32,
) {
    ui.horizontal(|ui| {
        ui.set_height(ROW);
        for (view, name, hint) in View::ALL {
            if ui.selectable_label(stage.view == view, name).on_hover_text(hint).clicked() {
                stage.view = view;
            }
        }
    });
    ui.horizontal(|ui| {
        ui.set_height(ROW);
        for (arrangement, name, hint) in Arrangement::ALL {
            if ui.selectable_label(stage.arrangement == arrangement, name).on_hover_text(hint).clicked() {
                stage.arrangement = arrangement;
            }
        }
        ui.separator();
        ui.checkbox(&mut stage.compares, "Beside the saved")
            .on_hover_text("The tree as it is in its file stands to the left");
        ui.checkbox(&mut stage.turns, "Turn").on_hover_text("Ctrl+T");
        if panel == Panel::Species {
            ui.checkbox(&mut stage.shows_envelope, "Envelope")
                .on_hover_text("The outline that branches do not leave: drag its base, its top and its side");
        }
    });
    ui.horizontal(|ui| {
        ui.set_height(ROW);
        let width = (ui.available_width() - 3.0 * 8.0) / 3.0;
        age(ui, width, stage, mature_years);
        season_and_wind(ui, width, season, wind);
    });
}

/// The bar under a picture of a wood or of ground: from where it is seen, season and wind.
pub fn land_bar(ui: &mut Ui, pose: &mut LandPose, season: &mut Season, wind: &mut LiveSettings<Wind>) {
    ui.horizontal(|ui| {
        ui.set_height(ROW);
        if ui.button("From above").on_hover_text("North is up").clicked() {
            pose.look_down();
        }
        if ui.button("Aslant").clicked() {
            pose.look_aslant();
        }
        ui.weak(format!("{:.0} m away", pose.distance_m));
    });
    ui.horizontal(|ui| {
        ui.set_height(ROW);
        let width = (ui.available_width() - 2.0 * 8.0) / 2.0;
        season_and_wind(ui, width, season, wind);
    });
}

/// A name, and controls beside it, in a part of a row.
fn part(ui: &mut Ui, width: f32, name: &str, add: &mut dyn FnMut(&mut Ui, Id)) {
    ui.allocate_ui_with_layout(vec2(width, ROW), Layout::left_to_right(Align::Center), |ui| {
        ui.set_width(width);
        let named = ui.label(name).id;
        ui.spacing_mut().slider_width = (ui.available_width() - 76.0).max(24.0);
        add(ui, named);
    });
}

fn age(ui: &mut Ui, width: f32, stage: &mut Stage, mature_years: f32) {
    let before_years = stage.age_share * mature_years;
    let mut years = before_years;
    part(ui, width, "Age", &mut |ui, named| {
        let slider = Slider::new(&mut years, 1.0..=2.0 * mature_years).logarithmic(true);
        ui.add(bare(slider)).labelled_by(named);
        ui.add_sized(
            vec2(64.0, ROW - 4.0),
            DragValue::new(&mut years).range(1.0..=5000.0).clamp_existing_to_range(false).suffix(" a").max_decimals(0),
        )
        .labelled_by(named);
    });
    if years != before_years {
        stage.age_share = years / mature_years;
    }
}

fn season_and_wind(ui: &mut Ui, width: f32, season: &mut Season, wind: &mut LiveSettings<Wind>) {
    part(ui, width, "Season", &mut |ui, named| {
        let mut year = season.year;
        ui.add(bare(Slider::new(&mut year, 0.0..=1.0))).labelled_by(named);
        if year != season.year {
            season.year = year;
        }
        ui.add_sized(vec2(64.0, ROW - 4.0), Label::new(month(season.year)));
    });
    part(ui, width, "Wind", &mut |ui, named| {
        let mut speed = wind.value().speed;
        ui.add(bare(Slider::new(&mut speed, 0.0..=30.0).step_by(0.5))).labelled_by(named);
        let drag = DragValue::new(&mut speed).range(0.0..=75.0).suffix(" m/s").max_decimals(1);
        ui.add_sized(vec2(64.0, ROW - 4.0), drag).labelled_by(named);
        if speed != wind.value().speed {
            wind.change(Wind { speed, ..wind.value().clone() }, "Speed");
        }
    });
}

/// A slider without a value of its own. What it cannot show, such as a hurricane, it leaves as it is.
fn bare(slider: Slider) -> Slider {
    slider.show_value(false).clamping(SliderClamping::Edits)
}

/// The month of a time of the year, which begins at midwinter, the 21st of December.
fn month(year: f32) -> &'static str {
    const MONTHS: [&str; 12] = [
        "January",
        "February",
        "March",
        "April",
        "May",
        "June",
        "July",
        "August",
        "September",
        "October",
        "November",
        "December",
    ];
    let day = (year.rem_euclid(1.0) * 365.0 - 11.0).rem_euclid(365.0);
    MONTHS[((day / 365.0 * 12.0) as usize).min(11)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn months_begin_after_midwinter() {
        assert_eq!(month(0.0), "December");
        assert_eq!(month(0.04), "January");
        assert_eq!(month(Season::SUMMER.year), "July");
        assert_eq!(month(0.81), "October");
        assert_eq!(month(1.0), "December");
    }
}
