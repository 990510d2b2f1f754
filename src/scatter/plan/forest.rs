//! The plan of a forest and its areas.

use bevy::{asset::Asset, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{
    keep_out::KeepOut,
    shape::Shape,
    stock::{GroundLimits, Stock},
};
use crate::{
    ron_loader::RonAsset,
    ron_text::from_ron,
    scatter::{
        counts::law::{CountLaw, CountModel, GREATEST_MEAN},
        error::ScatterError,
    },
    setting::{SettingError, require},
};

const MOST_AREAS: usize = 10_000;
const MOST_KEPT_OUT: usize = 100_000;
const MOST_STOCK: usize = 64;
/// Species of one plan: their numbers are bytes.
pub(in crate::scatter) const MOST_SPECIES: usize = 256;
/// Ten plants a square metre: a thicket of saplings.
const DENSEST_PER_HA: f32 = 1e5;
const SPARSEST_PER_HA: f32 = 1e-3;
/// Plants that one cell may hold: 16 MiB when packed.
const MOST_IN_CELL: f32 = 1_048_576.0;
const LARGEST_QUADRAT_M: f32 = 1000.0;
/// Quadrats along a side of a cell.
const MOST_QUADRATS_IN_CELL: f32 = 512.0;
/// Random packing of discs stops at 0.547 of the ground, which is 0.70 / distance² (Feder 1980): beyond half of that most
/// plants would find no room.
const DENSEST_PACKING: f32 = 0.35;
const SQUARE_METRES_PER_HA: f32 = 1e4;

/// A forest, before it is planted.
#[derive(Asset, Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ForestPlan {
    /// Another seed is another forest of the same plan.
    pub seed: u64,
    /// Side of the square cells in which the forest is planted and drawn. The cells do not change what stands where.
    /// units: m, domain: \[8, 1024\].
    pub cell_m: f32,
    /// What grows where. Where areas overlap both are planted; where two plants are too near to each other, that of the
    /// earlier area stays. At most 10,000.
    pub areas: Vec<Area>,
    /// Where nothing grows. At most 100,000.
    pub keep_out: Vec<KeepOut>,
    /// Species that no area grows, but that may be planted. At most 256.
    pub more_species: Vec<String>,
}

impl Default for ForestPlan {
    fn default() -> Self {
        Self { seed: 0, cell_m: 64.0, areas: Vec::new(), keep_out: Vec::new(), more_species: Vec::new() }
    }
}

/// A piece of ground with one kind of growth.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Area {
    /// The area's name.
    pub name: String,
    /// Its outline on the map.
    pub shape: Shape,
    /// Plants per hectare (10,000 m²): 100 to 400 in a grown forest. domain: 0, or \[0.001, 100000\].
    pub density_per_ha: f32,
    /// How the plants cluster or keep apart.
    pub pattern: CountModel,
    /// Side of the quadrats, the scale of the pattern's clumps; 0 gives as many quadrats as plants, as the paper advises.
    /// units: m, domain: 0, or \[`cell_m` / 512, 1000\] with at most 500 plants in a quadrat.
    pub quadrat_m: f32,
    /// No two plants stand nearer than this, at the cost of some of them: of 160 a hectare 1% at 1.5 m, 7% at 3 m and a
    /// quarter at the greatest distance (of clumps more). units: m, domain: 0 to the quadrat's side, and at most the
    /// distance at which plants of this density just find room, sqrt(0.35 / plants per m²).
    pub least_distance_m: f32,
    /// Size of the drifts in which one species prevails. units: m, domain: 0 (none), or \[1, 10000\].
    pub drift_m: f32,
    /// Share of the plants that are of their drift's species. domain: \[0, 1\].
    pub drift_purity: f32,
    /// The ground on which it grows.
    pub ground: GroundLimits,
    /// The species, 1 to 64.
    pub stock: Vec<Stock>,
}

