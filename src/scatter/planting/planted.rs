//! A plant of a cell, and its packed form.

use std::f32::consts::TAU;

use bevy::math::{DVec2, Vec2, Vec3};
use rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rand_distr::{Distribution, StandardNormal};

use crate::scatter::plan::stock::Stock;

/// What is left to grow at the age at which a species is called full-grown: it has 95% of its size.
const LEFT_TO_GROW: f32 = 0.05;
/// The greatest size that fits into a packed plant.
pub(crate) const GREATEST_SIZE: f32 = 4.0;
/// Deviations beyond which a normal variable is drawn in: one plant in 16,000.
const MOST_DEVIATIONS: f32 = 4.0;

/// A plant as it stands in its cell.
///
/// # Two sizes
/// A plan has a law of growth of its own, since it plants whatever has a name: crops, shrubs, trees of another program. It knows no
/// species files, and its one number, the age at which a stock is full-grown, is enough to know the stems of a plan from the plan alone.
/// The size that follows from it, `plan_size`, is what stores of cells pack, and what their queries scale trunks by.
///
/// The trees of a [`Forest`](crate::forest::Forest) are drawn in the size of their species at that age, after its
/// [`Age`](crate::tree::growth::age::Age), times `vigour`. There height, girth and crown have a curve each. Age and vigour are the same
/// in both. For nearly the same heights give a stock the age at which its species has 95% of its greatest height: with the rate k and
/// the shape p of its height that is -ln(1 - 0.95^(1/p)) / k years.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planted {
    /// Where its stem leaves the ground, in the forest's own frame. units: m.
    pub position: Vec3,
    /// Turn about the vertical. units: rad, domain: \[0, 2π).
    pub turn_rad: f32,
    /// Its size after the plan's own law of growth, relative to a full-grown individual. domain: (0, 4\].
    pub plan_size: f32,
    /// Its size, relative to the mean of its species and age, whichever law of growth is asked.
    pub vigour: f32,
    /// units: years.
    pub age_years: f32,
    /// How far it is ahead of the forest's season. units: days.
    pub season_days: f32,
    /// Its shade within the species, from -1 to 1.
    pub tint: f32,
    /// Number of its species among [`Planter::species`](super::Planter::species).
    pub species: u8,
    /// Selects the individual and whatever else is random about it.
    pub seed: u32,
}

impl Planted {
    /// What follows from a plant's own random number.
    pub(super) fn grow(position: Vec3, stock: &Stock, species: u8, seed: u64) -> Self {
        let random = &mut Xoshiro256PlusPlus::seed_from_u64(seed);
        let age_years = log_normal(stock.age_years, stock.age_spread_years, random);
        let vigour = log_normal(1.0, stock.size_spread, random);
        Self {
            position,
            turn_rad: random.random_range(0.0..TAU),
            plan_size: plan_size(age_years, stock.full_grown_years, vigour),
            vigour,
            age_years,
            season_days: stock.season_offset_days + stock.season_spread_days * normal(random),
            tint: stock.tint_spread * random.random_range(-1.0..=1.0),
            species,
            seed: random.next_u32(),
        }
    }

    /// The same plant at another age, of a stock that is full-grown at that one.
    pub(super) fn at_age(self, age_years: f32, full_grown_years: f32) -> Self {
        Self { plan_size: plan_size(age_years, full_grown_years, self.vigour), age_years, ..self }
    }

    /// The plant in 16 bytes, four words for a shader, lowest bits first:
    ///
    /// | word | bits |
    /// |---|---|
    /// | 0 | x, z in the cell, each 16 bits from 0 to `cell_m` |
    /// | 1 | height, the bits of an `f32` |
    /// | 2 | turn, 16 bits from 0 to 2π; size, 16 bits from 0 to 4 |
    /// | 3 | species; tint, 8 bits from -1 to 1; season, 8 bits from -128 to 127 days; the low byte of the seed |
    pub(crate) fn pack(&self, corner_m: DVec2, cell_m: f32) -> [u32; 4] {
        let whole = |share: f32, greatest: f32| (share.clamp(0.0, 1.0) * greatest).round() as u32;
        let place = DVec2::new(f64::from(self.position.x), f64::from(self.position.z));
        let place = ((place - corner_m) / f64::from(cell_m)).as_vec2();
        let tint = whole(0.5 + 0.5 * self.tint, 254.0);
        let season = whole((self.season_days + 128.0) / 255.0, 255.0);
        [
            whole(place.x, 65_535.0) | whole(place.y, 65_535.0) << 16,
            self.position.y.to_bits(),
            (whole(self.turn_rad / TAU, 65_536.0) & 0xffff) | whole(self.plan_size / GREATEST_SIZE, 65_535.0) << 16,
            u32::from(self.species) | tint << 8 | season << 16 | (self.seed & 0xff) << 24,
        ]
    }
}

/// What a packed plant holds, rounded: 1 mm of place in a cell of 64 m, 0.1 mrad of turn, a day of season.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stem {
    /// Where it leaves the ground, in the forest's own frame. units: m.
    pub position: Vec3,
    /// Turn about the vertical. units: rad, domain: \[0, 2π).
    pub turn_rad: f32,
    /// Its [`Planted::plan_size`]. domain: \[0, 4\].
    pub plan_size: f32,
    /// How far it is ahead of the forest's season. units: days, domain: \[-128, 127\].
    pub season_days: f32,
    /// Its shade within the species, from -1 to 1.
    pub tint: f32,
    /// Number of its species among [`Planter::species`](super::Planter::species).
    pub species: u8,
    /// The low byte of the plant's seed.
    pub seed: u8,
}

