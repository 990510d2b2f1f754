//! A species that is edited: its file, its history, and what has to be asked before anything is lost.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{
    fields::{Field, Section, all_fields, copy_at, fields_of, is_same_at},
    history::History,
    randomise::randomised,
    species_file::{FileError, OnDisk, SpeciesFile},
};
use crate::tree::{Growth, Species};

/// Trees of one stand differ by about this share in each measure.
pub const NATURAL_SPREAD: f64 = 0.1;

/// A species that is edited.
pub struct Session {
    file: SpeciesFile,
    history: History<Species>,
    table: Arc<Section>,
    table_of: Species,
    /// What the last action did, or why it could not.
    pub message: Option<Message>,
    /// What has to be answered before anything else.
    pub question: Option<Question>,
    /// Whether randomising leaves the seed of the individuals.
    pub is_seed_locked: bool,
    /// How often it was randomised: each time with another seed.
    randomisations: u64,
    on_disk: OnDisk,
    /// The species that was last kept against a crash.
    kept: Option<Species>,
}

/// What is told about an action.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    Done(String),
    Failed(String),
}

/// What has to be answered before anything is lost.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// There are unsaved changes; what follows would lose them.
    Unsaved(Intent),
    /// Saving would lose comments of the file.
    LoseComments,
    /// The file was changed by another program since it was read.
    Overwrite,
    /// Work of a session that ended without saving.
    Restore(Box<Species>),
}

/// What follows once changes are saved or given up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Intent {
    Open(PathBuf),
    Quit,
}

impl Session {
    /// A new species that will be saved at a path.
    pub fn new(path: &Path, species: Species) -> Self {
        Self::of(SpeciesFile::new(path, species))
    }

