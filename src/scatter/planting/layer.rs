//! A prepared area: its quadrats, and the plants that they hold.

use bevy::math::{DVec2, IVec2};
use rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

use crate::{
    ground::Ground,
    mixing::{mixed, packed},
    scatter::{
        counts::probability::Probabilities,
        plan::{forest::Area, shape::Region, stock::Stock},
        quadrat::place::throw_darts,
    },
    setting::SettingError,
};

/// How far rounding to `f32` may move a place, at the farthest from the origin.
const ROUNDING_M: f64 = 0.01;

/// A plant that would stand somewhere, if nothing is in its way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Candidate {
    pub at: DVec2,
    pub height_m: f32,
    pub seed: u64,
    pub least_distance_m: f64,
    pub area: u32,
    /// Which of the area's stock.
    pub stock: u32,
    /// Others are outside the cell and only take part in the comparison.
    pub in_cell: bool,
    pub stays: bool,
}

impl Candidate {
    /// Of two plants in each other's way that of higher rank stays: that of the earlier area, then that with the greater
    /// random number.
    pub(super) fn rank(&self) -> (std::cmp::Reverse<u32>, u64) {
        (std::cmp::Reverse(self.area), self.seed)
    }
}

/// A square on the map.
#[derive(Clone, Copy)]
pub(super) struct Square {
    pub min: DVec2,
    pub max: DVec2,
}

impl Square {
    /// Its least edges belong to it, its greatest to the next.
    pub(super) fn contains(&self, at: DVec2) -> bool {
        at.cmpge(self.min).all() && at.cmplt(self.max).all()
    }
}

/// A prepared area.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// The area's own stream of random numbers.
    stream: u64,
    number: u32,
    region: Region,
    quadrat_m: f64,
    counts: Probabilities,
    area: Area,
}

impl Layer {
    pub(super) fn new(area: &Area, number: u32, seed: u64) -> Result<Self, SettingError> {
        Ok(Self {
            stream: mixed(mixed(seed) ^ u64::from(number)),
            number,
            region: Region::new(&area.shape),
            quadrat_m: f64::from(area.quadrat_side_m()),
            counts: Probabilities::new(&area.law()?),
            area: area.clone(),
        })
    }

    /// Its place in the plan.
    pub(super) fn number(&self) -> u32 {
        self.number
    }

    pub(super) fn bounds(&self) -> [DVec2; 2] {
        self.region.bounds()
    }

    pub(super) fn stock(&self, number: u32) -> &Stock {
        &self.area.stock[number as usize]
    }

    pub(super) fn stocks(&self) -> &[Stock] {
        &self.area.stock
    }

    pub(super) fn least_distance_m(&self) -> f64 {
        f64::from(self.area.least_distance_m)
    }

    /// Plants per hectare to be expected at a place with that ground, before those go that are too near to each other.
    pub(super) fn density_per_ha(&self, at: DVec2, height_m: f32, slope: f32) -> f32 {
        let [min, max] = self.region.bounds();
        if at.cmplt(min).any() || at.cmpgt(max).any() {
            return 0.0;
        }
        let stock_admitted: f32 =
            self.area.stock.iter().map(|stock| stock.ground.admitted(height_m, slope)).fold(0.0, f32::max);
        let ground = self.area.ground.admitted(height_m, slope).min(stock_admitted);
        self.area.density_per_ha * self.region.coverage(at) * ground
    }

    /// Tells what each stock adds to [`density_per_ha`](Self::density_per_ha): the number of the stock, and its part.
    pub(super) fn expected_stock(&self, at: DVec2, height_m: f32, slope: f32, mut tell: impl FnMut(u32, f32)) {
        let density_per_ha = self.density_per_ha(at, height_m, slope);
        if density_per_ha <= 0.0 {
            return;
        }
        let share = |stock: &Stock| stock.share * stock.ground.admitted(height_m, slope);
        let shares: f32 = self.area.stock.iter().map(share).sum();
        for (number, stock) in (0..).zip(&self.area.stock) {
            let part = share(stock) / shares;
            if part > 0.0 {
                tell(number, density_per_ha * part);
            }
        }
    }

