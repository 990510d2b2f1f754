//! Makes the table of all fields of a value, by reflection.
//!
//! The range of a field is asked of the settings' own check: a value that cannot be right is put in the field, and the error says what
//! would be. So a range that depends on other fields is right, too. Where the check says nothing of a field, its documentation may.

use std::ops::RangeInclusive;

use bevy::{
    math::Dir2,
    reflect::{
        GetPath, NamedField, PartialReflect, Reflect, ReflectRef, TypeInfo,
        enums::{Enum, VariantInfo, VariantType},
    },
};

use super::{
    field_text::{allowed_range, documented_range, label as label_of, unit},
    fields::{Choice, Field, Kind, Row, Section, number, set_number, words},
};
use crate::setting::SettingError;

/// The table of all fields of a value. `check` is the settings' own.
pub fn fields_of<T: Reflect + Clone>(value: &T, check: impl Fn(&T) -> Result<(), SettingError>) -> Section {
    let probe = |path: &str, name: &str| {
        let mut spoilt = value.clone();
        spoil(spoilt.reflect_path_mut(path).ok()?);
        let error = check(&spoilt).err()?;
        allowed_range(&error.allowed).filter(|_| error.field == name)
    };
    Walk { probe: &probe }.section(value.as_partial_reflect(), String::new(), Place::default(), "")
}

/// Puts a value in a field that no check lets pass.
fn spoil(value: &mut dyn PartialReflect) {
    let is_whole = value.try_downcast_ref::<f32>().is_none() && value.try_downcast_ref::<f64>().is_none();
    set_number(value, if is_whole { f64::MAX } else { f64::NAN });
}

/// Where a value is, for reflection and for errors.
#[derive(Clone, Debug, Default)]
struct Place {
    path: String,
    name: String,
}

impl Place {
    fn field(&self, name: &str) -> Self {
        let join = |parent: &str| if parent.is_empty() { name.to_owned() } else { format!("{parent}.{name}") };
        Self { path: join(&self.path), name: join(&self.name) }
    }

    fn item(&self, index: usize) -> Self {
        Self { path: format!("{}[{index}]", self.path), name: format!("{}[{index}]", self.name) }
    }

    /// What a variant holds: errors do not name it.
    fn held(&self) -> Self {
        Self { path: format!("{}.0", self.path), name: self.name.clone() }
    }
}

/// Asks for the range of the field at a path, which errors call by a name.
type Probe<'a> = &'a dyn Fn(&str, &str) -> Option<RangeInclusive<f64>>;

struct Walk<'a> {
    probe: Probe<'a>,
}

impl Walk<'_> {
    fn section(&self, value: &dyn PartialReflect, title: String, place: Place, docs: &str) -> Section {
        let mut section =
            Section { title, docs: docs.to_owned(), path: place.path.clone(), rows: Vec::new(), is_list: false };
        match value.reflect_ref() {
            ReflectRef::Struct(fields) => {
                let info = value.get_represented_type_info().and_then(|info| info.as_struct().ok());
                for index in 0..fields.field_len() {
                    let (Some(name), Some(value)) = (fields.name_at(index), fields.field_at(index)) else { continue };
                    let docs = info.and_then(|info| info.field_at(index)?.docs()).map(plain).unwrap_or_default();
                    self.rows(value, name, &label_of(name), place.field(name), &docs, &mut section.rows);
                }
            }
            ReflectRef::List(list) => {
                section.is_list = true;
                let singular = section.title.strip_suffix('s').unwrap_or(&section.title).to_owned();
                for (index, item) in list.iter().enumerate() {
                    let label = format!("{singular} {}", index + 1);
                    self.rows(item, &label, &label, place.item(index), docs, &mut section.rows);
                }
            }
            _ => {}
        }
        section
    }

    /// The rows of one value: mostly one.
    fn rows(&self, value: &dyn PartialReflect, name: &str, label: &str, place: Place, docs: &str, rows: &mut Vec<Row>) {
        let field = |kind: Kind, range| {
            let Place { path, name: error_name } = place.clone();
            let unit = matches!(kind, Kind::Number | Kind::Whole).then(|| unit(name, docs)).flatten();
            Row::Field(Field {
                path,
                name: error_name,
                label: label.to_owned(),
                docs: docs.to_owned(),
                unit,
                range,
                kind,
            })
        };
        if let Some(kind) = plain_kind(value, name) {
            let has_range = matches!(kind, Kind::Number | Kind::Whole);
            let range = || (self.probe)(&place.path, &place.name).or_else(|| documented_range(docs));
            rows.push(field(kind, has_range.then(range).flatten()));
            return;
        }
        match value.reflect_ref() {
            ReflectRef::Enum(variant) => {
                rows.push(field(Kind::Choice(choices(value)), None));
                self.variant_rows(variant, label, &place, docs, rows);
            }
            ReflectRef::Array(array) => {
                for (index, item) in array.iter().enumerate() {
                    let label = format!("{label} {}", index + 1);
                    self.rows(item, name, &label, place.item(index), docs, rows);
                }
            }
            ReflectRef::Struct(_) | ReflectRef::List(_) => {
                rows.push(Row::Section(self.section(value, label.to_owned(), place, docs)));
            }
            _ => {}
        }
    }
}