    /// Opens a file. Work that was never saved is offered.
    ///
    /// # Errors
    /// Where it cannot be read, or is no species.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let mut session = Self::of(SpeciesFile::open(path)?);
        session.question = session.file.autosaved().map(|species| Question::Restore(Box::new(species)));
        Ok(session)
    }

    fn of(file: SpeciesFile) -> Self {
        let species = file.species.clone();
        Self {
            history: History::new(species.clone()),
            table: fields_of(&species, Species::validate).into(),
            table_of: species,
            file,
            message: None,
            question: None,
            is_seed_locked: true,
            randomisations: 0,
            on_disk: OnDisk::AsKnown,
            kept: None,
        }
    }

    /// The species as it is now.
    pub fn species(&self) -> &Species {
        self.history.value()
    }

    /// The species as it is in its file.
    pub fn saved(&self) -> &Species {
        &self.file.species
    }

    pub fn path(&self) -> &Path {
        &self.file.path
    }

    pub fn history(&self) -> &History<Species> {
        &self.history
    }

    /// The table of its fields. Ranges are those of the last species that was valid.
    pub fn table(&self) -> &Arc<Section> {
        &self.table
    }

    pub fn on_disk(&self) -> OnDisk {
        self.on_disk
    }

    /// Whether there is anything to save.
    pub fn is_changed(&self) -> bool {
        !self.file.is_saved() || self.species() != self.saved()
    }

    /// Why the species as it is now cannot be grown: the last good one is shown meanwhile.
    pub fn error(&self) -> Option<String> {
        self.species().validate().err().map(|error| error.to_string())
    }

    /// Takes a changed species over; see [`History::change`].
    pub fn change(&mut self, species: Species, step: &str) {
        self.history.change(species, step);
        self.refresh();
    }

    pub fn end_gesture(&mut self) {
        self.history.end_gesture();
    }

    pub fn undo(&mut self) {
        self.history.undo();
        self.refresh();
    }

    pub fn redo(&mut self) {
        self.history.redo();
        self.refresh();
    }

    /// Gives a field the value that it has in the file, or else by default.
    pub fn reset(&mut self, field: &Field) {
        let default = Species { growth: default_growth(&self.species().growth), ..Species::default() };
        for source in [self.saved().clone(), default] {
            let mut species = self.species().clone();
            if copy_at(&mut species, &source, &field.path) && species != *self.species() {
                self.change(species, &field.label);
                self.end_gesture();
                return;
            }
        }
    }

    /// Whether a field is not as it is in the file.
    pub fn is_field_changed(&self, field: &Field) -> bool {
        !is_same_at(self.species(), self.saved(), &field.path)
    }

    /// Another individual of the kind: see [`randomised`].
    pub fn randomise(&mut self) {
        self.randomisations += 1;
        let fields = all_fields(&self.table);
        let species = randomised(self.species(), &fields, NATURAL_SPREAD, self.randomisations, Species::validate);
        let Some(mut species) = species else {
            self.message = Some(Message::Failed("No other individual passes the checks".into()));
            return;
        };
        if !self.is_seed_locked {
            species.seed = species.seed.wrapping_add(self.randomisations);
        }
        self.change(species, "Randomise");
        self.end_gesture();
    }

    /// Saves the species to its file. Asks first, where comments or another program's changes would be lost.
    pub fn save(&mut self) {
        if self.error().is_some() {
            self.save_to(None);
            return;
        }
        self.look_at_disk();
        let loses_comments = self.file.text_of(self.species()).is_ok_and(|merged| merged.loses_comments);
        self.question = match self.on_disk {
            OnDisk::Changed => Some(Question::Overwrite),
            OnDisk::AsKnown | OnDisk::Removed if loses_comments => Some(Question::LoseComments),
            OnDisk::AsKnown | OnDisk::Removed => None,
        };
        if self.question.is_none() {
            self.save_to(None);
        }
    }

    /// Saves without asking; to another file if one is given. Returns whether it is saved.
    pub fn save_to(&mut self, path: Option<&Path>) -> bool {
        self.question = None;
        self.history.end_gesture();
        if let Some(error) = self.error() {
            self.message = Some(Message::Failed(error));
            return false;
        }
        let before = self.file.clone();
        match self.file.save(&self.history.value().clone(), path) {
            Ok(()) => {
                before.forget_autosave();
                self.kept = None;
                self.on_disk = OnDisk::AsKnown;
                self.message = Some(Message::Done(format!("Saved {}", self.file.path.display())));
                true
            }
            Err(error) => {
                self.message = Some(Message::Failed(error.to_string()));
                false
            }
        }
    }

    /// Opens another file; asks first where changes would be lost. A file that cannot be read leaves everything as it is.
    pub fn open_another(&mut self, path: &Path) {
        if self.is_changed() && self.history.undo_step().is_some() {
            self.question = Some(Question::Unsaved(Intent::Open(path.to_owned())));
        } else {
            self.open_now(path);
        }
    }

    /// Opens another file, and gives up what is not saved.
    pub fn open_now(&mut self, path: &Path) {
        match Self::open(path) {
            Ok(session) => {
                self.file.forget_autosave();
                *self = Self { is_seed_locked: self.is_seed_locked, ..session };
            }
            Err(error) => {
                self.question = None;
                self.message = Some(Message::Failed(error.to_string()));
            }
        }
    }

    /// Gives up what is not saved.
    pub fn forget(&mut self) {
        self.file.forget_autosave();
        self.kept = None;
    }

    /// Whether the program may end now; asks where changes would be lost.
    pub fn may_quit(&mut self) -> bool {
        let has_work = self.is_changed() && self.history.undo_step().is_some();
        if has_work {
            self.question = Some(Question::Unsaved(Intent::Quit));
        }
        !has_work
    }

    /// Takes work over that was never saved, or forgets it.
    pub fn answer_restore(&mut self, wanted: bool) {
        let Some(Question::Restore(species)) = self.question.take() else { return };
        if wanted {
            self.change(*species, "Restore unsaved work");
            self.end_gesture();
        } else {
            self.file.forget_autosave();
        }
    }

    /// Reads the file again, and gives up the changes.
    pub fn reload(&mut self) {
        let path = self.file.path.clone();
        self.open_now(&path);
    }

    /// Looks whether another program has changed the file. To be called now and then.
    pub fn look_at_disk(&mut self) {
        self.on_disk = self.file.on_disk();
    }

    /// Keeps unsaved work against a crash. To be called now and then.
    pub fn keep(&mut self) {
        if self.kept.as_ref() == Some(self.species()) || matches!(self.question, Some(Question::Restore(_))) {
            return;
        }
        if self.species() == self.saved() {
            if self.kept.take().is_some() {
                self.file.forget_autosave();
            }
            return;
        }
        match self.file.autosave(self.history.value()) {
            Ok(()) => self.kept = Some(self.species().clone()),
            Err(error) => self.message = Some(Message::Failed(format!("Unsaved work is not kept: {error}"))),
        }
    }

    /// Makes the table of fields anew, if the species is another.
    fn refresh(&mut self) {
        if self.table_of != *self.history.value() && self.history.value().validate().is_ok() {
            self.table_of = self.history.value().clone();
            self.table = fields_of(&self.table_of, Species::validate).into();
        }
    }
}

/// The same model of growth with its default settings.
pub fn default_growth(growth: &Growth) -> Growth {
    match growth {
        Growth::ReevesBlau(_) => Growth::ReevesBlau(Default::default()),
        Growth::Oak(_) => Growth::Oak(Default::default()),
        Growth::Fir(_) => Growth::Fir(Default::default()),
        Growth::AonoKunii(_) => Growth::AonoKunii(Default::default()),
        Growth::Impressionist(_) => Growth::Impressionist(Default::default()),
        Growth::Gardner(_) => Growth::Gardner(Default::default()),
    }
}

#[cfg(test)]
mod tests;
