//! Settings of the running program that have no file of their own: the wind, levels of detail. They are edited where they are, and what a
//! panel has changed can be taken back.

use super::{history::History, steps::Steps};

/// Settings that the program has, too.
#[derive(Debug)]
pub struct LiveSettings<T> {
    history: History<T>,
    /// As the program last had them.
    known: T,
}

impl<T: Clone + PartialEq> LiveSettings<T> {
    /// Begins with what the program has.
    pub fn new(value: T) -> Self {
        Self { history: History::new(value.clone()), known: value }
    }

    /// The settings as they are now.
    pub fn value(&self) -> &T {
        self.history.value()
    }

    /// Takes changed settings over; see [`History::change`].
    pub fn change(&mut self, value: T, step: &str) {
        self.history.change(value, step);
    }

    /// Learns what the program has. What it has changed by itself is no step: it stays when the steps before it are undone and redone.
    pub fn follow(&mut self, program: &T) {
        if *program != self.known {
            self.known = program.clone();
            self.history.amend(program.clone());
        }
    }

    /// What the program is to have instead of what it has.
    pub fn take_change(&mut self) -> Option<T> {
        let is_changed = *self.history.value() != self.known;
        is_changed.then(|| {
            self.known = self.history.value().clone();
            self.known.clone()
        })
    }
}

impl<T: Clone + PartialEq> Steps for LiveSettings<T> {
    fn undo_step(&self) -> Option<&str> {
        self.history.undo_step()
    }

    fn redo_step(&self) -> Option<&str> {
        self.history.redo_step()
    }

    fn undo(&mut self) {
        self.history.undo();
    }

    fn redo(&mut self) {
        self.history.redo();
    }

    fn end_gesture(&mut self) {
        self.history.end_gesture();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_panel_changes_goes_to_the_program_once() {
        let mut live = LiveSettings::new(1);
        live.follow(&1);
        assert_eq!(live.take_change(), None);
        live.change(2, "speed");
        assert_eq!((live.take_change(), live.take_change()), (Some(2), None));
        live.follow(&2);
        live.undo();
        assert_eq!((live.take_change(), live.undo_step()), (Some(1), None));
    }

    #[test]
    fn what_the_program_changes_is_no_step() {
        let mut live = LiveSettings::new(1);
        live.change(2, "speed");
        live.take_change();
        live.follow(&7);
        assert_eq!((*live.value(), live.take_change(), live.undo_step()), (7, None, Some("speed")));
        live.undo();
        assert_eq!(live.take_change(), Some(1));
        live.redo();
        assert_eq!(live.take_change(), Some(7));
    }
}
