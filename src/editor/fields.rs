//! The table of all fields of settings: what a panel has to know to show each, by reflection. A new field of a settings struct is
//! in it by itself, with its documentation, its unit and its range; see `field_table`.

use std::ops::RangeInclusive;

use bevy::reflect::{GetPath, PartialReflect, Reflect};

use super::field_text::Unit;

/// A group of fields: a struct, a list, or what a variant holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    pub title: String,
    pub docs: String,
    /// Where it is, for reflection; empty for the whole.
    pub path: String,
    pub rows: Vec<Row>,
    /// Whether it is a list, whose items can be added and removed.
    pub is_list: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    Field(Field),
    Section(Section),
}

/// One value.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Where it is, for reflection: `growth.0.trunk.height_m`.
    pub path: String,
    /// What errors call it: `growth.trunk.height_m`.
    pub name: String,
    pub label: String,
    pub docs: String,
    pub unit: Option<Unit>,
    pub range: Option<RangeInclusive<f64>>,
    pub kind: Kind,
}

/// What kind of value a field has.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    Number,
    Whole,
    /// Any whole number is as good as any other.
    Seed,
    Switch,
    /// One of several variants.
    Choice(Vec<Choice>),
    /// sRGB, 0 to 1.
    Colour,
    /// A direction on the map.
    Direction,
    Text,
}

/// A variant that can be chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    pub name: &'static str,
    pub docs: String,
    /// Whether it holds settings of its own.
    pub has_settings: bool,
}

impl Section {
    /// The same section of settings that are part of others, where that part is at a path.
    #[must_use]
    pub fn inside(mut self, parent: &str) -> Self {
        let join = |path: &str| if path.is_empty() { parent.to_owned() } else { format!("{parent}.{path}") };
        self.path = join(&self.path);
        self.rows = self
            .rows
            .into_iter()
            .map(|row| match row {
                Row::Field(field) => Row::Field(Field { path: join(&field.path), name: join(&field.name), ..field }),
                Row::Section(section) => Row::Section(section.inside(parent)),
            })
            .collect();
        self
    }
}

/// Every field of a section and of those in it.
pub fn all_fields(section: &Section) -> Vec<&Field> {
    let mut fields = Vec::new();
    for row in &section.rows {
        match row {
            Row::Field(field) => fields.push(field),
            Row::Section(inside) => fields.extend(all_fields(inside)),
        }
    }
    fields
}

/// A number as it is, whatever its type.
pub fn number(value: &dyn PartialReflect) -> Option<f64> {
    macro_rules! of {
        ($($number:ty),+) => { None$(.or_else(|| value.try_downcast_ref::<$number>().map(|number| *number as f64)))+ };
    }
    of!(f32, f64, u8, u16, u32, u64, usize, i32)
}

/// Sets a number, rounded to its type.
pub fn set_number(value: &mut dyn PartialReflect, number: f64) {
    macro_rules! set {
        ($($whole:ty),+) => { $(if let Some(value) = value.try_downcast_mut::<$whole>() { *value = number.round() as $whole; })+ };
    }
    if let Some(value) = value.try_downcast_mut::<f32>() {
        *value = number as f32;
    }
    if let Some(value) = value.try_downcast_mut::<f64>() {
        *value = number;
    }
    set!(u8, u16, u32, u64, usize, i32);
}

/// Whether two settings have the same value at a path. What has no value there does not differ.
pub fn is_same_at<T: Reflect>(a: &T, b: &T, path: &str) -> bool {
    let values = a.reflect_path(path).ok().zip(b.reflect_path(path).ok());
    values.is_none_or(|(a, b)| a.reflect_partial_eq(b) == Some(true))
}

/// Gives settings the value that others have at a path. Returns whether both have one there.
pub fn copy_at<T: Reflect>(to: &mut T, from: &T, path: &str) -> bool {
    let Ok(value) = from.reflect_path(path) else { return false };
    to.reflect_path_mut(path).is_ok_and(|own| own.try_apply(value).is_ok())
}

/// A name in capitals and small letters as words: `ReevesBlau` is `Reeves Blau`.
pub fn words(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.push(letter);
    }
    words
}