impl Walk<'_> {
    /// What a variant holds: the settings of one struct, fields of its own, or one value.
    fn variant_rows(&self, variant: &dyn Enum, label: &str, place: &Place, docs: &str, rows: &mut Vec<Row>) {
        let name = variant.variant_name();
        let title = format!("{label}: {}", words(name));
        let info = variant.get_represented_type_info().and_then(|info| info.as_enum().ok()?.variant(name));
        match (variant.variant_type(), variant.field_at(0)) {
            (VariantType::Tuple, Some(held)) if matches!(held.reflect_ref(), ReflectRef::Struct(_)) => {
                rows.push(Row::Section(self.section(held, title, place.held(), docs)));
            }
            (VariantType::Tuple, Some(held)) => {
                let place = Place { path: place.held().path, name: place.field(name).name };
                let docs = choices(variant.as_partial_reflect()).into_iter().find(|choice| choice.name == name);
                self.rows(held, name, &words(name), place, &docs.map(|choice| choice.docs).unwrap_or_default(), rows);
            }
            (VariantType::Struct, _) => {
                let mut inside = Section {
                    title,
                    docs: docs.to_owned(),
                    path: place.path.clone(),
                    rows: Vec::new(),
                    is_list: false,
                };
                for index in 0..variant.field_len() {
                    let (Some(name), Some(value)) = (variant.name_at(index), variant.field_at(index)) else { continue };
                    let docs = match info {
                        Some(VariantInfo::Struct(info)) => info.field_at(index).and_then(NamedField::docs).map(plain),
                        _ => None,
                    };
                    self.rows(
                        value,
                        name,
                        &label_of(name),
                        place.field(name),
                        &docs.unwrap_or_default(),
                        &mut inside.rows,
                    );
                }
                rows.push(Row::Section(inside));
            }
            _ => {}
        }
    }
}

/// The kind of a value that is one field by its type.
fn plain_kind(value: &dyn PartialReflect, name: &str) -> Option<Kind> {
    if value.try_downcast_ref::<u64>().is_some() && name.contains("seed") {
        return Some(Kind::Seed);
    }
    if value.try_downcast_ref::<f32>().is_some() || value.try_downcast_ref::<f64>().is_some() {
        return Some(Kind::Number);
    }
    if number(value).is_some() {
        return Some(Kind::Whole);
    }
    if value.try_downcast_ref::<bool>().is_some() {
        return Some(Kind::Switch);
    }
    if value.try_downcast_ref::<String>().is_some() {
        return Some(Kind::Text);
    }
    if value.try_downcast_ref::<Dir2>().is_some() {
        return Some(Kind::Direction);
    }
    (value.try_downcast_ref::<[f32; 3]>().is_some() && name.contains("colour")).then_some(Kind::Colour)
}

/// The variants of an enum, which the type knows.
fn choices(value: &dyn PartialReflect) -> Vec<Choice> {
    let Some(TypeInfo::Enum(info)) = value.get_represented_type_info() else { return Vec::new() };
    let choice = |variant: &VariantInfo| Choice {
        name: variant.name(),
        docs: variant.docs().map(plain).unwrap_or_default(),
        has_settings: variant.variant_type() != VariantType::Unit,
    };
    info.iter().map(choice).collect()
}

/// Documentation without the marks of links and code.
fn plain(docs: &str) -> String {
    let mut text = String::new();
    let mut rest = docs.trim();
    while let Some(start) = rest.find("](") {
        let Some(end) = rest[start..].find(')') else { break };
        text.push_str(&rest[..start]);
        rest = &rest[start + end + 1..];
    }
    text.push_str(rest);
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let text = lines.join(" ").replace("\\[", "\u{1}").replace("\\]", "\u{2}").replace(['[', ']', '`'], "");
    text.replace('\u{1}', "[").replace('\u{2}', "]")
}

#[cfg(test)]
mod tests;
