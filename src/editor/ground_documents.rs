//! Random ground and ground formed by control points as something that is edited.

use bevy::reflect::PartialReflect;

use super::{
    document::Document,
    field_table::fields_of,
    fields::{Row, Section},
    variants::choose_of,
};
use crate::{
    ron_text::from_ron,
    setting::SettingError,
    terrain::{CovarianceModel, SplineGroundSettings, SplinePatch, TerrainError, TurningBandsSettings},
};

impl Document for TurningBandsSettings {
    const EXTENSION: &'static str = ".bands.ron";
    const NAME: &'static str = "random ground";

    fn read(text: &str) -> Result<Self, String> {
        let settings: Self = from_ron(text).map_err(|error| error.to_string())?;
        settings.check()?;
        Ok(settings)
    }

    fn check(&self) -> Result<(), String> {
        self.validate().map_err(|error| error.to_string())
    }

    fn table(&self) -> Section {
        fields_of(self, Self::validate)
    }

    fn default_of_kind(&self) -> Self {
        let usual = CovarianceModel::ALL.into_iter().find(|usual| usual.name() == self.model.name());
        Self { model: usual.unwrap_or_default(), ..Self::default() }
    }

    fn choose(value: &mut dyn PartialReflect, variant: &str) -> bool {
        choose_of(value, CovarianceModel::ALL, variant)
    }
}

impl Document for SplineGroundSettings {
    const EXTENSION: &'static str = ".ground.ron";
    const NAME: &'static str = "ground of control points";

    fn read(text: &str) -> Result<Self, String> {
        Self::from_ron(text).map_err(|error| error.to_string())
    }

    fn check(&self) -> Result<(), String> {
        self.validate().map_err(|error| error.to_string())
    }

    /// Its lattice. Patches have tables of their own, and points are dragged.
    fn table(&self) -> Section {
        let bare = Self { patches: Vec::new(), ..self.clone() };
        let mut table = fields_of(&bare, |settings| settings.validate().map_err(setting_error));
        table.rows.retain(|row| matches!(row, Row::Field(_)));
        table
    }

    fn default_of_kind(&self) -> Self {
        Self { patches: vec![SplinePatch::default(); self.patches.len()], ..Self::default() }
    }

    fn choose(_value: &mut dyn PartialReflect, _variant: &str) -> bool {
        false
    }
}

fn setting_error(error: TerrainError) -> SettingError {
    match error {
        TerrainError::Setting(error) => error,
        other => SettingError::new("patches", "wrong", other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::{
        document_file::DocumentFile,
        fields::{Kind, all_fields},
        variants::with_variant,
    };

    const FIVE: &str = include_str!("../../assets/terrain/five_patches.ground.ron");

    #[test]
    fn every_model_can_be_chosen_and_every_number_has_its_range() {
        let settings = TurningBandsSettings::default();
        for model in CovarianceModel::ALL {
            let variant = format!("{model:?}");
            let variant = variant.split(' ').next().unwrap();
            assert_eq!(with_variant(&settings, "model", variant).unwrap().model, model);
        }
        let table = settings.table();
        for field in all_fields(&table) {
            let is_number = matches!(field.kind, Kind::Number | Kind::Whole);
            assert!(!is_number || field.range.is_some(), "{}", field.name);
        }
    }

    #[test]
    fn a_field_is_written_and_read_again_and_bad_ones_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hills.bands.ron");
        let model = CovarianceModel::Fractal { dimension: 2.3 };
        let settings = TurningBandsSettings { model, seed: 9, ..Default::default() };
        DocumentFile::new(&path, settings.clone()).save(&settings, None).unwrap();
        assert_eq!(DocumentFile::<TurningBandsSettings>::open(&path).unwrap().document, settings);
        assert!(TurningBandsSettings::read("(lines: 1)").unwrap_err().starts_with("`lines` is 1"));
        assert!(TurningBandsSettings::read("(lnes: 1)").unwrap_err().contains("lnes"));
    }

    #[test]
    fn a_moved_control_point_changes_its_number_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("five.ground.ron");
        std::fs::write(&path, FIVE).unwrap();
        let file = DocumentFile::<SplineGroundSettings>::open(&path).unwrap();
        let mut changed = file.document.clone();
        changed.patches[0].heights_m[3] = 25.5;
        let merged = file.text_of(&changed).unwrap();
        assert_eq!((merged.text, merged.loses_comments), (FIVE.replacen("24.0", "25.5", 1), false));
        let names: Vec<_> = all_fields(&changed.table()).into_iter().map(|field| field.name.clone()).collect();
        assert_eq!(names, ["cell_x_m", "cell_z_m", "west_m", "north_m", "base_m"]);
    }
}
