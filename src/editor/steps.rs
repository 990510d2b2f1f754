//! What can be taken back, whatever it is.

/// Changes that can be taken back one by one, and made again.
pub trait Steps {
    /// What undoing would take back.
    fn undo_step(&self) -> Option<&str>;

    /// What redoing would bring back.
    fn redo_step(&self) -> Option<&str>;

    fn undo(&mut self);

    fn redo(&mut self);

    /// The pointer was released, or the keyboard went elsewhere: the next change is a step of its own.
    fn end_gesture(&mut self);
}
