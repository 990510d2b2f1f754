//! A plant as it stands in its cell.

use std::f32::consts::TAU;

use bevy::math::{DVec2, Vec3};
use rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rand_distr::{Distribution, StandardNormal};

use crate::scatter::plan::Stock;

/// Size at the age at which a species is called full-grown: 95%.
const LEFT_TO_GROW: f32 = 0.05;
/// The greatest size that fits into a packed plant.
const GREATEST_SIZE: f32 = 4.0;
/// Deviations beyond which a normal variable is drawn in: one plant in 16,000.
const MOST_DEVIATIONS: f32 = 4.0;

/// A plant as it stands in its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planted {
    /// Where its stem leaves the ground, in the forest's own frame. units: m.
    pub position: Vec3,
    /// Turn about the vertical. units: rad, domain: \[0, 2π).
    pub turn_rad: f32,
    /// Its size, relative to a full-grown individual of its species. domain: (0, 4\].
    pub size: f32,
    /// Its size, relative to the mean of its species and age.
    pub vigour: f32,
    /// units: years.
    pub age_years: f32,
    /// How far it is ahead of the forest's season. units: days.
    pub season_days: f32,
    /// A shade of its own, from -1 to 1.
    pub tint: f32,
    /// Number of its species among [`Planter::species`](super::Planter::species).
    pub species: u8,
    /// Selects the individual and whatever else is random about it.
    pub seed: u32,
}

impl Planted {
    /// What follows from a plant's own random number. A species of age a has 1 - 0.05^(a/full-grown) of its size
    /// (Mitscherlich's law of growth).
    pub(super) fn grow(position: Vec3, stock: &Stock, species: u8, seed: u64) -> Self {
        let random = &mut Xoshiro256PlusPlus::seed_from_u64(seed);
        let age_years = log_normal(stock.age_years, stock.age_spread_years, random);
        let grown = 1.0 - LEFT_TO_GROW.powf(age_years / stock.full_grown_years);
        let vigour = log_normal(1.0, stock.size_spread, random);
        Self {
            position,
            turn_rad: random.random_range(0.0..TAU),
            size: (grown * vigour).clamp(1e-3, GREATEST_SIZE),
            vigour,
            age_years,
            season_days: stock.season_offset_days + stock.season_spread_days * normal(random),
            tint: stock.tint_spread * random.random_range(-1.0..=1.0),
            species,
            seed: random.next_u32(),
        }
    }

    /// The plant in 16 bytes, four words for a shader, lowest bits first:
    ///
    /// | word | bits |
    /// |---|---|
    /// | 0 | x, z in the cell, each 16 bits from 0 to `cell_m` |
    /// | 1 | height, the bits of an `f32` |
    /// | 2 | turn, 16 bits from 0 to 2π; size, 16 bits from 0 to 4 |
    /// | 3 | species; tint, 8 bits from -1 to 1; season, 8 bits from -128 to 127 days; the low byte of the seed |
    pub fn pack(&self, corner_m: DVec2, cell_m: f32) -> [u32; 4] {
        let whole = |share: f32, greatest: f32| (share.clamp(0.0, 1.0) * greatest).round() as u32;
        let place = DVec2::new(f64::from(self.position.x), f64::from(self.position.z));
        let place = ((place - corner_m) / f64::from(cell_m)).as_vec2();
        let tint = whole(0.5 + 0.5 * self.tint, 254.0);
        let season = whole((self.season_days + 128.0) / 255.0, 255.0);
        [
            whole(place.x, 65_535.0) | whole(place.y, 65_535.0) << 16,
            self.position.y.to_bits(),
            (whole(self.turn_rad / TAU, 65_536.0) & 0xffff) | whole(self.size / GREATEST_SIZE, 65_535.0) << 16,
            u32::from(self.species) | tint << 8 | season << 16 | (self.seed & 0xff) << 24,
        ]
    }
}

fn normal(random: &mut impl Rng) -> f32 {
    let value: f32 = StandardNormal.sample(random);
    value.clamp(-MOST_DEVIATIONS, MOST_DEVIATIONS)
}

