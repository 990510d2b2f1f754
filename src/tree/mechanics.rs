//! How stiff, heavy and exposed each beam of a tree is: from a skeleton to the rows that are posed.
//!
//! A branch is a chain of tapered beams that continue one another, clamped where it grows from its parent. What it bears
//! rides on it: every other beam and leaf cluster is a lump of mass and drag on a rigid arm, which holds on somewhere along
//! the chain and ends at `x` along it (and `r` beside it). With the bending moment `M(x)` of forces on the lumps that hold on
//! beyond `x`, and `E I(x)` of the round section
//! (I = pi R^4/4, eq. 20 corrected),
//!
//! ```text
//! slope(x) = int_0^x M / E I,    y(x) = int_0^x slope
//! gain of a beam  = (slope at its tip - slope at its root) under the drag for |u|u = 1 m^2/s^2, over phi_1'(1)
//! w^2 of a branch = sum m y / sum m (y^2 + (r slope)^2),   y and slope under the forces m in place of the drag
//! ```
//!
//! The second is Rayleigh's method with the shape of the static deflection, which takes taper and load as they are: the
//! generalised mass and stiffness (eqs. 20, 23) of the uniform beam's mode would make a tapering trunk a third too fast.
//! All beams of a branch sway with its frequency. Without what it bears a trunk would sway much faster (80% of the
//! crown must go before it shows: Moore & Maguire 2004).
//!
//! Three things make a standing tree slower than a clamped pole of clear wood, and are taken in:
//! - bark is thick but bears little: `I` is that of the wood inside it;
//! - the ground gives: a stem stands on a rotational spring `k` (Neild & Wood 1999), whose turn `M(0) / k` comes before
//!   the slope above. The root plate is a rigid disc of radius `a` that rocks on an elastic half-space,
//!   `k = 8 G a^3 / (3 (1 - nu))` (Borowicka 1943);
//! - weight pulls over what leans: `sum m g int slope^2 dx` over the way to each lump is taken from the numerator
//!   (`sum m y` is twice the elastic energy for forces `m`), with the sine of the beam's elevation: a hanging branch is
//!   stiffened.

use super::{
    skeleton::{LeafCluster, Skeleton, SkeletonBeam},
    species::Species,
};
use crate::dynamics::{
    pose::{BeamDynamics, NO_PARENT, SLOPE_TIP},
    response::FrequencyClasses,
};
use bevy::math::Vec3;
use std::f64::consts::{PI, TAU};

/// Density of air, kg/m^3: 15 degrees C at sea level, ISO 2533.
const AIR_DENSITY_KG_M3: f64 = 1.225;
/// Drag coefficient of a round branch across the flow below the drag crisis (Simiu & Scanlan 1978).
const BRANCH_DRAG_COEFFICIENT: f64 = 1.2;
/// Thickness of bark that bears nothing, as a share of the radius. Single bark thickness of conifers and of oaks is some 3
/// to 10% of the radius; this is the middle.
const BARK_SHARE: f64 = 0.06;
/// Radius of the root plate that turns with the stem, in stem radii: for stems of 0.4 m a plate of 2.4 m across, within
/// the 2 to 3 m of uprooted conifers of that size.
const ROOT_PLATE_RADII: f64 = 6.0;
/// Shear modulus of a forest's top soil under sway, Pa: soft moist loam.
const SOIL_SHEAR_PA: f64 = 1.0e6;
/// Poisson's ratio of the soil.
const SOIL_POISSON: f64 = 0.4;
/// Gravity, m/s^2 (standard).
const GRAVITY_M_S2: f64 = 9.806_65;
/// Least share of its stiffness that weight leaves a tree: one that stands has some.
const LEAST_STIFFNESS_SHARE: f64 = 0.1;
/// Height at which foresters measure a trunk's diameter, m.
const BREAST_HEIGHT_M: f32 = 1.3;
/// Roughness length with which heights are weighted, m: open woodland (Simiu & Scanlan 1978 give 0.01 to 1). The model is
/// baked once for all winds; over the heights of a crown other roughness changes the weights by a few per cent.
const ROUGHNESS_M: f64 = 0.3;
/// Height at which the wind of the response table is taken, m.
const REFERENCE_HEIGHT_M: f64 = 10.0;
/// Stations on a beam at which the moment is taken: the midpoint rule is exact to 0.1% there.
const STATIONS: usize = 12;

