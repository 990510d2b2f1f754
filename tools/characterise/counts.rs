//! Points counted in the quadrats that lie wholly inside a window.

use crate::window::Window;
use bevy::math::DVec2;
use bevy_windwood::{
    SettingError,
    scatter::{
        counts::{CountModel, Frequencies},
        quadrat::{QuadratGrid, exact_counts, place_points},
    },
};
use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

/// Counts in the quadrats of a window.
pub struct Counts {
    pub grid: QuadratGrid,
    pub table: Frequencies,
    /// Whether each quadrat lies wholly inside the window.
    is_inside: Vec<bool>,
    /// Points in them.
    pub points: usize,
}

impl Counts {
    /// Counts points in quadrats, so many each way over the box around the window, or else about as many as points.
    ///
    /// # Errors
    /// Where there are too few quadrats or too many points in one.
    pub fn of(points: &[DVec2], window: &Window, quadrats: Option<(u32, u32)>) -> Result<Self, SettingError> {
        let (min_m, max_m) = (window.min_m, window.max_m);
        // As many as would be in the whole box, if it were as full as the window.
        let size_m = window.size_m();
        let in_box = points.len() as f64 * size_m.x * size_m.y / window.area_m2();
        let grid = match quadrats {
            Some((columns, rows)) => QuadratGrid::new(min_m, max_m, columns, rows),
            None => QuadratGrid::with_quadrat_for_each(in_box.round() as usize, min_m, max_m),
        }?;
        let is_inside: Vec<bool> = (0..grid.quadrats())
            .map(|quadrat| window.contains_box(grid.corner_m(quadrat), grid.corner_m(quadrat) + grid.quadrat_m()))
            .collect();
        let counts = grid.counts(points)?;
        let inside: Vec<u32> =
            counts.into_iter().zip(&is_inside).filter(|(_, is_inside)| **is_inside).map(|(count, _)| count).collect();
        let points = inside.iter().map(|&count| count as usize).sum();
        Ok(Self { table: Frequencies::of_counts(&inside)?, grid, is_inside, points })
    }

    /// Quadrats that count.
    pub fn quadrats(&self) -> usize {
        self.is_inside.iter().filter(|is_inside| **is_inside).count()
    }

    /// As many points in the same quadrats, by a law.
    ///
    /// # Errors
    /// As [`exact_counts`] and [`place_points`].
    pub fn simulate(&self, model: CountModel, seed: u64) -> Result<Vec<DVec2>, SettingError> {
        let random = &mut Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut inside = exact_counts(model, self.points, self.quadrats(), random)?.into_iter();
        let count = |is_inside: &bool| if *is_inside { inside.next().unwrap_or(0) } else { 0 };
        let counts: Vec<u32> = self.is_inside.iter().map(count).collect();
        place_points(&self.grid, &counts, 0.0, random)
    }
}
