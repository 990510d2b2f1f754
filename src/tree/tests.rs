//! What must hold of every tree, whatever its species: checked on random species and on the shipped ones.

pub(super) mod strategies;
mod wood_surface;
mod zaharia;

use bevy::math::Vec3;
use proptest::prelude::*;

use self::strategies::{species, structures, zaharias_fir, zaharias_oak};
use super::{
    foliage::{CLUSTERS_LIMIT, Card},
    generator::Growth,
    growth::{
        BEAMS_LIMIT,
        aono_kunii::AonoKunii,
        damage::Damage,
        envelope::{Envelope, EnvelopeShape},
        reeves_blau::{BranchOrder, ReevesBlau},
        trunk::Trunk,
        zaharia::{Fir, Oak},
    },
    individual::grow,
    leaf_mesh::leaves,
    skeleton::Skeleton,
    species::Species,
    wood_mesh::wood,
};

fn oak() -> Species {
    Species::from_ron(include_str!("../../assets/species/oak.species.ron")).unwrap()
}

fn fir() -> Species {
    Species::from_ron(include_str!("../../assets/species/fir.species.ron")).unwrap()
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
    fn every_valid_species_grows_a_valid_tree(
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
    fn every_structural_tree_is_valid(structure in structures(), age_years in 0.0_f32..300.0, seed in any::<u64>()) {
        let species = Species { growth: Growth::AonoKunii(structure), ..Species::default() };
        species.validate().unwrap();
        check_skeleton(&species, &grow(&species, age_years, seed));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn every_tree_of_zaharia_is_valid(
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
fn one_of_each_generator() -> Vec<Species> {
    let growths = [
        Growth::ReevesBlau(ReevesBlau::default()),
        Growth::Oak(Oak::default()),
        Growth::Fir(Fir::default()),
        Growth::AonoKunii(AonoKunii::default()),
    ];
    growths.map(|growth| Species { growth, ..Species::default() }).into()
}

#[test]
fn all_generators_grow_valid_trees_at_all_ages_and_read_back_what_they_write() {
    for species in one_of_each_generator() {
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
    for species in one_of_each_generator() {
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
        assert!((Vec3::from(*point.0) - stem.base).length() < 1.0, "each stem starts at its own base");
    }
}

/// The last beams of pendulous twigs point at the ground.
#[test]
fn twigs_of_a_weeping_tree_point_at_the_ground() {
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
fn a_tree_is_determined_by_its_seed() {
    let oak = oak();
    assert_eq!(grow(&oak, 80.0, 7), grow(&oak, 80.0, 7));
    assert_ne!(grow(&oak, 80.0, 7), grow(&oak, 80.0, 8));
}

#[test]
fn shipped_trees_have_realistic_sizes_and_few_enough_vertices() {
    // Firs that stand free are a quarter to four tenths as wide as high. Crowns are solid with some 20,000 vertices near the camera.
    for (species, heights, widths) in [(oak(), 12.5..18.0, 10.0..19.0), (fir(), 17.0..25.0, 5.0..10.0)] {
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
            assert!((12_000..=26_000).contains(&vertices), "{name} {seed}: {vertices} vertices");
        }
    }
}

#[test]
fn a_leaf_card_starts_at_its_anchor_and_runs_along_its_axis() {
    let mut species = fir();
    (species.foliage.card, species.foliage.bend_deg) = (Card::Bent, 40.0);
    let skeleton = grow(&species, species.age.mature_years, 5);
    let leaves = leaves(&species, &skeleton);
    let stride = species.foliage.card.vertices();
    // Both parts keep their lengths, 0.58 and 0.42 of the spray's (law of cosines).
    let bent = (0.58_f32.powi(2) + 0.42_f32.powi(2) + 2.0 * 0.58 * 0.42 * 40.0_f32.to_radians().cos()).sqrt();
    for (card, cluster) in skeleton.clusters.iter().enumerate() {
        let [root, tip] = [stride * card, stride * card + 2].map(|index| Vec3::from(leaves.positions[index]));
        let along = (tip - root).normalize();
        assert_eq!(root.to_array(), leaves.anchor[stride * card][..3]);
        assert!(along.dot(cluster.axis) > 0.9999);
        assert!((root.distance(tip) - bent * cluster.size_m).abs() < 1e-3);
    }
}