/// A piece of the tree, taken together at one point of a branch.
#[derive(Clone, Copy)]
struct Lump {
    /// Where it holds on: distance from the branch's root along the branch, m.
    attach_m: f64,
    /// Rigid arm from there to the lump, along the branch and beside it, m.
    arm_m: f64,
    beside_m: f64,
    mass_kg: f64,
    /// Drag for one m^2/s^2 of wind pressure |u|u at the reference height, kg/m.
    drag_kg_m: f64,
}

/// A chain of beams, root first, with all that rides on it.
struct Branch {
    beams: Vec<u32>,
    lumps: Vec<Lump>,
}

/// The beams of `skeleton` as rows for posing, in the same order.
pub fn beam_dynamics(species: &Species, skeleton: &Skeleton) -> Vec<BeamDynamics> {
    let classes = FrequencyClasses::default();
    let mut rows: Vec<BeamDynamics> = skeleton.beams.iter().map(at_rest).collect();
    for branch in branches(species, skeleton) {
        let beams = branch.beams.clone();
        let answer = branch.answer(species, skeleton);
        for (beam, gain) in beams.into_iter().zip(answer.gains) {
            // Boughs that reach back past their root would bend a beam against the wind: it stands still instead.
            rows[beam as usize].gain = gain.max(0.0) as f32;
            rows[beam as usize].class = classes.coordinate(answer.frequency_hz as f32);
        }
    }
    rows
}

/// Natural frequency of a row's branch with all that it bears, Hz.
pub fn natural_frequency_hz(row: &BeamDynamics) -> f32 {
    let classes = FrequencyClasses::default();
    classes.lowest_hz * classes.ratio.powf(row.class)
}

/// What foresters measure of a standing tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeSway {
    /// First natural frequency of the trunk with all that it bears, Hz.
    pub frequency_hz: f32,
    /// Diameter over bark at breast height (1.3 m along the stem; at the tip of a lower one), m.
    pub dbh_m: f32,
    /// Height of the highest wood, m.
    pub height_m: f32,
}

/// First sway frequency and size of a tree; of a shrub those of its first stem.
#[must_use]
pub fn tree_sway(species: &Species, skeleton: &Skeleton) -> TreeSway {
    let trunk = branches(species, skeleton).into_iter().next();
    let (frequency_hz, dbh_m) = trunk.map_or((0.0, 0.0), |trunk| {
        let dbh_m = 2.0 * trunk.radius_m(skeleton, BREAST_HEIGHT_M);
        (trunk.answer(species, skeleton).frequency_hz as f32, dbh_m)
    });
    TreeSway { frequency_hz, dbh_m, height_m: skeleton.height_m() }
}

/// Rocking stiffness of the roots of a stem, N m/rad.
fn root_stiffness_nm_rad(base_radius_m: f32) -> f64 {
    let plate_m = ROOT_PLATE_RADII * f64::from(base_radius_m);
    8.0 * SOIL_SHEAR_PA * plate_m.powi(3) / (3.0 * (1.0 - SOIL_POISSON))
}

fn at_rest(beam: &SkeletonBeam) -> BeamDynamics {
    BeamDynamics {
        base: beam.base,
        length_m: beam.length_m,
        direction: beam.direction,
        attach: beam.attach,
        parent: beam.parent.unwrap_or(NO_PARENT),
        gain: 0.0,
        class: 0.0,
    }
}

