//! Draws trees: one draw for the wood and one for the leaves of a tree, all trees of a model and a level in one batch.
//!
//! Nothing here runs for a tree that nobody comes nearer to. A tree is dressed when it gets its model, and again when it
//! wears another level; between, the frame's clock is the only thing that changes.

use super::{
    detail::{Levels, MOST_LEVELS, Sight},
    exposure::Exposure,
    looks::{Garment, SpeciesDressed, VariantLook, Wardrobe},
    rouse::CulledOnGpu,
    stand::{Stand, Standing},
};
use crate::tree::{Grown, Species, Tree, TreeModel};
use bevy::{
    camera::{primitives::Aabb, visibility::NoAutoAabb},
    mesh::MeshTag,
    prelude::*,
};

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
    pub levels: Levels,
    /// How many levels it has.
    count: u8,
    /// Its height while its scale is 1, m.
    pub height_m: f32,
    tint: u8,
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

/// Puts the meshes and materials of its model on every tree that has got a new one.
pub(super) fn dress_trees(
    mut commands: Commands,
    wardrobe: Res<Wardrobe>,
    path: Res<DrawPath>,
    sight: Res<Sight>,
    mut stand: ResMut<Stand>,
    mut dressed: MessageReader<SpeciesDressed>,
    places: TransformHelper,
    trees: Query<(Entity, &Tree, &Grown, Option<&Children>, Has<CardBehind>)>,
    regrown: Query<Entity, Changed<Grown>>,
    draws: Query<(), Or<(With<Foliage>, With<Coming>)>>,
) {
    let renewed: Vec<AssetId<Species>> = dressed.read().map(|message| message.0).collect();
    let mut dress = |(entity, tree, grown, children, card_behind): (Entity, &Tree, &Grown, Option<&Children>, bool)| {
        let Some(variant) = wardrobe.variant(tree.species.id(), grown.model.id()) else { return };
        for old in children.into_iter().flatten().filter(|child| draws.contains(**child)) {
            commands.entity(*old).despawn();
        }
        let standing = if path.sways { stand.admit(grown.model.id()) } else { None };
        let (scale, _, place) =
            places.compute_global_transform(entity).unwrap_or_default().to_scale_rotation_translation();
        let mut worn = Worn {
            levels: Levels::default(),
            count: variant.levels.len() as u8,
            height_m: variant.height_m,
            tint: tree.tint_byte(grown.seed) as u8,
        };
        let fades = Fades { levels: standing.is_some(), into_card: card_behind };
        worn.levels = worn.choose(&sight, place, scale.y, fades, None);
        // The old row, if there is one, is given back when the component goes.
        let mut tree = commands.entity(entity);
        tree.remove::<Standing>().insert(worn);
        if let Some(standing) = standing {
            tree.insert(standing);
        }
        let dress = Dress { tree: entity, variant, worn, standing, card_behind, path: *path };
        dress.put_on(None, &mut commands);
    };
    if renewed.is_empty() {
        regrown.iter().filter_map(|entity| trees.get(entity).ok()).for_each(&mut dress);
    } else {
        let due = |tree: &Tree, entity| renewed.contains(&tree.species.id()) || regrown.contains(entity);
        trees.iter().filter(|(entity, tree, ..)| due(tree, *entity)).for_each(&mut dress);
    }
}

/// Gives trees more room when a stronger wind comes, and takes back what they need no more.
pub(super) fn fit_boxes(
    exposure: Res<Exposure>,
    models: Res<Assets<TreeModel>>,
    mut wardrobe: ResMut<Wardrobe>,
    mut trees: Query<(&Tree, &Grown, &mut Aabb, Option<&Children>), With<Worn>>,
    mut draws: Query<&mut Aabb, (Or<(With<Foliage>, With<Coming>)>, Without<Worn>)>,
) {
    if !exposure.is_changed() {
        return;
    }
    wardrobe.fit_boxes(&models, &exposure);
    for (tree, grown, mut bounds, children) in &mut trees {
        let Some(variant) = wardrobe.variant(tree.species.id(), grown.model.id()) else { continue };
        bounds.set_if_neq(variant.bounds);
        let mut draws = draws.iter_many_mut(children.into_iter().flatten());
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
        dress.put_on(Some((before, leaves)), &mut commands);
    }
}

