//! A species: the settings from which all individuals of one kind of tree grow.
//!
//! A species is written in RON, every field with its unit in its name; what is left out takes the default, which is
//! a pedunculate oak. Sizes are those of the mature tree: [`Age`] says when that is and how the tree gets there.
//! [`Species::from_ron`] refuses what does not make a tree and says which field, which value and
//! what is allowed, so that a typing error in a file is found at once.

use bevy::{asset::Asset, reflect::Reflect};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{
    bark::Bark,
    foliage::Foliage,
    generator::Growth,
    green_wood::GreenWood,
    growth::{age::Age, damage::Damage, reeves_blau::ReevesBlau},
    leaf::LeafKind,
    phenology::Phenology,
};
use crate::{
    ron_loader::RonAsset,
    ron_text::{SyntaxError, from_ron},
    setting::{SettingError, require},
};

/// One kind of tree.
#[derive(Asset, Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Species {
    /// What the species is called.
    pub name: String,
    /// Number of different individuals that a forest of this species repeats, 1 to 16.
    pub variants: u32,
    /// Another seed is another set of individuals of the same kind.
    pub seed: u64,
    /// How the skeleton grows.
    pub growth: Growth,
    /// How it ages; the sizes written in `growth` are those at its `mature_years`.
    pub age: Age,
    /// What wind and rot have broken.
    pub damage: Damage,
    /// What its beams are made of.
    pub wood: Wood,
    /// What it carries.
    pub foliage: Foliage,
    /// What its leaves do over the year.
    pub phenology: Phenology,
}

impl Default for Species {
    fn default() -> Self {
        Self {
            name: "oak".into(),
            variants: 4,
            seed: 0,
            growth: Growth::ReevesBlau(ReevesBlau::default()),
            age: Age::default(),
            damage: Damage::default(),
            wood: Wood::default(),
            foliage: Foliage::default(),
            phenology: Phenology::default(),
        }
    }
}

/// Green wood: what decides how fast a beam swings.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wood {
    /// Young's modulus along the grain, Pa: 1e8 to 1e11.
    pub young_modulus_pa: f32,
    /// Density of the living wood, water and all, kg/m^3: 100 to 2000.
    pub density_kg_m3: f32,
    /// How the drag of the bare tree falls with the wind's speed: it grows with the speed to the power 2 + this, -1 to 0. Bare
    /// oaks: 1.9 to 2.0 (Angelou et al. 2019).
    pub drag_exponent: f32,
    /// Its bark.
    pub bark: Bark,
    /// Its smallest branches, which may be green instead.
    pub green: GreenWood,
}

impl Default for Wood {
    /// Green oak: Young's modulus and density after the Wood Handbook (Forest Products Laboratory, 2010, table 5-3:
    /// white oak, green).
    fn default() -> Self {
        Self {
            young_modulus_pa: 8.6e9,
            density_kg_m3: 1000.0,
            drag_exponent: -0.05,
            bark: Bark::default(),
            green: GreenWood::default(),
        }
    }
}

impl Wood {
    fn validate(&self) -> Result<(), SettingError> {
        require("young_modulus_pa", self.young_modulus_pa, 1.0e8..=1.0e11)?;
        require("density_kg_m3", self.density_kg_m3, 100.0..=2000.0)?;
        require("drag_exponent", self.drag_exponent, -1.0..=0.0)?;
        self.bark.validate().map_err(|error| error.inside("bark"))?;
        self.green.validate().map_err(|error| error.inside("green"))
    }
}

impl Species {
    /// Largest number of individuals per species: each is a set of meshes of its own.
    pub const VARIANTS_LIMIT: u32 = 16;

    /// Reads and checks a species.
    ///
    /// # Errors
    /// [`SpeciesError::Syntax`] with line and column where `text` is no RON of a species, [`SpeciesError::Setting`]
    /// where it is one but does not make a tree.
    pub fn from_ron(text: &str) -> Result<Self, SpeciesError> {
        let species: Self = from_ron(text)?;
        species.validate()?;
        Ok(species)
    }