/// Cuts the skeleton into branches and lets every beam and cluster ride on all branches that bear it.
fn branches(species: &Species, skeleton: &Skeleton) -> Vec<Branch> {
    let mut branches: Vec<Branch> = Vec::new();
    // For each beam its branch, and the length of the branch before it.
    let mut places: Vec<(usize, f64)> = Vec::with_capacity(skeleton.beams.len());
    let continuations = skeleton.continuations();
    for (index, beam) in (0u32..).zip(&skeleton.beams) {
        let continued = beam.parent.filter(|&parent| continuations[parent as usize] == Some(index));
        let place = match continued {
            Some(parent) => {
                let (branch, before_m) = places[parent as usize];
                (branch, before_m + f64::from(skeleton.beams[parent as usize].length_m))
            }
            None => {
                branches.push(Branch { beams: Vec::new(), lumps: Vec::new() });
                (branches.len() - 1, 0.0)
            }
        };
        branches[place.0].beams.push(index);
        places.push(place);
    }
    let ride = |branches: &mut [Branch], mut bearer: u32, mut attach: f32, at: Vec3, mass_kg, drag_kg_m| loop {
        let beam = &skeleton.beams[bearer as usize];
        let arm = at - (beam.base + beam.direction * beam.length_m * attach);
        let (branch, before_m) = places[bearer as usize];
        let attach_m = before_m + f64::from(beam.length_m * attach);
        let arm_m = f64::from(arm.dot(beam.direction));
        let beside_m = f64::from(arm.reject_from_normalized(beam.direction).length());
        branches[branch].lumps.push(Lump { attach_m, arm_m, beside_m, mass_kg, drag_kg_m });
        let root = &skeleton.beams[branches[branch].beams[0] as usize];
        let Some(parent) = root.parent else { return };
        (bearer, attach) = (parent, root.attach);
    };
    for (index, beam) in (0u32..).zip(&skeleton.beams) {
        for (s, share) in BEAM_LUMPS {
            let (at, mass_kg, drag_kg_m) = beam_lump(species, beam, s, share);
            ride(&mut branches, index, s, at, mass_kg, drag_kg_m);
        }
    }
    for cluster in &skeleton.clusters {
        let (at, mass_kg, drag_kg_m) = cluster_lump(species, cluster);
        ride(&mut branches, cluster.beam, cluster.at, at, mass_kg, drag_kg_m);
    }
    branches
}

/// A beam's own wood as lumps: place on the beam, and share of its length.
const BEAM_LUMPS: [(f32, f64); 6] = {
    let share = 1.0 / 6.0;
    [
        (1.0 / 12.0, share),
        (3.0 / 12.0, share),
        (5.0 / 12.0, share),
        (7.0 / 12.0, share),
        (9.0 / 12.0, share),
        (11.0 / 12.0, share),
    ]
};

fn beam_lump(species: &Species, beam: &SkeletonBeam, s: f32, share: f64) -> (Vec3, f64, f64) {
    let radius_m = f64::from(beam.radius_m(s));
    let length_m = share * f64::from(beam.length_m);
    let at = beam.base + beam.direction * beam.length_m * s;
    let mass_kg = PI * radius_m * radius_m * length_m * f64::from(species.wood.density_kg_m3);
    let area_m2 = 2.0 * radius_m * length_m;
    (at, mass_kg, 0.5 * AIR_DENSITY_KG_M3 * BRANCH_DRAG_COEFFICIENT * area_m2 * pressure_ratio(at.y))
}

fn cluster_lump(species: &Species, cluster: &LeafCluster) -> (Vec3, f64, f64) {
    let area_m2 = f64::from(cluster.size_m * cluster.size_m);
    let at = cluster.anchor + cluster.axis * cluster.size_m * 0.5;
    let coefficient = f64::from(species.foliage.drag_coefficient);
    let drag_kg_m = 0.5 * AIR_DENSITY_KG_M3 * coefficient * area_m2 * pressure_ratio(at.y);
    (at, area_m2 * f64::from(species.foliage.mass_per_area_kg_m2), drag_kg_m)
}

