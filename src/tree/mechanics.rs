//! How stiff, heavy and exposed each beam of a tree is: from a skeleton to the rows that are posed.
//!
//! Each beam is a tapered cantilever in its fundamental mode phi (Setas et al., eqs. 18-23). What it bears rides on it
//! rigidly: a mass m at distance a along and r beside the beam's own point of attachment moves with
//! phi + phi' a/L across the beam and phi' r/L along it, so it adds m ((phi + phi' a/L)^2 + (phi' r/L)^2) to the generalised
//! mass, and a drag f adds f (phi + phi' a/L) to the generalised load. Without this a bare trunk would sway twice as fast
//! as the tree (80% of the crown must go before it shows: Moore & Maguire 2004).

use super::{
    skeleton::{LeafCluster, Skeleton, SkeletonBeam},
    species::Species,
};
use crate::dynamics::{
    cantilever::{CantileverMode, TaperedBeam},
    pose::{BeamDynamics, NO_PARENT},
    response::FrequencyClasses,
};
use bevy::math::Vec3;
use std::f64::consts::{PI, TAU};

/// Density of air, kg/m^3: 15 degrees C at sea level, ISO 2533.
const AIR_DENSITY_KG_M3: f64 = 1.225;
/// Drag coefficient of a round branch across the flow below the drag crisis (Simiu & Scanlan 1978).
const BRANCH_DRAG_COEFFICIENT: f64 = 1.2;
/// Roughness length with which heights are weighted, m: open woodland (Simiu & Scanlan 1978 give 0.01 to 1). The model is
/// baked once for all winds; over the heights of a crown other roughness changes the weights by a few per cent.
const ROUGHNESS_M: f64 = 0.3;
/// Height at which the wind of the response table is taken, m.
const REFERENCE_HEIGHT_M: f64 = 10.0;

/// A lump of the tree: the mass and the drag of one beam or one leaf cluster at one point.
#[derive(Clone, Copy)]
struct Lump {
    at: Vec3,
    mass_kg: f64,
    /// Drag for one m^2/s^2 of wind pressure |u|u at the reference height, kg/m.
    drag_kg_m: f64,
}

/// The beams of `skeleton` as rows for posing, in the same order.
pub fn beam_dynamics(species: &Species, skeleton: &Skeleton) -> Vec<BeamDynamics> {
    let mode = CantileverMode::nth(1);
    let classes = FrequencyClasses::default();
    let mut sums: Vec<ModalSums> =
        skeleton.beams.iter().map(|beam| ModalSums::of_beam_alone(species, beam, &mode)).collect();
    for (index, beam) in skeleton.beams.iter().enumerate() {
        let lump = beam_lump(species, beam);
        if let Some(parent) = beam.parent {
            ride_up(skeleton, &mode, &mut sums, parent, f64::from(beam.attach), lump);
        }
        debug_assert!(beam.parent.is_none_or(|parent| (parent as usize) < index), "parents come first");
    }
    for cluster in &skeleton.clusters {
        let lump = cluster_lump(species, cluster);
        ride_up(skeleton, &mode, &mut sums, cluster.beam, f64::from(cluster.at), lump);
    }
    skeleton.beams.iter().zip(&sums).map(|(beam, sums)| row(beam, sums, &classes)).collect()
}

/// Natural frequency of a row's beam with all that it bears, Hz.
pub fn natural_frequency_hz(row: &BeamDynamics) -> f32 {
    let classes = FrequencyClasses::default();
    classes.lowest_hz * classes.ratio.powf(row.class)
}

/// Generalised mass, stiffness and load of one beam.
struct ModalSums {
    mass_kg: f64,
    stiffness_n_m: f64,
    load_kg_m: f64,
}

