//! Sets of the meshes of a tree: parts of its LOD levels.

use crate::lod::MOST_LEVELS;

/// What a mesh of an LOD level is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LevelPart {
    Wood,
    /// The wood of a bare tree, where it has more of it.
    BareWood,
    Leaves,
}

impl LevelPart {
    pub const ALL: [Self; 3] = [Self::Wood, Self::BareWood, Self::Leaves];
}

/// Most parts of one tree.
pub(crate) const MOST_PARTS: usize = MOST_LEVELS * LevelPart::ALL.len();

/// A set of meshes of one tree: a bit for each part of each level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PartSet(u16);

impl PartSet {
    pub const EMPTY: Self = Self(0);
    #[cfg(test)]
    pub const ALL: Self = Self((1 << MOST_PARTS) - 1);

    /// One part. Levels beyond the last have none.
    pub const fn one(level: usize, part: LevelPart) -> Self {
        if level < MOST_LEVELS { Self(1 << (level * LevelPart::ALL.len() + part as usize)) } else { Self::EMPTY }
    }

    /// The part of a number below [`MOST_PARTS`].
    pub const fn numbered(number: usize) -> Self {
        Self(1 << number)
    }

    /// What is drawn of a level in leaf.
    pub const fn in_leaf(level: usize) -> Self {
        Self::one(level, LevelPart::Wood).and(Self::one(level, LevelPart::Leaves))
    }

    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// What both have.
    pub const fn common(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether it has all parts of another.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether it has a part of that level.
    pub const fn has_level(self, level: usize) -> bool {
        let all = Self::in_leaf(level).and(Self::one(level, LevelPart::BareWood));
        !self.common(all).is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_disjoint_and_are_all() {
        let mut all = PartSet::EMPTY;
        for level in 0..MOST_LEVELS {
            for part in LevelPart::ALL {
                let one = PartSet::one(level, part);
                assert!(!one.is_empty() && all.common(one).is_empty());
                assert!((0..MOST_LEVELS).all(|other| one.has_level(other) == (other == level)));
                all = all.and(one);
            }
        }
        assert_eq!(all, PartSet::ALL);
        assert_eq!(PartSet::one(MOST_LEVELS, LevelPart::Wood), PartSet::EMPTY);
        assert_eq!(all.without(PartSet::in_leaf(1)).and(PartSet::in_leaf(1)), all);
        assert!(all.contains(PartSet::in_leaf(2)) && !PartSet::in_leaf(2).contains(all));
    }
}
