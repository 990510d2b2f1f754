//! What every session can do, whatever it edits: its file, and what has to be asked before anything is lost.

use std::path::{Path, PathBuf};

use super::{document_file::OnDisk, steps::Steps};

/// What is told about an action.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    Done(String),
    Failed(String),
}

/// What has to be answered before anything is lost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// There are unsaved changes; what follows would lose them.
    Unsaved(Intent),
    /// Saving would lose comments of the file.
    LoseComments,
    /// The file was changed by another program since it was read.
    Overwrite,
    /// There is work of a session that ended without saving.
    Restore,
}

/// What follows once changes are saved or given up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Intent {
    Open(PathBuf),
    Quit,
}

/// A session, whatever it edits.
pub trait FileSession: Steps {
    fn path(&self) -> &Path;

    /// How its files end.
    fn extension(&self) -> &'static str;

    /// What is edited.
    fn name(&self) -> &'static str;

    fn on_disk(&self) -> OnDisk;

    /// Whether there is anything to save.
    fn is_changed(&self) -> bool;

    /// Why what is edited cannot be shown as it is now: the last good one is shown meanwhile.
    fn error(&self) -> Option<String>;

    /// What the last action did, or why it could not.
    fn message(&self) -> Option<&Message>;

    /// What has to be answered before anything else.
    fn question(&self) -> Option<&Question>;

    /// Leaves the question unanswered: nothing happens.
    fn dismiss_question(&mut self);

    /// Saves to the session's file. Asks first, where comments or another program's changes would be lost.
    fn save(&mut self);

    /// Saves without asking; to another file if one is given. Returns whether it is saved.
    fn save_to(&mut self, path: Option<&Path>) -> bool;

    /// Opens another file; asks first where changes would be lost. A file that cannot be read leaves everything as it is.
    fn open_another(&mut self, path: &Path);

    /// Opens another file, and gives up what is not saved.
    fn open_now(&mut self, path: &Path);

    /// Reads the file again, and gives up the changes.
    fn reload(&mut self);

    /// Gives up what is not saved.
    fn forget(&mut self);

    /// Whether the program may end now; asks where changes would be lost that nobody has given up.
    fn may_quit(&mut self) -> bool;

    /// Takes work over that was never saved, or forgets it.
    fn answer_restore(&mut self, wanted: bool);

    /// Looks whether another program has changed the file. To be called now and then.
    fn look_at_disk(&mut self);

    /// Keeps unsaved work against a crash. To be called now and then.
    fn keep(&mut self);
}