impl Default for Area {
    /// A hectare of one species.
    fn default() -> Self {
        Self {
            name: "wood".into(),
            shape: Shape::default(),
            density_per_ha: 160.0,
            pattern: CountModel::Poisson,
            quadrat_m: 0.0,
            least_distance_m: 1.5,
            drift_m: 0.0,
            drift_purity: 0.8,
            ground: GroundLimits::default(),
            stock: vec![Stock::default()],
        }
    }
}

impl ForestPlan {
    /// Reads and checks a plan.
    ///
    /// # Errors
    /// [`ScatterError::Syntax`] with line and column where `text` is no RON of a plan, [`ScatterError::Setting`]
    /// with the field where it is one that cannot be planted.
    pub fn from_ron(text: &str) -> Result<Self, ScatterError> {
        let plan: Self = from_ron(text)?;
        plan.validate()?;
        Ok(plan)
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`SettingError`] for the first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("cell_m", self.cell_m, 8.0..=1024.0)?;
        require("areas.len()", self.areas.len(), 0..=MOST_AREAS)?;
        require("keep_out.len()", self.keep_out.len(), 0..=MOST_KEPT_OUT)?;
        require("more_species.len()", self.more_species.len(), 0..=MOST_SPECIES)?;
        if let Some(index) = self.more_species.iter().position(String::is_empty) {
            return Err(SettingError::new(format!("more_species[{index}]"), "empty", "the name of a species"));
        }
        for (index, area) in self.areas.iter().enumerate() {
            area.validate(self.cell_m).map_err(|error| error.inside(&format!("areas[{index}]")))?;
        }
        for (index, keep_out) in self.keep_out.iter().enumerate() {
            keep_out.validate().map_err(|error| error.inside(&format!("keep_out[{index}]")))?;
        }
        Ok(())
    }
}

impl RonAsset for ForestPlan {
    type Error = ScatterError;

    const EXTENSIONS: &'static [&'static str] = &["forest.ron"];

    fn read(text: &str) -> Result<Self, ScatterError> {
        Self::from_ron(text)
    }
}

impl Area {
    fn validate(&self, cell_m: f32) -> Result<(), SettingError> {
        self.shape.validate().map_err(|error| error.inside("shape"))?;
        if self.density_per_ha != 0.0 {
            let densest = DENSEST_PER_HA.min(MOST_IN_CELL / (cell_m * cell_m) * SQUARE_METRES_PER_HA);
            require("density_per_ha", self.density_per_ha, SPARSEST_PER_HA..=densest)?;
        }
        if self.quadrat_m != 0.0 {
            require("quadrat_m", self.quadrat_m, cell_m / MOST_QUADRATS_IN_CELL..=LARGEST_QUADRAT_M)?;
        }
        if self.drift_m != 0.0 {
            require("drift_m", self.drift_m, 1.0..=1e4)?;
        }
        require("drift_purity", self.drift_purity, 0.0..=1.0)?;
        self.ground.validate().map_err(|error| error.inside("ground"))?;
        require("stock.len()", self.stock.len(), 1..=MOST_STOCK)?;
        for (index, stock) in self.stock.iter().enumerate() {
            stock.validate().map_err(|error| error.inside(&format!("stock[{index}]")))?;
        }
        require("stock.share.sum()", self.stock.iter().map(|stock| stock.share).sum::<f32>(), 1e-6..=1e9)?;
        self.validate_pattern()
    }

    fn validate_pattern(&self) -> Result<(), SettingError> {
        if self.density_per_ha == 0.0 {
            return self.pattern.validate().map_err(|error| error.inside("pattern"));
        }
        if self.plants_in_quadrat() > GREATEST_MEAN {
            let most = (GREATEST_MEAN / f64::from(self.density_per_m2())).sqrt();
            return Err(SettingError::new(
                "quadrat_m",
                self.quadrat_side_m(),
                format!("at most {most:.3} with {} plants per hectare", self.density_per_ha),
            ));
        }
        let widest = (DENSEST_PACKING / self.density_per_m2()).sqrt().min(self.quadrat_side_m());
        require("least_distance_m", self.least_distance_m, 0.0..=widest)?;
        self.law().map(|_| ()).map_err(|error| error.inside("pattern"))
    }

