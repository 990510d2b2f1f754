//! Changes of a species that reflection cannot make by itself: variants that hold settings, and the lengths of lists.

use bevy::reflect::{GetPath, ReflectMut};

use crate::{
    editor::session::default_growth,
    tree::{Growth, Species, crown::impressionist::ImpressionistCrown, leaf::LeafKind},
};

/// Every model of growth, with its default settings.
fn growths() -> [Growth; 6] {
    [
        Growth::ReevesBlau(Default::default()),
        Growth::Oak(Default::default()),
        Growth::Fir(Default::default()),
        Growth::AonoKunii(Default::default()),
        Growth::Impressionist(ImpressionistCrown::default()),
        Growth::Gardner(Default::default()),
    ]
}

/// A species whose enum at a path has another variant, with its default settings. None where there is no such variant.
pub fn with_variant(species: &Species, name: &str, variant: &str) -> Option<Species> {
    let mut changed = species.clone();
    match name {
        "growth" => changed.growth = growths().into_iter().find(|growth| variant_name(growth) == variant)?,
        "foliage.kind" => {
            let kinds = [LeafKind::Sprays, LeafKind::Ellipsoids(Default::default())];
            changed.foliage.kind = kinds.into_iter().find(|kind| variant_name(kind) == variant)?;
        }
        _ => return None,
    }
    Some(changed)
}

fn variant_name(value: &impl bevy::reflect::enums::Enum) -> String {
    value.variant_name().to_owned()
}

/// A species whose list at a path has one more item like the last, or one less. None where it cannot.
pub fn with_list(species: &Species, path: &str, is_longer: bool) -> Option<Species> {
    let mut changed = species.clone();
    let ReflectMut::List(list) = changed.reflect_path_mut(path).ok()?.reflect_mut() else { return None };
    if is_longer {
        match list.get(list.len().checked_sub(1).unwrap_or_default()).map(|last| last.to_dynamic()) {
            Some(last) => list.push(last.ok()?),
            None => return default_list(species, path),
        }
    } else {
        list.pop()?;
    }
    Some(changed)
}

/// An empty list gets the items that it has by default.
fn default_list(species: &Species, path: &str) -> Option<Species> {
    let default = Species { growth: default_growth(&species.growth), ..Species::default() };
    let mut changed = species.clone();
    let items = default.reflect_path(path).ok()?;
    changed.reflect_path_mut(path).ok()?.try_apply(items).ok()?;
    Some(changed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::fields::{Kind, all_fields, fields_of};

    #[test]
    fn every_variant_that_the_table_offers_can_be_chosen() {
        let species = Species::default();
        let table = fields_of(&species, Species::validate);
        let mut chosen = 0;
        for field in all_fields(&table) {
            let Kind::Choice(choices) = &field.kind else { continue };
            if choices.iter().all(|choice| !choice.has_settings) {
                continue;
            }
            for choice in choices {
                let changed = with_variant(&species, &field.name, choice.name).unwrap_or_else(|| panic!("{}", choice.name));
                assert!(changed.validate().is_ok(), "{}", choice.name);
                chosen += 1;
            }
        }
        assert_eq!(chosen, 8);
        assert_eq!(with_variant(&species, "growth", "Palm"), None);
    }

    #[test]
    fn lists_get_longer_and_shorter() {
        let species = Species::default();
        let orders = |species: &Species| match &species.growth {
            Growth::ReevesBlau(growth) => growth.orders.clone(),
            _ => panic!("the default model"),
        };
        let longer = with_list(&species, "growth.0.orders", true).unwrap();
        assert_eq!(orders(&longer)[..2], orders(&species));
        assert_eq!(orders(&longer)[2], orders(&species)[1]);
        let mut empty = species.clone();
        while let Some(shorter) = with_list(&empty, "growth.0.orders", false) {
            empty = shorter;
        }
        assert!(orders(&empty).is_empty());
        assert_eq!(orders(&with_list(&empty, "growth.0.orders", true).unwrap()), orders(&species));
        assert_eq!(with_list(&species, "name", true), None);
    }
}
