//! The layout of a meadow: tufts over the ground, blades in each tuft.
//!
//! A tuft, after Zaharia (section 2.2), has blades that grow from closely positioned points, each with
//!
//! ```text
//! l   = l_min + (l_max - l_min) random()        length
//! w   = w_min + (w_max - w_min) random()        width at the base
//! u_y = spread pi/2 random()                    inclination; as printed, spread = 1
//! u_z = 2 pi random()                           azimuth
//! ```
//!
//! Tufts stand at the points of a low-discrepancy sequence (Roberts' R2, 2018: multiples of the inverse plastic number,
//! modulo 1), each moved a little. Blades are ordered so that **every prefix is a thinner meadow**: first one blade of each
//! tuft, then a second of each, and so on. A blade's `rank` is its place in that order, from 0 to 1.

use super::settings::Sward;
use crate::{ground::Ground, sequence::r2};
use bevy::math::{Vec2, Vec3};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f32::consts::{FRAC_PI_2, TAU};

/// How far a tuft is moved off its point, as a share of the mean distance between tufts: enough to hide the lattice.
const TUFT_JITTER: f32 = 0.45;
/// Greatest dryness of blades that are not dry: a little yellow that differs from blade to blade.
const GREENEST: f32 = 0.25;

/// One blade at rest, in the patch's coordinates: y up, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blade {
    /// Where it grows.
    pub root: Vec3,
    /// Length, m.
    pub length_m: f32,
    /// Width at the base, m.
    pub width_m: f32,
    /// Direction in which it leans, from x towards z, rad.
    pub azimuth_rad: f32,
    /// Angle from the vertical at the root, rad.
    pub lean_rad: f32,
    /// How much farther from the vertical the tip is in still air, rad.
    pub droop_rad: f32,
    /// 0 is fresh, 1 is straw.
    pub dryness: f32,
    /// Place in the order of thinning, 0 to 1: the last ones are left out first.
    pub rank: f32,
    /// Share of the ground there that is under trees, 0 to 1.
    pub under_trees: f32,
}

/// The blades of a sward over `ground` in the patch's coordinates, in the order of their rank. Where its height is not a number,
/// nothing grows.
///
/// `sward` must be valid. The same sward over the same ground gives the same blades, bit by bit.
pub fn layout_blades(sward: &Sward, ground: &impl Ground) -> Vec<Blade> {
    let tufts: Vec<Vec<Blade>> = (0..sward.tufts()).map(|tuft| layout_tuft(sward, tuft, ground)).collect();
    let mut blades: Vec<Blade> = (0..sward.tuft.blades as usize)
        .flat_map(|round| tufts.iter().filter_map(move |tuft| tuft.get(round)))
        .copied()
        .collect();
    let count = blades.len() as f32;
    for (place, blade) in blades.iter_mut().enumerate() {
        blade.rank = place as f32 / count;
    }
    blades
}

/// All blades of one tuft. Each tuft has random numbers of its own, so that none depends on how many there are before it.
fn layout_tuft(sward: &Sward, number: u32, ground: &impl Ground) -> Vec<Blade> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(sward.seed ^ (u64::from(number) << 32));
    let tuft = &sward.tuft;
    let centre = tuft_centre(sward, number, &mut random);
    // An exponent above 1 makes short blades likelier, one below 1 long ones.
    let exponent = (4.0 * tuft.clumping * (random.random::<f32>() - 0.5)).exp2();
    let mut between = |low: f32, high: f32| low + (high - low) * random.random::<f32>();
    let blades = (0..tuft.blades).map(|_| {
        let azimuth_rad = between(0.0, TAU);
        let at = centre + Vec2::from_angle(between(0.0, TAU)) * (tuft.radius_m * between(0.0, 1.0).sqrt());
        let at = within(sward, at);
        let is_dry = between(0.0, 1.0) < sward.dry_share;
        Blade {
            root: Vec3::new(at.x, ground.height_m(at.as_dvec2()) as f32, at.y),
            length_m: tuft.shortest_m + (tuft.longest_m - tuft.shortest_m) * between(0.0, 1.0).powf(exponent),
            width_m: between(tuft.narrowest_m, tuft.widest_m),
            azimuth_rad,
            lean_rad: tuft.spread * FRAC_PI_2 * between(0.0, 1.0),
            droop_rad: tuft.droop * FRAC_PI_2 * between(0.0, 1.0),
            dryness: if is_dry { between(GREENEST, 1.0) } else { between(0.0, GREENEST) },
            rank: 0.0,
            under_trees: 0.0,
        }
    });
    blades.filter(|blade| blade.root.y.is_finite()).collect()
}

fn tuft_centre(sward: &Sward, number: u32, random: &mut Xoshiro256PlusPlus) -> Vec2 {
    let share = r2([0.5; 2], number as usize);
    let size = Vec2::new(sward.width_m, sward.depth_m);
    let jitter = TUFT_JITTER / sward.tufts_per_m2.sqrt();
    let moved = Vec2::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0)) * jitter;
    size * (Vec2::from_array(share) - 0.5) + moved
}

/// The nearest place on the patch.
fn within(sward: &Sward, at: Vec2) -> Vec2 {
    let half = 0.5 * Vec2::new(sward.width_m, sward.depth_m);
    at.clamp(-half, half)
}

#[cfg(test)]
mod tests {
    use super::{super::settings::Tuft, *};
    use crate::ground::LevelGround;
    use bevy::math::{DVec2, Vec3Swizzles};

    fn sward() -> Sward {
        Sward { width_m: 6.0, depth_m: 3.0, tufts_per_m2: 20.0, seed: 4, ..Sward::default() }
    }

    fn level(sward: &Sward) -> Vec<Blade> {
        layout_blades(sward, &LevelGround(0.0))
    }

