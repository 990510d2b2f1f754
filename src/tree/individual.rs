//! Grows one individual: branches from the species' generator, foliage on them, radii, and damage.

use rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};

use super::{
    foliage::Foliage,
    generator::Grown,
    growth::{age::Stage, grower::GrownBranches, pipes},
    leaf_places::place_foliage,
    skeleton::{Skeleton, SkeletonBeam},
    species::Species,
};

/// Sprays of a young tree are shoots no longer than this share of its height.
const LONGEST_SPRAY_SHARE: f32 = 0.3;

/// Grows one individual of `species` as it is at `age_years`, which is clamped to 1 year and the oldest age of the
/// species. The same species, age and seed give the same tree, on every run.
#[must_use]
pub fn grow(species: &Species, age_years: f32, seed: u64) -> Skeleton {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let stage = species.age.stage(age_years);
    let mut skeleton = match species.growth.grow(&stage, &mut random) {
        Grown::Branches(branches) => with_foliage(species, &stage, branches, &mut random),
        Grown::WholeTree(skeleton) => skeleton,
    };
    species.damage.apply(&mut skeleton.beams, &mut skeleton.clusters, &mut random);
    skeleton
}

/// Places the foliage on the branches, and finds from both how thick the branches are.
fn with_foliage(species: &Species, stage: &Stage, branches: GrownBranches, random: &mut impl Rng) -> Skeleton {
    let GrownBranches { mut beams, envelope, trunk_radius_m } = branches;
    let mut clusters = place_foliage(&foliage_of_age(&species.foliage, &beams), &beams, &envelope, random);
    // Outer sprays hide inner ones from wherever one looks: drawn first, they save what is behind them.
    clusters.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    if let Some(exponent) = species.growth.pipe_exponent() {
        pipes::assign_radii(&mut beams, &clusters, trunk_radius_m, exponent);
    }
    let trunk = species.growth.trunk();
    let trunk = trunk.scaled(stage.height, trunk_radius_m / trunk.radius_m);
    Skeleton { beams, clusters, envelope, trunk }
}

/// The foliage on a tree that may not have all its orders of branches yet: leaves sit on the last that there is. Sprays
/// keep their size whatever the age, but are no larger than a seedling.
fn foliage_of_age(foliage: &Foliage, beams: &[SkeletonBeam]) -> Foliage {
    let last_order = beams.iter().map(|beam| beam.order).max().unwrap_or(0);
    let height_m = beams.iter().map(|beam| beam.path(1.0).y).fold(0.0, f32::max);
    let size_m = foliage.size_m.min(LONGEST_SPRAY_SHARE * height_m);
    Foliage {
        first_order: foliage.first_order.min(last_order),
        size_m,
        spacing_m: foliage.spacing_m * size_m / foliage.size_m,
        ..foliage.clone()
    }
}
