//! What a game has changed in a forest.

use super::{journal::Journal, stem_id::StemId};
use crate::setting::{SettingError, require};
use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Different species that may be named.
const MOST_SPECIES: usize = 256;
/// Ages that stems may have, years: those of a plan.
const AGES: std::ops::RangeInclusive<f32> = 0.1..=1e4;
/// How far from the origin a plan may reach, m.
const FARTHEST_M: f32 = 1e5;

/// The difference between a [`Forest`](super::Forest) and its plan: which stems are felled, aged, of another species, or planted. It is a
/// component of the forest, which is there from the start.
///
/// It is all that has to be saved of a forest: it is written and read by `serde`, and cells that come are planted after it. A change shows
/// in the next frame where its stem is near; otherwise as soon as the stem's cells have been planted again in the background. No frame takes
/// longer for changes that have been made before.
///
/// The methods check numbers alone. [`ForestEditor`](super::ForestEditor) also refuses stems that do not stand, and species that the plan
/// does not have. Here these have no effect, until the plan has them.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Serialize, Deserialize)]
#[serde(try_from = "SavedChanges")]
pub struct ForestChanges {
    /// Names, to whose numbers the others refer.
    species: Vec<String>,
    stems: BTreeMap<StemId, StemChange>,
    planted: BTreeMap<StemId, PlantedStem>,
    planted_so_far: u32,
    #[serde(skip)]
    #[reflect(ignore)]
    pub(super) journal: Journal,
}

/// A stem to be planted.
#[derive(Clone, Debug, PartialEq)]
pub struct NewStem {
    /// Where (x, z), in the forest's own frame. units: m, domain: \[-100000, 100000\].
    pub place_m: Vec2,
    /// One of the plan's species, those among its `more_species`.
    pub species: String,
    /// units: years, domain: \[0.1, 10000\].
    pub age_years: f32,
}

/// What is other with a stem of the plan.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum StemChange {
    Felled,
    /// Its age in years, and the number of its species.
    Altered(Option<f32>, Option<u8>),
}

/// A stem that the game has planted: place (x, z) in m, age in years, number of the species.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PlantedStem(pub [f32; 2], pub f32, pub u8);

/// Changes as they are read, before they are checked.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
#[derive(Default)]
struct SavedChanges {
    species: Vec<String>,
    stems: BTreeMap<StemId, StemChange>,
    planted: BTreeMap<StemId, PlantedStem>,
    planted_so_far: u32,
}

impl TryFrom<SavedChanges> for ForestChanges {
    type Error = SettingError;

    fn try_from(saved: SavedChanges) -> Result<Self, SettingError> {
        let SavedChanges { species, stems, planted, planted_so_far } = saved;
        require("species.len()", species.len(), 0..=MOST_SPECIES)?;
        for (id, change) in &stems {
            let StemChange::Altered(age_years, number) = change else { continue };
            require_age(age_years.unwrap_or(1.0)).and_then(|()| require_number(*number, &species)).map_err(at(*id))?;
        }
        for (id, PlantedStem(place_m, age_years, number)) in &planted {
            if !id.is_planted() || *id > StemId::planted(planted_so_far) {
                return Err(SettingError::new("planted", id, format!("at most planted stem {planted_so_far}")));
            }
            let checked = require_place((*place_m).into()).and_then(|()| require_age(*age_years));
            checked.and_then(|()| require_number(Some(*number), &species)).map_err(at(*id))?;
        }
        Ok(Self { species, stems, planted, planted_so_far, journal: Journal::default() })
    }
}

fn at(id: StemId) -> impl FnOnce(SettingError) -> SettingError {
    move |error| error.inside(&id.to_string())
}

fn require_place(place_m: Vec2) -> Result<(), SettingError> {
    require("place_m.x", place_m.x, -FARTHEST_M..=FARTHEST_M)?;
    require("place_m.y", place_m.y, -FARTHEST_M..=FARTHEST_M)
}

fn require_age(age_years: f32) -> Result<(), SettingError> {
    require("age_years", age_years, AGES)
}

fn require_number(number: Option<u8>, species: &[String]) -> Result<(), SettingError> {
    match number {
        Some(number) if usize::from(number) >= species.len() => {
            Err(SettingError::new("species", number, "the number of a name in `species`"))
        }
        _ => Ok(()),
    }
}

impl ForestChanges {
    /// Fells a stem. One that is felled stays so. Of a stem that the game had planted, nothing remains.
    ///
    /// # Errors
    /// Where the game has planted no such stem.
    pub fn fell(&mut self, id: StemId) -> Result<(), SettingError> {
        let place_m = self.place_m(id)?;
        if id.is_planted() {
            self.planted.remove(&id);
        } else if self.stems.insert(id, StemChange::Felled) == Some(StemChange::Felled) {
            return Ok(());
        }
        self.journal.note_felled(id, place_m);
        Ok(())
    }

