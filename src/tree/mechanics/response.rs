//! How a branch bends under drag, and how fast it sways: beam theory and Rayleigh's method.

use super::branches::{LoadedBranch, Lump};
use crate::{
    dynamics::pose::SLOPE_TIP,
    tree::{skeleton::Skeleton, species::Species},
};
use std::f64::consts::PI;

/// Thickness of bark that bears nothing, as a share of the radius. Single bark thickness of conifers and of oaks is some 3
/// to 10% of the radius; this is the middle.
pub(super) const BARK_SHARE: f64 = 0.06;
/// Radius of the root plate that turns with the stem, in stem radii: for stems of 0.4 m a plate of 2.4 m across, within
/// the 2 to 3 m of uprooted conifers of that size.
const ROOT_PLATE_RADII: f64 = 6.0;
/// Shear modulus of a forest's top soil under sway, Pa: soft moist loam.
const SOIL_SHEAR_PA: f64 = 1.0e6;
/// Poisson's ratio of the soil.
const SOIL_POISSON: f64 = 0.4;
/// Gravity, m/s^2 (standard).
pub(super) const GRAVITY_M_S2: f64 = 9.806_65;
/// Least share of its stiffness that weight leaves a branch. A tree that does not fall over has some, and trees keep about twice
/// what they need against their own weight (Science 179, 1201, 1973: trees have a quarter of the height at which they would buckle).
const LEAST_STIFFNESS_SHARE: f64 = 0.5;
/// Lower loads count as at this height, m: the mean wind is not known there.
const LEAST_HEIGHT_M: f64 = 0.1;
/// Bounds of what the deflection of a branch is corrected by: 0.4 for a single cone, whose tip turns far more than it moves.
const LEAST_TIP_SHARE: f64 = 0.2;
const MOST_TIP_SHARE: f64 = 2.0;
/// Stations on a beam at which the moment is taken: the midpoint rule is exact to 0.1% there.
pub(super) const STATIONS: usize = 12;

/// What a branch does under load.
pub(super) struct BranchResponse {
    /// One a beam.
    pub loads: Vec<BeamLoad>,
    pub sway: BranchSway,
}

/// A branch's deflection under the forces `m` on all that it carries, which are taken as rigid beyond it.
pub(super) struct BranchSway {
    /// Of each lump, in the order of the branch's lumps, m.
    pub deflections_m: Vec<f64>,
    /// Squares of what turning adds to a lump's motion, sum of `m (r slope)^2`.
    pub turning: f64,
    /// Deflection under a static load, by what it would be without weight.
    pub softening: f64,
}

/// How a beam bends under the drag of all that it carries, and where that is.
#[derive(Clone, Copy, Debug)]
pub(super) struct BeamLoad {
    /// s^2/m^2.
    pub gain: f64,
    /// Height at which the wind presses as on the whole of it: the mean of its logarithm, m.
    pub height_m: f64,
    /// Standard deviations of its places, in the mean of the two horizontal directions and in height, m.
    pub horizontal_m: f64,
    pub vertical_m: f64,
}

/// A station of a branch: the middle of a short piece of it.
pub(super) struct Station {
    pub middle_m: f64,
    pub length_m: f64,
    /// 1 / E I, 1/(N m^2).
    pub compliance: f64,
    /// Sine of the elevation: 1 upright, -1 hanging.
    pub upright: f64,
}

impl LoadedBranch {
    pub fn response(&self, species: &Species, skeleton: &Skeleton) -> BranchResponse {
        let stations = self.stations(species, skeleton);
        let root_compliance = self.root_compliance(skeleton);
        self.response_on_root(&stations, root_compliance)
    }

    /// The same branch without its leaves.
    pub fn without_leaves(&self) -> Self {
        let lumps = self.lumps.iter().filter(|lump| !lump.is_leaf).copied().collect();
        Self { beams: self.beams.clone(), lumps, direction: self.direction }
    }

    /// The response of a branch, its lumps in order, on a root that turns by `root_compliance` for 1 N m.
    pub fn response_on_root(&self, stations: &[Station], root_compliance: f64) -> BranchResponse {
        let sway = self.sway(stations, root_compliance);
        let mut loads = self.loads(stations, root_compliance);
        // Weight pulls further over what the wind has bent, by as much as it makes the branch sway slower.
        for load in &mut loads {
            load.gain *= sway.softening;
        }
        BranchResponse { loads, sway }
    }