/// Wind pressure at a height over that at the reference height: the log law (eq. 10), squared.
fn pressure_ratio(height_m: f32) -> f64 {
    let log = |z: f64| (z / ROUGHNESS_M).max(1.0).ln();
    (log(f64::from(height_m)) / log(REFERENCE_HEIGHT_M)).powi(2)
}

/// What a branch does under load.
struct Answer {
    /// One a beam, s^2/m^2.
    gains: Vec<f64>,
    frequency_hz: f64,
}

/// A station of a branch: the middle of a short piece of it.
struct Station {
    middle_m: f64,
    length_m: f64,
    /// 1 / E I, 1/(N m^2).
    compliance: f64,
    /// Sine of the elevation: 1 upright, -1 hanging.
    upright: f64,
}

impl Branch {
    fn answer(mut self, species: &Species, skeleton: &Skeleton) -> Answer {
        self.lumps.sort_by(|a, b| a.attach_m.total_cmp(&b.attach_m));
        let stations = self.stations(species, skeleton);
        let root_compliance = self.root_compliance(skeleton);
        self.respond(&stations, root_compliance)
    }

    /// The answer of a branch, its lumps in order, on a root that turns by `root_compliance` for 1 N m.
    fn respond(&self, stations: &[Station], root_compliance: f64) -> Answer {
        let root_turn = |force: fn(&Lump) -> f64| {
            let moment: f64 = self.lumps.iter().map(|lump| force(lump) * (lump.attach_m + lump.arm_m)).sum();
            moment * root_compliance
        };
        let drag_turns = turns(stations, &self.lumps, |lump| lump.drag_kg_m);
        let mut gains: Vec<f64> =
            drag_turns.chunks(STATIONS).map(|beam| beam.iter().sum::<f64>() / f64::from(SLOPE_TIP)).collect();
        // The roots' turn is taken into the bend of the lowest beam.
        if let Some(lowest) = gains.first_mut() {
            *lowest += root_turn(|lump| lump.drag_kg_m) / f64::from(SLOPE_TIP);
        }
        let mass_turns = turns(stations, &self.lumps, |lump| lump.mass_kg);
        let (mut work, mut inertia, mut weight) = (0.0, 0.0, 0.0);
        // Slope, and first moment of the turns, of all stations before the lump.
        let (mut slope, mut first_moment) = (root_turn(|lump| lump.mass_kg), 0.0);
        // How far the branch's axis has sunk by leaning, twice: int slope^2 dx, and up to where.
        let (mut sunk_m, mut reached_m, mut upright) = (0.0, 0.0, stations.first().map_or(0.0, |first| first.upright));
        let mut ahead = stations.iter().zip(mass_turns).peekable();
        for lump in &self.lumps {
            while let Some((station, turn)) = ahead.next_if(|(station, _)| station.middle_m < lump.attach_m) {
                sunk_m += slope * slope * upright * (station.middle_m - reached_m);
                (reached_m, upright) = (station.middle_m, station.upright);
                slope += turn;
                first_moment += turn * station.middle_m;
            }
            let deflection = slope * (lump.attach_m + lump.arm_m) - first_moment;
            work += lump.mass_kg * deflection;
            inertia += lump.mass_kg * (deflection * deflection + (lump.beside_m * slope).powi(2));
            let sinks_m = sunk_m + slope * slope * upright * (lump.attach_m + lump.arm_m - reached_m);
            weight += lump.mass_kg * GRAVITY_M_S2 * sinks_m;
        }
        let stiffness = (work - weight).max(LEAST_STIFFNESS_SHARE * work).max(0.0);
        Answer { gains, frequency_hz: (stiffness / inertia).sqrt() / TAU }
    }

    /// Turn of the branch's root for 1 N m: branches are clamped, stems stand on their roots.
    fn root_compliance(&self, skeleton: &Skeleton) -> f64 {
        let root = &skeleton.beams[self.beams[0] as usize];
        if root.parent.is_some() { 0.0 } else { 1.0 / root_stiffness_nm_rad(root.base_radius_m) }
    }

