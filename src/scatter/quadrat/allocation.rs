//! The number of plants of each quadrat: drawn from the law, or allocated so that they are exactly N in all.
//!
//! Algorithm 2 gives r points to each of Q P(r) quadrats, which is not whole, and the points do not add up to N. Here:
//!
//! 1. Every class r gets the whole part of Q P(r), and the quadrats that are left go to the classes with the largest
//!    remainders.
//! 2. While the points are too few (or too many), one quadrat moves to the next class up (or down): the one whose move
//!    distorts the table least, by the chi-square distance sum of (f(r) - Q P(r))² / (Q P(r)).
//! 3. The quadrats are shuffled.

use rand::{Rng, RngExt, seq::SliceRandom};

use crate::{
    scatter::counts::{
        law::{CountLaw, CountModel},
        probability::Probabilities,
    },
    setting::{SettingError, require},
};

/// The least expected number of a class, so that the emptiest can be compared.
const LEAST_EXPECTED: f64 = 1e-9;

/// Draws the number of plants in each of `quadrats` quadrats from a law.
pub fn draw_counts(law: &CountLaw, quadrats: usize, random: &mut impl Rng) -> Vec<u32> {
    let probabilities = Probabilities::new(law);
    (0..quadrats).map(|_| probabilities.draw(random) as u32).collect()
}

/// Allocates exactly `points` plants to `quadrats` quadrats, as many with r plants as the model expects with the mean
/// points / quadrats (the paper's algorithm 2, corrected as above).
///
/// # Errors
/// [`SettingError`] where the model does not allow that mean, or the quadrats are none or more than 2^24.
pub fn exact_counts(
    model: CountModel,
    points: usize,
    quadrats: usize,
    random: &mut impl Rng,
) -> Result<Vec<u32>, SettingError> {
    require("quadrats", quadrats, 1..=1 << 24)?;
    let law = model.with_mean(points as f64 / quadrats as f64)?;
    let expected: Vec<f64> =
        Probabilities::new(&law).as_slice().iter().map(|probability| probability * quadrats as f64).collect();
    let mut table = largest_remainder(&expected, quadrats);
    repair(&mut table, &expected, points, random);
    let mut counts = Vec::with_capacity(quadrats);
    for (count, &quadrats) in table.iter().enumerate() {
        counts.resize(counts.len() + quadrats, count as u32);
    }
    counts.shuffle(random);
    Ok(counts)
}

/// Whole numbers near `expected` that add up to `total`, to which `expected` itself adds up but for rounding.
fn largest_remainder(expected: &[f64], total: usize) -> Vec<usize> {
    let mut table: Vec<usize> = expected.iter().map(|&quadrats| quadrats as usize).collect();
    let mut classes: Vec<usize> = (0..expected.len()).collect();
    // A stable sort: of equal remainders the smaller class comes first.
    classes.sort_by(|&a, &b| expected[b].fract().total_cmp(&expected[a].fract()));
    let left = total.saturating_sub(table.iter().sum());
    for &class in classes.iter().cycle().take(left) {
        table[class] += 1;
    }
    table
}

