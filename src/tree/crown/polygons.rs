//! Where the polygons of an impressionist crown lie; see [`impressionist`](super::impressionist).

use std::f32::consts::{PI, TAU};

use bevy::math::{Quat, Vec3};
use rand::{Rng, RngExt};

use super::{
    billows::Billows,
    crown_wood::{CrownWood, limb_targets, nearest},
    impressionist_settings::{CrownForm, ImpressionistCrown},
    profile::Profile,
};
use crate::{
    sequence::r2,
    tree::{
        foliage::CLUSTERS_LIMIT,
        growth::pipes,
        skeleton::{LeafCluster, Skeleton, SkeletonBeam},
        vertices::LeafVertices,
    },
};

/// How far out limbs reach as a share of the way from the core to the surface: far enough that polygons move with their
/// limb and not with the trunk, and hidden in summer.
const SUMMER_REACH: f32 = 0.68;
const WINTER_REACH: f32 = 0.8;
/// How far out their branches do.
const BRANCH_REACH: [f32; 2] = [0.75, 0.95];
/// Turn of polygons in their own plane, rad: anyhow, twigs upwards, boughs outwards and down.
const SPIN_RAD: [f32; 3] = [PI, 0.45, 0.45];
/// Twigs leave their branch between this place and its tip.
const FIRST_TWIG_AT: f32 = 0.3;
/// Places among which the texture's values are ranked.
const RANKED_PLACES: usize = 2048;
/// Exponent of the pipe model, about Leonardo's 2.
const PIPE_EXPONENT: f32 = 2.2;
/// How much of a polygon's tint is its own, the rest its depth.
const OWN_TINT: f32 = 0.5;
/// Steps of the way to the core in which a polygon that leaves the outline is moved, and how much smaller it then
/// becomes.
const INWARD_STEPS: u32 = 12;
const SHRINKING: f32 = 0.7;
/// How often it may shrink, which takes it to a millionth.
const SHRINKINGS: u32 = 40;

pub(super) fn grow(crown: &ImpressionistCrown, random: &mut impl Rng) -> Skeleton {
    let profile = crown.profile();
    let mut beams = grow_wood(crown, &profile, random);
    // In summer limbs carry polygons and the trunk none; of a winter tree, what is farthest out.
    let order = if crown.form == CrownForm::Winter && crown.branches > 0 { 2 } else { 1 };
    let mut placer = PolygonPlacer {
        crown,
        profile,
        billows: Billows::new(&profile, crown.distortion, crown.form == CrownForm::Conifer, random.random()),
        order,
        carriers: (0_u32..).zip(&beams).filter(|(_, beam)| beam.order >= order).map(|(index, _)| index).collect(),
        beams: &beams,
    };
    let places: Vec<Vec3> = (0..RANKED_PLACES).map(|index| placer.place(r2([0.0; 2], index)).1).collect();
    placer.billows.rank_among(&places);
    let clusters = placer.polygons(random);
    pipes::assign_radii(&mut beams, &clusters, crown.trunk_radius_m, PIPE_EXPONENT);
    Skeleton { beams, clusters, envelope: crown.envelope(), trunk: crown.trunk() }
}

/// Trunk, limbs and branches.
fn grow_wood(crown: &ImpressionistCrown, profile: &Profile, random: &mut impl Rng) -> Vec<SkeletonBeam> {
    let (trunk_top, rise, reach) = match crown.form {
        CrownForm::Normal => (0.72, 0.7, SUMMER_REACH),
        CrownForm::Winter => (0.7, 0.85, WINTER_REACH),
        CrownForm::Conifer => (0.97, -0.12, SUMMER_REACH),
    };
    let trunk_top_m = profile.base_m + trunk_top * profile.height_m();
    let lowest_limb_m = profile.base_m.max(0.12 * crown.height_m);
    let mut wood = CrownWood::with_trunk(trunk_top_m, lowest_limb_m, rise);
    for target in limb_targets(profile, crown.limbs, reach, random) {
        let limb = wood.limb(target);
        let sides = side_targets(crown.branches, target, profile, random);
        wood.branches(limb, &sides);
    }
    wood.beams
}