    fn density_per_m2(&self) -> f32 {
        self.density_per_ha / SQUARE_METRES_PER_HA
    }

    fn plants_in_quadrat(&self) -> f64 {
        f64::from(self.density_per_m2()) * f64::from(self.quadrat_side_m()).powi(2)
    }

    /// Side of a quadrat, m: chosen, or so that it holds one plant on average.
    #[must_use]
    pub fn quadrat_side_m(&self) -> f32 {
        if self.quadrat_m > 0.0 { self.quadrat_m } else { (1.0 / self.density_per_m2().sqrt()).min(LARGEST_QUADRAT_M) }
    }

    /// The law of the number of plants in a quadrat.
    ///
    /// # Errors
    /// [`SettingError`] where nothing grows, or the pattern is not possible at this density.
    pub fn law(&self) -> Result<CountLaw, SettingError> {
        self.pattern.with_mean(self.plants_in_quadrat())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ron_text::SyntaxError;

    const MIXED: &str = include_str!("../../../assets/forests/mixed.forest.ron");

    fn error(change: impl Fn(&mut Area)) -> String {
        let mut plan = ForestPlan { areas: vec![Area::default()], ..Default::default() };
        change(&mut plan.areas[0]);
        plan.validate().unwrap_err().to_string()
    }

    #[test]
    fn shipped_forest_is_valid_and_round_trips_through_ron() {
        let plan = ForestPlan::from_ron(MIXED).unwrap();
        assert!(plan.areas.len() > 1 && plan.keep_out.len() > 1);
        let written = ron::to_string(&plan).unwrap();
        assert_eq!(ron::from_str::<ForestPlan>(&written).unwrap(), plan);
        ForestPlan { areas: vec![Area::default()], ..Default::default() }.validate().unwrap();
    }

    #[test]
    fn a_value_out_of_range_is_named_with_its_path() {
        assert_eq!(
            error(|area| area.density_per_ha = 1e10),
            "`areas[0].density_per_ha` is 10000000000, but must be 0.001 to 100000"
        );
        assert!(error(|area| area.stock[0].share = f32::NAN).starts_with("`areas[0].stock[0].share` is NaN"));
        assert!(error(|area| area.stock.clear()).starts_with("`areas[0].stock.len()` is 0"));
        assert!(error(|area| area.stock[0].share = 0.0).starts_with("`areas[0].stock.share.sum()` is 0"));
        assert!(
            error(|area| area.pattern = CountModel::NegativeBinomial { k: -2.0 }).starts_with("`areas[0].pattern.k`")
        );
        assert!(error(|area| area.quadrat_m = 900.0).starts_with("`areas[0].quadrat_m` is 900, but must be at most"));
        assert!(error(|area| area.quadrat_m = f32::NAN).starts_with("`areas[0].quadrat_m` is NaN"));
        assert!(error(|area| area.least_distance_m = 5.0).starts_with("`areas[0].least_distance_m` is 5"));
        assert!(error(|area| area.ground.steepest_deg = -1.0).starts_with("`areas[0].ground.steepest_deg` is -1"));
        let nameless = ForestPlan { more_species: vec!["apple".into(), String::new()], ..Default::default() };
        assert!(nameless.validate().unwrap_err().to_string().starts_with("`more_species[1]` is empty"));
    }

    #[test]
    fn more_plants_than_a_cell_may_hold_are_refused() {
        let mut plan = ForestPlan { cell_m: 1024.0, areas: vec![Area::default()], ..Default::default() };
        plan.areas[0].density_per_ha = 50_000.0;
        assert!(plan.validate().unwrap_err().to_string().starts_with("`areas[0].density_per_ha` is 50000"));
    }

    #[test]
    fn an_unknown_field_is_reported_with_line_and_name() {
        let text = "(\n areas: [(\n  densty_per_ha: 3,\n )],\n)";
        let Err(ScatterError::Syntax(SyntaxError { line, message, .. })) = ForestPlan::from_ron(text) else {
            panic!("an unknown field must be a syntax error")
        };
        assert_eq!(line, 3);
        assert!(message.contains("densty_per_ha"), "{message}");
    }
}
