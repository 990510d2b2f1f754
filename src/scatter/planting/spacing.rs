//! Removes plants that stand too near to others.

use bevy::math::DVec2;

use super::layer::Candidate;

/// Marks which candidates stay: those to which no candidate of higher rank is nearer than the mean of both their least
/// distances.
///
/// Candidates are sorted into tiles of the greatest distance, so that each looks into nine of them.
pub(super) fn keep_apart(candidates: &mut [Candidate], greatest_distance_m: f64) {
    if greatest_distance_m <= 0.0 || candidates.is_empty() {
        return;
    }
    let tiles = Tiles::new(candidates, greatest_distance_m);
    for index in 0..candidates.len() {
        candidates[index].stays = !candidates[index].in_cell || !tiles.is_crowded(candidates, &candidates[index]);
    }
}

struct Tiles {
    min: DVec2,
    side: f64,
    columns: usize,
    rows: usize,
    /// Where in `members` each tile begins; one more than tiles.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Tiles {
    fn new(candidates: &[Candidate], greatest_distance_m: f64) -> Self {
        let (min, max) = candidates
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(min, max), one| (min.min(one.at), max.max(one.at)));
        // No more tiles than candidates are worth.
        let side = greatest_distance_m.max((max - min).max_element() / (candidates.len() as f64).sqrt());
        let [columns, rows] = ((max - min) / side).to_array().map(|tiles| tiles as usize + 1);
        let mut tiles = Self { min, side, columns, rows, starts: vec![0; columns * rows + 1], members: Vec::new() };
        // A counting sort: stable, so that members keep their order.
        for one in candidates {
            let tile = tiles.tile(one.at);
            tiles.starts[tile + 1] += 1;
        }
        for tile in 1..tiles.starts.len() {
            tiles.starts[tile] += tiles.starts[tile - 1];
        }
        let mut next = tiles.starts.clone();
        tiles.members = vec![0; candidates.len()];
        for (index, one) in candidates.iter().enumerate() {
            let tile = tiles.tile(one.at);
            tiles.members[next[tile] as usize] = index as u32;
            next[tile] += 1;
        }
        tiles
    }

    fn column_and_row(&self, at: DVec2) -> [usize; 2] {
        let [column, row] = ((at - self.min) / self.side).to_array().map(|place| place as usize);
        [column.min(self.columns - 1), row.min(self.rows - 1)]
    }

    fn tile(&self, at: DVec2) -> usize {
        let [column, row] = self.column_and_row(at);
        row * self.columns + column
    }

    /// Whether a candidate has to give way to another.
    fn is_crowded(&self, candidates: &[Candidate], one: &Candidate) -> bool {
        let [column, row] = self.column_and_row(one.at);
        let columns = column.saturating_sub(1)..(column + 2).min(self.columns);
        (row.saturating_sub(1)..(row + 2).min(self.rows)).any(|row| {
            // Tiles of a row follow each other.
            let [first, last] = [columns.start, columns.end].map(|column| self.starts[row * self.columns + column]);
            self.members[first as usize..last as usize].iter().any(|&other| {
                let other = &candidates[other as usize];
                let distance_m = 0.5 * (one.least_distance_m + other.least_distance_m);
                other.at.distance_squared(one.at) < distance_m * distance_m && other.rank() > one.rank()
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    fn candidates(count: usize, side: f64, least_distance_m: f64, seed: u64) -> Vec<Candidate> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let one = |_| Candidate {
            at: side * DVec2::new(random.random(), random.random()),
            seed: random.next_u64(),
            least_distance_m: least_distance_m * random.random_range(0.5..=1.0),
            area: random.random_range(0..3),
            in_cell: true,
            ..Candidate::default()
        };
        (0..count).map(one).collect()
    }

    #[test]
    fn tiles_agree_with_an_exhaustive_search() {
        for (count, side, distance) in [(500, 100.0, 4.0), (300, 5.0, 20.0), (2, 1e4, 0.1), (1, 1.0, 1.0)] {
            let mut tiled = candidates(count, side, distance, 3);
            let slow: Vec<bool> = tiled
                .iter()
                .map(|one| {
                    !tiled.iter().any(|other| {
                        let distance_m = 0.5 * (one.least_distance_m + other.least_distance_m);
                        other.at.distance(one.at) < distance_m && other.rank() > one.rank()
                    })
                })
                .collect();
            keep_apart(&mut tiled, distance);
            assert_eq!(tiled.iter().map(|one| one.stays).collect::<Vec<_>>(), slow);
        }
    }

    /// Matérn's second process: of a random pattern of density λ remain (1 - exp(-λ π d²)) / (π d²).
    #[test]
    fn density_after_thinning_is_materns() {
        let (side, distance, count) = (1000.0, 4.0, 40_000);
        let mut candidates = candidates(count, side, distance, 8);
        for one in &mut candidates {
            (one.least_distance_m, one.area) = (distance, 0);
        }
        keep_apart(&mut candidates, distance);
        let inside = |one: &&Candidate| one.at.min_element() > 4.0 && one.at.max_element() < side - 4.0;
        let stay = candidates.iter().filter(inside).filter(|one| one.stays).count() as f64;
        let disc = std::f64::consts::PI * distance * distance;
        let density = count as f64 / (side * side);
        let expected = (1.0 - (-density * disc).exp()) / disc * (side - 8.0).powi(2);
        // 17,000 are expected, and scatter less than a random pattern's 130.
        assert!((stay / expected - 1.0).abs() < 0.02, "{stay} for {expected}");
    }
}
