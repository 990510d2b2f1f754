//! Point patterns against the laws that they are drawn from, the laws of real patterns, and the cells of a forest.
//!
//! The share of rejected patterns should be the level of the test: a generator whose patterns are never rejected is wrong
//! too.

#[path = "../support/forest_plans.rs"]
mod forest_plans;

use crate::report::Report;
use bevy::math::{DVec2, IVec2};
use bevy_windwood::{
    LevelGround,
    scatter::{
        ForestPlan, Planter,
        counts::{
            CountKind, CountModel, Frequencies, by_likelihood, by_moments, characterise, dispersion, goodness_of_fit,
        },
        plan::{Area, Shape},
        quadrat::{QuadratGrid, draw_counts, exact_counts, place_points},
    },
};
use forest_plans::{shipped, shipped_with_many_areas};
use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{collections::BTreeSet, time::Instant};

/// Patterns of each law.
const PATTERNS: u64 = 100;
/// Quadrats along a side of each pattern.
const SIDE: u32 = 50;
/// Plants in a quadrat.
const MEAN: f64 = 1.2;
/// Level of the tests.
const LEVEL: f64 = 0.01;

const MODELS: [CountModel; 6] = [
    CountModel::Poisson,
    CountModel::Binomial { n: 4 },
    CountModel::NegativeBinomial { k: 0.9 },
    CountModel::PoissonPoisson { clump: 2.0 },
    CountModel::PoissonBinomial { n: 4, p: 0.6 },
    CountModel::PoissonNegativeBinomial { k: 1.0, p: 1.5 },
];

/// Numbers of quadrats with 0, 1, 2, ... trees in real stands, and the law that fits each best.
const REAL_TABLES: [(&[u64], CountKind); 4] = [
    // 65 Japanese black pine saplings, 8 x 8 quadrats.
    (&[22, 26, 10, 5, 1], CountKind::Poisson),
    // 134 Norway spruces, 14 x 10.
    (&[38, 74, 26, 0, 2], CountKind::Binomial),
    // 195 Californian redwood seedlings, 14 x 14.
    (&[101, 44, 27, 12, 5, 4, 2, 0, 0, 1], CountKind::NegativeBinomial),
    // 2251 trees of Lansing Woods, 47 x 48.
    (&[824, 826, 447, 117, 33, 6, 3], CountKind::Poisson),
];

pub fn run() -> Report {
    let mut report = Report::default();
    let patterns = Patterns::measure();
    report.at_most("rejected_share", patterns.rejected, 0.025, "of 600 patterns, chi-square at 1%: 0.01 is right");
    report.record("wrong_law_rejected_share", patterns.wrong_rejected, "of 500 patterns tested for being random");
    report.at_most(
        "exact_total_errors",
        patterns.total_errors,
        0.0,
        "patterns of exactly N points that have another number",
    );
    report.at_most("random_called_clustered", patterns.clustered, 0.05, "of 100 random patterns, dispersion at 1%");
    report.record("random_called_regular", patterns.regular, "of 100 random patterns, dispersion at 1%");
    let (likelihood, moments) = parameter_errors();
    report.at_most("likelihood_worst_error", likelihood, 0.05, "relative, parameters of samples of 400,000 quadrats");
    report.record("moments_worst_error", moments, "the same by the method of moments");
    let right = real_tables_right();
    report.record("real_tables_right", right, "real stands whose law has the best AIC");
    report.at_most("real_tables_wrong", REAL_TABLES.len() as f64 - right, 0.0, "");
    report.at_most("cells_differences", cells_differences(), 0.0, "plants that differ between cells of 64 m and 150 m");

    let (points, seconds) = million_points();
    report.record("million_points", points, "of a forest of 5 x 5 km, 400 to the hectare");
    report.record("million_points_s", seconds, "on one thread");
    let (small, huge) = (cell_s(&shipped()), cell_s(&shipped_with_many_areas()));
    report.record("cell_small_forest_s", small, "one cell of the shipped forest");
    report.record("cell_huge_forest_s", huge, "the same cell among 2,000 more areas and 100,000 m of paths");
    report.record("cell_huge_to_small", huge / small, "");
    report
}

/// Shares and numbers of patterns, by result.
#[derive(Default)]
struct Patterns {
    rejected: f64,
    wrong_rejected: f64,
    total_errors: f64,
    clustered: f64,
    regular: f64,
}

