//! A species as something that is edited.

use bevy::reflect::PartialReflect;

use super::{document::Document, field_table::fields_of, fields::Section, variants::choose_of};
use crate::tree::{
    Growth, Species,
    growth::{
        Phyllotaxis,
        aono_kunii::{Branching, Shoot},
    },
    leaf::LeafKind,
};

impl Document for Species {
    const EXTENSION: &'static str = ".species.ron";
    const NAME: &'static str = "species";

    fn read(text: &str) -> Result<Self, String> {
        Self::from_ron(text).map_err(|error| error.to_string())
    }

    fn check(&self) -> Result<(), String> {
        self.validate().map_err(|error| error.to_string())
    }

    fn table(&self) -> Section {
        fields_of(self, Self::validate)
    }

    fn default_of_kind(&self) -> Self {
        Self { growth: default_growth(&self.growth), ..Self::default() }
    }

    fn choose(value: &mut dyn PartialReflect, variant: &str) -> bool {
        choose_of(value, growths(), variant)
            || choose_of(value, [LeafKind::Sprays, LeafKind::Ellipsoids(Default::default())], variant)
            || choose_of(value, branchings(), variant)
            || choose_of(
                value,
                [Phyllotaxis::Spiral, Phyllotaxis::Alternate, Phyllotaxis::Opposite, Phyllotaxis::Whorled(3)],
                variant,
            )
    }
}

/// The same model of growth with its default settings.
fn default_growth(growth: &Growth) -> Growth {
    match growth {
        Growth::ReevesBlau(_) => Growth::ReevesBlau(Default::default()),
        Growth::Oak(_) => Growth::Oak(Default::default()),
        Growth::Fir(_) => Growth::Fir(Default::default()),
        Growth::AonoKunii(_) => Growth::AonoKunii(Default::default()),
        Growth::Impressionist(_) => Growth::Impressionist(Default::default()),
        Growth::Gardner(_) => Growth::Gardner(Default::default()),
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::{
        fields::{Kind, all_fields},
        variants::{with_list, with_variant},
    };

    #[test]
    fn every_variant_that_the_table_offers_can_be_chosen() {
        let species = Species::default();
        let mut chosen = 0;
        for growth in growths() {
            let species = Species { growth, ..species.clone() };
            let table = species.table();
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
