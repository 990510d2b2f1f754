//! The plan of a forest as something that is edited.

use bevy::reflect::PartialReflect;

use super::{
    document::Document,
    field_table::fields_of,
    fields::{Row, Section},
    variants::choose_of,
};
use crate::{
    scatter::{
        ForestPlan,
        counts::CountModel,
        plan::{Area, Shape, Stock},
    },
    setting::SettingError,
};

impl Document for ForestPlan {
    const EXTENSION: &'static str = ".forest.ron";
    const NAME: &'static str = "forest plan";

    fn read(text: &str) -> Result<Self, String> {
        Self::from_ron(text).map_err(|error| error.to_string())
    }

    fn check(&self) -> Result<(), String> {
        self.validate().map_err(|error| error.to_string())
    }

    /// Its seed and cells. Areas have [tables of their own](area_table).
    fn table(&self) -> Section {
        let bare = Self { areas: Vec::new(), keep_out: Vec::new(), ..self.clone() };
        let mut table = fields_of(&bare, Self::validate);
        table.rows.retain(|row| matches!(row, Row::Field(_)));
        table
    }

    fn default_of_kind(&self) -> Self {
        let area = |area: &Area| Area {
            stock: vec![Stock::default(); area.stock.len()],
            pattern: default_pattern(area.pattern),
            ..Area::default()
        };
        Self { areas: self.areas.iter().map(area).collect(), ..Self::default() }
    }

    fn choose(value: &mut dyn PartialReflect, variant: &str) -> bool {
        choose_of(value, patterns(), variant)
    }
}

/// The table of an area's fields, without its outline.
pub fn area_table(plan: &ForestPlan, number: usize) -> Option<Section> {
    let path = format!("areas[{number}]");
    // The range of a field is asked of a plan with nothing else: a large one would have to be checked for each.
    let alone = |area: &Area| ForestPlan { cell_m: plan.cell_m, areas: vec![area.clone()], ..ForestPlan::default() };
    let check = |area: &Area| {
        alone(area).validate().map_err(|error| SettingError { field: error.field.replace("areas[0].", ""), ..error })
    };
    let area = Area { shape: Shape::default(), ..plan.areas.get(number)?.clone() };
    let mut table = fields_of(&area, check);
    table.rows.retain(|row| match row {
        Row::Field(field) => !field.path.starts_with("shape"),
        Row::Section(section) => !section.path.starts_with("shape"),
    });
    Some(table.inside(&path))
}

/// The same law with its usual parameters.
fn default_pattern(pattern: CountModel) -> CountModel {
    patterns().into_iter().find(|usual| usual.kind() == pattern.kind()).unwrap_or_default()
}

/// Each law, with parameters with which what it does is plainly seen.
fn patterns() -> [CountModel; 6] {
    [
        CountModel::Poisson,
        CountModel::Binomial { n: 4 },
        CountModel::NegativeBinomial { k: 1.5 },
        CountModel::PoissonPoisson { clump: 3.0 },
        CountModel::PoissonBinomial { n: 6, p: 0.5 },
        CountModel::PoissonNegativeBinomial { k: 1.0, p: 1.5 },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::{
        fields::{Kind, all_fields},
        variants::{with_list, with_variant},
    };

    const MIXED: &str = include_str!("../../assets/forests/mixed.forest.ron");

    fn mixed() -> ForestPlan {
        ForestPlan::from_ron(MIXED).unwrap()
    }

    #[test]
    fn every_field_of_an_area_but_its_outline_has_its_range() {
        let plan = mixed();
        let table = area_table(&plan, 2).unwrap();
        let fields = all_fields(&table);
        let find = |name: &str| {
            let name = format!("areas[2].{name}");
            fields.iter().find(|field| field.name == name).copied().unwrap_or_else(|| panic!("no {name}"))
        };
        assert_eq!(find("density_per_ha").range, Some(0.001..=100_000.0));
        assert_eq!(find("stock[1].age_years").range, Some(0.1..=10_000.0));
        assert_eq!(find("stock[1].season_offset_days").range, Some(-120.0..=120.0));
        assert_eq!(find("pattern.clump").range, Some(0.001..=100.0));
        assert!(matches!(find("pattern").kind, Kind::Choice(_)));
        assert!(fields.iter().all(|field| !field.path.contains("shape")));
        assert_eq!(area_table(&plan, 3), None);
        let whole: Vec<_> = all_fields(&plan.table()).into_iter().map(|field| field.name.clone()).collect();
        assert_eq!(whole, ["seed", "cell_m"]);
    }

    #[test]
    fn every_law_can_be_chosen_and_species_come_and_go() {
        let plan = mixed();
        for law in ["Poisson", "Binomial", "NegativeBinomial", "PoissonPoisson", "PoissonBinomial"] {
            let changed = with_variant(&plan, "areas[0].pattern", law).unwrap();
            assert!(changed.validate().is_ok(), "{law}: {:?}", changed.validate());
        }
        let longer = with_list(&plan, "areas[0].stock", true).unwrap();
        assert_eq!((longer.areas[0].stock.len(), longer.areas[0].stock[2].species.as_str()), (3, "oak"));
        assert_eq!(plan.default_of_kind().areas[0].pattern, CountModel::NegativeBinomial { k: 1.5 });
    }
}
