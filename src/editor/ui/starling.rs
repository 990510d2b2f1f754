//! The menus of Starling & Ashdown's program, word by word ("The creation process"): SHAPE, SURFACE, PROPERTIES.

use bevy_egui::egui::{CollapsingHeader, Color32, Ui, color_picker, vec2};

use super::rows::Rows;
use crate::{
    editor::fields::{Field, Row, Section},
    tree::crown::impressionist::ImpressionistCrown,
};

/// A menu: its name, and its commands with the field that each sets.
type Menu = (&'static str, &'static [(&'static str, &'static str)]);

/// "The material properties are defined by entering HSV colour values. The shading in the interior of the crown can be altered
/// by adjusting the minimum and maximum diffuse values."
const MENUS: [Menu; 3] = [
    (
        "SHAPE",
        &[
            ("TYPE", "form"),
            ("HEIGHT", "height_m"),
            ("DIAMETER", "diameter_m"),
            ("CROWN SIZE", "crown_size"),
            ("TIP POINT", "tip_point"),
            ("CURVE", "curve"),
        ],
    ),
    (
        "SURFACE",
        &[
            ("NUMBER OF POLYGONS", "polygons"),
            ("POLYGON SIZE, top", "least_size_m"),
            ("POLYGON SIZE, middle", "greatest_size_m"),
            ("ROUGHNESS", "roughness"),
            ("GAPS", "gaps"),
            ("DISTORTION", "distortion"),
        ],
    ),
    (
        "PROPERTIES",
        &[
            ("COLOUR, hue", "hue_deg"),
            ("COLOUR, saturation", "saturation"),
            ("DIFFUSE, outside", "greatest_brightness"),
            ("DIFFUSE, inside", "least_brightness"),
        ],
    ),
];

/// Size of words in capitals, points.
const CAPITALS: f32 = 11.5;

/// Draws the menus, and what the program has beyond them.
pub fn menus(rows: &mut Rows, ui: &mut Ui, crown: &Section, now: &ImpressionistCrown) {
    for (menu, commands) in MENUS {
        CollapsingHeader::new(menu).default_open(true).show(ui, |ui| {
            let usual = std::mem::replace(&mut rows.label_size, CAPITALS);
            for (word, name) in commands {
                if let Some(field) = field(crown, name) {
                    rows.labelled(ui, field, word);
                }
            }
            rows.label_size = usual;
            if menu == "PROPERTIES" {
                swatches(ui, now);
            }
        });
    }
    let others = crown.rows.iter().filter(|row| !matches!(row, Row::Field(field) if is_in_menus(crown, field)));
    let others = Section { title: "More than his menus".into(), rows: others.cloned().collect(), ..crown.clone() };
    rows.folded(ui, &others, false);
}

/// The colours from the outermost to the deepest polygon.
fn swatches(ui: &mut Ui, crown: &ImpressionistCrown) {
    const STEPS: usize = 8;
    let width = ui.available_width() / STEPS as f32;
    ui.spacing_mut().item_spacing.x = 0.0;
    ui.horizontal(|ui| {
        for step in 0..STEPS {
            let depth = step as f32 / (STEPS - 1) as f32;
            let value = crown.greatest_brightness + depth * (crown.least_brightness - crown.greatest_brightness);
            color_picker::show_color(ui, hsv(crown.hue_deg, crown.saturation, value), vec2(width, 14.0));
        }
    });
}

/// A colour of the HSV model: hue in degrees.
fn hsv(hue_deg: f32, saturation: f32, value: f32) -> Color32 {
    let channel = |shift: f32| {
        // Smith 1978.
        let place = (hue_deg / 60.0 + shift).rem_euclid(6.0);
        let share = value * (1.0 - saturation * place.min(4.0 - place).clamp(0.0, 1.0));
        (share.clamp(0.0, 1.0) * 255.0).round() as u8
    };
    Color32::from_rgb(channel(5.0), channel(3.0), channel(1.0))
}

fn field<'a>(crown: &'a Section, name: &str) -> Option<&'a Field> {
    let path = format!("{}.{name}", crown.path);
    crown.rows.iter().find_map(|row| match row {
        Row::Field(field) if field.path == path => Some(field),
        Row::Field(_) | Row::Section(_) => None,
    })
}

fn is_in_menus(crown: &Section, other: &Field) -> bool {
    let commands = MENUS.iter().flat_map(|(_, commands)| *commands);
    commands.into_iter().any(|(_, name)| field(crown, name) == Some(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        editor::field_table::fields_of,
        tree::{Growth, Species},
    };

    #[test]
    fn every_command_of_the_paper_sets_a_field_of_the_crown() {
        let species = Species { growth: Growth::Impressionist(ImpressionistCrown::default()), ..Species::default() };
        let table = fields_of(&species, Species::validate);
        let crown = table.rows.iter().find_map(|row| match row {
            Row::Section(section) if section.path == "growth.0" => Some(section),
            Row::Section(_) | Row::Field(_) => None,
        });
        let crown = crown.expect("the crown's section");
        for (_, name) in MENUS.iter().flat_map(|(_, commands)| *commands) {
            assert!(field(crown, name).is_some(), "{name}");
        }
        let others = crown.rows.iter().filter(|row| matches!(row, Row::Field(field) if !is_in_menus(crown, field)));
        assert_eq!(others.count(), crown.rows.len() - 16);
    }

    #[test]
    fn colours_are_those_of_the_hsv_model() {
        assert_eq!(hsv(0.0, 1.0, 1.0), Color32::from_rgb(255, 0, 0));
        assert_eq!(hsv(120.0, 1.0, 1.0), Color32::from_rgb(0, 255, 0));
        assert_eq!(hsv(240.0, 1.0, 1.0), Color32::from_rgb(0, 0, 255));
        assert_eq!(hsv(60.0, 1.0, 1.0), Color32::from_rgb(255, 255, 0));
        assert_eq!(hsv(90.0, 0.0, 0.4), Color32::from_rgb(102, 102, 102));
    }
}