/// Where the branches of a limb end: around its own end, left and right by turns.
fn side_targets(count: u32, limb: Vec3, profile: &Profile, random: &mut impl Rng) -> Vec<Vec3> {
    let core = profile.core(limb);
    (0..count)
        .map(|index| {
            let side = if index % 2 == 0 { 1.0 } else { -1.0 };
            let turn = Quat::from_rotation_y(side * random.random_range(0.1..0.75));
            let lift = Vec3::Y * (0.22 * profile.height_m() * random.random_range(-0.7..1.0));
            outwards(profile, core, turn * (limb - core) + lift, random.random_range(BRANCH_REACH[0]..BRANCH_REACH[1]))
        })
        .collect()
}

/// The point `reach` of the way from `core` along `direction` to the outline.
fn outwards(profile: &Profile, core: Vec3, direction: Vec3, reach: f32) -> Vec3 {
    let direction = direction.try_normalize().unwrap_or(Vec3::Y);
    let (mut inside_m, mut outside_m) = (0.0, profile.height_m() + 2.0 * profile.radius_m);
    for _ in 0..24 {
        let middle_m = 0.5 * (inside_m + outside_m);
        if profile.holds(core + direction * middle_m) { inside_m = middle_m } else { outside_m = middle_m }
    }
    core + direction * (reach * inside_m)
}

struct PolygonPlacer<'a> {
    crown: &'a ImpressionistCrown,
    profile: Profile,
    billows: Billows,
    /// Least order of the beams that carry polygons, and these beams.
    order: u8,
    carriers: Vec<u32>,
    beams: &'a [SkeletonBeam],
}

/// The random numbers of a polygon. They are drawn first, so that settings do not change them.
struct RandomNumbers {
    /// Place on the surface, both 0 to 1.
    even: [f32; 2],
    inclination: f32,
    heading: f32,
    spin: f32,
    phase: f32,
    tint: f32,
}

impl PolygonPlacer<'_> {
    fn polygons(&self, random: &mut impl Rng) -> Vec<LeafCluster> {
        let start: [f64; 2] = [random.random(), random.random()];
        (0..(self.crown.polygons as usize).min(CLUSTERS_LIMIT))
            .filter_map(|index| {
                let mut signed = || random.random_range(-1.0_f32..=1.0);
                let numbers = RandomNumbers {
                    even: r2(start, index),
                    inclination: signed(),
                    heading: signed(),
                    spin: signed(),
                    phase: random.random(),
                    tint: random.random(),
                };
                self.polygon(&numbers)
            })
            .collect()
    }

    /// The polygon of these numbers, unless a gap is there.
    fn polygon(&self, numbers: &RandomNumbers) -> Option<LeafCluster> {
        let crown = self.crown;
        let (branch, surface) = self.place(numbers.even);
        let depth = self.billows.depth(surface);
        if depth >= 1.0 - crown.gaps {
            return None;
        }
        let inclination_deg = crown.inclination_deg + crown.inclination_spread_deg * numbers.inclination;
        let heading_rad = surface.z.atan2(surface.x) + crown.azimuth_spread_deg.to_radians() * numbers.heading;
        let (normal, axis) = self.orientation(inclination_deg.to_radians(), heading_rad, numbers.spin);
        let breadth = self.profile.breadth_share(surface.y);
        let size_m = crown.least_size_m + (crown.greatest_size_m - crown.least_size_m) * breadth;
        let core = self.profile.core(surface);
        // Roughness does not move twigs off their branch.
        let rough = if branch.is_some() { surface } else { surface.lerp(core, crown.roughness * depth) };
        let (anchor, size_m) = self.move_inside(rough, core, axis, normal, size_m);
        let (beam, at) = branch.unwrap_or_else(|| nearest(self.beams, self.order, anchor));
        let tint = OWN_TINT * numbers.tint + (1.0 - OWN_TINT) * (1.0 - depth);
        Some(LeafCluster { beam, at, anchor, axis, normal, size_m, phase: numbers.phase, depth, tint })
    }

    /// The point of the outline that belongs to a place of the sequence; in winter a point of a branch inside the
    /// outline, with that branch and the place on it. All branches bear as many twigs.
    fn place(&self, even: [f32; 2]) -> (Option<(u32, f32)>, Vec3) {
        let carrier = self.carriers.get((even[0] * self.carriers.len() as f32) as usize);
        match carrier {
            Some(&index) if self.crown.form == CrownForm::Winter => {
                let beam = &self.beams[index as usize];
                // A branch may start outside the crown, but ends inside.
                let first = FIRST_TWIG_AT + (1.0 - FIRST_TWIG_AT) * even[1];
                let mut places =
                    (0..=INWARD_STEPS).map(|step| first + (1.0 - first) * step as f32 / INWARD_STEPS as f32);
                let at = places.find(|&at| self.profile.holds(beam.path(at))).unwrap_or(1.0).min(1.0);
                (Some((index, at)), beam.path(at))
            }
            _ => (None, self.profile.surface(even[0], TAU * even[1])),
        }
    }

    /// Unit normal and axis of a polygon. The axis is the steepest line in its plane, turned by the polygon's spin: up
    /// in general; a bough's anchor is its tip, so that it too lies below; twigs lean the other way and rise outwards.
    fn orientation(&self, inclination_rad: f32, heading_rad: f32, spin: f32) -> (Vec3, Vec3) {
        let winter = self.crown.form == CrownForm::Winter;
        let lean = if winter { -inclination_rad.sin() } else { inclination_rad.sin() };
        let normal = Vec3::new(lean * heading_rad.cos(), inclination_rad.cos(), lean * heading_rad.sin());
        let level = Vec3::new(-heading_rad.sin(), 0.0, heading_rad.cos());
        let uphill = level.cross(normal) * if level.cross(normal).y < 0.0 { -1.0 } else { 1.0 };
        let spin_rad = spin * SPIN_RAD[self.crown.form as usize];
        (normal, Quat::from_axis_angle(normal, spin_rad) * uphill)
    }

    /// Moves a polygon inwards until it is just inside the outline, and makes it smaller where it is too large for
    /// that. Twigs stay on their branch.
    fn move_inside(&self, anchor: Vec3, core: Vec3, axis: Vec3, normal: Vec3, size_m: f32) -> (Vec3, f32) {
        let steps = if self.crown.form == CrownForm::Winter { 0 } else { INWARD_STEPS };
        let mut size_m = size_m;
        for _ in 0..SHRINKINGS {
            let inside = |share: f32| {
                let corners = corners(anchor.lerp(core, share), axis, normal, size_m, self.crown.width);
                corners.into_iter().all(|corner| self.profile.holds(corner))
            };
            let step = 0.9 / INWARD_STEPS as f32;
            // Not quite to the core, where there is no way out.
            if let Some(first) = (0..=steps).map(|count| step * count as f32).find(|&share| inside(share)) {
                return (anchor.lerp(core, first_inside(first, step, inside)), size_m);
            }
            size_m *= SHRINKING;
        }
        (anchor, size_m)
    }
}

