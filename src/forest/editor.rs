//! Changes forests, and refuses what cannot be.

use super::{
    cells::ForestCells,
    changes::{ForestChanges, NewStem},
    stem_id::StemId,
    stems::StandingStem,
};
use crate::{ground::Ground, setting::SettingError};
use bevy::{ecs::system::SystemParam, prelude::*};

/// Changes the [`ForestChanges`] of forests. Other than these it knows what stands, and refuses with a message what has no effect: then
/// nothing changes.
#[derive(SystemParam)]
pub struct ForestEditor<'w, 's> {
    forests: Query<'w, 's, (Entity, &'static ForestCells, &'static mut ForestChanges)>,
}

impl ForestEditor<'_, '_> {
    /// The stem of any forest that is nearest to a place (x, z), within a radius, m.
    #[must_use]
    pub fn nearest(&self, place_m: Vec2, radius_m: f32) -> Option<(Entity, StandingStem)> {
        let distance_m = |stem: &StandingStem| stem.plant.position.xz().distance(place_m);
        let found = self.forests.iter().filter_map(|(forest, cells, changes)| {
            let stem = cells.nearest_stem(place_m, radius_m)?;
            (!changes.is_felled(stem.id)).then_some((forest, stem))
        });
        found.min_by(|(_, a), (_, b)| distance_m(a).total_cmp(&distance_m(b)))
    }

    /// Fells a stem of a forest.
    ///
    /// # Errors
    /// Where there is no such forest, or the stem does not stand.
    pub fn fell(&mut self, forest: Entity, id: StemId) -> Result<(), SettingError> {
        self.standing(forest, id)?.fell(id)
    }

    /// Plants a stem in a forest, and returns its id.
    ///
    /// # Errors
    /// Where there is no such forest, a number is outside its domain, there is no ground, or the plan does not have the species.
    pub fn plant(&mut self, forest: Entity, stem: &NewStem) -> Result<StemId, SettingError> {
        let (cells, mut changes) = self.forest(forest)?;
        require_species(cells, &stem.species)?;
        if !cells.ground.height_m(stem.place_m.as_dvec2()).is_finite() {
            return Err(SettingError::new("place_m", stem.place_m, "a place that has ground"));
        }
        changes.plant(stem)
    }

    /// Gives a stem of a forest another age, years, 0.1 to 10000.
    ///
    /// # Errors
    /// Where there is no such forest, the stem does not stand, or the age is outside its domain.
    pub fn set_age(&mut self, forest: Entity, id: StemId, years: f32) -> Result<(), SettingError> {
        self.standing(forest, id)?.set_age(id, years)
    }

    /// Makes a stem of a forest one of another species.
    ///
    /// # Errors
    /// Where there is no such forest, the stem does not stand, or the plan does not have the species.
    pub fn set_species(&mut self, forest: Entity, id: StemId, species: &str) -> Result<(), SettingError> {
        require_species(self.forest(forest)?.0, species)?;
        self.standing(forest, id)?.set_species(id, species)
    }

    /// Takes back all that was changed with a stem of a forest's plan: it stands again.
    ///
    /// # Errors
    /// Where there is no such forest, or nothing was changed with the stem.
    pub fn restore(&mut self, forest: Entity, id: StemId) -> Result<(), SettingError> {
        self.forest(forest)?.1.restore(id)
    }

    fn forest(&mut self, forest: Entity) -> Result<(&ForestCells, Mut<'_, ForestChanges>), SettingError> {
        let found = self.forests.get_mut(forest).map(|(_, cells, changes)| (cells, changes));
        found.map_err(|_| SettingError::new("forest", forest, "a forest whose plan is loaded"))
    }

    /// The changes of a forest in which a stem stands.
    fn standing(&mut self, forest: Entity, id: StemId) -> Result<Mut<'_, ForestChanges>, SettingError> {
        let (cells, changes) = self.forest(forest)?;
        // The cells do not know yet what was done in this frame.
        let stands = match id.place_m() {
            Some(place_m) => !changes.is_felled(id) && cells.plan_grows(place_m),
            None => changes.planted_stem(id).is_some(),
        };
        stands.then_some(changes).ok_or_else(|| SettingError::new("id", id, "a stem of the forest that stands"))
    }
}

/// Refuses a species that the plan does not have.
fn require_species(cells: &ForestCells, species: &str) -> Result<(), SettingError> {
    if cells.planter().species().iter().any(|name| name == species) {
        return Ok(());
    }
    Err(SettingError::new("species", format!("`{species}`"), "a species of the plan (see `more_species`)"))
}
