//! Puts the meshes and materials of a model on a tree.

use super::{
    detail::{Levels, Sight},
    draw::{CardBehind, Coming, DrawPath, Fades, Foliage, Worn},
    looks::{Garment, StageDressed, VariantLook, Wardrobe},
    rouse::CulledOnGpu,
    stand::{Stand, Standing},
};
use crate::tree::{Grown, Tree};
use bevy::{camera::visibility::NoAutoAabb, ecs::system::SystemParam, mesh::MeshTag, prelude::*};

/// A tree, its model, and whether it has a card behind it.
type Clothed = (Entity, &'static Tree, &'static Grown, Has<CardBehind>);

/// Dresses trees from head to foot.
#[derive(SystemParam)]
pub(super) struct Dresser<'w, 's> {
    commands: Commands<'w, 's>,
    wardrobe: Res<'w, Wardrobe>,
    path: Res<'w, DrawPath>,
    sight: Res<'w, Sight>,
    stand: ResMut<'w, Stand>,
    places: TransformHelper<'w, 's>,
    draws: Query<'w, 's, (), Or<(With<Foliage>, With<Coming>)>>,
}

/// Dresses every tree that has got a new model: of those that wear nothing yet so many in a frame, the others at once, for
/// what they wear may be gone.
pub(super) fn dress_trees(
    mut dresser: Dresser,
    mut dressed: MessageReader<StageDressed>,
    bare: Query<Clothed, Without<Worn>>,
    worn: Query<(Clothed, &Worn, Option<&Children>)>,
    regrown: Query<Entity, (Changed<Grown>, With<Worn>)>,
) {
    // To be dressed from head to foot takes twice as long as to change.
    let mut left = dresser.sight.changes_per_frame().div_ceil(2);
    for (entity, tree, grown, card_behind) in &bare {
        if left == 0 {
            break;
        }
        left -= usize::from(dresser.dress(entity, tree, grown, card_behind));
    }
    let mut due: Vec<Entity> = regrown.iter().collect();
    let stages: Vec<StageDressed> = dressed.read().copied().collect();
    if !stages.is_empty() {
        // They have waited for these looks, or wear some that are gone.
        let waits = |((_, tree, grown, _), worn, _): &((Entity, &Tree, &Grown, bool), &Worn, Option<&Children>)| {
            worn.model != grown.model.id() || dresser.is_anew(&stages, tree, grown)
        };
        due.extend(worn.iter().filter(waits).map(|((entity, ..), ..)| entity));
        due.sort_unstable();
        due.dedup();
    }
    for ((entity, tree, grown, card_behind), worn, children) in due.into_iter().filter_map(|tree| worn.get(tree).ok()) {
        if dresser.wardrobe.variant(tree.species.id(), grown.model.id()).is_some() {
            dresser.undress(entity, worn, children);
            dresser.dress(entity, tree, grown, card_behind);
        }
    }
}

impl Dresser<'_, '_> {
    fn is_anew(&self, stages: &[StageDressed], tree: &Tree, grown: &Grown) -> bool {
        let species = tree.species.id();
        let mut anew = stages.iter().filter(|stage| stage.is_anew && stage.species == species).peekable();
        let look = anew.peek().and_then(|_| self.wardrobe.variant(species, grown.model.id()));
        look.is_some_and(|look| anew.any(|stage| stage.step == look.step))
    }

    fn undress(&mut self, tree: Entity, worn: &Worn, children: Option<&Children>) {
        for child in children.into_iter().flatten().filter(|child| self.draws.contains(**child)) {
            self.commands.entity(*child).despawn();
        }
        // The row is given back when the component goes.
        let mut tree = self.commands.entity(tree);
        tree.remove::<Standing>();
        if worn.levels.gone {
            tree.insert(Visibility::Inherited);
        }
    }

    /// Dresses a tree that wears nothing, if there is something for it, and says whether it did.
    fn dress(&mut self, entity: Entity, tree: &Tree, grown: &Grown, card_behind: bool) -> bool {
        let Self { commands, wardrobe, path, sight, stand, places, .. } = self;
        let Some(variant) = wardrobe.variant(tree.species.id(), grown.model.id()) else { return false };
        let standing = if path.sways { stand.admit(grown.model.id()) } else { None };
        let at = places.compute_global_transform(entity).unwrap_or_default();
        let fades = Fades { levels: standing.is_some(), into_card: card_behind };
        let worn = Worn::new(variant, grown, tree.tint_byte(grown.seed) as u8).as_seen(sight, &at, fades);
        let dress = Dress { tree: entity, variant, worn, standing, card_behind, path: **path };
        match standing {
            Some(standing) => dress.put_on(None, (worn, standing), commands),
            None => dress.put_on(None, worn, commands),
        }
        true
    }
}

/// How the level of a draw fades: bits of its tag.
const FADES_OUT: u32 = 1 << FADES_OUT_BIT;
const FADES_IN: u32 = 1 << FADES_IN_BIT;
const CARDS_BEHIND: u32 = 1 << CARDS_BEHIND_BIT;
/// The layout of a tag, as the shaders read it.
pub(super) const TAG_LAYOUT: [(&str, u32); 5] = [
    ("TAG_ROW_BITS", 16),
    ("TAG_FADES_OUT_BIT", FADES_OUT_BIT),
    ("TAG_FADES_IN_BIT", FADES_IN_BIT),
    ("TAG_FADES_TO_IMPOSTOR_BIT", CARDS_BEHIND_BIT),
    ("TAG_TINT_SHIFT", 24),
];
const FADES_OUT_BIT: u32 = 18;
const FADES_IN_BIT: u32 = 19;
const CARDS_BEHIND_BIT: u32 = 20;

