//! The file of a session: opened and saved without loss.

use std::path::Path;

use super::Session;
use crate::editor::{
    document::Document,
    document_file::OnDisk,
    file_session::{FileSession, Intent, Message, Question},
    steps::Steps,
};

impl<T: Document> Steps for Session<T> {
    fn undo_step(&self) -> Option<&str> {
        self.history.undo_step()
    }

    fn redo_step(&self) -> Option<&str> {
        self.history.redo_step()
    }

    fn undo(&mut self) {
        self.history.undo();
        self.refresh();
    }

    fn redo(&mut self) {
        self.history.redo();
        self.refresh();
    }

    fn end_gesture(&mut self) {
        self.history.end_gesture();
    }
}

impl<T: Document> FileSession for Session<T> {
    fn path(&self) -> &Path {
        &self.file.path
    }

    fn extension(&self) -> &'static str {
        T::EXTENSION
    }

    fn name(&self) -> &'static str {
        T::NAME
    }

    fn on_disk(&self) -> OnDisk {
        self.on_disk
    }

    fn is_changed(&self) -> bool {
        !self.file.is_saved() || self.document() != self.saved()
    }

    fn error(&self) -> Option<String> {
        self.document().check().err()
    }

    fn message(&self) -> Option<&Message> {
        self.message.as_ref()
    }

    fn question(&self) -> Option<&Question> {
        self.question.as_ref()
    }

    fn dismiss_question(&mut self) {
        self.question = None;
    }

    fn save(&mut self) {
        if self.error().is_some() {
            self.save_to(None);
            return;
        }
        self.look_at_disk();
        let loses_comments = self.file.text_of(self.document()).is_ok_and(|merged| merged.loses_comments);
        self.question = match self.on_disk {
            OnDisk::Changed => Some(Question::Overwrite),
            OnDisk::AsKnown | OnDisk::Removed if loses_comments => Some(Question::LoseComments),
            OnDisk::AsKnown | OnDisk::Removed => None,
        };
        if self.question.is_none() {
            self.save_to(None);
        }
    }

    fn save_to(&mut self, path: Option<&Path>) -> bool {
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

    fn open_another(&mut self, path: &Path) {
        if self.is_changed() && self.history.undo_step().is_some() {
            self.question = Some(Question::Unsaved(Intent::Open(path.to_owned())));
        } else {
            self.open_now(path);
        }
    }

    fn open_now(&mut self, path: &Path) {
        match Self::open(path) {
            Ok(session) => {
                self.file.forget_autosave();
                *self = session;
            }
            Err(error) => {
                self.question = None;
                self.message = Some(Message::Failed(error.to_string()));
            }
        }
    }

    fn reload(&mut self) {
        let path = self.file.path.clone();
        self.open_now(&path);
    }

    fn forget(&mut self) {
        self.file.forget_autosave();
        self.kept = None;
        self.given_up = Some(self.document().clone());
    }

    fn may_quit(&mut self) -> bool {
        let is_given_up = self.given_up.as_ref() == Some(self.document());
        let has_work = self.is_changed() && self.history.undo_step().is_some() && !is_given_up;
        if has_work {
            self.question = Some(Question::Unsaved(Intent::Quit));
        }
        !has_work
    }

    fn answer_restore(&mut self, wanted: bool) {
        self.question = None;
        let Some(document) = self.restorable.take() else { return };
        if wanted {
            self.change(document, "Restore unsaved work");
            self.end_gesture();
        } else {
            self.file.forget_autosave();
        }
    }

    fn look_at_disk(&mut self) {
        self.on_disk = self.file.on_disk();
    }

    fn keep(&mut self) {
        if self.kept.as_ref() == Some(self.document()) || self.restorable.is_some() {
            return;
        }
        if self.document() == self.saved() {
            if self.kept.take().is_some() {
                self.file.forget_autosave();
            }
            return;
        }
        match self.file.autosave(self.history.value()) {
            Ok(()) => self.kept = Some(self.document().clone()),
            Err(error) => self.message = Some(Message::Failed(format!("Unsaved work is not kept: {error}"))),
        }
    }
}