/// Moves quadrats between neighbouring classes until the table holds `points`. Of moves that distort the table alike, one
/// is drawn.
fn repair(table: &mut Vec<usize>, expected: &[f64], points: usize, random: &mut impl Rng) {
    let distortion = |table: &[usize], class: usize, change: f64| {
        let expected = expected.get(class).copied().unwrap_or(0.0).max(LEAST_EXPECTED);
        // (f + change - e)^2 / e - (f - e)^2 / e
        change * (2.0 * (table[class] as f64 - expected) + change) / expected
    };
    let mut held: usize = table.iter().enumerate().map(|(count, quadrats)| count * quadrats).sum();
    while held != points {
        let up = held < points;
        if up && table.last() != Some(&0) && table.len() == expected.len() {
            table.push(0);
        }
        let moves = (0..table.len() - 1).map(|low| if up { (low, low + 1) } else { (low + 1, low) });
        let mut ties = 0_u32;
        let mut best: Option<(usize, usize, f64)> = None;
        for (from, to) in moves.filter(|&(from, _)| table[from] > 0) {
            let cost = distortion(table, from, -1.0) + distortion(table, to, 1.0);
            let (better, equal) = best.map_or((true, false), |(.., least)| (cost < least, cost == least));
            ties = if better { 1 } else { ties + u32::from(equal) };
            if better || (equal && random.random_range(0..ties) == 0) {
                best = Some((from, to, cost));
            }
        }
        // Some quadrat can always give or take a plant while there are too many or too few; this ends the loop if not.
        let Some((from, to, _)) = best else { return };
        table[from] -= 1;
        table[to] += 1;
        held = if up { held + 1 } else { held - 1 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::counts::{dispersion::goodness_of_fit, frequencies::Frequencies};
    use proptest::prelude::*;
    use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

    fn models() -> impl Strategy<Value = CountModel> {
        prop_oneof![
            Just(CountModel::Poisson),
            (20_u32..60).prop_map(|n| CountModel::Binomial { n }),
            (0.2..20.0).prop_map(|k| CountModel::NegativeBinomial { k }),
            (0.1..8.0).prop_map(|clump| CountModel::PoissonPoisson { clump }),
            (1_u32..9, 0.05..1.0).prop_map(|(n, p)| CountModel::PoissonBinomial { n, p }),
            (0.1..3.0, 0.1..3.0).prop_map(|(k, p)| CountModel::PoissonNegativeBinomial { k, p }),
        ]
    }

    proptest! {
        #[test]
        fn exact_counts_add_up_to_the_number_asked_for(
            model in models(), points in 1_usize..4000, quadrats in 200_usize..2000, seed: u64,
        ) {
            let counts =
                exact_counts(model, points, quadrats, &mut Xoshiro256PlusPlus::seed_from_u64(seed)).unwrap();
            prop_assert_eq!(counts.len(), quadrats);
            prop_assert_eq!(counts.iter().map(|&count| count as usize).sum::<usize>(), points);
        }

        #[test]
        fn largest_remainders_are_off_by_less_than_one(shares in prop::collection::vec(0.0..1.0_f64, 1..40)) {
            let sum: f64 = shares.iter().sum();
            prop_assume!(sum > 0.0);
            let expected: Vec<f64> = shares.iter().map(|share| share / sum * 777.0).collect();
            let table = largest_remainder(&expected, 777);
            prop_assert_eq!(table.iter().sum::<usize>(), 777);
            prop_assert!(table.iter().zip(&expected).all(|(&whole, part)| (whole as f64 - part).abs() < 1.0 + 1e-9));
        }
    }

    #[test]
    fn exact_counts_are_closer_to_the_law_than_drawn_ones() {
        let model = CountModel::NegativeBinomial { k: 0.9 };
        let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
        let counts = exact_counts(model, 1000, 1000, &mut random).unwrap();
        let law = model.with_mean(1.0).unwrap();
        let distance =
            |counts: &[u32]| goodness_of_fit(&law, &Frequencies::of_counts(counts).unwrap(), 0).unwrap().chi_square;
        let drawn: Vec<f64> = (0..100).map(|_| distance(&draw_counts(&law, 1000, &mut random))).collect();
        // Drawn counts are at a distance of 5 or 6 on average.
        assert!(drawn.iter().all(|drawn| distance(&counts) < 0.25 * drawn), "{}", distance(&counts));
        let variance = Frequencies::of_counts(&counts).unwrap().variance();
        assert!((variance / law.variance() - 1.0).abs() < 0.05, "{variance}");
    }

    #[test]
    fn a_mean_that_the_model_does_not_allow_is_refused() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
        let mut error = |model, points, quadrats| exact_counts(model, points, quadrats, &mut random).unwrap_err();
        assert!(error(CountModel::Binomial { n: 2 }, 300, 100).to_string().starts_with("`n` is 2"));
        assert!(error(CountModel::Poisson, 10, 0).to_string().starts_with("`quadrats` is 0"));
        assert!(error(CountModel::Poisson, usize::MAX, 100).to_string().starts_with("`mean_per_quadrat`"));
    }
}
