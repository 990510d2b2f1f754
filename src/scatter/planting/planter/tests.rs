use super::*;
use crate::{
    ground::LevelGround,
    scatter::{
        counts::{dispersion::goodness_of_fit, frequencies::Frequencies, law::CountModel},
        plan::{
            forest::Area,
            shape::Shape,
            stock::{GroundLimits, Stock},
        },
        quadrat::grid::QuadratGrid,
    },
};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn square(half_m: f32) -> Shape {
    Shape::Rectangle { min_m: [-half_m; 2], max_m: [half_m; 2] }
}

fn planter(areas: Vec<Area>, keep_out: Vec<KeepOut>) -> Planter {
    Planter::new(&ForestPlan { seed: 4, areas, keep_out, ..Default::default() }).unwrap()
}

/// Everything that stands in the forest, cell after cell.
fn whole(planter: &Planter, ground: &impl Ground) -> Vec<Planted> {
    let Some([first, last]) = planter.cells() else { return Vec::new() };
    let (mut all, mut planted) = (Vec::new(), Vec::new());
    for row in first.y..=last.y {
        for column in first.x..=last.x {
            planter.plant(IVec2::new(column, row), ground, &mut planted);
            all.extend_from_slice(&planted);
        }
    }
    all
}

fn map_place(plant: &Planted) -> DVec2 {
    DVec2::new(f64::from(plant.position.x), f64::from(plant.position.z))
}

/// A plant's bits, to compare forests as sets.
fn fingerprints(planted: &[Planted]) -> BTreeSet<[u32; 6]> {
    let bits = |plant: &Planted| {
        let [x, y, z] = plant.position.to_array().map(f32::to_bits);
        [x, y, z, plant.turn_rad.to_bits(), plant.plan_size.to_bits(), plant.seed]
    };
    planted.iter().map(bits).collect()
}

fn shipped() -> ForestPlan {
    ForestPlan::from_ron(include_str!("../../../../assets/forests/mixed.forest.ron")).unwrap()
}

#[test]
fn plants_do_not_depend_on_the_size_of_cells() {
    let forest = |cell_m| {
        let planted = whole(&Planter::new(&ForestPlan { cell_m, ..shipped() }).unwrap(), &LevelGround(500.0));
        assert_eq!(fingerprints(&planted).len(), planted.len(), "no plant is in two cells");
        fingerprints(&planted)
    };
    let large = forest(200.0);
    assert!(large.len() > 5000, "{}", large.len());
    assert_eq!(forest(64.0), large);
    assert_eq!(forest(23.7), large);
}

#[test]
fn a_cell_does_not_depend_on_cells_planted_before() {
    let planter = Planter::new(&shipped()).unwrap();
    let (mut first, mut again) = (Vec::new(), Vec::new());
    planter.plant(IVec2::new(1, -2), &LevelGround(0.0), &mut first);
    planter.plant(IVec2::new(-3, 2), &LevelGround(0.0), &mut again);
    planter.plant(IVec2::new(1, -2), &LevelGround(0.0), &mut again);
    assert!(!first.is_empty());
    assert_eq!(first, again);
    let other = Planter::new(&ForestPlan { seed: 8, ..shipped() }).unwrap();
    other.plant(IVec2::new(1, -2), &LevelGround(0.0), &mut again);
    assert!(fingerprints(&first).is_disjoint(&fingerprints(&again)));
}

#[test]
fn least_distance_holds_across_cells_and_areas() {
    let dense = |least_distance_m, species: &str| Area {
        shape: square(90.0),
        density_per_ha: 600.0,
        least_distance_m,
        pattern: CountModel::NegativeBinomial { k: 1.0 },
        stock: vec![Stock { species: species.into(), ..Default::default() }],
        ..Default::default()
    };
    let planter = planter(vec![dense(2.4, "tree"), dense(0.6, "shrub")], vec![]);
    let planted = whole(&planter, &LevelGround(0.0));
    let distance_m = [2.4, 0.6];
    let mut nearest = f64::INFINITY;
    for (index, a) in planted.iter().enumerate() {
        for b in &planted[..index] {
            let least = 0.5 * (distance_m[a.species as usize] + distance_m[b.species as usize]);
            let distance = map_place(a).distance(map_place(b));
            assert!(distance > least - 1e-9, "{a:?} {b:?}");
            nearest = nearest.min(distance / least);
        }
    }
    assert!(nearest < 1.05, "no pair is near the limit: {nearest}");
    // The trees lose none to the shrubs.
    let alone = self::planter(vec![dense(2.4, "tree")], vec![]);
    let trees = |planted: &[Planted]| planted.iter().filter(|plant| plant.species == 0).count();
    assert_eq!(trees(&planted), whole(&alone, &LevelGround(0.0)).len());
}

