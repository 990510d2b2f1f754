//! How a branch bends under drag, and how fast it sways: beam theory and Rayleigh's method.

use super::branches::{LoadedBranch, Lump};
use crate::{
    dynamics::pose::SLOPE_TIP,
    tree::{skeleton::Skeleton, species::Species},
};
use std::f64::consts::{PI, TAU};

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
/// Least share of its stiffness that weight leaves a tree: a tree that does not fall over has some.
const LEAST_STIFFNESS_SHARE: f64 = 0.1;
/// Stations on a beam at which the moment is taken: the midpoint rule is exact to 0.1% there.
pub(super) const STATIONS: usize = 12;

/// What a branch does under load.
pub(super) struct BranchResponse {
    /// One a beam, s^2/m^2.
    pub gains: Vec<f64>,
    pub frequency_hz: f64,
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
    pub fn response(mut self, species: &Species, skeleton: &Skeleton) -> BranchResponse {
        self.lumps.sort_by(|a, b| a.attach_m.total_cmp(&b.attach_m));
        let stations = self.stations(species, skeleton);
        let root_compliance = self.root_compliance(skeleton);
        self.response_on_root(&stations, root_compliance)
    }

    /// The response of a branch, its lumps in order, on a root that turns by `root_compliance` for 1 N m.
    pub fn response_on_root(&self, stations: &[Station], root_compliance: f64) -> BranchResponse {
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
        BranchResponse { gains, frequency_hz: (stiffness / inertia).sqrt() / TAU }
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

/// Rocking stiffness of the roots of a stem, N m/rad.
fn root_stiffness_nm_rad(base_radius_m: f32) -> f64 {
    let plate_m = ROOT_PLATE_RADII * f64::from(base_radius_m);
    8.0 * SOIL_SHEAR_PA * plate_m.powi(3) / (3.0 * (1.0 - SOIL_POISSON))
}