impl ModalSums {
    fn of_beam_alone(species: &Species, beam: &SkeletonBeam, mode: &CantileverMode) -> Self {
        let tapered = TaperedBeam {
            length_m: f64::from(beam.length_m),
            base_radius_m: f64::from(beam.base_radius_m),
            tip_radius_m: f64::from(beam.tip_radius_m),
            young_modulus_pa: f64::from(species.wood.young_modulus_pa),
            density_kg_m3: f64::from(species.wood.density_kg_m3),
        };
        let load_per_length = |s: f64| {
            let diameter_m = 2.0 * (tapered.base_radius_m + s * (tapered.tip_radius_m - tapered.base_radius_m));
            let height_m = f64::from(beam.base.y + beam.direction.y * beam.length_m * s as f32);
            0.5 * AIR_DENSITY_KG_M3 * BRANCH_DRAG_COEFFICIENT * diameter_m * pressure_ratio(height_m)
        };
        Self {
            mass_kg: tapered.generalised_mass(mode),
            stiffness_n_m: tapered.generalised_stiffness(mode),
            load_kg_m: tapered.generalised_load(mode, load_per_length),
        }
    }
}

/// Lets a lump ride on `bearer` at `attach`, and so on every beam below.
fn ride_up(
    skeleton: &Skeleton,
    mode: &CantileverMode,
    sums: &mut [ModalSums],
    mut bearer: u32,
    mut attach: f64,
    lump: Lump,
) {
    loop {
        let beam = &skeleton.beams[bearer as usize];
        let arm = lump.at - (beam.base + beam.direction * beam.length_m * attach as f32);
        let along_m = f64::from(arm.dot(beam.direction));
        let beside_m = f64::from(arm.reject_from_normalized(beam.direction).length());
        let slope_per_m = mode.slope(attach) / f64::from(beam.length_m);
        let across = mode.shape(attach) + slope_per_m * along_m;
        let forth = slope_per_m * beside_m;
        let sum = &mut sums[bearer as usize];
        sum.mass_kg += lump.mass_kg * (across * across + forth * forth);
        sum.load_kg_m += lump.drag_kg_m * across.max(0.0);
        let Some(parent) = beam.parent else { return };
        bearer = parent;
        attach = f64::from(beam.attach);
    }
}

fn beam_lump(species: &Species, beam: &SkeletonBeam) -> Lump {
    let (r0, r1) = (f64::from(beam.base_radius_m), f64::from(beam.tip_radius_m));
    let length_m = f64::from(beam.length_m);
    let volume_m3 = PI * length_m * (r0 * r0 + r0 * r1 + r1 * r1) / 3.0;
    let at = beam.base + beam.direction * beam.length_m * 0.5;
    Lump {
        at,
        mass_kg: volume_m3 * f64::from(species.wood.density_kg_m3),
        drag_kg_m: 0.5 * AIR_DENSITY_KG_M3 * BRANCH_DRAG_COEFFICIENT * length_m * (r0 + r1)
            * pressure_ratio(f64::from(at.y)),
    }
}

fn cluster_lump(species: &Species, cluster: &LeafCluster) -> Lump {
    let area_m2 = f64::from(cluster.size_m * cluster.size_m);
    let at = cluster.anchor + cluster.axis * cluster.size_m * 0.5;
    Lump {
        at,
        mass_kg: area_m2 * f64::from(species.foliage.mass_per_area_kg_m2),
        drag_kg_m: 0.5 * AIR_DENSITY_KG_M3 * f64::from(species.foliage.drag_coefficient) * area_m2
            * pressure_ratio(f64::from(at.y)),
    }
}

/// Wind pressure at a height over that at the reference height: the log law (eq. 10), squared.
fn pressure_ratio(height_m: f64) -> f64 {
    let log = |z: f64| (z / ROUGHNESS_M).max(1.0).ln();
    (log(height_m) / log(REFERENCE_HEIGHT_M)).powi(2)
}

fn row(beam: &SkeletonBeam, sums: &ModalSums, classes: &FrequencyClasses) -> BeamDynamics {
    let frequency_hz = (sums.stiffness_n_m / sums.mass_kg).sqrt() / TAU;
    BeamDynamics {
        base: beam.base,
        length_m: beam.length_m,
        direction: beam.direction,
        attach: beam.attach,
        parent: beam.parent.unwrap_or(NO_PARENT),
        gain: (sums.load_kg_m / (sums.stiffness_n_m * f64::from(beam.length_m))) as f32,
        class: classes.coordinate(frequency_hz as f32),
    }
}
