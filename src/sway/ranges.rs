//! Ranges of a table.

use bevy::platform::collections::HashMap;

/// Hands out ranges of a table that keep their places, and again what was given back, for ranges of the same length.
#[derive(Default)]
pub(super) struct Ranges {
    /// No range has ever reached beyond this.
    pub end: u32,
    free: HashMap<u32, Vec<u32>>,
}

impl Ranges {
    pub fn has_room(&self, length: u32, limit: u32) -> bool {
        let reusable = self.free.get(&length).is_some_and(|free| !free.is_empty());
        reusable || self.end.checked_add(length).is_some_and(|end| end <= limit)
    }

    pub fn take(&mut self, length: u32) -> u32 {
        if let Some(first) = self.free.get_mut(&length).and_then(Vec::pop) {
            return first;
        }
        let first = self.end;
        self.end += length;
        first
    }

    pub fn give_back(&mut self, first: u32, length: u32) {
        self.free.entry(length).or_default().push(first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_were_given_back_are_used_again_for_their_length() {
        let mut ranges = Ranges::default();
        let (a, b) = (ranges.take(10), ranges.take(4));
        assert_eq!((a, b, ranges.end), (0, 10, 14));
        ranges.give_back(a, 10);
        assert_eq!(ranges.take(4), 14);
        assert_eq!(ranges.take(10), 0);
        assert!(!ranges.has_room(10, 20) && ranges.has_room(2, 20));
    }
}