/// Counted on the quadrats of the area itself, the plants follow the area's law, and their number its density.
#[test]
fn pattern_follows_its_law_and_density() {
    for pattern in [
        CountModel::Poisson,
        CountModel::Binomial { n: 6 },
        CountModel::NegativeBinomial { k: 0.8 },
        CountModel::PoissonPoisson { clump: 2.0 },
        CountModel::PoissonBinomial { n: 3, p: 0.7 },
        CountModel::PoissonNegativeBinomial { k: 1.0, p: 1.0 },
    ] {
        let area = Area {
            shape: square(500.0),
            density_per_ha: 150.0,
            quadrat_m: 10.0,
            least_distance_m: 0.0,
            pattern,
            ..Default::default()
        };
        let points: Vec<DVec2> = whole(&planter(vec![area], vec![]), &LevelGround(0.0)).iter().map(map_place).collect();
        let grid = QuadratGrid::new(DVec2::splat(-500.0), DVec2::splat(500.0), 100, 100).unwrap();
        let law = pattern.with_mean(1.5).unwrap();
        // Five standard errors; and a p value that one pattern in 20,000 falls below.
        let scatter = (10_000.0 * law.variance()).sqrt();
        assert!((points.len() as f64 - 15_000.0).abs() < 5.0 * scatter, "{pattern:?}: {}", points.len());
        let table: Frequencies = grid.frequencies(&points).unwrap();
        let fit = goodness_of_fit(&law, &table, 0).unwrap();
        assert!(fit.p > 5e-5, "{pattern:?}: {fit:?}");
    }
}

/// The least distance of the default area takes its stems from the borders of the quadrats only.
#[test]
fn least_distance_costs_the_documented_share_of_stems() {
    let area = |least_distance_m| Area { shape: square(800.0), least_distance_m, ..Default::default() };
    let count = |area| whole(&planter(vec![area], vec![]), &LevelGround(0.0)).len() as f64;
    let all = count(area(0.0));
    // What the field's documentation says.
    for (least_distance_m, lost) in [(1.5, 0.01), (3.0, 0.07), (4.67, 0.26)] {
        let kept = count(area(least_distance_m)) / all;
        assert!((kept + lost - 1.0).abs() < 0.01, "{least_distance_m}: {kept}");
    }
}

#[test]
fn limits_of_ground_and_keep_out_shapes_hold() {
    /// Rises along x, with a hole.
    struct Slope;
    impl Ground for Slope {
        fn height_m(&self, place: DVec2) -> f64 {
            if place.y > 80.0 { f64::NAN } else { place.x }
        }
        fn gradient(&self, place: DVec2) -> DVec2 {
            DVec2::X * if place.y < -80.0 { 2.0 } else { 0.1 }
        }
    }
    let stock = |species: &str, highest_m| Stock {
        species: species.into(),
        ground: GroundLimits { highest_m, ..Default::default() },
        ..Default::default()
    };
    let area = Area {
        shape: square(100.0),
        density_per_ha: 2000.0,
        least_distance_m: 0.0,
        ground: GroundLimits { highest_m: 50.0, steepest_deg: 45.0, ..Default::default() },
        stock: vec![stock("oak", 0.0), stock("fir", 1000.0)],
        ..Default::default()
    };
    let disc = KeepOut::Disc { centre_m: [-30.0, 0.0], radius_m: 20.0 };
    let planted = whole(&planter(vec![area], vec![disc]), &Slope);
    assert!(planted.len() > 3000);
    for plant in &planted {
        let Vec3 { x, y, z } = plant.position;
        assert!(x <= 50.0 && (-80.0..=80.0).contains(&z) && x >= -100.0, "{plant:?}");
        assert_eq!(y, x);
        assert!(Vec2::new(x + 30.0, z).length() >= 20.0 - 1e-4);
        assert!(plant.species == 1 || x <= 0.0, "oaks stay below");
    }
    let uphill = planted.iter().filter(|plant| plant.position.x > 0.0).count() as f64;
    assert!((uphill / (2000.0 * 0.8) - 1.0).abs() < 0.13, "where oaks cannot grow firs take their place: {uphill}");
}

