//! What must hold of every tree, whatever its species: tried on random species and on the shipped ones.

use std::collections::HashMap;

use bevy::math::Vec3;
use proptest::prelude::*;

use super::{
    foliage::{CLUSTERS_LIMIT, Foliage},
    growth::{
        Growth, Phyllotaxis,
        aono_kunii::{AonoKunii, Branching, Shoot},
        damage::Damage,
        envelope::{Envelope, EnvelopeShape},
        reeves::{BEAMS_LIMIT, BranchOrder, ReevesBlau, Trunk},
        zaharia::{Fir, Oak},
    },
    leaf_mesh::leaves,
    mesh::{WoodVertices, wood},
    skeleton::{Skeleton, grow},
    species::Species,
};

fn oak() -> Species {
    Species::from_ron(include_str!("../../assets/species/oak.species.ron")).unwrap()
}

fn fir() -> Species {
    Species::from_ron(include_str!("../../assets/species/fir.species.ron")).unwrap()
}

fn orders() -> impl Strategy<Value = BranchOrder> {
    let places = (0.0_f32..0.6, 0.6_f32..=1.0, 0.2_f32..3.0, 0.0_f32..=1.0, 1_u32..6);
    let angles = (0.0_f32..150.0, 0.0_f32..150.0, 0.0_f32..60.0, -360.0_f32..360.0, 0.0_f32..180.0);
    let lengths = (0.02_f32..3.0, 0.0_f32..=1.0, 0.0_f32..=1.0, 0.05_f32..=1.0, 0.0_f32..3.0);
    let habit = (1_u32..=6, 0.0_f32..60.0, -4.0_f32..4.0, -0.3_f32..0.3, 0.0_f32..=1.0);
    (places, angles, lengths, habit).prop_map(|(places, angles, lengths, habit)| BranchOrder {
        first_at: places.0,
        last_at: places.1,
        spacing_m: places.2,
        spacing_spread: places.3,
        per_node: places.4,
        first_angle_deg: angles.0,
        last_angle_deg: angles.1,
        angle_spread_deg: angles.2,
        roll_deg: angles.3,
        roll_spread_deg: angles.4,
        length: lengths.0,
        taper: lengths.1,
        length_spread: lengths.2,
        reach: lengths.3,
        light_seeking: lengths.4,
        segments: habit.0,
        crook_deg: habit.1,
        rise: habit.2,
        sag: habit.3,
        probability: habit.4,
    })
}

const SHAPES: [EnvelopeShape; 5] = [
    EnvelopeShape::Ellipsoid,
    EnvelopeShape::Cone,
    EnvelopeShape::Cylinder,
    EnvelopeShape::Dome,
    EnvelopeShape::InvertedCone,
];

fn structures() -> impl Strategy<Value = AonoKunii> {
    let shoot = || {
        (0.0_f32..150.0, 0.1_f32..1.2, 0.1_f32..1.0).prop_map(|(angle_deg, length, diameter)| Shoot {
            angle_deg,
            length,
            diameter,
        })
    };
    let arrangements = prop::sample::select(vec![
        Phyllotaxis::Spiral,
        Phyllotaxis::Alternate,
        Phyllotaxis::Opposite,
        Phyllotaxis::Whorled(5),
    ]);
    let monopodial = (shoot(), shoot(), arrangements).prop_map(|(axis, lateral, arrangement)| Branching::Monopodial {
        axis,
        lateral,
        arrangement,
    });
    let dichotomous = ([shoot(), shoot()], -360.0_f32..360.0)
        .prop_map(|(shoots, turn_deg)| Branching::Dichotomous { shoots, turn_deg });
    let ternary = (shoot(), [-360.0_f32..360.0, -360.0_f32..360.0])
        .prop_map(|(shoot, turns_deg)| Branching::Ternary { shoot, turns_deg });
    let branching = prop_oneof![monopodial, dichotomous, ternary];
    (branching, 1_u32..=12, 0.0_f32..60.0, -1.0_f32..1.0, 0.0_f32..0.9).prop_map(
        |(branching, generations, deviation_deg, gravity, length_deviation)| AonoKunii {
            branching,
            generations,
            deviation_deg,
            gravity,
            length_deviation,
            ..AonoKunii::default()
        },
    )
}

