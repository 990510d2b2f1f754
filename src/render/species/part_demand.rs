//! Which meshes of a model have to be on the GPU: those that a tree wants, and for a while those that one has wanted.

use super::part_set::{MOST_PARTS, PartSet};

/// Rounds over all trees in which none has wanted a part before it is freed. A round takes 16 frames or more, so that a viewer who looks
/// about or turns round finds all as it was.
const ROUNDS_KEPT: u8 = 32;

/// What is wanted of a model's meshes.
#[derive(Clone, Debug, Default)]
pub(crate) struct PartDemand {
    /// Parts that were wanted in this round.
    wanted: PartSet,
    /// Parts that are being made.
    coming: PartSet,
    /// Whether something is wanted that has not been started.
    is_asked: bool,
    /// Rounds since a part was wanted.
    idle_rounds: [u8; MOST_PARTS],
}

impl PartDemand {
    /// A tree wants parts, now or soon. Whether something has to be made for it, beside what is there, for which nobody has asked.
    pub fn want(&mut self, parts: PartSet, there: PartSet) -> bool {
        self.wanted = self.wanted.and(parts);
        let is_new = !self.is_asked && !parts.without(there).without(self.coming).is_empty();
        self.is_asked |= is_new;
        is_new
    }

    /// What has to be made, of all that there is, beside what is there: once.
    pub fn start(&mut self, there: PartSet, all: PartSet) -> PartSet {
        self.is_asked = false;
        let due = self.wanted.common(all).without(there).without(self.coming);
        self.coming = self.coming.and(due);
        due
    }

    /// Parts have been made.
    pub fn finish(&mut self, parts: PartSet) {
        self.coming = self.coming.without(parts);
    }

    /// Every tree has been asked what it wants. Returns what none has wanted for long, of what is there.
    pub fn end_round(&mut self, there: PartSet) -> PartSet {
        let mut unwanted = PartSet::EMPTY;
        for (number, idle) in self.idle_rounds.iter_mut().enumerate() {
            let part = PartSet::numbered(number);
            *idle = if self.wanted.contains(part) { 0 } else { idle.saturating_add(1) };
            if *idle >= ROUNDS_KEPT {
                unwanted = unwanted.and(part);
            }
        }
        self.wanted = PartSet::EMPTY;
        unwanted.common(there)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::species::part_set::LevelPart;

    #[test]
    fn a_part_is_made_once_and_freed_after_a_while_without_demand() {
        let (mut demand, mut there) = (PartDemand::default(), PartSet::in_leaf(2));
        let bare_wood = PartSet::one(0, LevelPart::BareWood);
        let (all, finest) = (PartSet::ALL.without(bare_wood), PartSet::in_leaf(0));
        assert!(!demand.want(there, there), "it is there");
        assert!(demand.want(finest.and(bare_wood), there));
        assert!(!demand.want(finest, there), "somebody has asked");
        assert_eq!(demand.start(there, all), finest, "there is no other wood of the bare tree");
        assert_eq!(demand.start(there, all), PartSet::EMPTY, "it is coming");
        assert!(!demand.want(finest, there), "it is coming");
        demand.finish(finest);
        there = there.and(finest);
        assert_eq!(demand.start(there, all), PartSet::EMPTY, "it is there");
        for _ in 0..3 * ROUNDS_KEPT {
            assert!(!demand.want(finest, there));
            assert!(demand.end_round(there).common(finest).is_empty(), "a tree wants it");
        }
        for round in 1..=ROUNDS_KEPT {
            assert_eq!(demand.end_round(there).contains(finest), round == ROUNDS_KEPT, "round {round}");
        }
        there = there.without(finest);
        assert!(demand.want(finest, there));
        assert_eq!(demand.start(there, all), finest, "it comes back");
    }
}