#[test]
fn shares_of_species_hold_with_and_without_drifts() {
    let area = |drift_m| Area {
        shape: square(1500.0),
        density_per_ha: 50.0,
        least_distance_m: 0.0,
        drift_m,
        drift_purity: 0.9,
        stock: [("oak", 1.0), ("fir", 3.0)]
            .map(|(species, share)| Stock { species: species.into(), share, ..Default::default() })
            .to_vec(),
        ..Default::default()
    };
    for drift_m in [0.0, 25.0] {
        let planted = whole(&planter(vec![area(drift_m)], vec![]), &LevelGround(0.0));
        let firs = planted.iter().filter(|plant| plant.species == 1).count() as f64 / planted.len() as f64;
        assert!((firs - 0.75).abs() < 0.02, "{drift_m}: {firs}");
        let mut alike = (0, 0);
        for (index, a) in planted.iter().enumerate().step_by(7) {
            for b in planted.iter().skip(index + 1).take(300).filter(|b| map_place(a).distance(map_place(b)) < 6.0) {
                alike = (alike.0 + u32::from(a.species == b.species), alike.1 + 1);
            }
        }
        let alike = f64::from(alike.0) / f64::from(alike.1);
        // Without drifts neighbours are alike by chance: 0.75² + 0.25² = 0.625.
        assert_eq!(alike > 0.75, drift_m > 0.0, "{alike}");
    }
}

#[test]
fn empty_plans_have_no_cells_and_too_many_species_are_refused() {
    assert_eq!(planter(vec![], vec![]).cells(), None);
    assert_eq!(planter(vec![Area { density_per_ha: 0.0, ..Default::default() }], vec![]).cells(), None);
    let areas = (0..10_u32)
        .map(|area| Area {
            stock: (0..30).map(|number| Stock { species: format!("{area} {number}"), ..Default::default() }).collect(),
            ..Default::default()
        })
        .collect();
    let error = Planter::new(&ForestPlan { areas, ..Default::default() }).unwrap_err();
    assert_eq!(error.to_string(), "`species.len()` is 257, but must be 1 to 256");
}

/// Numbers, many of them sensible, some extreme.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => 0.0_f32..200.0,
        1 => -1e6_f32..1e6,
        1 => prop::sample::select(vec![f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, 1e-30, -0.0, 1e10]),
    ]
}

fn pattern() -> impl Strategy<Value = CountModel> {
    let number = || number().prop_map(f64::from);
    prop_oneof![
        Just(CountModel::Poisson),
        any::<u16>().prop_map(|n| CountModel::Binomial { n: n.into() }),
        number().prop_map(|k| CountModel::NegativeBinomial { k }),
        number().prop_map(|clump| CountModel::PoissonPoisson { clump }),
        (any::<u8>(), 0.0..1.2).prop_map(|(n, p)| CountModel::PoissonBinomial { n: n.into(), p }),
        (number(), number()).prop_map(|(k, p)| CountModel::PoissonNegativeBinomial { k, p }),
    ]
}

fn shape() -> impl Strategy<Value = Shape> {
    let place = || [number(), number()];
    prop_oneof![
        (place(), place()).prop_map(|(min_m, max_m)| Shape::Rectangle { min_m, max_m }),
        prop::collection::vec(place(), 0..6).prop_map(|corners_m| Shape::Polygon { corners_m }),
        (place(), place(), prop::collection::vec("[0-9.]{3}", 0..4)).prop_map(|(min_m, max_m, rows)| Shape::Mask {
            min_m,
            max_m,
            rows
        }),
    ]
}

proptest! {
    /// Whatever the plan, it is refused or planted, with finite plants within its bounds.
    #[test]
    fn any_plan_is_refused_or_gives_finite_plants(
        shape in shape(), pattern in pattern(), numbers in prop::array::uniform8(number()),
        keep_out in prop::collection::vec([number(), number()], 0..5),
    ) {
        let [density_per_ha, quadrat_m, least_distance_m, drift_m, age_years, steepest_deg, width_m, size_spread] = numbers;
        let ground = GroundLimits { steepest_deg, ..Default::default() };
        let stock = vec![Stock { age_years, size_spread, ..Default::default() }];
        let area =
            Area { shape, density_per_ha, pattern, quadrat_m, least_distance_m, drift_m, ground, stock, ..Default::default() };
        let keep_out = vec![KeepOut::Path { points_m: keep_out, width_m }];
        // Valid but for the field under test.
        let tame = Area { quadrat_m: 0.0, least_distance_m: 0.0, drift_m: 0.0, stock: vec![Stock::default()], ..area.clone() };
        for (area, keep_out) in [(area, keep_out), (tame, vec![])] {
            let plan = ForestPlan { areas: vec![area], keep_out, ..Default::default() };
            let Ok(planter) = Planter::new(&plan) else { continue };
            let mut planted = Vec::new();
            for cell in planter.cells().into_iter().flatten().chain([IVec2::ZERO, IVec2::MAX, IVec2::MIN]) {
                planter.plant(cell, &LevelGround(1.0), &mut planted);
                for plant in &planted {
                    prop_assert!(plant.position.is_finite() && plant.plan_size > 0.0 && plant.age_years.is_finite());
                    prop_assert_eq!(planter.cell_at(map_place(plant).as_vec2()), cell);
                }
            }
        }
    }
}