prop_compose! {
    fn species()(
        shape in prop::sample::select(SHAPES.to_vec()),
        (top_m, low, radius_m) in (0.5_f32..60.0, 0.0_f32..0.9, 0.1_f32..30.0),
        (height, trunk_radius_m, segments) in (0.1_f32..=1.0, 0.01_f32..2.0, 1_u32..=6),
        (lean_deg, crook_deg, buttresses, stems) in (0.0_f32..60.0, 0.0_f32..45.0, 0_u32..=9, 1_u32..=5),
        (dead, broken_trunks, broken_branches, remains) in
            (any::<bool>(), 0.0_f32..=1.0, 0.0_f32..=1.0, 0.02_f32..=1.0),
        orders in prop::collection::vec(orders(), 0..=3),
        (size_spread, shade_pruning, pipe_exponent) in (0.0_f32..0.8, 0.0_f32..=1.0, 1.5_f32..4.0),
        (first_order, spacing_m, size_m, droop) in (0_u8..=3, 0.05_f32..2.0, 0.05_f32..2.0, -2.0_f32..2.0),
    ) -> Species {
        let height_m = (height * top_m).max(0.5);
        Species {
            growth: Growth::ReevesBlau(ReevesBlau {
                envelope: Envelope { shape, base_m: low * top_m, top_m, radius_m },
                trunk: Trunk {
                    height_m, radius_m: trunk_radius_m, segments, stems, lean_deg, crook_deg, buttresses,
                    ..Trunk::default()
                },
                orders, size_spread, shade_pruning, pipe_exponent,
            }),
            damage: Damage { dead, broken_trunks, broken_branches, remains },
            foliage: Foliage { first_order, spacing_m, size_m, droop, ..Foliage::default() },
            ..Species::default()
        }
    }
}

/// The height that a species inside an envelope promises never to pass, whatever the age.
fn stated_height_m(species: &Species) -> f32 {
    let Growth::ReevesBlau(growth) = &species.growth else { return f32::INFINITY };
    growth.envelope.top_m * species.age.stage(species.age.oldest_years).height
}

fn check_skeleton(species: &Species, skeleton: &Skeleton) {
    assert!((1..=BEAMS_LIMIT + 64).contains(&skeleton.beams.len()));
    assert!(skeleton.clusters.len() <= CLUSTERS_LIMIT);
    for (index, beam) in skeleton.beams.iter().enumerate() {
        assert!(beam.base.is_finite() && beam.bow.is_finite() && beam.length_m > 0.0);
        assert!((beam.direction.length() - 1.0).abs() < 1e-4);
        assert!((0.0..=1.0).contains(&beam.attach));
        assert!(0.0 < beam.tip_radius_m && beam.tip_radius_m <= beam.base_radius_m);
        // A branch may overshoot the envelope by the shortest beam there is.
        assert!(beam.path(0.5).y.max(beam.path(1.0).y) <= stated_height_m(species) + 0.08 + 1e-3);
        let Some(parent) = beam.parent else { continue };
        assert!((parent as usize) < index, "parents come first");
        let parent = &skeleton.beams[parent as usize];
        assert!(beam.base.distance(parent.path(beam.attach)) < 1e-3, "a beam starts on its parent's path");
        assert!(beam.base_radius_m <= parent.radius_m(beam.attach) * 1.0001, "radii never grow outward");
        assert!(beam.order == parent.order || beam.order == parent.order + 1);
    }
    for cluster in &skeleton.clusters {
        let beam = &skeleton.beams[cluster.beam as usize];
        assert!(cluster.anchor.distance(beam.path(cluster.at)) < 1e-3);
        assert!((cluster.axis.length() - 1.0).abs() < 1e-4 && (cluster.normal.length() - 1.0).abs() < 1e-4);
        assert!(cluster.axis.dot(cluster.normal).abs() < 1e-3);
        assert!([cluster.depth, cluster.tint, cluster.phase].iter().all(|share| (0.0..=1.0).contains(share)));
    }
}