    /// Radius at a distance from the root, m; beyond its end that of the tip.
    fn radius_m(&self, skeleton: &Skeleton, along_m: f32) -> f32 {
        let mut left_m = along_m;
        let mut radius_m = 0.0;
        for &index in &self.beams {
            let beam = &skeleton.beams[index as usize];
            radius_m = beam.radius_m((left_m / beam.length_m).min(1.0));
            if left_m <= beam.length_m {
                break;
            }
            left_m -= beam.length_m;
        }
        radius_m
    }

    fn stations(&self, species: &Species, skeleton: &Skeleton) -> Vec<Station> {
        let mut stations = Vec::with_capacity(self.beams.len() * STATIONS);
        let mut before_m = 0.0;
        for &index in &self.beams {
            let beam = &skeleton.beams[index as usize];
            let length_m = f64::from(beam.length_m) / STATIONS as f64;
            for station in 0..STATIONS {
                let s = (station as f32 + 0.5) / STATIONS as f32;
                let wood_radius_m = (1.0 - BARK_SHARE) * f64::from(beam.radius_m(s));
                let second_moment_m4 = PI / 4.0 * wood_radius_m.powi(4);
                stations.push(Station {
                    middle_m: before_m + (station as f64 + 0.5) * length_m,
                    length_m,
                    compliance: 1.0 / (f64::from(species.wood.young_modulus_pa) * second_moment_m4),
                    upright: f64::from(beam.direction.y),
                });
            }
            before_m += f64::from(beam.length_m);
        }
        stations
    }
}