    /// Whether its foliage is ellipsoids, which grow translucent towards their outline.
    #[must_use]
    pub fn has_ellipsoids(&self) -> bool {
        match &self.growth {
            Growth::Gardner(_) => true,
            Growth::Impressionist(_) => false,
            Growth::ReevesBlau(_) | Growth::Oak(_) | Growth::Fir(_) | Growth::AonoKunii(_) => {
                matches!(self.foliage.kind, LeafKind::Ellipsoids(_))
            }
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`SettingError`] for the first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        if !(1..=Self::VARIANTS_LIMIT).contains(&self.variants) {
            return Err(SettingError::new("variants", self.variants, "1 to 16"));
        }
        self.growth.validate().map_err(|error| error.inside("growth"))?;
        self.age.validate().map_err(|error| error.inside("age"))?;
        self.damage.validate().map_err(|error| error.inside("damage"))?;
        self.wood.validate().map_err(|error| error.inside("wood"))?;
        self.foliage.validate().map_err(|error| error.inside("foliage"))?;
        self.phenology.validate().map_err(|error| error.inside("phenology"))
    }
}

impl RonAsset for Species {
    type Error = SpeciesError;

    const EXTENSIONS: &'static [&'static str] = &["species.ron"];

    fn read(text: &str) -> Result<Self, SpeciesError> {
        Self::from_ron(text)
    }
}

/// Why a species was refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum SpeciesError {
    /// The text is not the RON of a species.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// A field, named by its path such as `growth.trunk.height_m`, is outside its domain.
    #[error(transparent)]
    Setting(#[from] SettingError),
}

#[cfg(test)]
mod tests {
    use super::*;

    const OAK: &str = include_str!("../../assets/species/oak.species.ron");
    const FIR: &str = include_str!("../../assets/species/fir.species.ron");

    const ZAHARIA_OAK: &str = include_str!("../../assets/species/zaharia_oak.species.ron");
    const ZAHARIA_FIR: &str = include_str!("../../assets/species/zaharia_fir.species.ron");
    const STRUCTURAL: &str = include_str!("../../assets/species/aono_kunii.species.ron");

    #[test]
    fn the_shipped_species_are_valid() {
        assert_eq!(Species::from_ron(OAK).unwrap().name, "oak");
        assert_eq!(Species::from_ron(FIR).unwrap().name, "fir");
        for example in [ZAHARIA_OAK, ZAHARIA_FIR, STRUCTURAL] {
            assert!(!matches!(Species::from_ron(example).unwrap().growth, Growth::ReevesBlau(_)));
        }
        Species::default().validate().unwrap();
    }

    #[test]
    fn a_species_reads_back_what_it_writes() {
        let fir = Species::from_ron(FIR).unwrap();
        let written = ron::to_string(&fir).unwrap();
        // Written without the extension, a variant's struct keeps its own parentheses.
        let read: Species = ron::from_str(&written).unwrap();
        assert_eq!(read, fir);
    }

    #[test]
    fn a_value_out_of_range_is_named_with_its_path() {
        let broken = OAK.replace("height_m: 8.5", "height_m: -3.0");
        let error = Species::from_ron(&broken).unwrap_err();
        assert_eq!(error.to_string(), "`growth.trunk.height_m` is -3, but must be 0.5 to 17.2");
    }

    #[test]
    fn a_value_in_a_list_is_named_with_its_index() {
        let mut species = Species::default();
        let mut growth = ReevesBlau::default();
        growth.orders[1].spacing_m = f32::NAN;
        species.growth = Growth::ReevesBlau(growth);
        let error = species.validate().unwrap_err().to_string();
        assert!(error.starts_with("`growth.orders[1].spacing_m` is NaN"), "{error}");
    }

    #[test]
    fn too_many_variants_are_refused() {
        let species = Species { variants: 17, ..Species::default() };
        assert_eq!(species.validate().unwrap_err().to_string(), "`variants` is 17, but must be 1 to 16");
    }

    #[test]
    fn a_misspelt_field_is_reported_with_line_and_name() {
        let Err(SpeciesError::Syntax(SyntaxError { line, message, .. })) =
            Species::from_ron("(\n  name: \"oak\",\n  wod: (),\n)")
        else {
            panic!("an unknown field must be a syntax error")
        };
        assert_eq!(line, 3);
        assert!(message.contains("wod"), "{message}");
    }
}
