//! How much of its leaves a tree has over the year, in few bits: what posing needs of the phenology.

use super::phenology::{DROP, Phenology};

/// When a tree has leaves. The same bits are read on the GPU (`leaf_share` of `render/shaders/beam_sway.wesl`), so that poses agree there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeafSeason {
    /// When the leaves begin and end to unfold, and to fall, in 255ths of a year, lowest byte first; 0 for an evergreen.
    bits: u32,
}

impl LeafSeason {
    /// Of a tree that never sheds.
    pub const EVERGREEN: Self = Self { bits: 0 };

    /// Of a species.
    #[must_use]
    pub fn of(phenology: &Phenology) -> Self {
        if phenology.evergreen {
            return Self::EVERGREEN;
        }
        let Phenology { flush, flush_length, fall, fall_length, patchiness, .. } = *phenology;
        let unfolding = 0.5 * flush_length + patchiness;
        let times = [
            flush - unfolding,
            flush + unfolding,
            fall - 0.5 * fall_length,
            (fall + 0.5 * fall_length + DROP).min(1.0),
        ];
        Self { bits: u32::from_le_bytes(times.map(|time| (255.0 * time).round().clamp(1.0, 255.0) as u8)) }
    }

    /// The bits for the GPU.
    #[cfg(feature = "render")]
    pub(crate) fn bits(self) -> u32 {
        self.bits
    }

    /// Share of all leaves that is there at `year` (0 midwinter to 1): 0 to 1.
    #[must_use]
    pub fn share(self, year: f32) -> f32 {
        if self == Self::EVERGREEN {
            return 1.0;
        }
        let [flush, flushed, fall, fallen] = self.bits.to_le_bytes().map(|time| f32::from(time) / 255.0);
        let progress = |from: f32, to: f32| ((year - from) / (to - from).max(1.0 / 255.0)).clamp(0.0, 1.0);
        // Branches are early or late by a random lag; leaves fall one by one.
        let unfolded = progress(flush, flushed);
        unfolded * unfolded * (3.0 - 2.0 * unfolded) * (1.0 - progress(fall, fallen))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean size of clusters of all lags and ranks.
    #[test]
    fn it_is_the_mean_over_all_leaves() {
        let oak = Phenology::default();
        let season = LeafSeason::of(&oak);
        for step in 0..=100u16 {
            let year = f32::from(step) / 100.0;
            let sizes = (0..20)
                .flat_map(|lag| (0..20).map(move |rank| (lag, rank)))
                .map(|(lag, rank)| oak.leaves(year, -1.0 + 2.0 * lag as f32 / 19.0, rank as f32 / 19.0).size);
            let mean = sizes.sum::<f32>() / 400.0;
            assert!((season.share(year) - mean).abs() < 0.06, "{year}: {} against {mean}", season.share(year));
        }
        assert_eq!((season.share(0.0), season.share(0.6), season.share(1.0)), (0.0, 1.0, 0.0));
    }

    #[test]
    fn evergreens_are_always_in_leaf() {
        let season = LeafSeason::of(&Phenology { evergreen: true, ..Phenology::default() });
        assert!([0.0, 0.3, 0.9, f32::NAN].into_iter().all(|year| season.share(year) == 1.0));
    }
}