    #[test]
    fn layout_has_the_number_of_blades_of_the_sward() {
        let sward = sward();
        assert_eq!(level(&sward).len(), 6 * 3 * 20 * sward.tuft.blades as usize);
        assert_eq!(level(&sward).len() as u64, sward.blades());
    }

    #[test]
    fn blades_are_within_the_limits_of_tuft_and_patch() {
        let sward = sward();
        let tuft = &sward.tuft;
        for blade in level(&sward) {
            assert!((tuft.shortest_m..=tuft.longest_m).contains(&blade.length_m), "{blade:?}");
            assert!((tuft.narrowest_m..=tuft.widest_m).contains(&blade.width_m), "{blade:?}");
            assert!((0.0..=tuft.spread * FRAC_PI_2).contains(&blade.lean_rad), "{blade:?}");
            assert!(blade.root.x.abs() <= 3.0 && blade.root.z.abs() <= 1.5, "{blade:?}");
            assert!((0.0..1.0).contains(&blade.rank) && (0.0..=1.0).contains(&blade.dryness), "{blade:?}");
        }
    }

    #[test]
    fn lengths_and_angles_are_uniform_without_clumping() {
        let tuft = Tuft { blades: 50, clumping: 0.0, spread: 1.0, ..Tuft::default() };
        let blades = level(&Sward { tuft: tuft.clone(), ..sward() });
        let mean = |value: &dyn Fn(&Blade) -> f32| blades.iter().map(value).sum::<f32>() / blades.len() as f32;
        let length = |blade: &Blade| (blade.length_m - tuft.shortest_m) / (tuft.longest_m - tuft.shortest_m);
        let shares: [&dyn Fn(&Blade) -> f32; 3] =
            [&length, &|blade| blade.lean_rad / FRAC_PI_2, &|blade| blade.azimuth_rad / TAU];
        // Moments of the uniform distribution; four standard errors of 18,000 draws.
        for share in shares {
            let first = mean(share);
            let second = mean(&|blade| share(blade).powi(2));
            assert!((first - 0.5).abs() < 4.0 * 0.2887 / 134.0, "{first}");
            assert!((second - 1.0 / 3.0).abs() < 4.0 * 0.2981 / 134.0, "{second}");
        }
    }

    #[test]
    fn layout_depends_on_the_seed() {
        assert_eq!(level(&sward()), level(&sward()));
        assert_ne!(level(&sward()), level(&Sward { seed: 5, ..sward() }));
    }

    #[test]
    fn prefix_of_the_blades_is_evenly_spread() {
        let blades = level(&sward());
        // A tenth of the blades has about a tenth of them in each of 18 square metres: no bare and no dense spots.
        let tenth = &blades[..blades.len() / 10];
        let mut counts = [0_usize; 18];
        for blade in tenth {
            let cell = |c: f32, half: f32| ((c + half) as usize).min((2.0 * half) as usize - 1);
            counts[cell(blade.root.z, 1.5) * 6 + cell(blade.root.x, 3.0)] += 1;
        }
        let mean = tenth.len() as f32 / 18.0;
        // Random tufts would scatter by the root of the mean, 5.6; two standard deviations hold for 17 of 18 cells.
        let near = counts.iter().filter(|count| (**count as f32 - mean).abs() < 2.0 * mean.sqrt()).count();
        assert!(near >= 17, "{counts:?}");
        assert!(blades.is_sorted_by(|a, b| a.rank < b.rank));
    }

    #[test]
    fn blades_stand_on_the_ground() {
        let slope = |at: DVec2| 0.3 * at.x - 0.1 * at.y;
        for blade in layout_blades(&sward(), &slope) {
            assert_eq!(blade.root.y, slope(blade.root.as_dvec3().xz()) as f32);
        }
    }

    #[test]
    fn no_blade_stands_where_the_ground_has_no_height() {
        let pond = |at: DVec2| if at.length() < 1.0 { f64::NAN } else { 0.0 };
        let blades = layout_blades(&sward(), &pond);
        assert!(blades.iter().all(|blade| Vec2::new(blade.root.x, blade.root.z).length() >= 1.0));
        // The pond takes pi of 18 square metres.
        let share = blades.len() as f32 / level(&sward()).len() as f32;
        assert!((share - (1.0 - std::f32::consts::PI / 18.0)).abs() < 0.03, "{share}");
    }

    #[test]
    fn clumping_spreads_the_mean_lengths_of_tufts() {
        let mean_lengths = |clumping: f32| {
            let sward = Sward { tuft: Tuft { blades: 64, clumping, ..Tuft::default() }, ..sward() };
            let tufts = sward.tufts() as usize;
            let blades = level(&sward);
            let mean =
                |tuft: usize| blades[tuft..].iter().step_by(tufts).map(|blade| blade.length_m).sum::<f32>() / 64.0;
            let means: Vec<f32> = (0..tufts).map(mean).collect();
            let centre = means.iter().sum::<f32>() / tufts as f32;
            (means.iter().map(|mean| (mean - centre).powi(2)).sum::<f32>() / tufts as f32).sqrt()
        };
        // By chance alone: the range of 0.38 m over the root of 12 and of 64 blades. With clumping the mean of u^p is
        // 1/(1 + p), p = 2^x with x uniform from -2 to 2; its deviation, and that of 64 blades about it, by quadrature.
        // The deviation of 360 tufts is known to 4%.
        for (clumping, expected) in [(0.0, 0.38 / (12.0_f32 * 64.0).sqrt()), (1.0, 0.070_78)] {
            let found = mean_lengths(clumping);
            assert!((found / expected - 1.0).abs() < 0.12, "{clumping}: {found} is not {expected}");
        }
    }
}
