//! Which cells' trees stand near, as the shader reads it: a square of bits about the viewer.

use super::blocks::FarBlocks;
use crate::{forest::cells::ForestCells, sway::CardRange, tree::Tree, viewpoint::Viewpoints};
use bevy::{asset::RenderAssetUsages, prelude::*, render::storage::ShaderBuffer};

/// Cells along a side of the square: at 64 m a cell, a kilometre to each side.
pub(super) const SIDE: i32 = 32;
/// Words before the rows: the square's first cell, x and z, and the bits of a cell's side and of the farthest distance.
const HEADER: usize = 4;

/// Trees give way to cards at this share, at the latest, of the distance to which all of them stand: the fade must end
/// before it.
const TREES_GO_AT: f32 = 0.88;

/// The square in force.
#[derive(Resource)]
pub(super) struct NearCells {
    pub buffer: Handle<ShaderBuffer>,
    words: [u32; HEADER + SIDE as usize],
}

impl FromWorld for NearCells {
    fn from_world(world: &mut World) -> Self {
        let words = [0; HEADER + SIDE as usize];
        let buffer = ShaderBuffer::new(words.to_vec(), RenderAssetUsages::RENDER_WORLD);
        Self { buffer: world.resource_mut::<Assets<ShaderBuffer>>().add(buffer), words }
    }
}

/// The square about `centre`, with the bits of `cells` set. What lies outside does not count as near.
fn square(
    centre: IVec2,
    cell_m: f32,
    far_to_m: f32,
    cells: impl Iterator<Item = IVec2>,
) -> [u32; HEADER + SIDE as usize] {
    let first = centre - SIDE / 2;
    let mut words = [0; HEADER + SIDE as usize];
    words[..HEADER].copy_from_slice(&[
        first.x.cast_unsigned(),
        first.y.cast_unsigned(),
        cell_m.to_bits(),
        far_to_m.to_bits(),
    ]);
    for at in cells.map(|cell| cell - first) {
        if at.cmpge(IVec2::ZERO).all() && at.cmplt(IVec2::splat(SIDE)).all() {
            words[HEADER + at.y as usize] |= 1 << at.x;
        }
    }
    words
}

/// Notes the cells all of whose trees are drawn, and tells the shader where that changed.
pub(super) fn tell_near_cells(
    mut near: ResMut<NearCells>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    viewpoints: Viewpoints,
    mut cards: ResMut<CardRange>,
    mut forests: Query<(&mut ForestCells, Option<&FarBlocks>)>,
    children: Query<&Children>,
    bare: Query<(), (With<Tree>, Without<Mesh3d>)>,
) {
    let Some((mut forest, blocks)) = forests.iter_mut().next() else { return };
    // Trees do not go before there is something to stand for them.
    let begins = blocks.is_some_and(FarBlocks::is_complete);
    let from_m = if begins {
        Some(TREES_GO_AT * forest.settings().trees_to_m)
    } else {
        cards.from_m.filter(|_| blocks.is_some())
    };
    cards.set_if_neq(CardRange { from_m });
    let is_dressed = |cell: Entity| children.get(cell).is_ok_and(|trees| !trees.iter().any(|tree| bare.contains(tree)));
    forest.bypass_change_detection().near.note_dressed(is_dressed);
    let Some(centre) = viewpoints.iter().next().map(|eye| forest.planter().cell_at(eye.xz())) else { return };
    let words = square(centre, forest.planter().cell_m(), forest.settings().far_to_m, forest.near.dressed());
    if words == near.words {
        return;
    }
    near.words = words;
    if let Some(mut buffer) = buffers.get_mut(&near.buffer) {
        *buffer = ShaderBuffer::new(words.to_vec(), RenderAssetUsages::RENDER_WORLD);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_inside_are_set_and_others_are_not() {
        let cells = [IVec2::new(-5, 7), IVec2::new(-5 - SIDE, 7), IVec2::new(10, 7 + SIDE / 2)];
        let words = square(IVec2::new(-5, 7), 64.0, 900.0, cells.into_iter());
        let bits: u32 = words[HEADER..].iter().map(|row| row.count_ones()).sum();
        assert_eq!(bits, 1);
        assert_eq!(words[HEADER + SIDE as usize / 2], 1 << (SIDE / 2));
        assert_eq!((words[0].cast_signed(), f32::from_bits(words[2])), (-5 - SIDE / 2, 64.0));
    }
}
