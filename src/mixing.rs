//! Numbers that look random, from numbers that do not: the same on every machine.

use bevy::math::IVec2;

/// A step of `SplitMix64` (Steele, Lea & Flood 2014): nearby numbers become unrelated ones.
pub(crate) fn mixed(value: u64) -> u64 {
    finalised(value.wrapping_add(0x9e37_79b9_7f4a_7c15))
}

/// Its finaliser: every bit of the result depends on every bit of the value, and 0 stays 0.
pub(crate) fn finalised(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

/// A place of a grid as one number.
pub(crate) fn packed(place: IVec2) -> u64 {
    u64::from(place.x.cast_unsigned()) << 32 | u64::from(place.y.cast_unsigned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of the generator that its authors give for the seed 0: a step from each multiple of its constant.
    #[test]
    fn steps_are_those_of_the_published_generator() {
        let numbers = [0, 1, 2].map(|step: u64| mixed(step.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
        assert_eq!(numbers, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
    }
}
