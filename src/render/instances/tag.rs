//! The mesh tag of a tree's draw: the tree's row, the LOD level, how that level fades, and a tint.

/// Bits of the row, here and in the list of the pose pass.
pub(crate) const ROW_BITS: u32 = 16;
/// The level has two bits after the row.
const LOD_SHIFT: u32 = ROW_BITS;
const FADES_OUT_BIT: u32 = 18;
const FADES_IN_BIT: u32 = 19;
const FADES_TO_IMPOSTOR_BIT: u32 = 20;
const TINT_SHIFT: u32 = 24;

/// Rows that a tag can name.
pub(crate) const MAX_ROWS: u32 = (1 << ROW_BITS) - 1;

/// What shaders call the number of bits of a row.
pub(crate) const ROW_BITS_CONSTANT: &str = "TREE_ROW_BITS";

/// The layout as constants of the shaders.
pub(crate) const TAG_LAYOUT: [(&str, u32); 5] = [
    (ROW_BITS_CONSTANT, ROW_BITS),
    ("TAG_FADES_OUT_BIT", FADES_OUT_BIT),
    ("TAG_FADES_IN_BIT", FADES_IN_BIT),
    ("TAG_FADES_TO_IMPOSTOR_BIT", FADES_TO_IMPOSTOR_BIT),
    ("TAG_TINT_SHIFT", TINT_SHIFT),
];

/// How a level fades: a set of flags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Fading(u32);

impl Fading {
    /// The level is there at any distance.
    pub const NONE: Self = Self(0);
    /// It fades into the next level.
    pub const OUT: Self = Self(1 << FADES_OUT_BIT);
    /// The level before fades into it.
    pub const IN: Self = Self(1 << FADES_IN_BIT);
    /// It fades into the tree's impostor.
    pub const TO_IMPOSTOR: Self = Self(1 << FADES_TO_IMPOSTOR_BIT);

    /// Both.
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// Packs a tag.
pub(crate) fn pack_tag(row: u32, lod: u8, fading: Fading, tint: u8) -> u32 {
    row | u32::from(lod) << LOD_SHIFT | fading.0 | u32::from(tint) << TINT_SHIFT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_tag_do_not_overlap() {
        let parts = [
            pack_tag(MAX_ROWS, 0, Fading::NONE, 0),
            pack_tag(0, 3, Fading::NONE, 0),
            pack_tag(0, 0, Fading::OUT, 0),
            pack_tag(0, 0, Fading::IN, 0),
            pack_tag(0, 0, Fading::TO_IMPOSTOR, 0),
            pack_tag(0, 0, Fading::NONE, u8::MAX),
        ];
        let bits: u32 = parts.iter().map(|part| part.count_ones()).sum();
        assert_eq!(parts.iter().fold(0, |all, part| all | part).count_ones(), bits);
    }
}
