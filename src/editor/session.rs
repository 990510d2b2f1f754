//! What is edited: its history, its fields, and its file.

mod files;

use std::{path::Path, sync::Arc};

use super::{
    document::Document,
    document_file::{DocumentFile, FileError, OnDisk},
    fields::{Field, Section, copy_at, is_same_at},
    file_session::{Message, Question},
    history::History,
};

/// Settings that are edited.
pub struct Session<T> {
    file: DocumentFile<T>,
    history: History<T>,
    table: Arc<Section>,
    table_of: T,
    /// What the last action did, or why it could not.
    pub message: Option<Message>,
    /// What has to be answered before anything else.
    pub question: Option<Question>,
    on_disk: OnDisk,
    /// What was last kept against a crash.
    kept: Option<T>,
    /// Work of a session that ended without saving, until it is answered whether it is wanted.
    restorable: Option<T>,
    /// What a person has given up instead of saving it.
    given_up: Option<T>,
}

impl<T: Document> Session<T> {
    /// New settings that will be saved at a path.
    pub fn new(path: &Path, document: T) -> Self {
        Self::of(DocumentFile::new(path, document))
    }

    /// Opens a file. Work that was never saved is offered.
    ///
    /// # Errors
    /// Where it cannot be read, or is not what it should be.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let mut session = Self::of(DocumentFile::open(path)?);
        session.restorable = session.file.autosaved();
        session.question = session.restorable.as_ref().map(|_| Question::Restore);
        Ok(session)
    }

    fn of(file: DocumentFile<T>) -> Self {
        let document = file.document.clone();
        Self {
            history: History::new(document.clone()),
            table: document.table().into(),
            table_of: document,
            file,
            message: None,
            question: None,
            on_disk: OnDisk::AsKnown,
            kept: None,
            restorable: None,
            given_up: None,
        }
    }

    /// The settings as they are now.
    pub fn document(&self) -> &T {
        self.history.value()
    }

    /// The settings as they are in their file.
    pub fn saved(&self) -> &T {
        &self.file.document
    }

    /// The table of fields. Ranges are those of the last settings that were valid.
    pub fn table(&self) -> &Arc<Section> {
        &self.table
    }

    /// Takes changed settings over; see [`History::change`].
    pub fn change(&mut self, document: T, step: &str) {
        self.history.change(document, step);
        self.refresh();
    }

    /// Gives a field the value that it has in the file, or else by default.
    pub fn reset(&mut self, field: &Field) {
        let default = self.document().default_of_kind();
        for source in [self.saved().clone(), default] {
            let mut document = self.document().clone();
            if copy_at(&mut document, &source, &field.path) && document != *self.document() {
                self.change(document, &field.label);
                self.history.end_gesture();
                return;
            }
        }
    }

    /// Whether a field is not as it is in the file.
    pub fn is_field_changed(&self, field: &Field) -> bool {
        !is_same_at(self.document(), self.saved(), &field.path)
    }

    /// Makes the table of fields anew, if the settings are others.
    fn refresh(&mut self) {
        if self.table_of != *self.history.value() && self.history.value().check().is_ok() {
            self.table_of = self.history.value().clone();
            self.table = self.table_of.table().into();
        }
    }
}

#[cfg(test)]
mod tests;