    /// The branch's deflection under the forces `m`.
    fn sway(&self, stations: &[Station], root_compliance: f64) -> BranchSway {
        let mass_turns = turns(stations, &self.lumps, |lump| [lump.mass_kg]);
        let moment: f64 = self.lumps.iter().map(|lump| lump.mass_kg * (lump.attach_m + lump.arm_m)).sum();
        let (mut work, mut weight, mut turning) = (0.0, 0.0, 0.0);
        let mut deflections_m = Vec::with_capacity(self.lumps.len());
        // Slope, and first moment of the turns, of all stations before the lump.
        let (mut slope, mut first_moment) = (moment * root_compliance, 0.0);
        // How far the branch's axis has sunk by leaning, twice: int slope^2 dx, and up to where.
        let (mut sunk_m, mut reached_m, mut upright) = (0.0, 0.0, stations.first().map_or(0.0, |first| first.upright));
        let mut ahead = stations.iter().zip(mass_turns).peekable();
        for lump in &self.lumps {
            while let Some((station, [turn])) = ahead.next_if(|(station, _)| station.middle_m < lump.attach_m) {
                sunk_m += slope * slope * upright * (station.middle_m - reached_m);
                (reached_m, upright) = (station.middle_m, station.upright);
                slope += turn;
                first_moment += turn * station.middle_m;
            }
            let deflection = slope * (lump.attach_m + lump.arm_m) - first_moment;
            work += lump.mass_kg * deflection;
            turning += lump.mass_kg * (lump.beside_m * slope).powi(2);
            deflections_m.push(deflection);
            let sinks_m = sunk_m + slope * slope * upright * (lump.attach_m + lump.arm_m - reached_m);
            weight += lump.mass_kg * GRAVITY_M_S2 * sinks_m;
        }
        let stiffness = (work - weight).max(LEAST_STIFFNESS_SHARE * work).max(0.0);
        let softening = if stiffness > 0.0 { work / stiffness } else { 1.0 };
        BranchSway { deflections_m, turning, softening }
    }

    /// The bend of each beam under the drag.
    fn loads(&self, stations: &[Station], root_compliance: f64) -> Vec<BeamLoad> {
        let station_turns = turns(stations, &self.lumps, load_moments);
        let mut beams: Vec<[f64; MOMENTS]> = station_turns
            .chunks(STATIONS)
            .map(|beam| beam.iter().fold([0.0; MOMENTS], |sum, turn| add(sum, *turn)))
            .collect();
        // The roots' turn is taken into the bend of the lowest beam.
        let root_turn = self.lumps.iter().fold([0.0; MOMENTS], |sum, lump| {
            let arm = root_compliance * (lump.attach_m + lump.arm_m);
            add(sum, load_moments(lump).map(|moment| moment * arm))
        });
        if let Some(lowest) = beams.first_mut() {
            *lowest = add(*lowest, root_turn);
        }
        let tip_share = tip_share(stations, &station_turns, &beams, root_turn[0]);
        beams.iter().map(|moments| BeamLoad::of(moments, tip_share)).collect()
    }

    /// Turn of the branch's root for 1 N m: branches are clamped, stems stand on their roots.
    fn root_compliance(&self, skeleton: &Skeleton) -> f64 {
        let root = &skeleton.beams[self.beams[0] as usize];
        if root.parent.is_some() { 0.0 } else { 1.0 / root_stiffness_nm_rad(root.base_radius_m) }
    }

