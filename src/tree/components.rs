//! The components of trees.

use super::{model::TreeModel, species::Species};
use crate::mixing::mixed;
use bevy::prelude::*;

/// A tree of a species, at the place of its `Transform` (uniform scale).
///
/// Once the species is loaded and baked the entity gets a [`Grown`] model, and, where there is rendering, one draw for
/// its wood and one for its leaves; all trees of one model are drawn together.
/// It may be changed at any time. Another species, age or seed is noticed within eight frames, and the tree changes once
/// that model is baked.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component)]
#[require(Transform, Visibility)]
pub struct Tree {
    /// Its species.
    pub species: Handle<Species>,
    /// Chooses among the species' variants and tints. `None` takes it from the place in the world where the tree gets
    /// its model, so that equal forests look equal.
    pub seed: Option<u64>,
    /// Age, years; `None` is the species' mature age. Clamped to what the species allows; not every year has a model of
    /// its own, so a tree that ages as time goes by grows in steps.
    pub age_years: Option<f32>,
    /// How far it is ahead of the [`Season`](crate::tree::Season), or behind it (below 0): trees of one kind do not all turn
    /// on one day. units: days, clamped to half a year; what is not a number is 0.
    pub season_days: f32,
    /// A shade of its own, from -1 to 1, which others are clamped to; `None` takes it from the seed. It is looked up when the
    /// tree gets its model.
    pub tint: Option<f32>,
}

impl Tree {
    /// A tree whose variant follows from its place.
    pub fn new(species: Handle<Species>) -> Self {
        Self { species, seed: None, age_years: None, season_days: 0.0, tint: None }
    }

    /// Sets the seed that chooses the variant.
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = Some(seed);
        self
    }

    /// Sets the age.
    pub fn with_age(mut self, years: f32) -> Self {
        self.age_years = Some(years);
        self
    }

    /// Sets how far it is ahead of the season, days.
    pub fn with_season(mut self, days: f32) -> Self {
        self.season_days = days;
        self
    }

    /// Sets a shade of its own, -1 to 1.
    pub fn with_tint(mut self, tint: f32) -> Self {
        self.tint = Some(tint);
        self
    }

    /// Its shade in a byte, for a tree of that well-mixed seed.
    #[cfg(feature = "render")]
    pub(crate) fn tint_byte(&self, seed: u64) -> u32 {
        let byte = |tint: f32| ((0.5 + 0.5 * tint.clamp(-1.0, 1.0)) * 255.0).round() as u32;
        self.tint.filter(|tint| !tint.is_nan()).map_or((seed >> 56) as u32, byte)
    }

    /// How far it is ahead of the season, in years.
    pub(crate) fn season_shift(&self) -> f32 {
        let days = if self.season_days.is_nan() { 0.0 } else { self.season_days };
        days.clamp(-182.5, 182.5) / 365.0
    }

    /// Its own seed or that of its `place` in the world: a well-mixed number, the same on every run.
    pub(super) fn mixed_seed(&self, place: impl FnOnce() -> Vec3) -> u64 {
        let raw = self.seed.unwrap_or_else(|| {
            let [x, y, z] = place().to_array().map(|coordinate| u64::from(coordinate.to_bits()));
            x ^ y.rotate_left(21) ^ z.rotate_left(42)
        });
        mixed(raw)
    }

    /// Which of a species' variants a tree is that has a seed of its own.
    #[cfg(feature = "render")]
    pub(crate) fn variant_of(seed: u64, variants: u32) -> u32 {
        (mixed(seed) % u64::from(variants.max(1))) as u32
    }
}

/// The model of a tree whose species has been baked. Written by [`WindwoodSystems::Bake`](crate::WindwoodSystems::Bake).
#[derive(Component, Clone, Debug, PartialEq)]
#[component(immutable)]
pub struct Grown {
    /// The baked variant.
    pub model: Handle<TreeModel>,
    /// Its number among the species' variants.
    pub variant: usize,
    /// The tree's own well-mixed seed, for tints and the like.
    pub seed: u64,
}

/// Asks for a tree's beams and leaves as entities whose `Transform`s follow the wind, for things attached to branches,
/// for servers, for tests. It costs work every frame: give it to the trees that need it.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default)]
pub struct Articulated {
    /// Beams up to this order get entities: 0 only the trunk, 1 its branches as well, and so on.
    pub deepest_order: u8,
    /// Whether leaf clusters get entities as well.
    pub leaves: bool,
}

impl Default for Articulated {
    fn default() -> Self {
        Self { deepest_order: u8::MAX, leaves: true }
    }
}

/// One beam of an [`Articulated`] tree. Its `Transform`, in world space, rides on the cross-section at `at`, with +Y along
/// the beam: attach a lantern there as a child. It is no child of the tree, whose draw would be extracted anew each frame.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component)]
#[require(Transform, Visibility)]
pub struct Beam {
    /// Index into the skeleton's beams.
    pub index: u32,
    /// Place on the beam: 0 its root, 1 its tip. A game may change it.
    pub at: f32,
}

/// The tree that a [`Beam`] belongs to. Despawning the tree despawns its beams.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[relationship(relationship_target = TreeBeams)]
pub struct BeamOf(pub Entity);

/// The [`Beam`]s of an articulated tree, in the order of the skeleton's.
#[derive(Component, Debug, Default)]
#[relationship_target(relationship = BeamOf, linked_spawn)]
pub struct TreeBeams(Vec<Entity>);

/// One leaf cluster of an [`Articulated`] tree. Its `Transform`, in world space, is at the anchor, with +Y along the main axis.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component)]
#[require(Transform, Visibility)]
pub struct Leaf {
    /// Index into the skeleton's leaf clusters.
    pub index: u32,
}

/// The tree that a [`Leaf`] belongs to. Despawning the tree despawns its leaves.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[relationship(relationship_target = TreeLeaves)]
pub struct LeafOf(pub Entity);

/// The [`Leaf`]s of an articulated tree, in the order of the skeleton's clusters.
#[derive(Component, Debug, Default)]
#[relationship_target(relationship = LeafOf, linked_spawn)]
pub struct TreeLeaves(Vec<Entity>);

#[cfg(all(test, feature = "render"))]
mod tests {
    use super::*;

    #[test]
    fn tints_and_seasons_out_of_range_are_clamped() {
        let tree = Tree::new(Handle::default());
        assert_eq!(tree.tint_byte(0xab << 56), 0xab);
        let tint = |tint| tree.clone().with_tint(tint).tint_byte(7);
        assert_eq!([-1.0, 0.0, 1.0, 9.0, f32::NAN].map(tint), [0, 128, 255, 255, 0]);
        let shift = |days| tree.clone().with_season(days).season_shift();
        assert_eq!([73.0, 1e9, f32::NAN].map(shift), [0.2, 0.5, 0.0]);
    }
}