/// By how much each station's piece turns under a transverse force on every lump, rad. Lumps come in the order in which
/// they hold on.
fn turns(stations: &[Station], lumps: &[Lump], force: impl Fn(&Lump) -> f64) -> Vec<f64> {
    // Of all lumps that hold on beyond the station: force, and its first moment about the branch's root.
    let (mut total, mut first_moment) = (0.0, 0.0);
    let mut before = lumps.iter().rev().peekable();
    let mut turns: Vec<f64> = stations
        .iter()
        .rev()
        .map(|station| {
            while let Some(lump) = before.next_if(|lump| lump.attach_m > station.middle_m) {
                total += force(lump);
                first_moment += force(lump) * (lump.attach_m + lump.arm_m);
            }
            let moment = first_moment - total * station.middle_m;
            moment * station.compliance * station.length_m
        })
        .collect();
    turns.reverse();
    turns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::skeleton::grow;

    fn shipped(name: &str) -> Species {
        let path = format!("{}/assets/species/{name}.species.ron", env!("CARGO_MANIFEST_DIR"));
        Species::from_ron(&std::fs::read_to_string(path).expect("the file is shipped")).expect("it is valid")
    }

    fn trunk(name: &str) -> (Species, Skeleton, BeamDynamics) {
        let species = shipped(name);
        let skeleton = grow(&species, species.age.mature_years, 1);
        let trunk = beam_dynamics(&species, &skeleton)[0];
        (species, skeleton, trunk)
    }

    /// Moore & Maguire (2004): the sway of conifers is linear in DBH/H^2. The coefficients are
    /// unconfirmed, so a third of the line is allowed.
    #[test]
    fn a_fir_sways_as_slowly_as_real_conifers_at_all_ages() {
        let species = shipped("fir");
        for age_years in [15.0, 30.0, 50.0, 80.0, 120.0] {
            let sway = tree_sway(&species, &grow(&species, age_years, 1));
            let line_hz = 0.095 + 343.0 * sway.dbh_m / sway.height_m.powi(2);
            assert!((sway.frequency_hz / line_hz - 1.0).abs() < 0.333, "{age_years}: {sway:?} against {line_hz} Hz");
        }
    }

    #[test]
    fn frequencies_fall_while_a_fir_grows_up() {
        let species = shipped("fir");
        let ages = [10.0, 20.0, 40.0, 80.0];
        let hz = ages.map(|age_years| tree_sway(&species, &grow(&species, age_years, 1)).frequency_hz);
        assert!(hz.windows(2).all(|pair| pair[0] > pair[1]), "{hz:?}");
    }

    /// A rigid pole of mass m and length L on a spring: w^2 = (k - m g L/2) / (m L^2/3); hanging, the weight stiffens it.
    #[test]
    fn a_rigid_pole_on_its_roots_is_an_inverted_pendulum() {
        let (mass_kg, length_m, stiffness) = (50.0, 4.0, 3000.0_f64);
        let count = 200;
        let lumps = (0..count).map(|index| Lump {
            attach_m: (f64::from(index) + 0.5) / f64::from(count) * length_m,
            arm_m: 0.0,
            beside_m: 0.0,
            mass_kg: mass_kg / f64::from(count),
            drag_kg_m: 0.01,
        });
        let pole = Branch { beams: vec![0], lumps: lumps.collect() };
        for upright in [1.0, -1.0] {
            let station = |index: usize| Station {
                middle_m: (index as f64 + 0.5) / STATIONS as f64 * length_m,
                length_m: length_m / STATIONS as f64,
                compliance: 1e-15,
                upright,
            };
            let stations: Vec<Station> = (0..STATIONS).map(station).collect();
            let answer = pole.respond(&stations, 1.0 / stiffness);
            let spring = stiffness - upright * mass_kg * GRAVITY_M_S2 * length_m / 2.0;
            let expected_hz = (spring / (mass_kg * length_m * length_m / 3.0)).sqrt() / TAU;
            assert!((answer.frequency_hz / expected_hz - 1.0).abs() < 1e-3, "{} {expected_hz}", answer.frequency_hz);
            // All drag, at half the length on average, turns the spring.
            let turn = 0.01 * f64::from(count) * length_m / 2.0 / stiffness;
            assert!((answer.gains[0] * f64::from(SLOPE_TIP) / turn - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn what_a_beam_bears_makes_it_slower() {
        for name in ["oak", "fir"] {
            let (species, skeleton, trunk) = trunk(name);
            let bare = Skeleton { beams: vec![skeleton.beams[0]], clusters: Vec::new(), ..skeleton };
            let alone = beam_dynamics(&species, &bare)[0];
            assert!(natural_frequency_hz(&trunk) < 0.7 * natural_frequency_hz(&alone));
            assert!(trunk.gain > alone.gain);
        }
    }

    #[test]
    fn a_uniform_beam_has_the_closed_form_frequency() {
        let mut species = shipped("fir");
        species.wood.young_modulus_pa = 8.0e9;
        species.wood.density_kg_m3 = 700.0;
        let (_, skeleton, _) = trunk("fir");
        // A level branch: clamped, and no weight along it.
        let branch = SkeletonBeam {
            parent: Some(0),
            attach: 0.5,
            base: skeleton.beams[0].path(0.5),
            direction: Vec3::X,
            length_m: 1.5,
            base_radius_m: 0.015,
            tip_radius_m: 0.015,
            bow: Vec3::ZERO,
            order: 1,
        };
        let bare = Skeleton { beams: vec![skeleton.beams[0], branch], clusters: Vec::new(), ..skeleton };
        let row = beam_dynamics(&species, &bare)[1];
        // eta^2 sqrt(E I / rho A) / L^2 with I/A = R^2/4 (eq. 20 corrected), and I of the wood inside the bark.
        let inside_bark = (1.0 - BARK_SHARE as f32).powi(2);
        let expected = inside_bark * 1.875_104_1_f32.powi(2) * (8.0e9_f32 / 700.0).sqrt() * 0.0075
            / (1.5 * 1.5)
            / std::f32::consts::TAU;
        // The static shape is not quite the mode's, which makes Rayleigh's method some 0.8% high, and the wood is in lumps.
        assert!((natural_frequency_hz(&row) / expected - 1.0).abs() < 0.015, "{}", natural_frequency_hz(&row));
    }
}