impl Stem {
    /// Reads what [`Planted::pack`] wrote, of the same cell.
    pub(crate) fn unpack(words: [u32; 4], corner_m: DVec2, cell_m: f32) -> Self {
        let place = corner_m + Self::place_in_cell(words, cell_m).as_dvec2();
        let [_, height, turn_size, rest] = words;
        let [species, tint, season, seed] = rest.to_le_bytes();
        Self {
            position: Vec3::new(place.x as f32, f32::from_bits(height), place.y as f32),
            turn_rad: (turn_size & 0xffff) as f32 / 65_536.0 * TAU,
            plan_size: Self::packed_size(words),
            season_days: f32::from(season) - 128.0,
            tint: f32::from(tint) / 127.0 - 1.0,
            species,
            seed,
        }
    }

    /// Only the place (x, z) of a packed plant, from the corner of its cell, m.
    pub(crate) fn place_in_cell([place, ..]: [u32; 4], cell_m: f32) -> Vec2 {
        Vec2::new((place & 0xffff) as f32, (place >> 16) as f32) * (cell_m / 65_535.0)
    }

    /// Only the size of a packed plant.
    pub(crate) fn packed_size(words: [u32; 4]) -> f32 {
        (words[2] >> 16) as f32 * (GREATEST_SIZE / 65_535.0)
    }
}

/// [`Planted::plan_size`]. A species of age a has 1 - 0.05^(a/full-grown) of its size (Mitscherlich's law of growth).
fn plan_size(age_years: f32, full_grown_years: f32, vigour: f32) -> f32 {
    let grown = 1.0 - libm::powf(LEFT_TO_GROW, age_years / full_grown_years);
    (grown * vigour).clamp(1e-3, GREATEST_SIZE)
}

fn normal(random: &mut impl Rng) -> f32 {
    let value: f32 = StandardNormal.sample(random);
    value.clamp(-MOST_DEVIATIONS, MOST_DEVIATIONS)
}

/// A log-normal variable of given mean and standard deviation: with c = deviation / mean, σ² = ln(1 + c²) and
/// mean e^(σ z - σ²/2).
fn log_normal(mean: f32, deviation: f32, random: &mut impl Rng) -> f32 {
    let variance = libm::log1pf((deviation / mean) * (deviation / mean));
    mean * libm::expf(variance.sqrt() * normal(random) - 0.5 * variance)
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
    fn ages_seasons_and_tints_have_the_spread_of_the_stock() {
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
        assert!(plants.iter().all(|plant| (0.0..TAU).contains(&plant.turn_rad) && plant.plan_size > 0.0));
    }

    #[test]
    fn size_follows_mitscherlichs_law() {
        let size = |age_years| {
            let stock = Stock { age_years, age_spread_years: 0.0, size_spread: 0.0, ..Default::default() };
            Planted::grow(Vec3::ZERO, &stock, 0, 1).plan_size
        };
        assert_relative_eq!(size(100.0), 0.95, epsilon = 1e-6);
        assert_relative_eq!(size(50.0), 1.0 - 0.05_f32.sqrt(), epsilon = 1e-6);
    }

    #[test]
    fn packing_round_trips_within_its_resolution() {
        let corner = DVec2::new(-64.0, 64.0);
        for (number, plant) in plants(&Stock::default()).into_iter().take(500).enumerate() {
            let across = number as f32 / 499.0 * 64.0;
            let plant = Planted { position: Vec3::new(across - 64.0, 321.5, 128.0 - across), ..plant };
            let stem = Stem::unpack(plant.pack(corner, 64.0), corner, 64.0);
            assert_relative_eq!(stem.position.x, plant.position.x, epsilon = 1e-3);
            assert_relative_eq!(stem.position.z, plant.position.z, epsilon = 1e-3);
            assert_eq!(stem.position.y, 321.5);
            assert!(((stem.turn_rad - plant.turn_rad + 1.0).rem_euclid(TAU) - 1.0).abs() < 1e-4);
            assert!((0.0..TAU).contains(&stem.turn_rad));
            assert_relative_eq!(stem.plan_size, plant.plan_size, epsilon = 1e-4);
            assert_eq!((stem.species, stem.seed), (5, plant.seed as u8));
            assert_relative_eq!(stem.tint, plant.tint, epsilon = 0.005);
            assert_relative_eq!(stem.season_days, plant.season_days, epsilon = 0.501);
        }
    }

    #[test]
    fn bits_are_where_the_shader_reads_them() {
        let plant = Planted {
            position: Vec3::new(14.0, 321.5, 36.0),
            turn_rad: 0.25 * TAU,
            plan_size: 1.0,
            vigour: 1.0,
            age_years: 80.0,
            season_days: -8.0,
            tint: 1.0,
            species: 5,
            seed: 0x1234_56ab,
        };
        let [place, height, turn_size, rest] = plant.pack(DVec2::ZERO, 64.0);
        assert_eq!([place & 0xffff, place >> 16], [14, 36].map(|part| (part * 65_535 + 32) / 64));
        assert_eq!(f32::from_bits(height), 321.5);
        assert_eq!([turn_size & 0xffff, turn_size >> 16], [0x4000, 0x4000]);
        assert_eq!(rest.to_le_bytes(), [5, 254, 120, 0xab]);
    }
}
