//! How much of a spray's card its leaves cover, without its texture.

use bevy::math::Vec2;

use super::{outline, settings::Leaf, spray::spray};
use crate::sequence::r2;

/// Places that are looked at: the share is found to a hundredth or two.
const PLACES: usize = 512;

/// Share of a card of the spray of that seed that shows leaves, 0 to 1: as its mask does, but for twigs and stalks. The card is widest at a
/// share of its length, `widest_at`, where its texture has half of its own.
#[must_use]
pub(in crate::tree) fn card_cover(leaf: &Leaf, seed: u64, widest_at: f32) -> f32 {
    let (_, leaves) = spray(leaf, seed);
    let margin = outline::outline(leaf);
    let middle = Vec2::new(0.5, 0.0);
    let blade_reach = margin.iter().map(|point| point.distance(middle)).fold(0.5, f32::max);
    let [low, high] =
        margin.iter().fold([Vec2::INFINITY, Vec2::NEG_INFINITY], |[low, high], at| [low.min(*at), high.max(*at)]);
    // To look along a margin takes long.
    let covers = |at: Vec2| at.cmpge(low).all() && at.cmple(high).all() && outline::distance(&margin, at) > 0.0;
    // As in `texture.rs`: the twig runs along the diagonal.
    let places = (0..PLACES).map(|index| r2([0.5; 2], index)).map(|[u, v]| Vec2::new(u + 1.0 - v, u + v - 1.0) * 0.5);
    let covered = places.filter(|point| {
        leaves.iter().any(|leaf| {
            let middle = leaf.root + leaf.direction * (0.5 * leaf.length);
            let reach = (blade_reach + leaf.bend.abs()) * leaf.length;
            point.distance_squared(middle) <= reach * reach && covers(leaf.local(*point))
        })
    });
    let areas = covered.map(|point| if point.x < 0.5 { 2.0 * widest_at } else { 2.0 * (1.0 - widest_at) });
    areas.sum::<f32>() / PLACES as f32
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
            let side = textures.base_colour.width as usize;
            let texels = || textures.base_colour.mips[0].chunks_exact(4).map(|texel| texel[3] >= 128).enumerate();
            // The half towards the root is that below the diagonal from the upper left.
            let share = |is_inner: bool| {
                let of_half = texels().filter(|(index, _)| (index % side < index / side) == is_inner);
                let [covered, all] = of_half
                    .fold([0, 0], |[covered, all], (_, is_covered)| [covered + usize::from(is_covered), all + 1]);
                covered as f32 / all as f32
            };
            for widest_at in [0.5, 0.6] {
                let mask = widest_at * share(true) + (1.0 - widest_at) * share(false);
                let cover = card_cover(&species.foliage.leaf, species.seed, widest_at);
                // The twigs are some 2 to 5% of the card, mostly under leaves.
                assert!((cover - mask).abs() < 0.05, "{shape:?}, {widest_at}: {cover} for {mask}");
            }
        }
    }
}
