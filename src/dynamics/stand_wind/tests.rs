use super::*;
use crate::wind::{Canopy, LogProfile};
use approx::assert_relative_eq;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rand_distr::{Distribution, StandardNormal};

fn open(speed_m_s: f32) -> MeanWind {
    MeanWind::new(&LogProfile::from_reference(speed_m_s, 0.1, 0.0), 10.0)
}

fn inside(height_m: f32, frontal_area_index: f32) -> StandWind {
    let canopy = Canopy { height_m, frontal_area_index, exposure: [0.0; 8] };
    StandWind::new(open(8.0), canopy.pack(), Vec2::X)
}

#[test]
fn in_the_open_a_tree_feels_the_profile() {
    let wind = StandWind::open(open(8.0));
    for height_m in [0.0, 0.5, 3.0, 10.0, 40.0] {
        let ratio = open(8.0).ratio(height_m);
        let StandLoads { mean, gusts, convection } = wind.loads(height_m);
        assert_eq!([mean, gusts, convection], [ratio * ratio, ratio, ratio]);
        assert_eq!(wind.speeds(height_m).mean, ratio);
    }
    let velocity = Vec3::new(9.0, 0.4, -1.0);
    assert!(wind.velocity(10.0, velocity).abs_diff_eq(velocity, 1e-5));
}

#[test]
fn mean_wind_is_continuous_and_so_is_its_gradient_at_the_tops() {
    for index in [0.3, 1.0, 3.0] {
        let wind = inside(20.0, index);
        let tops_m = wind.canopy.height_m;
        let at = |height_m: f32| wind.inside(height_m).mean;
        assert_relative_eq!(at(tops_m - 1e-3), at(tops_m + 1e-3), max_relative = 1e-3);
        let slope = |from_m: f32| (at(from_m + 0.05) - at(from_m)) / 0.05;
        // psi takes 0.193 of 1 from the slope of the logarithm just above the tops, c_w half of it: 0.5 below, 0.8 above.
        let (below, above) = (slope(tops_m - 0.05), slope(tops_m));
        assert!((0.5..0.75).contains(&(below / above)), "{below} and {above}");
        let blending_m = BLENDING_HEIGHT_M;
        assert_relative_eq!(at(blending_m), wind.open.ratio(blending_m), max_relative = 0.01);
    }
}

/// The two roots against the mean of `|u| u` over a hundred thousand normal deviates, and how that changes with the mean.
#[test]
fn loads_are_those_of_gusts_as_strong_as_the_mean_wind() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
    let deviates: Vec<f64> = (0..100_000).map(|_| StandardNormal.sample(&mut random)).collect();
    let mean_load =
        |mean: f64, gusts: f64| deviates.iter().map(|d| mean + gusts * d).map(|u| u.abs() * u).sum::<f64>() / 1e5;
    for (mean, gusts) in [(1.0, 0.2), (0.5, 0.4), (0.3, 0.3), (0.1, 0.3)] {
        let root = |share: f32| (mean * mean + f64::from(share) * gusts * gusts).sqrt();
        // Between the two ends, at which they are exact, the roots are off by up to 12%.
        let ratio = mean * root(MEAN_LOAD_VARIANCE) / mean_load(mean, gusts);
        assert!((ratio - 1.0).abs() < 0.13, "{mean} {gusts}: {ratio}");
        let slope = (mean_load(mean + 0.01, gusts) - mean_load(mean - 0.01, gusts)) / 0.02;
        let ratio = 2.0 * root(GUST_LOAD_VARIANCE) / slope;
        assert!((ratio - 1.0).abs() < 0.13, "{mean} {gusts}: {ratio}");
    }
}

/// Bounds of trees are those of the open.
#[test]
fn no_tree_of_a_stand_is_pressed_harder_than_in_open_country() {
    let open = StandWind::open(open(8.0));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
    for _ in 0..20_000 {
        let canopy = Canopy {
            height_m: random.random_range(0.5..60.0),
            frontal_area_index: random.random_range(0.0..8.0_f32).powi(2) / 8.0,
            exposure: [random.random_range(0.0..1.0); 8],
        };
        let height_m = canopy.height_m * random.random_range(0.05..1.5);
        let wind = StandWind::new(open.open, canopy.pack(), Vec2::Y);
        let (stand, free) = (wind.loads(height_m), open.loads(height_m));
        assert!(stand.mean <= 1.02 * free.mean, "{canopy:?} at {height_m}: {stand:?} {free:?}");
        let greatest = |loads: StandLoads| loads.mean + PEAK_GUSTS * loads.gusts;
        assert!(
            stand.gusts >= 0.0 && greatest(stand) <= 1.001 * greatest(free),
            "{canopy:?} at {height_m}: {stand:?} {free:?}"
        );
    }
}

#[test]
fn winds_in_any_stand_are_finite() {
    for height_m in [f32::NEG_INFINITY, -1.0, 0.0, 1e30, f32::INFINITY, f32::NAN] {
        for wind in [StandWind::open(open(0.0)), inside(0.0, 0.0), inside(127.0, 10.0)] {
            let StandLoads { mean, gusts, convection } = wind.loads(height_m);
            assert!([mean, gusts, convection].iter().all(|load| !load.is_nan()), "{height_m} {wind:?}");
            assert!(wind.velocity(height_m, Vec3::ONE).is_finite());
        }
    }
}