/// A log-normal variable of given mean and standard deviation: with c = deviation / mean, σ² = ln(1 + c²) and
/// mean e^(σ z - σ²/2).
fn log_normal(mean: f32, deviation: f32, random: &mut impl Rng) -> f32 {
    let variance = (deviation / mean).powi(2).ln_1p();
    mean * (variance.sqrt() * normal(random) - 0.5 * variance).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn plants(stock: &Stock) -> Vec<Planted> {
        (0..40_000).map(|seed| Planted::grow(Vec3::new(10.0, 3.0, 20.0), stock, 5, seed)).collect()
    }

    fn moments(values: impl Iterator<Item = f32> + Clone) -> (f64, f64) {
        let count = values.clone().count() as f64;
        let mean = values.clone().map(f64::from).sum::<f64>() / count;
        (mean, (values.map(|value| (f64::from(value) - mean).powi(2)).sum::<f64>() / count).sqrt())
    }

    #[test]
    fn ages_seasons_and_tints_spread_as_the_stock_says() {
        let stock =
            Stock { season_offset_days: -20.0, season_spread_days: 6.0, tint_spread: 0.5, ..Default::default() };
        let plants = plants(&stock);
        // Standard errors: 0.2%, 1% (a long tail), 0.03 days, 0.4%.
        let (age, spread) = moments(plants.iter().map(|plant| plant.age_years));
        assert_relative_eq!(age, 80.0, max_relative = 0.01);
        assert_relative_eq!(spread, 30.0, max_relative = 0.04);
        let (season, spread) = moments(plants.iter().map(|plant| plant.season_days));
        assert_relative_eq!(season, -20.0, epsilon = 0.15);
        assert_relative_eq!(spread, 6.0, max_relative = 0.02);
        let (_, spread) = moments(plants.iter().map(|plant| plant.tint));
        assert_relative_eq!(spread, 0.5 / 3.0_f64.sqrt(), max_relative = 0.02);
        assert!(plants.iter().all(|plant| (0.0..TAU).contains(&plant.turn_rad) && plant.size > 0.0));
    }

    #[test]
    fn plants_of_one_age_grow_by_mitscherlich() {
        let size = |age_years| {
            let stock = Stock { age_years, age_spread_years: 0.0, size_spread: 0.0, ..Default::default() };
            Planted::grow(Vec3::ZERO, &stock, 0, 1).size
        };
        assert_relative_eq!(size(100.0), 0.95, epsilon = 1e-6);
        assert_relative_eq!(size(50.0), 1.0 - 0.05_f32.sqrt(), epsilon = 1e-6);
    }

    #[test]
    fn a_packed_plant_tells_the_same() {
        let corner = DVec2::new(-64.0, 64.0);
        for plant in plants(&Stock::default()).into_iter().take(500) {
            let plant = Planted { position: Vec3::new(-50.0, 321.5, 100.0), ..plant };
            let [place, height, turn_size, rest] = plant.pack(corner, 64.0);
            assert_relative_eq!((place & 0xffff) as f32 / 65_535.0 * 64.0, 14.0, epsilon = 1e-3);
            assert_relative_eq!((place >> 16) as f32 / 65_535.0 * 64.0, 36.0, epsilon = 1e-3);
            assert_eq!(f32::from_bits(height), 321.5);
            let turn = (turn_size & 0xffff) as f32 / 65_536.0 * TAU;
            assert!(((turn - plant.turn_rad + 1.0).rem_euclid(TAU) - 1.0).abs() < 1e-4);
            assert_relative_eq!((turn_size >> 16) as f32 / 65_535.0 * 4.0, plant.size, epsilon = 1e-4);
            let [species, tint, season, seed] = rest.to_le_bytes();
            assert_eq!((species, seed), (5, plant.seed as u8));
            assert_relative_eq!(f32::from(tint) / 127.0 - 1.0, plant.tint, epsilon = 0.005);
            assert_relative_eq!(f32::from(season) - 128.0, plant.season_days, epsilon = 0.501);
        }
    }
}
