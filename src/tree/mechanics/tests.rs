//! Sway frequencies against closed forms and against the measurements of foresters.

use super::{
    branches::{Carrier, LoadedBranch, Lump},
    hinges::{BARK_SHARE, Hinge, beam_compliance},
    resonance::resonances,
    skew::{posed_m, stiff_axes},
    statics::{Beyond, GRAVITY_M_S2, PieceWeight, influence, softening, stands},
    *,
};
use crate::{dynamics::bend::SLOPE_TIP, tree::individual::grow};
use bevy::math::{DVec3, Vec3};
use std::f64::consts::TAU;

/// Natural frequency of a row's branch with all that it bears, Hz.
fn natural_frequency_hz(row: &BeamDynamics) -> f32 {
    FrequencyClasses::default().frequency_at_hz(row.in_leaf.class)
}

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

/// A branch of hinges and lumps, from the origin to its tip; a stem if nothing carries it.
pub(super) fn branch(hinges: Vec<Hinge>, lumps: Vec<Lump>, tip: DVec3) -> LoadedBranch {
    LoadedBranch {
        beams: vec![0],
        lumps,
        swaying_hinges: hinges.clone(),
        hinges,
        stiff_axes: vec![Vec3::ZERO],
        direction: tip.normalize().as_vec3(),
        base: DVec3::ZERO,
        tip,
        length_m: tip.length(),
        bears: true,
        carrier: None,
    }
}

/// Drag of a lump, kg/m.
const DRAG_KG_M: f64 = 0.01;

pub(super) fn lump(attach_m: f64, mass_kg: f64, at: DVec3) -> Lump {
    Lump {
        attach_m,
        arm_m: 0.0,
        beside_m: 0.0,
        mass_kg,
        drag_kg_m: DRAG_KG_M,
        at: at.as_vec3(),
        log_height: at.y.ln(),
        is_leaf: false,
        is_own: true,
        slot: 0,
    }
}

/// A hinge at the root of a branch that is rigid beyond it.
pub(super) fn spring(at: DVec3, direction: DVec3, stiffness_nm: f64) -> Hinge {
    Hinge {
        along_m: 0.0,
        at,
        direction,
        beam: 0,
        radius_m: 0.1,
        bend_compliance: 1.0 / stiffness_nm,
        twist_compliance: 1.0 / stiffness_nm,
    }
}

/// Hinges of a uniform rod from a place on, so far along the branch.
fn rod(from: DVec3, direction: DVec3, length_m: f64, before_m: f64, [bend_nm2, twist_nm2]: [f64; 2]) -> Vec<Hinge> {
    let count = 100;
    let piece_m = length_m / f64::from(count);
    let hinge = |index: u32| {
        let along_m = (f64::from(index) + 0.5) * piece_m;
        Hinge {
            along_m: before_m + along_m,
            at: from + direction * along_m,
            direction,
            beam: 0,
            radius_m: 0.1,
            bend_compliance: piece_m / bend_nm2,
            twist_compliance: piece_m / twist_nm2,
        }
    };
    (0..count).map(hinge).collect()
}

/// A skeleton of these beams, each with its root, its direction and its length, m.
fn two_beams(beams: [(DVec3, DVec3, f64); 2]) -> Skeleton {
    let mut skeleton = grow(&shipped("oak"), 1.0, 1);
    skeleton.clusters.clear();
    let root = skeleton.beams.swap_remove(0);
    let beam = |(base, direction, length_m): (DVec3, DVec3, f64)| SkeletonBeam {
        base: base.as_vec3(),
        direction: direction.as_vec3(),
        length_m: length_m as f32,
        ..root
    };
    skeleton.beams = beams.map(beam).into();
    skeleton
}

/// By the moment of a force at the tip, piece by piece.
#[test]
fn beams_give_under_a_force_at_their_tip_as_their_taper_does() {
    let species = Species::default();
    let beam = SkeletonBeam {
        parent: Some(0),
        attach: 0.5,
        base: Vec3::ZERO,
        direction: Vec3::X,
        length_m: 3.0,
        base_radius_m: 0.05,
        tip_radius_m: 0.02,
        bow: Vec3::ZERO,
        order: 1,
    };
    let pieces = 10_000;
    let turn: f64 = (0..pieces)
        .map(|piece| (f64::from(piece) + 0.5) / f64::from(pieces))
        .map(|s| {
            let wood_m = (1.0 - BARK_SHARE) * f64::from(beam.radius_m(s as f32));
            let stiffness = f64::from(species.wood.young_modulus_pa) * std::f64::consts::PI / 4.0 * wood_m.powi(4);
            3.0 * (1.0 - s) * 3.0 / (stiffness * f64::from(pieces))
        })
        .sum();
    let even = beam_compliance(&species, &beam) * 3.0 / 2.0;
    assert!((even / turn - 1.0).abs() < 1e-4, "{even} against {turn}");
    let stem = SkeletonBeam { parent: None, ..beam };
    assert!(beam_compliance(&species, &stem) > beam_compliance(&species, &beam));
}