/// Halves the step before `share`, which is the first of its step to be inside, until the way in is found.
fn first_inside(share: f32, step: f32, inside: impl Fn(f32) -> bool) -> f32 {
    let (mut outside, mut within) = ((share - step).max(0.0), share);
    if inside(outside) {
        return outside;
    }
    for _ in 0..5 {
        let middle = 0.5 * (outside + within);
        if inside(middle) { within = middle } else { outside = middle }
    }
    within
}

/// The corners of a polygon, its anchor first, counter-clockwise seen against its normal.
fn corners(anchor: Vec3, axis: Vec3, normal: Vec3, size_m: f32, width: f32) -> [Vec3; 3] {
    let side = axis.cross(normal) * (0.5 * width * size_m);
    let far = anchor + axis * size_m;
    [anchor, far + side, far - side]
}

pub(super) fn leaves(crown: &ImpressionistCrown, skeleton: &Skeleton, count: usize, gain: f32) -> LeafVertices {
    let mut out = LeafVertices::default();
    for cluster in skeleton.clusters.iter().take(count) {
        let first = out.positions.len() as u32;
        let corners = corners(cluster.anchor, cluster.axis, cluster.normal, gain * cluster.size_m, crown.width);
        let outward = skeleton.envelope.outward(cluster.anchor);
        let normal = if crown.form == CrownForm::Winter { outward } else { cluster.normal };
        for (corner, uv) in corners.into_iter().zip([[0.5, 1.0], [1.0, 0.0], [0.0, 0.0]]) {
            out.positions.push(corner.to_array());
            out.normals.push(normal.to_array());
            out.uvs.push(uv);
            out.sway.push([cluster.beam as f32, cluster.at, cluster.phase, crown.light(cluster.depth)]);
            out.axis.push(cluster.axis.extend(cluster.tint).to_array());
            out.anchor.push(cluster.anchor.extend(0.0).to_array());
        }
        out.indices.extend([first, first + 1, first + 2]);
    }
    out
}