    /// Plants a stem, and returns its id. It stands beside whatever stands near, and only where there is ground.
    ///
    /// # Errors
    /// Where a number is outside its domain, the species has no name, or 256 others are named already.
    pub fn plant(&mut self, stem: &NewStem) -> Result<StemId, SettingError> {
        let NewStem { place_m, species, age_years } = stem;
        require_place(*place_m)?;
        require_age(*age_years)?;
        let number = self.species_number(species)?;
        let Some(planted_so_far) = self.planted_so_far.checked_add(1) else {
            return Err(SettingError::new("planted_so_far", self.planted_so_far, "fewer"));
        };
        self.planted_so_far = planted_so_far;
        let id = StemId::planted(planted_so_far);
        self.planted.insert(id, PlantedStem(place_m.to_array(), *age_years, number));
        self.journal.note(id, *place_m);
        Ok(id)
    }

    /// Gives a stem another age, years, 0.1 to 10000.
    ///
    /// # Errors
    /// Where the age is outside its domain, the stem is felled, or the game has planted no such stem.
    pub fn set_age(&mut self, id: StemId, years: f32) -> Result<(), SettingError> {
        require_age(years)?;
        self.alter(id, |age_years, _| *age_years = Some(years))
    }

    /// Makes a stem one of another species.
    ///
    /// # Errors
    /// Where the species has no name or 256 others are named already, the stem is felled, or the game has planted no such stem.
    pub fn set_species(&mut self, id: StemId, species: &str) -> Result<(), SettingError> {
        self.require_standing(id)?;
        let number = self.species_number(species)?;
        self.alter(id, |_, species| *species = Some(number))
    }

    /// Takes back all that was changed with a stem of the plan: it stands again.
    ///
    /// # Errors
    /// Where nothing was changed with it, or the game has planted it.
    pub fn restore(&mut self, id: StemId) -> Result<(), SettingError> {
        if self.stems.remove(&id).is_none() {
            return Err(SettingError::new("id", id, "a stem of the plan that was changed"));
        }
        self.journal.note(id, id.place_m().unwrap_or_default());
        Ok(())
    }

    /// Whether a stem of the plan is felled.
    #[must_use]
    pub fn is_felled(&self, id: StemId) -> bool {
        self.stems.get(&id) == Some(&StemChange::Felled)
    }

    /// The stems of the plan that are felled.
    pub fn felled(&self) -> impl Iterator<Item = StemId> {
        self.stems.iter().filter(|(_, change)| **change == StemChange::Felled).map(|(id, _)| *id)
    }

    /// The stems that the game has planted, as they stand now.
    pub fn planted(&self) -> impl Iterator<Item = (StemId, NewStem)> {
        self.planted.iter().map(|(id, PlantedStem(place_m, age_years, number))| {
            let species = self.species_name(*number).unwrap_or_default().to_owned();
            (*id, NewStem { place_m: Vec2::from(*place_m), species, age_years: *age_years })
        })
    }

    /// Number of stems that are not as the plan has them.
    #[must_use]
    pub fn len(&self) -> usize {
        self.stems.len() + self.planted.len()
    }

    /// Whether all is as the plan has it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What is other with a stem of the plan.
    pub(super) fn of_stem(&self, id: StemId) -> Option<StemChange> {
        self.stems.get(&id).copied()
    }

    /// A stem that the game has planted.
    pub(super) fn planted_stem(&self, id: StemId) -> Option<PlantedStem> {
        self.planted.get(&id).copied()
    }

    /// All stems that are changed or planted, and where.
    pub(super) fn places(&self) -> impl Iterator<Item = (StemId, Vec2)> {
        let changed = self.stems.keys().map(|id| (*id, id.place_m().unwrap_or_default()));
        changed.chain(self.planted.iter().map(|(id, stem)| (*id, stem.0.into())))
    }

    /// The name with a number.
    pub(super) fn species_name(&self, number: u8) -> Option<&str> {
        self.species.get(usize::from(number)).map(String::as_str)
    }

    fn alter(
        &mut self,
        id: StemId,
        change: impl FnOnce(&mut Option<f32>, &mut Option<u8>),
    ) -> Result<(), SettingError> {
        self.require_standing(id)?;
        let place_m = self.place_m(id)?;
        if let Some(PlantedStem(_, age_years, species)) = self.planted.get_mut(&id) {
            let (mut other_age, mut other_species) = (None, None);
            change(&mut other_age, &mut other_species);
            (*age_years, *species) = (other_age.unwrap_or(*age_years), other_species.unwrap_or(*species));
        } else if let StemChange::Altered(age_years, species) =
            self.stems.entry(id).or_insert(StemChange::Altered(None, None))
        {
            change(age_years, species);
        }
        self.journal.note(id, place_m);
        Ok(())
    }

    fn require_standing(&self, id: StemId) -> Result<(), SettingError> {
        if self.is_felled(id) {
            return Err(SettingError::new("id", id, "one that is not felled"));
        }
        self.place_m(id).map(|_| ())
    }