    /// Adds the plants of the quadrats that reach into `around`, where the place is `free` and the ground is right.
    pub(super) fn add_candidates(
        &self,
        around: Square,
        cell: Square,
        ground: &impl Ground,
        free: impl Fn(DVec2) -> bool,
        places: &mut Vec<DVec2>,
        candidates: &mut Vec<Candidate>,
        most: usize,
    ) {
        let [min, max] = self.region.bounds();
        let (from, to) = (around.min.max(min), around.max.min(max));
        if from.cmpgt(to).any() {
            return;
        }
        let quadrat = |place: DVec2| -> IVec2 { (place / self.quadrat_m).floor().as_ivec2() };
        let (first, last) = (quadrat(from - ROUNDING_M), quadrat(to + ROUNDING_M));
        for row in first.y..=last.y {
            for column in first.x..=last.x {
                let mut random = self.draw_places(IVec2::new(column, row), places);
                for place in &*places {
                    let seed = random.next_u64();
                    // Everything is decided for the place as it is returned, in `f32`.
                    let at = place.as_vec2().as_dvec2();
                    let wanted = around.contains(at) && at.cmpge(min).all() && at.cmple(max).all();
                    if wanted
                        && candidates.len() < most
                        && let Some(candidate) = self.candidate(at, seed, ground, &free)
                    {
                        candidates.push(Candidate { in_cell: cell.contains(at), ..candidate });
                    }
                }
            }
        }
    }

    /// Draws the places of a quadrat's plants, and returns its random numbers.
    fn draw_places(&self, quadrat: IVec2, places: &mut Vec<DVec2>) -> Xoshiro256PlusPlus {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(place_hash(self.stream, quadrat));
        places.clear();
        let count = self.counts.draw(&mut random);
        let corner = quadrat.as_dvec2() * self.quadrat_m;
        throw_darts(corner, DVec2::splat(self.quadrat_m), count, self.least_distance_m(), &mut random, places);
        random
    }

    fn candidate(&self, at: DVec2, seed: u64, ground: &impl Ground, free: impl Fn(DVec2) -> bool) -> Option<Candidate> {
        let coverage = self.region.coverage(at);
        let covered = coverage >= 1.0 || share_of(mixed(seed ^ COVERAGE)) < coverage;
        if !covered || !free(at) {
            return None;
        }
        let (height_m, slope) = (ground.height_m(at) as f32, ground.slope(at) as f32);
        let chance = share_of(mixed(seed ^ LIMITS));
        if !height_m.is_finite() || !self.area.ground.admit(height_m, slope, chance) {
            return None;
        }
        let stock = self.choose_stock(at, seed, |stock| stock.ground.admit(height_m, slope, chance))?;
        let least_distance_m = self.least_distance_m();
        Some(Candidate { at, height_m, seed, least_distance_m, area: self.number, stock, in_cell: false, stays: true })
    }

    /// Which species stands here: one of those that the ground admits, by their shares; mostly the same within a drift.
    fn choose_stock(&self, at: DVec2, seed: u64, admitted: impl Fn(&Stock) -> bool) -> Option<u32> {
        let shares = || self.area.stock.iter().map(|stock| if admitted(stock) { stock.share } else { 0.0 });
        let total: f32 = shares().sum();
        let with_drift = self.area.drift_m > 0.0 && share_of(mixed(seed ^ PURITY)) < self.area.drift_purity;
        let chooser = if with_drift { self.drift(at) } else { mixed(seed ^ SPECIES) };
        let mut left = share_of(chooser) * total;
        // The last with a share takes what rounding leaves.
        let mut chosen = None;
        for (number, share) in shares().enumerate().filter(|(_, share)| *share > 0.0) {
            chosen = Some(number as u32);
            left -= share;
            if left < 0.0 {
                break;
            }
        }
        chosen
    }

    /// The random number of the drift at a place: that of the nearest of scattered centres, one in each square.
    fn drift(&self, at: DVec2) -> u64 {
        let size = f64::from(self.area.drift_m);
        let here = (at / size).floor().as_ivec2();
        let mut nearest = (f64::INFINITY, 0);
        for row in -1..=1 {
            for column in -1..=1 {
                let square = here + IVec2::new(column, row);
                let number = place_hash(self.stream ^ DRIFT, square);
                let mut random = Xoshiro256PlusPlus::seed_from_u64(number);
                let centre = (square.as_dvec2() + DVec2::new(random.random(), random.random())) * size;
                let distance = centre.distance_squared(at);
                if distance < nearest.0 {
                    nearest = (distance, number);
                }
            }
        }
        mixed(nearest.1 ^ SPECIES)
    }
}

/// Salts that separate the random numbers of one seed for different purposes.
const COVERAGE: u64 = 0x636f_7665;
const LIMITS: u64 = 0x6c69_6d69;
const PURITY: u64 = 0x7075_7269;
const SPECIES: u64 = 0x7370_6563;
const DRIFT: u64 = 0x6472_6966;

fn place_hash(stream: u64, place: IVec2) -> u64 {
    mixed(stream ^ mixed(packed(place)))
}

/// A number from 0 to below 1.
fn share_of(random: u64) -> f32 {
    (random >> 40) as f32 / (1 << 24) as f32
}
