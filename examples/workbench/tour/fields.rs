//! The fields of a species that a person types.

use crate::hand::Hand;
use bevy::{
    prelude::*,
    reflect::{GetPath, ReflectRef},
};
use bevy_windwood::prelude::*;

/// What is typed first: how large the tree is and how it branches.
pub const SHAPE: &[&str] = &[
    "name",
    "age.mature_years",
    "growth.envelope.shape",
    "growth.envelope.top_m",
    "growth.envelope.base_m",
    "growth.envelope.radius_m",
    "growth.trunk.height_m",
    "growth.trunk.radius_m",
    "growth.orders[0].first_angle_deg",
    "growth.orders[0].last_angle_deg",
    "growth.orders[0].length",
    "growth.orders[0].light_seeking",
    "growth.orders[0].segments",
    "growth.orders[0].crook_deg",
    "growth.orders[0].rise",
    "growth.orders[1].spacing_m",
    "growth.orders[1].rise",
    "growth.orders[2].rise",
];
/// Then bark, leaves and the year.
pub const LOOK: &[&str] = &[
    "wood.young_modulus_pa",
    "wood.density_kg_m3",
    "wood.bark.pattern",
    "wood.bark.colour",
    "foliage.spacing_m",
    "foliage.size_m",
    "foliage.card",
    "foliage.bend_deg",
    "foliage.droop",
    "foliage.leaf.shape",
    "foliage.leaf.margin",
    "foliage.leaf.length",
    "foliage.leaf.width",
    "foliage.leaf.stalk",
    "foliage.leaf.vein_pairs",
    "foliage.leaf.shoots",
    "foliage.leaf.colour",
    "phenology.flush",
    "phenology.turn",
    "phenology.fall",
    "phenology.autumn_colours[0]",
    "phenology.autumn_colours[1]",
];

/// Types what fields have in a species.
///
/// # Errors
/// If there is no such field.
pub fn type_fields(hand: &mut Hand, names: &[&str], wanted: &Species) -> Result<(), String> {
    for name in names {
        let path = name.replace("growth.", "growth.0.");
        let value = wanted.reflect_path(path.as_str()).map_err(|error| format!("{name}: {error}"))?;
        if let Some(colour) = value.try_downcast_ref::<[f32; 3]>() {
            hand.set_colour(name, colour.map(|channel| (channel * 255.0).round() as u8))?;
        } else if let Some(text) = value.try_downcast_ref::<String>() {
            hand.set_text(name, text)?;
        } else if let ReflectRef::Enum(variant) = value.reflect_ref() {
            hand.choose(name, &words(variant.variant_name()))?;
        } else {
            // Moduli are shown in GPa.
            let number = number(value).ok_or_else(|| format!("{name} is no number"))?;
            let shown = if name.ends_with("_pa") { number * 1e-9 } else { number };
            hand.set_number(name, &format!("{shown}"))?;
        }
    }
    Ok(())
}

/// A number as it is, whatever its type.
fn number(value: &dyn PartialReflect) -> Option<f64> {
    let of_f32 = value.try_downcast_ref::<f32>().map(|number| format!("{number}"));
    let of_u32 = value.try_downcast_ref::<u32>().map(|number| format!("{number}"));
    of_f32.or(of_u32)?.parse().ok()
}

/// A name in capitals and small letters as words.
fn words(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.push(letter);
    }
    words
}