/// A rigid pole of mass m and length L on a spring: w^2 = (k - m g L/2) / (m L^2/3); hanging, the weight stiffens it.
#[test]
fn a_rigid_pole_on_its_roots_has_the_frequency_of_an_inverted_pendulum() {
    let (mass_kg, length_m, stiffness) = (50.0, 4.0, 3000.0_f64);
    let count = 200;
    for upright in [DVec3::Y, DVec3::NEG_Y] {
        let lumps = (0..count).map(|index: u32| {
            let along_m = (f64::from(index) + 0.5) / f64::from(count) * length_m;
            lump(along_m, mass_kg / f64::from(count), upright * along_m)
        });
        let root = spring(DVec3::ZERO, upright, stiffness);
        let pole = branch(vec![root], lumps.collect(), upright * length_m);
        let spring = stiffness - upright.y * mass_kg * GRAVITY_M_S2 * length_m / 2.0;
        let expected_hz = (spring / (mass_kg * length_m * length_m / 3.0)).sqrt() / TAU;
        let [drag, mass] = [|lump: &Lump| [lump.drag_kg_m], |lump: &Lump| [lump.mass_kg]]
            .map(|weight| Beyond::sums(&pole, &pole.hinges, weight));
        let softer = softening(&pole.hinges, &drag, &mass, pole.tip, &[DVec3::X]);
        assert!((softer * spring / stiffness - 1.0).abs() < 1e-6, "{softer}");
        let responses = [BranchResponse { loads: Vec::new(), sway: pole.sway() }];
        let found = resonances(std::slice::from_ref(&pole), &responses)[0];
        let hz = found.expect("within the frequencies tried").frequency_hz;
        // The peak of a damped resonance, between frequencies that are tried.
        assert!((hz / expected_hz - 1.0).abs() < 0.02, "{hz} {expected_hz}");
    }
}

/// An L in a level plane, loaded upright at its tip: both legs bend, and the first is twisted by the second.
#[test]
fn a_crooked_branch_bends_and_twists_as_a_bent_cantilever() {
    let ([a_m, b_m], [bend_nm2, twist_nm2]) = ([2.0, 0.7], [300.0, 40.0]);
    let (corner, tip) = (DVec3::X * a_m, DVec3::new(a_m, 0.0, b_m));
    let mut hinges = rod(DVec3::ZERO, DVec3::X, a_m, 0.0, [bend_nm2, twist_nm2]);
    hinges.extend(rod(corner, DVec3::Z, b_m, a_m, [bend_nm2, twist_nm2]));
    let bent = branch(hinges, vec![lump(a_m + b_m, 1.0, tip)], tip);
    let sums = Beyond::sums(&bent, &bent.hinges, |_| [1.0]);
    let deflection: f64 = bent
        .hinges
        .iter()
        .zip(&sums)
        .map(|(hinge, sum)| sum.about(hinge.at, 0).dot(influence(hinge, bent.tip, DVec3::Y)))
        .sum();
    let expected = (a_m.powi(3) + b_m.powi(3)) / (3.0 * bend_nm2) + a_m * b_m * b_m / twist_nm2;
    assert!((deflection / expected - 1.0).abs() < 1e-3, "{deflection} {expected}");
}

/// An L in a plane that is tipped by an angle about the line from its root to its tip, with the wind level and across that line. In its
/// plane it only bends, by `int M^2 / EI`; out of it it also twists, as above: so it moves askew of the wind.
#[test]
fn a_crooked_branch_moves_askew_of_the_wind() {
    let ([a_m, b_m], [bend_nm2, twist_nm2]) = ([2.0_f64, 1.2_f64], [300.0, 40.0]);
    let length_m = a_m.hypot(b_m);
    for tip_by_rad in [0.3_f64, 0.8, 1.3] {
        let in_plane = DVec3::new(0.0, tip_by_rad.cos(), tip_by_rad.sin());
        let out_of_plane = DVec3::X.cross(in_plane);
        let u = (DVec3::X * a_m - in_plane * b_m) / length_m;
        let v = (DVec3::X * b_m + in_plane * a_m) / length_m;
        let (corner, tip) = (u * a_m, DVec3::X * length_m);
        let mut hinges = rod(DVec3::ZERO, u, a_m, 0.0, [bend_nm2, twist_nm2]);
        let second = rod(corner, v, b_m, a_m, [bend_nm2, twist_nm2]);
        hinges.extend(second.into_iter().map(|hinge| Hinge { beam: 1, ..hinge }));
        let skeleton = two_beams([(DVec3::ZERO, u, a_m), (corner, v, b_m)]);
        let mut bent = branch(hinges, vec![lump(a_m + b_m, 0.0, tip)], tip);
        bent.beams = vec![0, 1];
        bent.carrier = Some(Carrier { branch: 0, attach_m: 0.0 });
        bent.stiff_axes = stiff_axes(&bent, &skeleton);

        // Moments of a unit force at the tip, in the plane, for each leg: by the way along it that is left, and by the other leg.
        let [along, across] = [DVec3::X, in_plane].map(|force| [u, v].map(|leg| leg.cross(force).dot(out_of_plane)));
        let work = |[p, q]: [f64; 2]| {
            let first = a_m * a_m * (a_m * p * across[0] / 3.0 + 0.5 * b_m * (p * across[1] + q * across[0]));
            (first + a_m * b_m * b_m * q * across[1] + b_m.powi(3) * q * across[1] / 3.0) / bend_nm2
        };
        let out = (a_m.powi(3) + b_m.powi(3)) / (3.0 * bend_nm2) + a_m * b_m * b_m / twist_nm2;
        let expected =
            (DVec3::X * work(along) + in_plane * work(across)) * in_plane.z + out_of_plane * (out * out_of_plane.z);
        let loads = bent.response(&skeleton).loads;
        let moved: DVec3 = (skeleton.beams.iter().zip(&loads).zip(&bent.stiff_axes))
            .map(|((beam, load), stiff_axis)| {
                let (across, stiff_axis) = (DVec3::Z.reject_from(beam.direction.as_dvec3()), stiff_axis.as_dvec3());
                let turn = (across - stiff_axis * stiff_axis.dot(across)) * load.gain * f64::from(SLOPE_TIP);
                posed_m(beam, tip, turn) / DRAG_KG_M
            })
            .sum();
        assert!(moved.distance(expected) < 0.1 * expected.length(), "{tip_by_rad}: {moved} {expected}");
    }
}

