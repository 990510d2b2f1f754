//! Aerodynamic admittance: how much of the gusts of a frequency a body of some size feels as a whole.
//!
//! Gusts smaller than a crown push one side of it while they leave another. The load on many places, each with its share
//! `w` of the whole, has the amplitude `|J(f)|` of that on all of them at one point:
//!
//! ```text
//! |J|^2 = sum_ij w_i w_j exp(-C f d_ij / U) cos(2 pi f x_ij / U)
//! ```
//!
//! with the coherence of two points a distance `d` apart across the wind (eq. 12 of Setas et al., corrected), and the delay
//! between points a distance `x` apart along it (Taylor's hypothesis). It is worked out for a cloud whose places are spread
//! by the standard deviation `sigma` in each direction. For normal deviates both sums are closed forms, with
//! `b = C f sigma / U`:
//!
//! ```text
//! |J|^2 = (1 - sqrt(pi) b exp(b^2) erfc(b)) exp(-(2 pi f sigma / U)^2)
//! ```
//!
//! (the distance of two such places across the wind has a Rayleigh distribution). Balls, shells and cones of the same
//! `sigma` differ from it by some 3%; bodies that are higher than wide are like a cloud of a
//! [size between](equivalent_size_m).

use std::f64::consts::{PI, TAU};

/// Beyond this `b` the asymptotic series of `erfc` is exact to 1e-3.
const ASYMPTOTIC: f64 = 8.0;

/// `|J|` at a reduced frequency `f sigma / U`, for the decay coefficient `C` of the coherence (10 for the component along
/// the wind). 1 for slow gusts, 0 for fast ones.
#[must_use]
pub fn admittance(reduced_frequency: f64, decay: f64) -> f64 {
    let across = coherent_share(decay * reduced_frequency.abs());
    let along = (-(TAU * reduced_frequency).powi(2)).exp();
    (across * along).max(0.0).sqrt()
}

/// The mean of `exp(-b r)` for `r` with the Rayleigh distribution of scale sqrt 2.
fn coherent_share(b: f64) -> f64 {
    if b < ASYMPTOTIC {
        1.0 - PI.sqrt() * b * (b * b).exp() * puruspe::erfc(b)
    } else {
        (1.0 - 1.5 / (b * b)) / (2.0 * b * b)
    }
}

/// The `sigma` of a cloud that is spread alike in each direction and has the admittance of one that is spread by
/// `horizontal_m` and `vertical_m`: fitted to balls, shells, cones and normal clouds from 0.3 to 5 times as high as wide,
/// for which it leaves at most 5% where `|J|^2` is 0.2 or more.
#[must_use]
pub fn equivalent_size_m(horizontal_m: f64, vertical_m: f64) -> f64 {
    1.03 * (2.0 * horizontal_m + vertical_m) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    const DECAY: f64 = 10.0;

    /// The double sum of the module's page, over random places in an upright ellipsoid.
    fn by_sum(places: &[[f64; 3]], frequency_by_speed: f64) -> f64 {
        let pairs = places.iter().flat_map(|a| places.iter().map(move |b| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]));
        let of_pair = |[along, up, across]: [f64; 3]| {
            (-DECAY * frequency_by_speed * up.hypot(across)).exp() * (TAU * frequency_by_speed * along).cos()
        };
        (pairs.map(of_pair).sum::<f64>() / (places.len() * places.len()) as f64).sqrt()
    }

    /// Places in an ellipsoid of standard deviation 1 in each horizontal direction.
    fn ellipsoid(height: f64) -> Vec<[f64; 3]> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        let mut odd = || random.random_range(-1.0..1.0_f64);
        let mut places = Vec::new();
        while places.len() < 700 {
            let place = [odd(), odd(), odd()];
            if place.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
                // A ball of radius 1 has the standard deviation 1/sqrt 5.
                places.push([place[0], place[1] * height, place[2]].map(|x| x * 5f64.sqrt()));
            }
        }
        places
    }

    #[test]
    fn crowns_of_any_slenderness_follow_the_closed_form() {
        for height in [0.5, 1.0, 2.0, 3.0] {
            let places = ellipsoid(height);
            let size_m = equivalent_size_m(1.0, height);
            for frequency_by_speed in [0.005, 0.02, 0.05, 0.1] {
                let sum = by_sum(&places, frequency_by_speed);
                let form = admittance(frequency_by_speed * size_m, DECAY);
                // Where less than a fifth of the power is felt, the shape shows more.
                let tolerance = if sum * sum >= 0.2 { 0.06 } else { 0.25 };
                assert!((form / sum - 1.0).abs() < tolerance, "{height}, {frequency_by_speed}: {form} against {sum}");
            }
        }
    }

    #[test]
    fn it_falls_from_one_to_nothing_without_a_step() {
        assert_eq!(admittance(0.0, DECAY), 1.0);
        let values: Vec<f64> = (0..2000).map(|step| admittance(f64::from(step) * 1e-3, DECAY)).collect();
        assert!(values.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] < 0.02));
        assert!(values[1999] < 1e-6);
        let joint = ASYMPTOTIC / DECAY;
        let ratio = coherent_share(DECAY * joint * 0.9999) / coherent_share(DECAY * joint * 1.0001);
        assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
    }
}
