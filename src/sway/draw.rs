//! Draws trees: one draw for the wood and one for the leaves of a tree, all trees of a model and a level in one batch.
//!
//! Nothing here runs for a tree that nobody comes nearer to. A tree is dressed when it gets its model, and again when it
//! wears another level; between, the frame's clock is the only thing that changes.

use super::{
    detail::{Levels, MOST_LEVELS, Sight},
    dress::Dress,
    exposure::Exposure,
    looks::{VariantLook, Wardrobe},
    stand::{Stand, Standing},
};
use crate::tree::{Grown, Tree, TreeModel};
use bevy::{camera::primitives::Aabb, prelude::*};

/// How this machine can draw trees; found out once at start.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawPath {
    /// Whether the vertex shader can read the wind tables. If not, trees stand still in a standard material.
    pub sways: bool,
    /// Whether the graphics processor culls by itself, so that the processor need not.
    pub culls_on_gpu: bool,
    /// Beams that can be posed at once, over all trees that are seen; trees beyond that stand still.
    pub pose_limit: u32,
    /// Largest table that a shader can read, bytes.
    pub table_limit_bytes: u64,
}

/// The leaves of a tree: a child entity with a draw of its own.
#[derive(Component, Clone, Copy, Debug)]
#[require(Visibility)]
pub struct Foliage;

/// A draw of the level that a tree fades into: a child that goes when the tree wears that level alone.
#[derive(Component, Clone, Copy)]
#[require(Visibility)]
pub(super) struct Coming;

/// A tree for which a card stands from [`CardRange`](super::detail::CardRange) on.
#[derive(Component, Clone, Copy)]
pub(crate) struct CardBehind;

/// What a tree wears.
#[derive(Component, Clone, Copy, Debug)]
pub(super) struct Worn {
    /// What it was dressed as.
    pub model: AssetId<TreeModel>,
    pub levels: Levels,
    /// How many levels it has.
    pub count: u8,
    /// Its height while its scale is 1, m.
    pub height_m: f32,
    pub tint: u8,
}

/// Which levels trees wear.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct TreesByLevel<'w, 's> {
    trees: Query<'w, 's, (&'static Worn, &'static GlobalTransform)>,
    stand: Option<Res<'w, Stand>>,
}

impl TreesByLevel<'_, '_> {
    /// Trees of each level, and how many of them fade into the next.
    pub fn count(&self) -> ([usize; MOST_LEVELS], usize) {
        let mut count = ([0; MOST_LEVELS], 0);
        for (Worn { levels, .. }, _) in &self.trees {
            count.0[usize::from(levels.first).min(MOST_LEVELS - 1)] += 1;
            count.1 += usize::from(levels.both);
        }
        count
    }

    /// What the tables of trees have on the graphics processor, bytes.
    pub fn table_bytes(&self) -> usize {
        self.stand.as_ref().map_or(0, |stand| stand.bytes())
    }

    /// Where each tree stands, and its level.
    pub fn iter(&self) -> impl Iterator<Item = (Vec3, usize)> + '_ {
        self.trees.iter().map(|(worn, at)| (at.translation(), usize::from(worn.levels.first)))
    }
}

/// Boxes that are fitted in a frame, at most: to do it for all trees takes milliseconds, and a wind grows over many frames.
const BOXES_PER_FRAME: usize = 512;

/// Gives trees more room when a stronger wind comes, and takes back what they need no more.
pub(super) fn fit_boxes(
    exposure: Res<Exposure>,
    models: Res<Assets<TreeModel>>,
    mut wardrobe: ResMut<Wardrobe>,
    mut due: Local<Vec<Entity>>,
    mut trees: Query<(Entity, &Tree, &Grown, &mut Aabb, Option<&Children>), With<Worn>>,
    mut draws: Query<&mut Aabb, (Or<(With<Foliage>, With<Coming>)>, Without<Worn>)>,
) {
    if exposure.is_changed() && wardrobe.fit_boxes(&models, &exposure) {
        due.clear();
        due.extend(trees.iter().map(|(entity, ..)| entity));
    }
    let rest = due.len().saturating_sub(BOXES_PER_FRAME);
    for tree in due.drain(rest..) {
        let Ok((_, tree, grown, mut bounds, children)) = trees.get_mut(tree) else { continue };
        let Some(variant) = wardrobe.variant(tree.species.id(), grown.model.id()) else { continue };
        bounds.set_if_neq(variant.bounds);
        let mut draws = draws.iter_many_mut(children.into_iter().flatten()).matched();
        while let Some(mut bounds) = draws.fetch_next() {
            bounds.set_if_neq(variant.bounds);
        }
    }
}

