//! The mask of leaves at coarse levels of detail.
//!
//! A spray is a few dozen pixels long there, and its texture is read at a mip in which leaves and gaps are blended. Where the mask's cut-off
//! is then lower, more of a spray is drawn. Sprays that are so much fewer cover as much of the picture, and cost so much less: what
//! a crown costs is the area of its cards, whatever the mask leaves of it.

use super::{LeafKind, cover::card_cover};
#[cfg(any(test, feature = "render"))]
use crate::texture::{MASK_CUT_OFF, TextureData};
use crate::tree::{Growth, Species};

/// The mip that coarse levels read: the coarsest that is used of masks.
#[cfg(any(test, feature = "render"))]
pub(crate) const COARSE_MIP: usize = 3;
/// A mask lets so many times as much through, at most, and no more than such a share of a card.
const MOST_GAIN: f32 = 1.7;
const MOST_COVER: f32 = 0.85;

/// How many times as much of a spray coarse levels draw.
#[must_use]
pub(crate) fn coarse_mask_gain(species: &Species) -> f32 {
    let has_sprays = matches!(species.foliage.kind, LeafKind::Sprays)
        && !matches!(species.growth, Growth::Impressionist(_) | Growth::Gardner(_));
    if !has_sprays {
        return 1.0;
    }
    (MOST_COVER / card_cover(&species.foliage.leaf, species.seed).max(1e-3)).clamp(1.0, MOST_GAIN)
}

/// Less than this is hardly there, and stays away.
#[cfg(any(test, feature = "render"))]
const LEAST_CUT_OFF: f32 = 0.1;

/// The cut-off that lets so many times as many texels of a mask through as [`MASK_CUT_OFF`].
#[must_use]
#[cfg(any(test, feature = "render"))]
pub(crate) fn coarse_cut_off(mask: &TextureData, gain: f32) -> f32 {
    let Some(mip) = mask.mips.get(COARSE_MIP) else { return MASK_CUT_OFF };
    let mut alphas: Vec<u8> = mip.iter().skip(3).step_by(4).copied().collect();
    let drawn = alphas.iter().filter(|alpha| f32::from(**alpha) > MASK_CUT_OFF * 255.0).count();
    let wanted = (gain * drawn as f32).round() as usize;
    let Some(last) = wanted.checked_sub(1).filter(|last| *last < alphas.len()) else { return MASK_CUT_OFF };
    let (_, &mut faintest, _) = alphas.select_nth_unstable_by(last, |a, b| b.cmp(a));
    // Half a step below the faintest.
    ((f32::from(faintest) - 0.5) / 255.0).clamp(LEAST_CUT_OFF, MASK_CUT_OFF)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::textures::species_textures;

    #[test]
    fn an_oaks_mask_lets_so_many_times_as_much_through() {
        let species = Species::default();
        let gain = coarse_mask_gain(&species);
        assert!(gain > 1.2 && gain <= MOST_GAIN, "{gain}");
        let mask = species_textures(&species).foliage;
        let cut_off = coarse_cut_off(&mask, gain);
        let share = |cut_off: f32| {
            let alphas = || mask.mips[COARSE_MIP].iter().skip(3).step_by(4);
            alphas().filter(|alpha| f32::from(**alpha) / 255.0 > cut_off).count() as f32 / alphas().count() as f32
        };
        let [before, coarse] = [MASK_CUT_OFF, cut_off].map(share);
        // Texels of equal alpha pass together.
        assert!((coarse / before / gain - 1.0).abs() < 0.02, "{coarse} for {before}, which is not {gain} times");
    }

    #[test]
    fn a_mask_without_texels_keeps_its_cut_off() {
        let species = Species::default();
        let mut mask = species_textures(&species).foliage;
        mask.mips[COARSE_MIP].iter_mut().for_each(|byte| *byte = 0);
        assert_eq!(coarse_cut_off(&mask, 1.5), MASK_CUT_OFF);
        mask.mips.truncate(1);
        assert_eq!(coarse_cut_off(&mask, 1.5), MASK_CUT_OFF);
    }
}
