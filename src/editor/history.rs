//! Undo and redo: the states of what is edited, one after another.
//!
//! Settings are small, so every state is kept whole. That makes undo exact: what comes back is what was there.

/// How many steps can be undone.
const MOST_STEPS: usize = 500;

/// The states of a value that is edited.
#[derive(Clone, Debug)]
pub struct History<T> {
    states: Vec<State<T>>,
    now: usize,
    /// What the gesture that is going on changes: further changes of it belong to the same step.
    gesture: Option<String>,
}

#[derive(Clone, Debug)]
struct State<T> {
    value: T,
    /// What led to it.
    step: String,
}

impl<T: Clone + PartialEq> History<T> {
    /// Begins with a value.
    pub fn new(value: T) -> Self {
        Self { states: vec![State { value, step: String::new() }], now: 0, gesture: None }
    }

    /// The value as it is now.
    pub fn value(&self) -> &T {
        &self.states[self.now].value
    }

    /// Takes a changed value over. `step` says what was changed; while one [gesture](Self::end_gesture) lasts, changes of the
    /// same thing are one step. What was undone before is forgotten.
    pub fn change(&mut self, value: T, step: &str) {
        if value == *self.value() {
            return;
        }
        self.states.truncate(self.now + 1);
        let goes_on = self.gesture.as_deref() == Some(step) && self.now > 0;
        if goes_on && value == self.states[self.now - 1].value {
            // A gesture that ends where it began is no step.
            self.states.truncate(self.now);
            self.now -= 1;
            self.gesture = None;
            return;
        }
        if goes_on {
            self.states[self.now].value = value;
            return;
        }
        self.gesture = Some(step.to_owned());
        self.states.push(State { value, step: step.to_owned() });
        if self.states.len() > MOST_STEPS + 1 {
            self.states.remove(0);
        }
        self.now = self.states.len() - 1;
    }

    /// Puts another value in the place of the one that is there now, without a step.
    pub fn amend(&mut self, value: T) {
        self.states[self.now].value = value;
    }

    /// The pointer was released, or the keyboard went elsewhere: the next change is a step of its own.
    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    /// What undoing would take back.
    pub fn undo_step(&self) -> Option<&str> {
        (self.now > 0).then(|| self.states[self.now].step.as_str())
    }

    /// What redoing would bring back.
    pub fn redo_step(&self) -> Option<&str> {
        self.states.get(self.now + 1).map(|state| state.step.as_str())
    }

    /// Goes one step back. Returns whether there was one.
    pub fn undo(&mut self) -> bool {
        self.go_to(self.now.checked_sub(1))
    }

    /// Goes one step forth. Returns whether there was one.
    pub fn redo(&mut self) -> bool {
        self.go_to(Some(self.now + 1))
    }

    fn go_to(&mut self, place: Option<usize>) -> bool {
        self.end_gesture();
        let Some(place) = place.filter(|place| *place < self.states.len()) else { return false };
        self.now = place;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_gesture_is_one_step() {
        let mut history = History::new(0);
        (1..=5).for_each(|value| history.change(value, "height"));
        history.end_gesture();
        history.change(6, "height");
        history.change(7, "width");
        assert_eq!((*history.value(), history.undo_step()), (7, Some("width")));
        assert!(history.undo() && *history.value() == 6);
        assert!(history.undo() && *history.value() == 5);
        assert!(history.undo() && *history.value() == 0);
        assert!(!history.undo() && history.redo_step() == Some("height"));
        assert!(history.redo() && *history.value() == 5);
    }

    #[test]
    fn a_gesture_that_ends_where_it_began_is_no_step() {
        let mut history = History::new(0);
        history.change(1, "width");
        history.end_gesture();
        for value in [5, 3, 1] {
            history.change(value, "height");
        }
        assert_eq!((*history.value(), history.undo_step()), (1, Some("width")));
        // The pointer goes on without having been released.
        history.change(2, "height");
        assert!(history.undo() && *history.value() == 1 && history.undo_step() == Some("width"));
    }

    #[test]
    fn a_change_after_an_undo_forgets_what_was_undone() {
        let mut history = History::new(0);
        history.change(1, "a");
        history.change(2, "b");
        history.undo();
        history.change(3, "c");
        assert!(!history.redo() && *history.value() == 3);
        history.change(3, "d");
        assert_eq!(history.undo_step(), Some("c"), "no change is no step");
    }

    #[test]
    fn the_oldest_steps_are_forgotten() {
        let mut history = History::new(0);
        (1..=2000).for_each(|value| history.change(value, &format!("{value}")));
        let undone = std::iter::from_fn(|| history.undo().then_some(())).count();
        assert_eq!((undone, *history.value()), (MOST_STEPS, 2000 - MOST_STEPS as i32));
    }

    proptest! {
        /// Against the obvious way: a list of all values with a finger on one of them.
        #[test]
        fn undo_and_redo_walk_a_list(steps in prop::collection::vec(0..6_u8, 1..60)) {
            let (mut list, mut finger) = (vec![0_usize], 0_usize);
            let mut history = History::new(0);
            for (index, step) in steps.into_iter().enumerate() {
                match step {
                    0 | 1 => { history.undo(); finger = finger.saturating_sub(1); }
                    2 => { history.redo(); finger = (finger + 1).min(list.len() - 1); }
                    _ => {
                        history.change(index + 1, &index.to_string());
                        list.truncate(finger + 1);
                        list.push(index + 1);
                        finger += 1;
                    }
                }
                prop_assert_eq!(*history.value(), list[finger]);
            }
        }
    }
}