impl Patterns {
    /// Draws 100 patterns of each law, places their points and counts them again.
    fn measure() -> Self {
        let mut sums = Self::default();
        let side_m = f64::from(SIDE);
        let grid = QuadratGrid::new(DVec2::ZERO, DVec2::splat(side_m), SIDE, SIDE).expect("a valid grid");
        for (number, model) in MODELS.into_iter().enumerate() {
            let law = model.with_mean(MEAN).expect("a valid law");
            let random_law = CountModel::Poisson.with_mean(MEAN).expect("a valid law");
            for pattern in 0..PATTERNS {
                let random = &mut Xoshiro256PlusPlus::seed_from_u64(number as u64 * PATTERNS + pattern);
                let counts = draw_counts(&law, grid.quadrats(), random);
                let points = place_points(&grid, &counts, 0.0, random).expect("few points");
                let table = grid.frequencies(&points).expect("points inside");
                let rejected = |law| goodness_of_fit(law, &table, 0).is_some_and(|fit| fit.p < LEVEL);
                sums.rejected += f64::from(rejected(&law));
                if model == CountModel::Poisson {
                    let dispersion = dispersion(&table);
                    sums.clustered += f64::from(dispersion.p_clustered < LEVEL);
                    sums.regular += f64::from(dispersion.p_regular < LEVEL);
                } else {
                    sums.wrong_rejected += f64::from(rejected(&random_law));
                }
                let wanted = 2000 + 13 * pattern as usize;
                let exact = exact_counts(model, wanted, grid.quadrats(), random).expect("a valid law");
                sums.total_errors += f64::from(exact.iter().sum::<u32>() as usize != wanted);
            }
        }
        let patterns = PATTERNS as f64;
        sums.rejected /= 6.0 * patterns;
        sums.wrong_rejected /= 5.0 * patterns;
        sums.clustered /= patterns;
        sums.regular /= patterns;
        sums
    }
}

/// The worst relative error of estimated parameters, by likelihood and by moments.
fn parameter_errors() -> (f64, f64) {
    let (mut likelihood, mut moments) = (0.0_f64, 0.0_f64);
    for (seed, model) in (1000..).zip(MODELS) {
        let law = model.with_mean(MEAN).expect("a valid law");
        let counts = draw_counts(&law, 400_000, &mut Xoshiro256PlusPlus::seed_from_u64(seed));
        let table = Frequencies::of_counts(&counts).expect("counts");
        let error = |estimate: Option<_>| estimate.map_or(f64::INFINITY, |law| parameter_error(law, model));
        likelihood = likelihood.max(error(by_likelihood(model.kind(), &table).map(|law| law.model())));
        moments = moments.max(error(by_moments(model.kind(), &table).map(|law| law.model())));
    }
    (likelihood, moments)
}

fn parameter_error(found: CountModel, wanted: CountModel) -> f64 {
    let parameters = |model| match model {
        CountModel::Poisson => [1.0; 2],
        CountModel::Binomial { n } => [f64::from(n), 1.0],
        CountModel::NegativeBinomial { k } => [k, 1.0],
        CountModel::PoissonPoisson { clump } => [clump, 1.0],
        CountModel::PoissonBinomial { n, p } => [f64::from(n), p],
        CountModel::PoissonNegativeBinomial { k, p } => [k, p],
    };
    let pairs = parameters(found).into_iter().zip(parameters(wanted));
    pairs.map(|(found, wanted)| (found / wanted - 1.0).abs()).fold(0.0, f64::max)
}

fn real_tables_right() -> f64 {
    let is_right = |(table, kind): &(&[u64], CountKind)| {
        let table = Frequencies::new(table.to_vec()).expect("a table of counts");
        characterise(&table).is_ok_and(|fits| fits.first().is_some_and(|fit| fit.law.model().kind() == *kind))
    };
    REAL_TABLES.iter().filter(|table| is_right(table)).count() as f64
}

/// Number of plants that cells of one size have and cells of another have not.
fn cells_differences() -> f64 {
    let forest = |cell_m| {
        let planter = Planter::new(&ForestPlan { cell_m, ..shipped() }).expect("a valid plan");
        let mut all = BTreeSet::new();
        for_each_cell(&planter, |planted| {
            all.extend(planted.iter().map(|plant| (plant.position.to_array().map(f32::to_bits), plant.seed)));
        });
        all
    };
    forest(64.0).symmetric_difference(&forest(150.0)).count() as f64
}

fn for_each_cell(planter: &Planter, mut with: impl FnMut(&[bevy_windwood::scatter::Planted])) {
    let Some([first, last]) = planter.cells() else { return };
    let mut planted = Vec::new();
    for row in first.y..=last.y {
        for column in first.x..=last.x {
            planter.plant(IVec2::new(column, row), &LevelGround(0.0), &mut planted);
            with(&planted);
        }
    }
}

/// Points and seconds of a forest of a million trees.
fn million_points() -> (f64, f64) {
    let shape = Shape::Rectangle { min_m: [-2500.0; 2], max_m: [2500.0; 2] };
    let area = Area { shape, density_per_ha: 400.0, least_distance_m: 1.0, ..Area::default() };
    let planter = Planter::new(&ForestPlan { areas: vec![area], ..ForestPlan::default() }).expect("a valid plan");
    let start = Instant::now();
    let mut points = 0;
    for_each_cell(&planter, |planted| points += planted.len());
    (points as f64, start.elapsed().as_secs_f64())
}

/// Seconds for one cell, the best of many.
fn cell_s(plan: &ForestPlan) -> f64 {
    let planter = Planter::new(plan).expect("a valid plan");
    let mut planted = Vec::new();
    let once = |_| {
        let start = Instant::now();
        planter.plant(IVec2::new(1, 1), &LevelGround(0.0), &mut planted);
        start.elapsed().as_secs_f64()
    };
    (0..200).map(once).fold(f64::INFINITY, f64::min)
}
