//! Which changes have still to be taken over by the cells of a forest.

use super::stem_id::StemId;
use bevy::math::Vec2;

/// A stem with which something was changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChangedStem {
    pub id: StemId,
    /// Where (x, z) it stands or stood, m.
    pub place_m: Vec2,
    pub was_felled: bool,
}

/// The stems whose changes have still to be taken over, in the order of the changes. Changes that were read or cloned are another set than
/// that which the forest knows: none of them has been taken over.
#[derive(Debug, Default)]
pub(super) enum Journal {
    #[default]
    All,
    Stems(Vec<ChangedStem>),
}

impl Journal {
    pub fn note(&mut self, id: StemId, place_m: Vec2) {
        self.push(ChangedStem { id, place_m, was_felled: false });
    }

    pub fn note_felled(&mut self, id: StemId, place_m: Vec2) {
        self.push(ChangedStem { id, place_m, was_felled: true });
    }

    fn push(&mut self, stem: ChangedStem) {
        if let Self::Stems(stems) = self {
            stems.push(stem);
        }
    }

    /// Takes over what it has; from then on it keeps what comes.
    pub fn take(&mut self) -> Self {
        std::mem::replace(self, Self::Stems(Vec::new()))
    }
}

impl Clone for Journal {
    fn clone(&self) -> Self {
        Self::All
    }
}

/// Two sets of changes are equal whatever has been taken over of them.
impl PartialEq for Journal {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_taken_over_is_not_kept_and_clones_have_taken_over_nothing() {
        let mut journal = Journal::default();
        journal.note(StemId::planted(1), Vec2::ONE);
        assert!(matches!(journal.take(), Journal::All));
        journal.note_felled(StemId::planted(1), Vec2::ONE);
        assert!(matches!(journal.clone(), Journal::All));
        let felled = ChangedStem { id: StemId::planted(1), place_m: Vec2::ONE, was_felled: true };
        assert!(matches!(journal.take(), Journal::Stems(stems) if stems == [felled]));
        assert!(matches!(journal.take(), Journal::Stems(stems) if stems.is_empty()));
    }
}