fn check_vertices(positions: &[[f32; 3]], normals: &[[f32; 3]], sway: &[[f32; 4]], indices: &[u32], beams: usize) {
    assert!(positions.len() == normals.len() && positions.len() == sway.len());
    assert!(positions.iter().flatten().all(|value| value.is_finite()));
    assert!(normals.iter().all(|&normal| (Vec3::from(normal).length() - 1.0).abs() < 1e-3));
    assert!(indices.len().is_multiple_of(3) && indices.iter().all(|&index| (index as usize) < positions.len()));
    for [beam, s, phase, light] in sway {
        assert!(beam.fract() == 0.0 && (*beam as usize) < beams);
        assert!([s, phase, light].iter().all(|share| (0.0..=1.0).contains(*share)));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn every_valid_species_grows_a_sound_tree(
        species in species(),
        age_years in 0.0_f32..700.0,
        seed in any::<u64>(),
    ) {
        species.validate().unwrap();
        let skeleton = grow(&species, age_years, seed);
        check_skeleton(&species, &skeleton);
        let (wood, leaves) = (wood(&species, &skeleton), leaves(&species, &skeleton));
        check_vertices(&wood.positions, &wood.normals, &wood.sway, &wood.indices, skeleton.beams.len());
        check_vertices(&leaves.positions, &leaves.normals, &leaves.sway, &leaves.indices, skeleton.beams.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_structural_tree_is_sound(structure in structures(), age_years in 0.0_f32..300.0, seed in any::<u64>()) {
        let species = Species { growth: Growth::AonoKunii(structure), ..Species::default() };
        species.validate().unwrap();
        check_skeleton(&species, &grow(&species, age_years, seed));
    }
}

prop_compose! {
    fn zaharias_oak()(
        (height_m, radius_m, delta) in (0.5_f32..60.0, 0.01_f32..2.0, 0.0_f32..=1.0),
        (min_branch, more) in (0.0_f32..20.0, 0.0_f32..20.0),
        (min_age_years, span_years) in (0.0_f32..200.0, 1.0_f32..500.0),
        adjust_branch in prop::collection::vec(-1.0_f32..2.0, 0..=4),
        (first_at, shortest) in (0.0_f32..=0.95, 0.0_f32..=1.0),
        (first_angle_deg, last_angle_deg, angle_spread_deg) in (0.0_f32..150.0, 0.0_f32..150.0, 0.0_f32..60.0),
    ) -> Growth {
        Growth::Oak(Oak {
            trunk: Trunk { height_m, radius_m, ..Trunk::default() },
            delta_m: delta * height_m, min_branch, max_branch: min_branch + more,
            min_age_years, max_age_years: min_age_years + span_years,
            adjust_branch, first_at, shortest, first_angle_deg, last_angle_deg, angle_spread_deg,
            ..Oak::default()
        })
    }
}

prop_compose! {
    fn zaharias_fir()(
        (height_m, radius_m, delta) in (0.5_f32..60.0, 0.01_f32..2.0, 0.0_f32..=1.0),
        (min_floors, more, branching_factor) in (0.0_f32..40.0, 0.0_f32..40.0, 1_u32..=12),
        (min_age_years, span_years) in (0.0_f32..200.0, 1.0_f32..500.0),
        (adjust_branch, side_pairs) in ([-1.0_f32..2.0, -1.0_f32..2.0], 0.0_f32..20.0),
        (first_at, shortest, sag) in (0.0_f32..=0.95, 0.0_f32..=1.0, -0.3_f32..0.3),
        (first_angle_deg, last_angle_deg, side_angle_deg) in (0.0_f32..150.0, 0.0_f32..150.0, 0.0_f32..150.0),
    ) -> Growth {
        Growth::Fir(Fir {
            trunk: Trunk { height_m, radius_m, ..Trunk::default() },
            delta_m: delta * height_m, min_floors, max_floors: min_floors + more, branching_factor,
            min_age_years, max_age_years: min_age_years + span_years,
            adjust_branch, side_pairs, first_at, shortest, sag, first_angle_deg, last_angle_deg, side_angle_deg,
            ..Fir::default()
        })
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn every_tree_of_zaharias_is_sound(
        growth in prop_oneof![zaharias_oak(), zaharias_fir()],
        age_years in 0.0_f32..800.0,
        seed in any::<u64>(),
    ) {
        let species = Species { growth, ..Species::default() };
        species.validate().unwrap();
        check_skeleton(&species, &grow(&species, age_years, seed));
    }
}

/// One species of each generator.
fn of_all_kinds() -> Vec<Species> {
    let growths = [
        Growth::ReevesBlau(ReevesBlau::default()),
        Growth::Oak(Oak::default()),
        Growth::Fir(Fir::default()),
        Growth::AonoKunii(AonoKunii::default()),
    ];
    growths.map(|growth| Species { growth, ..Species::default() }).into()
}

#[test]
fn all_generators_grow_sound_trees_at_all_ages_and_survive_writing_and_reading() {
    for species in of_all_kinds() {
        species.validate().unwrap();
        let written = ron::to_string(&species).unwrap();
        assert_eq!(ron::from_str::<Species>(&written).unwrap(), species);
        for age_years in [-5.0, 1.0, 7.0, 60.0, 200.0, 1e6] {
            let skeleton = grow(&species, age_years, 3);
            check_skeleton(&species, &skeleton);
            assert_eq!(skeleton, grow(&species, age_years, 3));
        }
    }
}

/// A sapling is no shrunk old tree: fewer beams and orders, and leaves that are larger beside it.
#[test]
fn trees_grow_in_height_girth_and_number_of_branches() {
    for species in of_all_kinds() {
        let ages = [5.0, 20.0, 60.0, 120.0].map(|age_years| {
            let trees = (0..5).map(|seed| grow(&species, age_years, seed));
            trees.fold([0.0; 4], |sum, tree| {
                let orders = tree.beams.iter().map(|beam| beam.order).max().unwrap_or(0);
                let size_m =
                    tree.clusters.iter().map(|cluster| cluster.size_m).sum::<f32>() / tree.clusters.len() as f32;
                let leafiness = size_m / tree.height_m();
                let own = [tree.height_m(), tree.beams[0].base_radius_m, tree.beams.len() as f32, f32::from(orders)];
                assert!(leafiness < 0.5, "{leafiness}");
                [0, 1, 2, 3].map(|index| sum[index] + own[index])
            })
        });
        for pair in ages.windows(2) {
            let grows = pair[0][..3].iter().zip(&pair[1]).all(|(young, old)| young < old) && pair[0][3] <= pair[1][3];
            assert!(grows, "{:?}: {ages:?}", species.growth);
        }
        assert!(ages[0][2] < 0.2 * ages[3][2], "{ages:?}");
    }
}

#[test]
fn a_dead_tree_has_broken_branches_and_no_leaves() {
    let whole = oak();
    let damage = Damage { dead: true, broken_branches: 0.7, broken_trunks: 0.0, remains: 0.1 };
    let dead = Species { damage, ..whole.clone() };
    let [whole, snag] = [grow(&whole, 120.0, 2), grow(&dead, 120.0, 2)];
    assert!(snag.clusters.is_empty() && 4 * snag.beams.len() < 3 * whole.beams.len());
    assert_eq!(snag.beams[0], whole.beams[0], "the trunk keeps its wood");
    let thickest_tip = |tree: &Skeleton| {
        let next = tree.continuations();
        let tips = tree.beams.iter().zip(next).filter(|(beam, next)| beam.order > 0 && next.is_none());
        tips.map(|(beam, _)| beam.tip_radius_m).fold(0.0, f32::max)
    };
    assert!(thickest_tip(&snag) > 2.0 * thickest_tip(&whole), "stubs are blunt");
}

#[test]
fn a_shrub_has_several_stems_that_lean_apart() {
    let trunk = Trunk { stems: 9, height_m: 3.0, radius_m: 0.03, lean_deg: 30.0, ..Trunk::default() };
    let envelope = Envelope { shape: EnvelopeShape::InvertedCone, base_m: 0.0, top_m: 4.0, radius_m: 2.0 };
    let growth = Growth::ReevesBlau(ReevesBlau { trunk, envelope, ..ReevesBlau::default() });
    let shrub = Species { growth, ..Species::default() };
    let skeleton = grow(&shrub, 120.0, 1);
    let stems: Vec<_> = skeleton.beams.iter().filter(|beam| beam.parent.is_none()).collect();
    assert_eq!(stems.len(), 9);
    assert!(stems.iter().all(|stem| stem.base.dot(stem.direction) >= 0.0 && stem.base.y == 0.0));
    let wood = wood(&shrub, &skeleton);
    for point in wood.positions.iter().zip(&wood.sway).filter(|(at, sway)| sway[1] == 0.0 && at[1] < 0.0) {
        let stem = &skeleton.beams[point.1[0] as usize];
        assert!((Vec3::from(*point.0) - stem.base).length() < 1.0, "each stem stands on its own foot");
    }
}

/// Pendulous twigs hang: their last beams point at the ground.
#[test]
fn a_weeping_tree_hangs_its_twigs() {
    let mut growth = ReevesBlau::default();
    growth.orders[1] = BranchOrder { segments: 4, rise: -3.0, length: 0.8, light_seeking: 0.0, ..growth.orders[1] };
    let willow = Species { growth: Growth::ReevesBlau(growth), ..Species::default() };
    let skeleton = grow(&willow, 120.0, 4);
    let next = skeleton.continuations();
    let tips = skeleton.beams.iter().zip(&next).filter(|(beam, next)| beam.order == 2 && next.is_none());
    let falls: Vec<f32> = tips.map(|(beam, _)| beam.direction.y).collect();
    let mean = falls.iter().sum::<f32>() / falls.len() as f32;
    assert!(falls.len() > 20 && mean < -0.7, "{mean} of {}", falls.len());
}

#[test]
fn the_same_seed_grows_the_same_tree_and_another_seed_another() {
    let oak = oak();
    assert_eq!(grow(&oak, 80.0, 7), grow(&oak, 80.0, 7));
    assert_ne!(grow(&oak, 80.0, 7), grow(&oak, 80.0, 8));
}

#[test]
fn the_shipped_trees_have_the_sizes_of_real_ones_and_keep_their_budget() {
    for (species, heights, widths) in [(oak(), 12.5..18.0, 10.0..19.0), (fir(), 17.0..23.0, 4.5..8.0)] {
        for seed in 0..6 {
            let skeleton = grow(&species, species.age.mature_years, seed);
            let (wood, leaves) = (wood(&species, &skeleton), leaves(&species, &skeleton));
            let vertices = wood.positions.len() + leaves.positions.len();
            let reach = |x: &[f32; 3]| 2.0 * x[0].hypot(x[2]);
            let width = leaves.positions.iter().map(reach).fold(0.0, f32::max);
            let name = &species.name;
            assert!(heights.contains(&skeleton.height_m()), "{name} {seed}: {} m", skeleton.height_m());
            assert!(widths.contains(&width), "{name} {seed}: {width} m wide");
            assert!((350..=750).contains(&skeleton.beams.len()), "{name} {seed}: {} beams", skeleton.beams.len());
            assert!((8_000..=16_000).contains(&vertices), "{name} {seed}: {vertices} vertices");
        }
    }
}

/// Edges with a triangle on one side only, after vertices at one place are taken as one.
fn open_edges(wood: &WoodVertices) -> Vec<[usize; 2]> {
    let mut welded: HashMap<([u32; 3], u32), usize> = HashMap::new();
    let first_at: Vec<usize> = (0..wood.positions.len())
        .map(|index| {
            let place = wood.positions[index].map(f32::to_bits);
            *welded.entry((place, wood.sway[index][0] as u32)).or_insert(index)
        })
        .collect();
    let mut sides: HashMap<[usize; 2], i32> = HashMap::new();
    for triangle in wood.indices.chunks_exact(3) {
        for corner in 0..3 {
            let edge = [triangle[corner], triangle[(corner + 1) % 3]].map(|index| first_at[index as usize]);
            let (key, direction) = if edge[0] < edge[1] { (edge, 1) } else { ([edge[1], edge[0]], -1) };
            *sides.entry(key).or_insert(0) += direction;
        }
    }
    sides.into_iter().filter(|&(_, balance)| balance != 0).map(|(edge, _)| edge).collect()
}

#[test]
fn bark_is_open_inside_the_parent_and_below_the_ground() {
    for species in [oak(), fir()] {
        let skeleton = grow(&species, species.age.mature_years, 3);
        let wood = wood(&species, &skeleton);
        let edges = open_edges(&wood);
        assert!(edges.len() >= 3 * skeleton.beams.iter().filter(|beam| beam.attach < 1.0).count() / 2);
        let branches = branches(&skeleton);
        let (mut shown, mut tried) = (0, 0);
        for index in edges.into_iter().flatten() {
            let point = Vec3::from(wood.positions[index]);
            let [beam, at, ..] = wood.sway[index];
            let bound = &skeleton.beams[beam as usize];
            if bound.parent.is_none() && point.y < 0.0 {
                continue; // The trunk is open below the ground.
            }
            // A foot moves with the parent that it stands on, a thin root with its own beam's root inside the parent.
            let (bearer, at) = match bound.parent {
                Some(parent) if at == 0.0 && is_inside(&wood, &skeleton, &branches, parent, bound.attach, point) => {
                    (parent, bound.attach)
                }
                _ => (beam as u32, at),
            };
            let inside = is_inside(&wood, &skeleton, &branches, bearer, at, point);
            shown += u32::from(!inside);
            tried += 1;
        }
        // At a kink of a thin limb the drawn surface is narrower than its cross-sections: a few feet stand out there.
        assert!(100 * shown < tried, "{}: {shown} of {tried} vertices at open edges show", species.name);
    }
}

/// The branch of each beam, named after its first beam.
fn branches(skeleton: &Skeleton) -> Vec<usize> {
    let mut branches: Vec<usize> = (0..skeleton.beams.len()).collect();
    for (beam, next) in skeleton.continuations().into_iter().enumerate() {
        if let Some(next) = next {
            branches[next as usize] = branches[beam];
        }
    }
    branches
}

/// Whether a point lies inside the drawn surface of `beam`'s branch beside the place `at`: met from within to both sides.
fn is_inside(wood: &WoodVertices, skeleton: &Skeleton, branches: &[usize], beam: u32, at: f32, point: Vec3) -> bool {
    let bearer = &skeleton.beams[beam as usize];
    let across = bearer.tangent(at).any_orthonormal_vector();
    [across, -across]
        .into_iter()
        .all(|out| leaves_through(wood, branches, beam, point, out, 2.5 * bearer.base_radius_m))
}

/// Whether a ray meets the surface of `beam`'s branch from within, not farther than `limit_m`.
fn leaves_through(wood: &WoodVertices, branches: &[usize], beam: u32, point: Vec3, out: Vec3, limit_m: f32) -> bool {
    wood.indices.chunks_exact(3).any(|triangle| {
        let own = |&index: &u32| branches[wood.sway[index as usize][0] as usize] == branches[beam as usize];
        if !triangle.iter().all(own) {
            return false;
        }
        // Moeller and Trumbore, 1997.
        let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from(wood.positions[triangle[corner] as usize]));
        let (ab, ac, from) = (b - a, c - a, point - a);
        let across = out.cross(ac);
        let volume = ab.dot(across);
        let u = from.dot(across) / volume;
        let v = out.dot(from.cross(ab)) / volume;
        let far_m = ac.dot(from.cross(ab)) / volume;
        // A negative volume is a triangle seen from behind, which is from within.
        volume < 0.0 && u >= -1e-4 && v >= -1e-4 && u + v <= 1.0001 && (0.0..=limit_m).contains(&far_m)
    })
}

#[test]
fn a_leaf_card_hangs_at_its_anchor_along_its_axis() {
    let species = fir();
    let skeleton = grow(&species, species.age.mature_years, 5);
    let leaves = leaves(&species, &skeleton);
    let stride = species.foliage.card.vertices();
    let bent = (0.5 * species.foliage.bend_deg.to_radians()).cos();
    for (card, cluster) in skeleton.clusters.iter().enumerate() {
        let [root, tip] = [stride * card, stride * card + 2].map(|index| Vec3::from(leaves.positions[index]));
        let along = (tip - root).normalize();
        assert_eq!(root.to_array(), leaves.anchor[stride * card][..3]);
        assert!(along.dot(cluster.axis) > 0.9999);
        assert!((root.distance(tip) - bent * cluster.size_m).abs() < 1e-3);
    }
}
