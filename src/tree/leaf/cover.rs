//! How much of a spray's card its leaves cover, without its texture.

use bevy::math::Vec2;

use super::{outline, settings::Leaf, spray::spray};
use crate::sequence::r2;

/// Places that are looked at: the share is found to a hundredth or two.
const PLACES: usize = 512;

/// Share of a card of the spray of that seed that shows leaves, 0 to 1: as its mask does, but for twigs and stalks.
#[must_use]
pub(in crate::tree) fn card_cover(leaf: &Leaf, seed: u64) -> f32 {
    let (_, leaves) = spray(leaf, seed);
    let margin = outline::outline(leaf);
    let middle = Vec2::new(0.5, 0.0);
    let blade_reach = margin.iter().map(|point| point.distance(middle)).fold(0.5, f32::max);
    let [low, high] =
        margin.iter().fold([Vec2::INFINITY, Vec2::NEG_INFINITY], |[low, high], at| [low.min(*at), high.max(*at)]);
    // To look along a margin takes long.
    let covers = |at: Vec2| at.cmpge(low).all() && at.cmple(high).all() && outline::distance(&margin, at) > 0.0;
    let covered = (0..PLACES).filter(|index| {
        let [u, v] = r2([0.5; 2], *index);
        // As in `texture.rs`: the twig runs along the diagonal.
        let point = Vec2::new(0.5 * (u + 1.0 - v), 0.5 * (u + v - 1.0));
        leaves.iter().any(|leaf| {
            let middle = leaf.root + leaf.direction * (0.5 * leaf.length);
            let reach = (blade_reach + leaf.bend.abs()) * leaf.length;
            point.distance_squared(middle) <= reach * reach && covers(leaf.local(point))
        })
    });
    covered.count() as f32 / PLACES as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{
        leaf::{LeafShape, leaf_textures},
        species::Species,
    };

    /// Against the mask of the texture.
    #[test]
    fn it_is_the_share_that_the_mask_covers() {
        for shape in [LeafShape::default(), LeafShape::NeedlePair, LeafShape::Needle] {
            let mut species = Species { seed: 5, ..Species::default() };
            species.foliage.leaf.shape = shape;
            let textures = leaf_textures(&species.foliage, &species.wood.green, species.seed);
            let alphas = || textures.base_colour.mips[0].chunks_exact(4).map(|texel| texel[3]);
            let mask = alphas().filter(|alpha| *alpha >= 128).count() as f32 / alphas().count() as f32;
            let cover = card_cover(&species.foliage.leaf, species.seed);
            // The twigs are some 2 to 5% of the card, mostly under leaves.
            assert!((cover - mask).abs() < 0.05, "{shape:?}: {cover} for {mask}");
        }
    }
}
