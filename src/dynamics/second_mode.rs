//! A second natural frequency of a beam.

/// A second natural frequency of a beam: that moves as the sum of two oscillators under one load. Most beams have one, of a share of 0.
///
/// Stems that are bent, and branches about as fast as those that they bear, divide their deflection between two modes. Trees that are baked
/// have it in the steps given, those of the tables on the GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondMode {
    /// Natural frequency above that of the first mode as a difference of [coordinates](super::FrequencyClasses::coordinate); negative
    /// where it is slower. -15.875 to 15.875 (a ratio of 23) in steps of 1/8 (2.5% of the frequency).
    pub class_offset: f32,
    /// Share of the static deflection that sways with it, 0 to 1 in steps of 1/127; the rest sways with the first.
    pub share: f32,
}

impl SecondMode {
    /// The greatest difference of coordinates.
    pub(crate) const MOST_OFFSET: f32 = 15.875;
    /// Steps of an offset of 1, and of a share of 1.
    const OFFSET_STEPS: f32 = 8.0;
    const SHARE_STEPS: f32 = 127.0;

    /// One that the tables on the GPU hold without rounding.
    pub(crate) fn rounded(class_offset: f32, share: f32) -> Self {
        let rounded = |value: f32, steps: f32| (value * steps).round() / steps;
        let offset = rounded(class_offset.clamp(-Self::MOST_OFFSET, Self::MOST_OFFSET), Self::OFFSET_STEPS);
        let share = rounded(share.clamp(0.0, 1.0), Self::SHARE_STEPS);
        if offset.is_finite() && share > 0.0 { Self { class_offset: offset, share } } else { Self::default() }
    }

    /// Whether a beam has one.
    pub(crate) fn is_there(&self) -> bool {
        self.share > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_two_numbers_make_a_mode_that_the_tables_hold() {
        for offset in [f32::NAN, f32::NEG_INFINITY, -3.07, 0.0, 40.0] {
            for share in [f32::NAN, -1.0, 0.002, 0.3, 7.0] {
                let SecondMode { class_offset, share } = SecondMode::rounded(offset, share);
                assert!((-SecondMode::MOST_OFFSET..=SecondMode::MOST_OFFSET).contains(&class_offset), "{offset}");
                assert!((0.0..=1.0).contains(&share) && (class_offset * 8.0).fract() == 0.0, "{offset} {share}");
            }
        }
        let SecondMode { class_offset, share } = SecondMode::rounded(3.07, 0.3);
        assert!((class_offset - 3.07).abs() < 0.0625 + 1e-6 && (share - 0.3).abs() < 0.004);
    }
}
