use super::*;
use crate::tree::growth::zaharia::plan::tests::{children_per_beam, length_ratios};

/// Age, leaves, branches of table 2, each of one random tree.
const TABLE_2: [(f32, f64, f64); 6] = [
    (100.0, 7673.0, 1755.0),
    (120.0, 6727.0, 1707.0),
    (140.0, 8521.0, 1856.0),
    (160.0, 15497.0, 2561.0),
    (180.0, 13467.0, 2731.0),
    (200.0, 13318.0, 2522.0),
];

fn mean_counts(age_years: f32) -> (f64, f64) {
    let seeds = 40;
    let counts = (0..seeds).map(|seed| Oak::default().counts(&LeafEllipsoids::default(), age_years, seed));
    let sum = counts.fold((0, 0), |sum, one| (sum.0 + one.leaves, sum.1 + one.branches));
    (sum.0 as f64 / seeds as f64, sum.1 as f64 / seeds as f64)
}

fn grown(oak: &Oak, age_years: f32, seed: u64) -> GrownBranches {
    oak.grow(&Stage::mature(age_years), &mut Xoshiro256PlusPlus::seed_from_u64(seed))
}

#[test]
fn counts_are_near_table_2() {
    for (age_years, leaves, branches) in TABLE_2 {
        let mean = mean_counts(age_years);
        // His own neighbours differ by up to 1.4 in branches and 1.8 in leaves.
        assert!((0.75..1.33).contains(&(mean.1 / branches)), "{age_years}: {} branches", mean.1);
        assert!((0.67..1.5).contains(&(mean.0 / leaves)), "{age_years}: {} leaves", mean.0);
    }
}

#[test]
fn counts_rise_with_age_and_a_sapling_has_few() {
    let branches: Vec<f64> = [20.0, 40.0, 100.0, 200.0].map(|age| mean_counts(age).1).into();
    assert!(branches.windows(2).all(|pair| pair[0] < pair[1]), "{branches:?}");
    assert!(branches[0] < 0.02 * branches[3] && branches[1] < 0.15 * branches[3], "{branches:?}");
}

/// `no_branch` on grown trees: where no branch is too short to grow, its fathers have as many as the formula says. With
/// numbers as far apart as 4 and 16 it would be seen if anything cancelled the age.
#[test]
fn the_number_of_branches_of_a_father_is_linear_in_age() {
    let oak = Oak {
        trunk: Trunk { height_m: 100.0, segments: 1, ..Trunk::default() },
        delta_m: 0.0,
        min_branch: 4.0,
        max_branch: 16.0,
        min_age_years: 20.0,
        adjust_branch: vec![2.0, 2.0],
        first_at: 0.0,
        ..Oak::default()
    };
    for (age_years, expected) in [(20.0, 4.0), (65.0, 7.0), (110.0, 10.0), (155.0, 13.0), (200.0, 16.0), (900.0, 16.0)]
    {
        for order in [0, 1] {
            let (mut branches, mut fathers) = (0.0, 0.0);
            for seed in 0..40 {
                let numbers = children_per_beam(&grown(&oak, age_years, seed).beams, order);
                fathers += numbers.len() as f32;
                branches += numbers.iter().sum::<usize>() as f32;
            }
            // A few are shorter than 8 cm: those within some centimetres of the tip of a father some metres long.
            let share = branches / fathers / expected;
            assert!((0.97..=1.0).contains(&share), "order {order} at {age_years}: {share} of {expected}");
        }
    }
}

/// `l_branch` on grown trees: what is random about a length is all within `shortest` to 1.
#[test]
fn lengths_grow_with_age_as_the_formula_says() {
    let oak = Oak { min_branch: 9.0, shortest: 0.7, ..Oak::default() };
    for age_years in [50.0, 100.0, 150.0, 200.0] {
        let over_max = age_years / oak.max_age_years;
        for (order, adjust_branch) in (1..).zip(&oak.adjust_branch) {
            let ratios = length_ratios(&grown(&oak, age_years, 3).beams, order);
            let longest = adjust_branch + over_max;
            // Shorter ones than 8 cm are missing, so the mean is that of `random()`, 0.85, or more.
            let mean = ratios.iter().sum::<f32>() / ratios.len() as f32 / longest;
            let (least, greatest) = ratios.iter().fold((f32::MAX, 0.0_f32), |(l, g), &r| (l.min(r), g.max(r)));
            assert!(
                least > 0.69 * longest && greatest < 1.01 * longest,
                "order {order} at {age_years}: {least} {greatest}"
            );
            assert!(ratios.len() < 40 || (0.83..0.89).contains(&mean), "order {order} at {age_years}: {mean}");
        }
    }
}

#[test]
fn no_setting_grows_beyond_the_limit() {
    let oak = Oak { min_branch: 40.0, max_branch: 40.0, adjust_branch: vec![1.0; 5], ..Oak::default() };
    oak.validate().unwrap();
    let counts = oak.counts(&LeafEllipsoids::default(), 200.0, 1);
    assert!(counts.branches <= crate::tree::growth::grower::BEAMS_LIMIT);
}

#[test]
fn a_level_out_of_range_is_named() {
    let oak = Oak { adjust_branch: vec![0.0, f32::NAN], ..Oak::default() };
    assert_eq!(oak.validate().unwrap_err().to_string(), "`adjust_branch[1]` is NaN, but must be -1 to 2");
}
