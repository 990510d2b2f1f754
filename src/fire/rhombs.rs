//! The shape of a fire: self-similar rhombs (Zaharia, section 2.1).
//!
//! The seed has four rhombs. The base lies on the ground; three tongues stand on its centre at 60 degrees of elevation,
//! turned about the vertical by
//!
//! ```text
//! u_rot = u_init +- random() pi,    u_init = -pi/2, pi/6, 5 pi/6        (1)
//! ```
//!
//! Along the longest diagonal of each tongue, at 0.15, 0.33, 0.66 and 1, stand copies of the seed, scaled by 0.6, 0.6, 0.5
//! and 0.2; copies of these on their tongues, until a copy would be smaller than the threshold. A copy is all of the seed:
//! its base, too, is kept and drawn, for the paper's cost of a seed is that of "the polygons forming the current seed", "the
//! basic rhomb" among them. A copy has a position and a scale, and no rotation: its base is parallel to the fire's base
//! plane, its centre on the tongue that bears it. The number of rhombs N of a seed of size x follows from that alone:
//!
//! ```text
//! N(x) = 4 + 3 (2 N(0.6 x) + N(0.5 x) + N(0.2 x)),   N(x) = 0 below the threshold
//! ```
//!
//! The paper does not give the threshold. With 2 in the unit of its `axa`, N is proportional to the times of its table 1 to
//! 10%, all eight of them; the aspect ratio (`cf01`) does not enter, as there. (The table does not tell whether the bases of
//! copies are drawn: without them it is (3 N + 4) / 4 rhombs, as proportional to his times as N is.)

use super::settings::FireShape;
use bevy::math::Vec3;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_6, PI};

/// `u_init` of the three tongues (equation 1), rad.
const FIRST_TURNS_RAD: [f32; 3] = [-FRAC_PI_2, FRAC_PI_6, 5.0 * FRAC_PI_6];
/// Sine and cosine of the tongues' elevation of 60 degrees.
const ELEVATION: (f32, f32) = (0.866_025_4, 0.5);
/// Where copies of the seed stand on a tongue, and how large they are.
const COPIES: [(f32, f32); 4] = [(0.15, 0.6), (0.33, 0.6), (0.66, 0.5), (1.0, 0.2)];

/// Which rhomb of the seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RhombKind {
    /// Lies on the base plane.
    Base,
    /// Stands on it.
    Tongue,
}

/// One rhomb, in the fire's coordinates: y up, metres, the centre of the first base at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rhomb {
    /// Which of the seed it is.
    pub kind: RhombKind,
    /// 0 for the first seed, 1 for its copies, and so on.
    pub order: u32,
    /// One end of the longest diagonal; the foot of a tongue.
    pub start: Vec3,
    /// The longest diagonal.
    pub along: Vec3,
    /// The shortest diagonal.
    pub across: Vec3,
}

impl Rhomb {
    /// The corners in their order around it, from the start.
    fn corners(&self) -> [Vec3; 4] {
        let (centre, half) = (self.start + 0.5 * self.along, 0.5 * self.across);
        [self.start, centre + half, self.start + self.along, centre - half]
    }
}

/// All rhombs of a fire. `shape` must be valid. The same shape gives the same rhombs, bit by bit.
pub fn grow_rhombs(shape: &FireShape) -> Vec<Rhomb> {
    let mut growth = Growth { shape, random: Xoshiro256PlusPlus::seed_from_u64(shape.seed), rhombs: Vec::new() };
    growth.seed(Vec3::ZERO, shape.size_m, 0);
    growth.rhombs
}

/// The number of rhombs of a seed of that size: `N` above. The sizes have one unit; the aspect ratios do not matter.
pub fn rhomb_count(size: f32, threshold: f32) -> u64 {
    if size < threshold {
        return 0;
    }
    4 + 3 * COPIES.iter().map(|(_, scale)| rhomb_count(size * scale, threshold)).sum::<u64>()
}

struct Growth<'a> {
    shape: &'a FireShape,
    random: Xoshiro256PlusPlus,
    rhombs: Vec<Rhomb>,
}

impl Growth<'_> {
    fn seed(&mut self, centre: Vec3, size_m: f32, order: u32) {
        if size_m < self.shape.threshold_m {
            return;
        }
        let along = Vec3::X * size_m;
        let across = Vec3::Z * (self.shape.base_ratio * size_m);
        self.rhombs.push(Rhomb { kind: RhombKind::Base, order, start: centre - 0.5 * along, along, across });
        for first_turn in FIRST_TURNS_RAD {
            let sign = if self.random.random::<bool>() { 1.0 } else { -1.0 };
            let turn = first_turn + sign * self.random.random::<f32>() * PI;
            let along = self.tongue(centre, turn, size_m, order);
            for (place, scale) in COPIES {
                self.seed(centre + along * place, size_m * scale, order + 1);
            }
        }
    }

    /// Adds a tongue; its longest diagonal.
    fn tongue(&mut self, foot: Vec3, turn_rad: f32, size_m: f32, order: u32) -> Vec3 {
        let (sine, cosine) = turn_rad.sin_cos();
        let (up, out) = ELEVATION;
        let along = Vec3::new(out * cosine, up, out * sine) * (self.shape.tongue_length * size_m);
        let across = Vec3::new(-sine, 0.0, cosine) * (self.shape.tongue_ratio * along.length());
        self.rhombs.push(Rhomb { kind: RhombKind::Tongue, order, start: foot, along, across });
        along
    }
}

