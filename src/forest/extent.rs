//! How far the trees of a cell reach.

use crate::scatter::Planted;
#[cfg(feature = "render")]
use bevy::math::{Vec2, Vec3};

/// How far trees of a species reach while their scale is 1, swaying.
#[cfg(feature = "render")]
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reach {
    /// Above their foot, m.
    pub up_m: f32,
    /// Below it, m.
    pub down_m: f32,
    /// Sideways, m.
    pub aside_m: f32,
}

#[cfg(feature = "render")]
impl Reach {
    /// The greater of it and that of a tree in a box with these corners, m.
    pub fn with(self, min: Vec3, max: Vec3) -> Self {
        let aside = min.abs().max(max.abs());
        Self {
            up_m: self.up_m.max(max.y),
            down_m: self.down_m.max(-min.y),
            aside_m: self.aside_m.max(aside.x.hypot(aside.z)),
        }
    }
}

/// How low, how high and how large the plants of a cell are.
#[derive(Clone, Debug)]
pub(super) struct Extent {
    lowest_m: f32,
    highest_m: f32,
    /// Number of a species, and the greatest scale of its plants.
    #[cfg_attr(not(feature = "render"), expect(dead_code))]
    largest: Box<[(u8, f32)]>,
}

impl Extent {
    pub fn of<'a>(plants: impl Iterator<Item = &'a Planted>) -> Self {
        let mut largest: Vec<(u8, f32)> = Vec::new();
        let (mut lowest_m, mut highest_m) = (f32::INFINITY, f32::NEG_INFINITY);
        for plant in plants {
            lowest_m = lowest_m.min(plant.position.y);
            highest_m = highest_m.max(plant.position.y);
            match largest.iter_mut().find(|(species, _)| *species == plant.species) {
                Some((_, scale)) => *scale = scale.max(plant.vigour),
                None => largest.push((plant.species, plant.vigour)),
            }
        }
        Self { lowest_m, highest_m, largest: largest.into() }
    }

    /// Whether nothing stands in the cell.
    pub fn is_empty(&self) -> bool {
        self.lowest_m > self.highest_m
    }

    /// Half way between its lowest and its highest foot, m.
    pub fn mean_m(&self) -> f32 {
        0.5 * (self.lowest_m + self.highest_m)
    }

    /// The corners of the box around the cell's trees, swaying.
    #[cfg(feature = "render")]
    pub fn corners(&self, corner: Vec2, cell_m: f32, reaches: &[Reach]) -> [Vec3; 2] {
        let [mut up_m, mut down_m, mut aside_m] = [0.0_f32; 3];
        for (species, scale) in &self.largest {
            let reach = reaches.get(usize::from(*species)).copied().unwrap_or_default();
            (up_m, down_m) = (up_m.max(scale * reach.up_m), down_m.max(scale * reach.down_m));
            aside_m = aside_m.max(scale * reach.aside_m);
        }
        let (min, max) = (corner - aside_m, corner + cell_m + aside_m);
        [Vec3::new(min.x, self.lowest_m - down_m, min.y), Vec3::new(max.x, self.highest_m + up_m, max.y)]
    }
}
