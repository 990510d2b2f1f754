//! Has the meshes of the levels made that trees will soon be drawn at, and those freed that none needs any more.

use super::{
    select::select_at,
    thresholds::{LodDistance, LodSelection},
    viewers::LodViewers,
};
use crate::{
    render::{
        instances::components::{HasImpostor, TreeInstance},
        species::{
            library::{PreparedVariant, SpeciesLibrary},
            part_set::PartSet,
        },
    },
    tree::{Season, Tree},
};
use bevy::prelude::*;

/// A tree wants the levels that it would have so much nearer, m: what a viewer at 15 m/s goes in a round and until meshes are made.
const AHEAD_M: f32 = 6.0;
/// Frames of a round over all trees, at least.
const ROUND_FRAMES: usize = 16;
/// Trees that are looked at in a frame, at least.
const LOOKED_AT_PER_FRAME: usize = 256;

/// A round over all trees.
#[derive(Default)]
pub(crate) struct Round {
    due: Vec<Entity>,
    per_frame: usize,
    frames: usize,
}

/// What a tree's wants follow from.
type Wanting = (
    &'static Tree,
    &'static TreeInstance,
    &'static LodSelection,
    &'static GlobalTransform,
    Option<&'static HasImpostor>,
);

/// Looks at some trees a frame. When it has looked at all, what none has wanted for some rounds is freed.
pub(crate) fn want_parts(
    viewers: Res<LodViewers>,
    season: Res<Season>,
    mut library: ResMut<SpeciesLibrary>,
    all: Query<Entity, With<LodSelection>>,
    trees: Query<Wanting>,
    mut round: Local<Round>,
) {
    let library = library.bypass_change_detection();
    let Round { due, per_frame, frames } = &mut *round;
    *frames += 1;
    if due.is_empty() && *frames > ROUND_FRAMES {
        library.variants_mut().for_each(PreparedVariant::end_round);
        due.extend(&all);
        *per_frame = due.len().div_ceil(ROUND_FRAMES).max(LOOKED_AT_PER_FRAME);
        *frames = 0;
    }
    let rest = due.len().saturating_sub(*per_frame);
    for (tree, instance, selection, at, impostor) in due.drain(rest..).filter_map(|tree| trees.get(tree).ok()) {
        let species = tree.species.id();
        let is_bare = library.is_bare(species, season.wrapped() + tree.season_shift());
        let ahead = nearer(viewers.distance(at.translation()), AHEAD_M);
        let soon = select_at(ahead, &viewers.thresholds, instance, at, impostor, None);
        library.want(species, instance.model, |variant| wanted(variant, &soon, selection, is_bare));
    }
}

/// A distance after a way towards the tree, m.
fn nearer(LodDistance { m, scaled_m }: LodDistance, way_m: f32) -> LodDistance {
    let left_m = (m - way_m).max(0.0);
    LodDistance { m: left_m, scaled_m: if m > 0.0 { scaled_m * (left_m / m) } else { scaled_m } }
}

/// The meshes that a tree has, and those that it will have soon.
fn wanted(variant: &PreparedVariant, soon: &LodSelection, now: &LodSelection, is_bare: bool) -> PartSet {
    if soon.is_impostor && now.is_impostor {
        return PartSet::EMPTY;
    }
    let levels = soon.lod.min(now.lod)..=now.lod + u8::from(now.is_fading);
    levels.fold(PartSet::EMPTY, |parts, level| parts.and(variant.parts_of(level, is_bare)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lens_scales_the_way_as_it_scales_distances() {
        let telephoto = LodDistance { m: 100.0, scaled_m: 10.0 };
        assert_eq!(nearer(telephoto, 20.0), LodDistance { m: 80.0, scaled_m: 8.0 });
        let there = LodDistance { m: 0.0, scaled_m: 0.0 };
        assert_eq!((nearer(telephoto, 200.0), nearer(there, 6.0)), (there, there));
    }
}