    /// Where a stem of the plan stands, or would stand, or one that was planted.
    pub(super) fn place_m(&self, id: StemId) -> Result<Vec2, SettingError> {
        let place_m = id.place_m().or_else(|| self.planted.get(&id).map(|stem| stem.0.into()));
        place_m.ok_or_else(|| SettingError::new("id", id, "a stem of the forest"))
    }

    fn species_number(&mut self, species: &str) -> Result<u8, SettingError> {
        if species.is_empty() {
            return Err(SettingError::new("species", "empty", "the name of a species"));
        }
        let number = self.species.iter().position(|name| name == species).unwrap_or(self.species.len());
        require("species.len()", number + 1, 1..=MOST_SPECIES)?;
        if number == self.species.len() {
            self.species.push(species.to_owned());
        }
        Ok(number as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plum(age_years: f32) -> NewStem {
        NewStem { place_m: Vec2::new(3.0, -4.5), species: "plum".into(), age_years }
    }

    fn changed() -> (ForestChanges, [StemId; 3]) {
        let mut changes = ForestChanges::default();
        let [felled, aged] = [Vec2::ONE, Vec2::new(-7.25, 12.0)].map(StemId::at);
        changes.fell(felled).unwrap();
        changes.set_age(aged, 12.5).unwrap();
        changes.set_species(aged, "larch").unwrap();
        let planted = changes.plant(&plum(3.0)).unwrap();
        (changes, [felled, aged, planted])
    }

    #[test]
    fn changes_come_back_from_text() {
        let (changes, _) = changed();
        let text = ron::to_string(&changes).unwrap();
        assert_eq!(ron::from_str::<ForestChanges>(&text).unwrap(), changes);
        assert_eq!(ron::from_str::<ForestChanges>("()").unwrap(), ForestChanges::default());
    }

    #[test]
    fn stems_are_felled_altered_planted_and_restored() {
        let (mut changes, [felled, aged, planted]) = changed();
        assert_eq!(changes.felled().collect::<Vec<_>>(), [felled]);
        assert_eq!(changes.of_stem(aged), Some(StemChange::Altered(Some(12.5), Some(0))));
        changes.set_species(planted, "larch").unwrap();
        changes.set_age(planted, 40.0).unwrap();
        let expected = NewStem { species: "larch".into(), ..plum(40.0) };
        assert_eq!(changes.planted().collect::<Vec<_>>(), [(planted, expected)]);
        changes.restore(felled).unwrap();
        changes.restore(aged).unwrap();
        changes.fell(planted).unwrap();
        assert!(changes.is_empty());
        assert_ne!(changes.plant(&plum(1.0)).unwrap(), planted, "a number is given once");
    }

    #[test]
    fn what_is_wrong_is_told_and_changes_nothing() {
        let (mut changes, [felled, _, planted]) = changed();
        let before = changes.clone();
        let none = StemId::planted(99);
        let nowhere = NewStem { place_m: Vec2::new(f32::NAN, 0.0), ..plum(1.0) };
        let nameless = NewStem { species: String::new(), ..plum(1.0) };
        for (result, message) in [
            (changes.plant(&nowhere).map(|_| ()), "`place_m.x` is NaN, but must be -100000 to 100000"),
            (changes.plant(&plum(f32::NAN)).map(|_| ()), "`age_years` is NaN, but must be 0.1 to 10000"),
            (changes.plant(&nameless).map(|_| ()), "`species` is empty, but must be the name of a species"),
            (changes.fell(none), "`id` is planted stem 99, but must be a stem of the forest"),
            (changes.set_age(felled, 3.0), "`id` is the stem at 1, 1, but must be one that is not felled"),
            (changes.set_age(planted, -1.0), "`age_years` is -1, but must be 0.1 to 10000"),
            (changes.set_species(none, "oak"), "`id` is planted stem 99, but must be a stem of the forest"),
            (changes.restore(planted), "`id` is planted stem 1, but must be a stem of the plan that was changed"),
        ] {
            assert_eq!(result.unwrap_err().to_string(), message);
        }
        assert_eq!(changes, before);
    }

    #[test]
    fn saved_changes_are_checked_when_they_are_read() {
        let (changes, [.., planted]) = changed();
        let text = ron::to_string(&changes).unwrap();
        for (right, wrong) in
            [(",3.0,1)", ",NaN,1)"), ("12.5", "-3.0"), ("[\"larch\",", "["), ("planted_so_far:1", "planted_so_far:0")]
        {
            assert!(text.contains(right), "{text}");
            assert!(ron::from_str::<ForestChanges>(&text.replacen(right, wrong, 1)).is_err(), "{wrong}");
        }
        assert!(ron::from_str::<ForestChanges>(&text.replace(&planted.to_bits().to_string(), "5")).is_err());
    }
}