/// A tree and what it is to wear.
pub(super) struct Dress<'a> {
    pub tree: Entity,
    pub variant: &'a VariantLook,
    pub worn: Worn,
    pub standing: Option<Standing>,
    pub card_behind: bool,
    pub path: DrawPath,
}

/// One draw of a tree.
#[derive(Clone, Copy)]
struct Draw {
    level: u8,
    fading: u32,
    /// Whether it is there already and nothing but how it fades is another.
    same: bool,
}

impl Dress<'_> {
    /// Puts the levels on, and `more` on the tree itself: `before` is what it has worn, and the draw of its leaves. All that an
    /// entity gets it gets at once, for each time it moves in memory.
    pub fn put_on(&self, before: Option<(Levels, Option<Entity>)>, more: impl Bundle, commands: &mut Commands) {
        let Levels { first, both, gone } = self.worn.levels;
        if before.map_or(gone, |(before, _)| before.gone != gone) {
            let shown = if gone { Visibility::Hidden } else { Visibility::Inherited };
            commands.entity(self.tree).insert(shown);
        }
        let Some(level) = self.variant.levels.get(usize::from(first)) else { return };
        let same = before.filter(|(before, _)| before.first == first).is_some();
        let draw = Draw { level: first, fading: if both { FADES_OUT } else { self.end_of(first) }, same };
        self.put(&level.wood, draw, more, commands.entity(self.tree));
        match (&level.leaves, before.and_then(|(_, leaves)| leaves)) {
            (Some(leaves), Some(entity)) => self.put(leaves, draw, (), commands.entity(entity)),
            (Some(leaves), None) => self.add(leaves, draw, Foliage, commands),
            (None, Some(entity)) => commands.entity(entity).despawn(),
            (None, None) => {}
        }
        let next = first + 1;
        let Some(level) = self.variant.levels.get(usize::from(next)).filter(|_| both) else { return };
        let draw = Draw { level: next, fading: FADES_IN | self.end_of(next), same: false };
        if !level.nested {
            self.add(&level.wood, draw, Coming, commands);
        }
        if let Some(leaves) = &level.leaves {
            self.add(leaves, draw, (Foliage, Coming), commands);
        }
    }

    /// What comes after a level that is worn alone.
    fn end_of(&self, level: u8) -> u32 {
        if self.card_behind && level + 1 == self.worn.count { CARDS_BEHIND } else { 0 }
    }

    /// A draw that is a child of the tree.
    fn add(&self, garment: &Garment, draw: Draw, mark: impl Bundle, commands: &mut Commands) {
        let child = (mark, ChildOf(self.tree), Transform::default());
        self.put(garment, Draw { same: false, ..draw }, child, commands.spawn_empty());
    }

    fn put(
        &self,
        garment: &Garment,
        Draw { level, fading, same }: Draw,
        more: impl Bundle,
        mut entity: EntityCommands,
    ) {
        let fading = if garment.fades && self.standing.is_some() { fading } else { 0 };
        let row = self.standing.map_or(0, |standing| standing.row);
        let tag = MeshTag::new(row | u32::from(level) << 16 | fading | u32::from(self.worn.tint) << 24);
        if same {
            entity.insert((more, tag));
            return;
        }
        // The box holds every pose of now; the mesh's own would cull a tree that leans into the view.
        let draw = (more, tag, Mesh3d(garment.mesh.clone()), self.variant.bounds, NoAutoAabb);
        match &garment.outfit.swaying {
            Some(swaying) if self.standing.is_some() => self.show((draw, MeshMaterial3d(swaying.clone())), entity),
            _ => self.show((draw, MeshMaterial3d(garment.outfit.still.clone())), entity),
        }
    }

    fn show(&self, draw: impl Bundle, mut entity: EntityCommands) {
        if self.path.culls_on_gpu {
            entity.insert((draw, CulledOnGpu));
        } else {
            entity.insert(draw);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::ecs::system::RunSystemOnce;

    fn undress_all(mut dresser: Dresser, trees: Query<(Entity, &Worn, Option<&Children>)>) {
        trees.iter().for_each(|(tree, worn, children)| dresser.undress(tree, worn, children));
    }

    #[test]
    fn who_is_undressed_keeps_nothing_but_what_is_its_own() {
        let mut world = World::new();
        world.init_resource::<Wardrobe>();
        world.init_resource::<Sight>();
        world.init_resource::<Stand>();
        let (pose_limit, table_limit_bytes) = (0, 0);
        world.insert_resource(DrawPath { sways: true, culls_on_gpu: true, pose_limit, table_limit_bytes });
        // One whose card stood for it, and one that its owner has hidden.
        let trees = [true, false].map(|gone| {
            let levels = Levels { gone, ..Levels::default() };
            let worn = Worn { model: AssetId::default(), levels, count: 1, height_m: 9.0, tint: 0 };
            let tree = world.spawn((worn, Standing { row: 0 }, Visibility::Hidden, children![Foliage, Coming]));
            let tree = tree.id();
            world.spawn((Name::new("nest"), ChildOf(tree)));
            tree
        });
        world.run_system_once(undress_all).expect("it runs");
        let seen = trees.map(|tree| world.get::<Visibility>(tree).copied());
        assert_eq!(seen, [Some(Visibility::Inherited), Some(Visibility::Hidden)]);
        for tree in trees {
            assert!(world.get::<Standing>(tree).is_none());
            let children = world.get::<Children>(tree).expect("the nest is left");
            assert!(children.len() == 1 && world.get::<Name>(children[0]).is_some());
        }
    }
}