/// What a tree can fade into.
#[derive(Clone, Copy)]
struct Fades {
    levels: bool,
    into_card: bool,
}

impl Worn {
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

/// How the level of a draw fades: bits of its tag.
const FADES_OUT: u32 = 1 << 18;
const FADES_IN: u32 = 1 << 19;
const CARDS_BEHIND: u32 = 1 << 20;

/// A tree and what it is to wear.
struct Dress<'a> {
    tree: Entity,
    variant: &'a VariantLook,
    worn: Worn,
    standing: Option<Standing>,
    card_behind: bool,
    path: DrawPath,
}

impl Dress<'_> {
    /// Puts the levels on: `before` is what the tree has worn, and the draw of its leaves.
    fn put_on(&self, before: Option<(Levels, Option<Entity>)>, commands: &mut Commands) {
        let Levels { first, both, gone } = self.worn.levels;
        if before.map_or(gone, |(before, _)| before.gone != gone) {
            let shown = if gone { Visibility::Hidden } else { Visibility::Inherited };
            commands.entity(self.tree).insert(shown);
        }
        let Some(level) = self.variant.levels.get(usize::from(first)) else { return };
        let same = before.filter(|(before, _)| before.first == first).is_some();
        let fading = if both { FADES_OUT } else { self.end_of(first) };
        self.put(&level.wood, first, fading, same, commands.entity(self.tree));
        match (&level.leaves, before.and_then(|(_, leaves)| leaves)) {
            (Some(leaves), Some(entity)) => self.put(leaves, first, fading, same, commands.entity(entity)),
            (Some(leaves), None) => self.put(leaves, first, fading, false, self.child(Foliage, commands)),
            (None, Some(entity)) => commands.entity(entity).despawn(),
            (None, None) => {}
        }
        let next = first + 1;
        let Some(level) = self.variant.levels.get(usize::from(next)).filter(|_| both) else { return };
        let fading = FADES_IN | self.end_of(next);
        if !level.nested {
            self.put(&level.wood, next, fading, false, self.child(Coming, commands));
        }
        if let Some(leaves) = &level.leaves {
            self.put(leaves, next, fading, false, self.child((Foliage, Coming), commands));
        }
    }

    /// What comes after a level that is worn alone.
    fn end_of(&self, level: u8) -> u32 {
        if self.card_behind && level + 1 == self.worn.count { CARDS_BEHIND } else { 0 }
    }

    fn child<'c>(&self, mark: impl Bundle, commands: &'c mut Commands) -> EntityCommands<'c> {
        commands.spawn((mark, ChildOf(self.tree), Transform::default()))
    }

    /// One draw; of one that is the `same` as before only the tag changes.
    fn put(&self, garment: &Garment, level: u8, fading: u32, same: bool, mut entity: EntityCommands) {
        let fading = if garment.fades && self.standing.is_some() { fading } else { 0 };
        let row = self.standing.map_or(0, |standing| standing.row);
        entity.insert(MeshTag(row | u32::from(level) << 16 | fading | u32::from(self.worn.tint) << 24));
        if same {
            return;
        }
        // The box holds every pose of now; the mesh's own would cull a tree that leans into the view.
        entity.insert((Mesh3d(garment.mesh.clone()), self.variant.bounds, NoAutoAabb));
        match &garment.outfit.swaying {
            Some(swaying) if self.standing.is_some() => entity.insert(MeshMaterial3d(swaying.clone())),
            _ => entity.insert(MeshMaterial3d(garment.outfit.still.clone())),
        };
        if self.path.culls_on_gpu {
            entity.insert(CulledOnGpu);
        }
    }
}