/// Looks trees over when a viewer has moved, and changes the levels of those that come nearer or go farther.
pub(super) fn choose_levels(
    mut commands: Commands,
    mut sight: ResMut<Sight>,
    wardrobe: Res<Wardrobe>,
    path: Res<DrawPath>,
    mut trees: Query<(
        Entity,
        &Tree,
        &Grown,
        &GlobalTransform,
        &mut Worn,
        Option<&Standing>,
        Option<&Children>,
        Has<CardBehind>,
    )>,
    foliage: Query<(), (With<Foliage>, Without<Coming>)>,
    coming: Query<(), With<Coming>>,
) {
    if !std::mem::take(&mut sight.bypass_change_detection().is_due) {
        return;
    }
    let mut left = sight.changes_per_frame();
    for (entity, tree, grown, at, mut worn, standing, children, card_behind) in &mut trees {
        let scale = at.affine().matrix3.y_axis.length();
        let fades = Fades { levels: standing.is_some(), into_card: card_behind };
        let levels = worn.choose(&sight, at.translation(), scale, fades, Some(worn.levels));
        if levels == worn.levels {
            continue;
        }
        let Some(variant) = wardrobe.variant(tree.species.id(), grown.model.id()) else { continue };
        if left == 0 {
            sight.bypass_change_detection().is_due = true;
            return;
        }
        left -= 1;
        let before = std::mem::replace(&mut worn.bypass_change_detection().levels, levels);
        let mut children = children.into_iter().flatten().copied();
        for gone in children.clone().filter(|child| coming.contains(*child)) {
            commands.entity(gone).despawn();
        }
        let leaves = children.find(|child| foliage.contains(*child));
        let dress = Dress { tree: entity, variant, worn: *worn, standing: standing.copied(), card_behind, path: *path };
        dress.put_on(Some((before, leaves)), (), &mut commands);
    }
}

/// What a tree can fade into.
#[derive(Clone, Copy)]
pub(super) struct Fades {
    pub levels: bool,
    pub into_card: bool,
}

impl Worn {
    pub fn new(variant: &VariantLook, grown: &Grown, tint: u8) -> Self {
        let (count, height_m) = (variant.levels.len() as u8, variant.height_m);
        Self { model: grown.model.id(), levels: Levels::default(), count, height_m, tint }
    }

    /// The same, as it is seen for the first time from where it stands.
    pub fn as_seen(self, sight: &Sight, at: &GlobalTransform, fades: Fades) -> Self {
        let scale = at.affine().matrix3.y_axis.length();
        Self { levels: self.choose(sight, at.translation(), scale, fades, None), ..self }
    }

    /// The levels at a distance; a tree whose material cannot fade wears one at a time.
    fn choose(&self, sight: &Sight, place: Vec3, scale: f32, fades: Fades, before: Option<Levels>) -> Levels {
        let (distance_m, height_m) = (sight.distance_m(place), self.height_m * scale);
        if !fades.levels {
            let levels = sight.ladder.choose(distance_m, height_m, self.count, before);
            let first = before
                .map_or(levels.first, |before| before.first.clamp(levels.first, levels.first + u8::from(levels.both)));
            return Levels { first, both: false, gone: false };
        }
        if fades.into_card {
            return sight.ladder.choose_before_card(distance_m, height_m, self.count, before);
        }
        sight.ladder.choose(distance_m, height_m, self.count, before)
    }
}
