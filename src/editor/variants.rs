//! Changes of a species that reflection cannot make by itself: variants that hold settings, and the lengths of lists.

use bevy::reflect::{GetPath, PartialReflect, Reflect, ReflectMut, enums::Enum};

use crate::{
    editor::session::default_growth,
    tree::{
        Growth, Species,
        growth::{
            Phyllotaxis,
            aono_kunii::{Branching, Shoot},
        },
        leaf::LeafKind,
    },
};

/// A species whose enum at a path has another variant, with its default settings. None where there is no such variant.
pub fn with_variant(species: &Species, path: &str, variant: &str) -> Option<Species> {
    let mut changed = species.clone();
    let value = changed.reflect_path_mut(path).ok()?;
    let is_chosen = choose(value, growths(), variant)
        || choose(value, [LeafKind::Sprays, LeafKind::Ellipsoids(Default::default())], variant)
        || choose(value, branchings(), variant)
        || choose(
            value,
            [Phyllotaxis::Spiral, Phyllotaxis::Alternate, Phyllotaxis::Opposite, Phyllotaxis::Whorled(3)],
            variant,
        );
    is_chosen.then_some(changed)
}

/// Gives a value the variant of that name, if it is of this type.
fn choose<T: Reflect + Enum>(value: &mut dyn PartialReflect, all: impl IntoIterator<Item = T>, variant: &str) -> bool {
    let Some(own) = value.try_downcast_mut::<T>() else { return false };
    let chosen = all.into_iter().find(|one| one.variant_name() == variant);
    chosen.map(|chosen| *own = chosen).is_some()
}

/// Every model of growth, with its default settings.
fn growths() -> [Growth; 6] {
    [
        Growth::ReevesBlau(Default::default()),
        Growth::Oak(Default::default()),
        Growth::Fir(Default::default()),
        Growth::AonoKunii(Default::default()),
        Growth::Impressionist(Default::default()),
        Growth::Gardner(Default::default()),
    ]
}

/// Every branching of a structural tree. Only the first has defaults of its own: the shoots of the others are alike.
fn branchings() -> [Branching; 3] {
    let shoot = Shoot::default();
    [
        Branching::default(),
        Branching::Dichotomous { shoots: [shoot; 2], turn_deg: 90.0 },
        Branching::Ternary { shoot, turns_deg: [120.0; 2] },
    ]
}

/// A species whose list at a path has one more item like the last, or one less. None where it cannot.
pub fn with_list(species: &Species, path: &str, is_longer: bool) -> Option<Species> {
    let mut changed = species.clone();
    let ReflectMut::List(list) = changed.reflect_path_mut(path).ok()?.reflect_mut() else { return None };
    if is_longer {
        match list.get(list.len().saturating_sub(1)).map(PartialReflect::to_dynamic) {
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
        let mut chosen = 0;
        for growth in growths() {
            let species = Species { growth, ..species.clone() };
            let table = fields_of(&species, Species::validate);
            for field in all_fields(&table) {
                let Kind::Choice(choices) = &field.kind else { continue };
                if choices.iter().all(|choice| !choice.has_settings) {
                    continue;
                }
                for choice in choices {
                    let changed = with_variant(&species, &field.path, choice.name);
                    let changed = changed.unwrap_or_else(|| panic!("{}: {}", field.path, choice.name));
                    assert!(changed.validate().is_ok(), "{}: {}", field.path, choice.name);
                    chosen += 1;
                }
            }
        }
        // Six times models and kinds of leaves; branchings and arrangements of the structural tree.
        assert_eq!(chosen, 6 * (6 + 2) + 3 + 4);
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