    /// Radius at a distance from the root, m; beyond its end that of the tip.
    pub fn radius_m(&self, skeleton: &Skeleton, along_m: f32) -> f32 {
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

/// Number of sums that tell how large a beam's load is, and where.
const MOMENTS: usize = 7;

/// A lump's drag, and the moments of its place with the drag as weight: logarithm of the height, the three coordinates, the
/// square of the horizontal ones, the square of the height.
fn load_moments(lump: &Lump) -> [f64; MOMENTS] {
    let [x, y, z] = lump.at.to_array().map(f64::from);
    [1.0, y.max(LEAST_HEIGHT_M).ln(), x, y, z, x * x + z * z, y * y].map(|moment| lump.drag_kg_m * moment)
}

fn add(mut sum: [f64; MOMENTS], moments: [f64; MOMENTS]) -> [f64; MOMENTS] {
    sum.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += moment);
    sum
}

impl BeamLoad {
    /// From the turn that each moment makes, rad.
    fn of(moments: &[f64; MOMENTS], tip_share: f64) -> Self {
        // Boughs that reach back past their root would bend a beam against the wind: it is kept still instead.
        if moments[0] <= 0.0 {
            return Self { gain: 0.0, height_m: 0.0, horizontal_m: 0.0, vertical_m: 0.0 };
        }
        let [log, x, y, z, horizontal, vertical] = [1, 2, 3, 4, 5, 6].map(|moment: usize| moments[moment] / moments[0]);
        // Of loads on both sides of the root some count as negative: what is left of a spread is at least none.
        let deviation = |variance: f64| variance.max(0.0).sqrt();
        Self {
            gain: moments[0] * tip_share / f64::from(SLOPE_TIP),
            height_m: log.exp(),
            horizontal_m: deviation(0.5 * (horizontal - x * x - z * z)),
            vertical_m: deviation(vertical - y * y),
        }
    }
}

/// The tip's deflection of a branch over that of its beams as they are posed, each along the first mode of a beam with a
/// free tip, with these turns. That mode has the right turn at its end, and not quite the right deflection: 3% less under a
/// uniform load, some 10% more where a chain's moment goes on beyond the beam, and twice as much for a cone.
fn tip_share(stations: &[Station], station_turns: &[[f64; MOMENTS]], beams: &[[f64; MOMENTS]], root_turn: f64) -> f64 {
    let lengths_m: Vec<f64> = stations.chunks(STATIONS).map(|beam| beam.iter().map(|s| s.length_m).sum()).collect();
    let length_m: f64 = lengths_m.iter().sum();
    let bent: f64 = stations.iter().zip(station_turns).map(|(s, turn)| turn[0] * (length_m - s.middle_m)).sum();
    let mut beyond_m = length_m;
    let posed: f64 = beams
        .iter()
        .zip(&lengths_m)
        .map(|(turn, beam_m)| {
            beyond_m -= beam_m;
            turn[0].max(0.0) * (beam_m / f64::from(SLOPE_TIP) + beyond_m)
        })
        .sum();
    let share = (bent + root_turn * length_m) / posed;
    if share.is_finite() { share.clamp(LEAST_TIP_SHARE, MOST_TIP_SHARE) } else { 1.0 }
}

/// By how much each station's piece turns under transverse forces on every lump, rad, for several sets of forces at once.
/// Lumps come in the order in which they hold on.
fn turns<const N: usize>(stations: &[Station], lumps: &[Lump], force: impl Fn(&Lump) -> [f64; N]) -> Vec<[f64; N]> {
    // Of all lumps that hold on beyond the station: force, and its first moment about the branch's root.
    let (mut total, mut first_moment) = ([0.0; N], [0.0; N]);
    let mut before = lumps.iter().rev().peekable();
    let mut turns: Vec<[f64; N]> = stations
        .iter()
        .rev()
        .map(|station| {
            while let Some(lump) = before.next_if(|lump| lump.attach_m > station.middle_m) {
                let arm_m = lump.attach_m + lump.arm_m;
                for (n, force) in force(lump).into_iter().enumerate() {
                    total[n] += force;
                    first_moment[n] += force * arm_m;
                }
            }
            let turn = station.compliance * station.length_m;
            std::array::from_fn(|n| (first_moment[n] - total[n] * station.middle_m) * turn)
        })
        .collect();
    turns.reverse();
    turns
}

/// Rocking stiffness of the roots of a stem, N m/rad.
fn root_stiffness_nm_rad(base_radius_m: f32) -> f64 {
    let plate_m = ROOT_PLATE_RADII * f64::from(base_radius_m);
    8.0 * SOIL_SHEAR_PA * plate_m.powi(3) / (3.0 * (1.0 - SOIL_POISSON))
}