/// Timoshenko & Gere (1961): a column buckles under P = pi^2 EI / 4 L^2, a level cantilever tips over sideways under
/// P = 4.013 sqrt(EI GJ) / L^2 (here it is as stiff upright as sideways, which makes no difference while it is straight).
#[test]
fn weight_topples_columns_and_level_branches_at_their_critical_loads() {
    let ([bend_nm2, twist_nm2], length_m) = ([300.0, 40.0], 2.0_f64);
    let column_n = std::f64::consts::PI.powi(2) * bend_nm2 / (4.0 * length_m * length_m);
    let level_n = 4.013 * (bend_nm2 * twist_nm2).sqrt() / (length_m * length_m);
    for (direction, critical_n) in [(DVec3::Y, column_n), (DVec3::X, level_n)] {
        let hinges = rod(DVec3::ZERO, direction, length_m, 0.0, [bend_nm2, twist_nm2]);
        let mass_kg = 0.1 * critical_n / GRAVITY_M_S2;
        let loaded = branch(hinges, vec![lump(length_m, mass_kg, direction * length_m)], direction * length_m);
        let weights = PieceWeight::of(&loaded.hinges, &Beyond::sums(&loaded, &loaded.hinges, |lump| [lump.mass_kg]));
        for (times, is_stable) in [(9.8, true), (10.2, false)] {
            assert_eq!(stands(&loaded.hinges, &weights, times), is_stable, "{direction} {times}");
        }
    }
}

/// eta^2 sqrt(EI / m) / L^2 for a cantilever of the mass m a metre.
#[test]
fn a_uniform_rod_resonates_at_its_natural_frequency() {
    let (bend_nm2, length_m, mass_kg) = (300.0, 2.0, 1.0);
    let count = 50;
    let lumps = (0..count).map(|index: u32| {
        let along_m = (f64::from(index) + 0.5) / f64::from(count) * length_m;
        lump(along_m, mass_kg / f64::from(count), DVec3::X * along_m)
    });
    let hinges = rod(DVec3::ZERO, DVec3::X, length_m, 0.0, [bend_nm2, 1e3 * bend_nm2]);
    let rod = branch(hinges, lumps.collect(), DVec3::X * length_m);
    let rod = LoadedBranch { carrier: Some(Carrier { branch: 0, attach_m: 0.0 }), ..rod };
    let stem = branch(rod.hinges[..1].to_vec(), Vec::new(), DVec3::Y);
    let responses = [&stem, &rod].map(|branch| BranchResponse { loads: Vec::new(), sway: branch.sway() });
    let hz = resonances(&[stem, rod], &responses)[1].expect("within the frequencies tried").frequency_hz;
    let expected_hz = 1.875_104_f64.powi(2) * (bend_nm2 * length_m / mass_kg).sqrt() / (length_m * length_m) / TAU;
    assert!((hz / expected_hz - 1.0).abs() < 0.02, "{hz} {expected_hz}");
}

#[test]
fn a_trunk_sways_slower_with_what_it_carries() {
    for name in ["oak", "fir"] {
        let (species, skeleton, trunk) = trunk(name);
        let bare = Skeleton { beams: vec![skeleton.beams[0]], clusters: Vec::new(), ..skeleton };
        let alone = beam_dynamics(&species, &bare)[0];
        assert!(natural_frequency_hz(&trunk) < 0.7 * natural_frequency_hz(&alone));
        assert!(trunk.in_leaf.gain > alone.in_leaf.gain);
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
