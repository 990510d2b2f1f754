//! Which cells' trees are entities, as the shader of impostors reads it: a square of bits about the viewer.

use bevy::{asset::RenderAssetUsages, prelude::*, render::storage::ShaderBuffer};

/// Cells along a side of the square: at 64 m a cell, a kilometre to each side.
pub(crate) const NEAR_MASK_SIDE: i32 = 32;
/// Words before the rows: the square's first cell, x and z, and the bits of a cell's side and of the farthest distance.
const HEADER: usize = 4;
const WORDS: usize = HEADER + NEAR_MASK_SIDE as usize;

/// The square in force.
#[derive(Resource)]
pub(crate) struct NearMask {
    pub buffer: Handle<ShaderBuffer>,
    words: [u32; WORDS],
}

impl FromWorld for NearMask {
    fn from_world(world: &mut World) -> Self {
        let words = [0; WORDS];
        Self { buffer: world.resource_mut::<Assets<ShaderBuffer>>().add(mask_buffer(words)), words }
    }
}

impl NearMask {
    /// Sets the bits of `cells` in the square about `centre`, and uploads it if that has changed. Cells outside do not count as near.
    pub fn update(
        &mut self,
        centre: IVec2,
        cell_m: f32,
        far_to_m: f32,
        cells: impl Iterator<Item = IVec2>,
        buffers: &mut Assets<ShaderBuffer>,
    ) {
        let words = mask_words(centre, cell_m, far_to_m, cells);
        if words == self.words {
            return;
        }
        self.words = words;
        if let Some(mut buffer) = buffers.get_mut(&self.buffer) {
            *buffer = mask_buffer(words);
        }
    }
}

fn mask_buffer(words: [u32; WORDS]) -> ShaderBuffer {
    ShaderBuffer::new(words.to_vec(), RenderAssetUsages::RENDER_WORLD)
}

fn mask_words(centre: IVec2, cell_m: f32, far_to_m: f32, cells: impl Iterator<Item = IVec2>) -> [u32; WORDS] {
    let first = centre - NEAR_MASK_SIDE / 2;
    let mut words = [0; WORDS];
    words[..HEADER].copy_from_slice(&[
        first.x.cast_unsigned(),
        first.y.cast_unsigned(),
        cell_m.to_bits(),
        far_to_m.to_bits(),
    ]);
    for at in cells.map(|cell| cell - first) {
        if at.cmpge(IVec2::ZERO).all() && at.cmplt(IVec2::splat(NEAR_MASK_SIDE)).all() {
            words[HEADER + at.y as usize] |= 1 << at.x;
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_inside_the_square_are_set_and_others_are_not() {
        const SIDE: i32 = NEAR_MASK_SIDE;
        let cells = [IVec2::new(-5, 7), IVec2::new(-5 - SIDE, 7), IVec2::new(10, 7 + SIDE / 2)];
        let words = mask_words(IVec2::new(-5, 7), 64.0, 900.0, cells.into_iter());
        let bits: u32 = words[HEADER..].iter().map(|row| row.count_ones()).sum();
        assert_eq!(bits, 1);
        assert_eq!(words[HEADER + SIDE as usize / 2], 1 << (SIDE / 2));
        assert_eq!((words[0].cast_signed(), f32::from_bits(words[2])), (-5 - SIDE / 2, 64.0));
    }
}