/// Height of the highest corner, m.
pub(super) fn height_m(rhombs: &[Rhomb]) -> f32 {
    rhombs.iter().flat_map(Rhomb::corners).map(|corner| corner.y).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape() -> FireShape {
        FireShape { size_m: 1.0, threshold_m: 0.2, seed: 3, ..FireShape::default() }
    }

    #[test]
    fn count_is_proportional_to_the_times_of_table_1() {
        const LONGEST_DIAGONAL: [f32; 8] = [20.0, 20.0, 30.0, 30.0, 30.0, 30.0, 35.0, 40.0];
        const TIME: [f64; 8] = [24.6, 27.9, 79.1, 82.3, 83.5, 82.5, 179.0, 297.0];
        let per_rhomb: Vec<f64> =
            LONGEST_DIAGONAL.iter().zip(TIME).map(|(size, time)| time / rhomb_count(*size, 2.0) as f64).collect();
        let mean = (per_rhomb.iter().map(|time| time.ln()).sum::<f64>() / 8.0).exp();
        // The same 20 units take 24.6 and 27.9 in the table: its own scatter is 13%.
        assert!(per_rhomb.iter().all(|time| (time / mean - 1.0).abs() < 0.1), "{per_rhomb:?}");
    }

    #[test]
    fn number_of_rhombs_is_the_count() {
        for threshold_m in [0.1, 0.17, 0.25, 0.4, 0.61, 1.0] {
            let shape = FireShape { threshold_m, ..shape() };
            assert_eq!(grow_rhombs(&shape).len() as u64, rhomb_count(1.0, threshold_m));
            let other = FireShape { tongue_ratio: 0.9, base_ratio: 0.2, seed: 8, ..shape };
            assert_eq!(grow_rhombs(&other).len() as u64, rhomb_count(1.0, threshold_m));
        }
        assert_eq!(rhomb_count(1.0, 0.61), 4);
        // Copies of 0.6 and 0.5, but none of 0.2, and nothing on them.
        assert_eq!(rhomb_count(1.0, 0.45), 4 + 3 * 3 * 4);
    }

    #[test]
    fn tongues_have_an_elevation_of_sixty_degrees_and_bases_of_none() {
        for rhomb in grow_rhombs(&shape()) {
            let elevation = (rhomb.along.y / rhomb.along.length()).asin().to_degrees();
            let expected = if rhomb.kind == RhombKind::Tongue { 60.0 } else { 0.0 };
            assert!((elevation - expected).abs() < 1e-3, "{elevation}");
            assert!(rhomb.across.y == 0.0 && rhomb.across.dot(rhomb.along).abs() < 1e-5);
        }
    }

    /// A copy is all of the seed: a base and three tongues, and its base is the first one, smaller and elsewhere.
    #[test]
    fn every_copy_has_its_base_parallel_to_the_first_and_three_tongues_on_its_centre() {
        let rhombs = grow_rhombs(&shape());
        let [first, ..] = rhombs[..] else { panic!("a fire has rhombs") };
        let bases: Vec<&Rhomb> = rhombs.iter().filter(|rhomb| rhomb.kind == RhombKind::Base).collect();
        assert!(bases.len() > 100 && 4 * bases.len() == rhombs.len(), "{} of {}", bases.len(), rhombs.len());
        for base in bases {
            let scale = base.along.length() / first.along.length();
            assert!(base.along.abs_diff_eq(first.along * scale, 1e-6), "{base:?}");
            assert!(base.across.abs_diff_eq(first.across * scale, 1e-6), "{base:?}");
            let centre = base.start + 0.5 * base.along;
            let stands = |rhomb: &&Rhomb| {
                let length = rhomb.along.length() / (shape().tongue_length * first.along.length());
                rhomb.kind == RhombKind::Tongue
                    && rhomb.order == base.order
                    && (length - scale).abs() < 1e-5
                    && rhomb.start.abs_diff_eq(centre, 1e-5)
            };
            assert!(rhombs.iter().filter(stands).count() >= 3, "{base:?}");
        }
    }

    #[test]
    fn copies_stand_on_their_tongues_with_the_sizes_given() {
        let rhombs = grow_rhombs(&shape());
        let first: Vec<&Rhomb> =
            rhombs.iter().filter(|rhomb| rhomb.order == 0 && rhomb.kind == RhombKind::Tongue).collect();
        let copies = rhombs.iter().filter(|rhomb| rhomb.order == 1 && rhomb.kind == RhombKind::Base);
        let mut number = 0;
        for copy in copies {
            let centre = copy.start + 0.5 * copy.along;
            let fits = |tongue: &&Rhomb| {
                COPIES.iter().any(|(place, scale)| {
                    centre.abs_diff_eq(tongue.start + tongue.along * *place, 1e-5)
                        && (copy.along.length() - scale).abs() < 1e-5
                })
            };
            assert!(first.iter().any(fits), "{copy:?}");
            number += 1;
        }
        assert_eq!(number, 12);
    }

    #[test]
    fn rhombs_depend_on_the_seed() {
        assert_eq!(grow_rhombs(&shape()), grow_rhombs(&shape()));
        assert_ne!(grow_rhombs(&shape()), grow_rhombs(&FireShape { seed: 4, ..shape() }));
    }

    #[test]
    fn turns_cover_the_circle() {
        let mut octants = [0_u32; 8];
        for seed in 0..400 {
            for rhomb in grow_rhombs(&FireShape { threshold_m: 1.0, seed, ..shape() }).iter().skip(1) {
                let turn = rhomb.along.z.atan2(rhomb.along.x).rem_euclid(2.0 * PI);
                octants[((turn / (2.0 * PI) * 8.0) as usize).min(7)] += 1;
            }
        }
        // u_init +- pi random() with both signs is uniform: 150 in each octant, give or take four standard deviations.
        assert!(octants.iter().all(|count| count.abs_diff(150) < 46), "{octants:?}");
    }
}
