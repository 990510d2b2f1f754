//! Trees of any size and stiffness in any wind, anywhere and after any time.

use crate::{report::Report, trees::shipped};
use bevy::math::{Mat3, Quat, Vec3};
use bevy_windwood::{
    dynamics::{BeamDynamics, BeamPose, TreeInWind, TreePoser},
    sway::{SwaySettings, WindResponse},
    tree::{Species, TreeModel},
    wind::{FieldSettings, WindField},
};
use std::sync::Arc;

/// Mean speeds, m/s. A wind is held to at most 75 m/s.
const SPEEDS_M_S: [f32; 6] = [0.0, 2.0, 12.0, 30.0, 60.0, 75.0];
/// Heights of trees, m: instances of one tree, scaled.
const HEIGHTS_M: [f32; 4] = [0.1, 2.0, 20.0, 100.0];
/// Young's moduli, Pa.
const MODULI_PA: [f32; 4] = [1e6, 1e8, 1e10, 1e12];
const SPECIES: [&str; 3] = ["oak", "norway_spruce", "birch"];
const SEED: u64 = 3;
const HOUR_S: f64 = 3600.0;
/// Times at which trees are looked at, s.
const TIMES_S: [f64; 4] = [0.0, 17.3, 24.0 * HOUR_S, 1000.0 * HOUR_S];
/// Places of trees: near, and 100 km from the origin.
const PLACES: [Vec3; 2] = [Vec3::new(3.0, 0.0, -7.0), Vec3::new(70_000.0, 0.0, -71_000.0)];
/// Pieces in which the length of a bent beam is measured.
const PIECES: usize = 64;

/// The worst that was found.
#[derive(Default)]
struct Worst {
    not_finite: u32,
    stretch: f64,
    stem_past_wind_rad: f64,
    beam_past_wind_rad: f64,
    drift: f64,
}

pub fn run() -> Report {
    let mut report = Report::default();
    match worst() {
        Ok(worst) => {
            let note = "0 to 75 m/s, trees of 0.1 to 100 m, moduli over six decades, mirrored, far, after 1000 h";
            report.at_most("not_finite", f64::from(worst.not_finite), 0.0, note);
            report.at_most("length_error_worst", worst.stretch, 1e-3, "change of a beam's length, relative");
            report.at_most("stem_past_wind_worst_rad", worst.stem_past_wind_rad, 1e-3, "tips of stems beyond downwind");
            report.at_most("beam_past_wind_worst_rad", worst.beam_past_wind_rad, 1e-3, "own bends beyond downwind");
            report.at_most("clock_drift", worst.drift, 1e-3, "pose after 1000 h by that of whole periods before, rad");
        }
        Err(error) => {
            eprintln!("extremes: {error}");
            report.at_most("not_finite", f64::NAN, 0.0, "could not be measured");
        }
    }
    report
}

fn worst() -> Result<Worst, String> {
    let mut models = Vec::new();
    for name in SPECIES {
        for young_modulus_pa in MODULI_PA {
            let mut species: Species = shipped(name)?;
            species.wood.young_modulus_pa = young_modulus_pa;
            models.push(TreeModel::bake(&species, species.age.mature_years, SEED));
        }
    }
    let mut worst = Worst::default();
    for speed in SPEEDS_M_S {
        let settings = FieldSettings { speed, ..Default::default() };
        let field = WindField::synthesise(&settings).map_err(|error| error.to_string())?;
        let wind = WindResponse::new(Arc::new(field), &SwaySettings::default());
        for model in &models {
            for height_m in HEIGHTS_M {
                for is_mirrored in [false, true] {
                    Instance::new(model, &wind, height_m, is_mirrored).look(&mut worst);
                }
            }
        }
    }
    Ok(worst)
}

/// By how much a beam's length changes as it is bent, relative. It is bent at the origin: far from there a twig's own length is not much more
/// than the rounding of its place. What its ancestors do to it is a rotation and a translation.
fn stretch(beam: &BeamDynamics, pose: &BeamPose) -> f64 {
    let beam = BeamDynamics { base: Vec3::ZERO, ..*beam };
    let pose = BeamPose { tip_angle: pose.tip_angle, ..BeamPose::REST };
    let at = |piece: usize| {
        let s = piece as f32 / PIECES as f32;
        pose.carry(&beam, s, beam.direction * (s * beam.length_m)).0
    };
    let length_m: f64 = (0..PIECES).map(|piece| f64::from(at(piece).distance(at(piece + 1)))).sum();
    (length_m / f64::from(beam.length_m) - 1.0).abs()
}

/// A tree in a wind.
struct Instance<'a> {
    model: &'a TreeModel,
    wind: &'a WindResponse,
    poser: TreePoser,
    /// Turns the tree's coordinates into the wind's.
    to_wind: Mat3,
    height_m: f32,
}

impl<'a> Instance<'a> {
    fn new(model: &'a TreeModel, wind: &'a WindResponse, height_m: f32, is_mirrored: bool) -> Self {
        let mirror = Mat3::from_diagonal(Vec3::new(if is_mirrored { -1.0 } else { 1.0 }, 1.0, 1.0));
        let to_wind = wind.field.frame().wind_from_world() * Mat3::from_quat(Quat::from_rotation_y(0.7)) * mirror;
        let scale = height_m / model.height_m();
        let tree = TreeInWind { map: wind.basis.map(), wind: wind.beam_wind(), to_wind, scale, leaf_share: 1.0 };
        let poser = TreePoser::new(&model.beams, &tree);
        Self { model, wind, poser, to_wind, height_m }
    }

    /// The poses at a place and time, and where the wind blows to there and then, in the tree's coordinates.
    fn poses(&self, place: Vec3, time_s: f64) -> (Vec<BeamPose>, Vec3) {
        let mut responses = Vec::new();
        let place = self.wind.place(place, time_s);
        self.wind.table.responses(&place, self.poser.rows(), &mut responses);
        let blowing = self.wind.wind_at(&self.wind.beam_wind().stand, &place, self.height_m);
        let blowing = self.to_wind.transpose() * self.wind.field.frame().to_wind(blowing);
        let mut poses = vec![BeamPose::REST; self.model.beams.len()];
        self.poser.pose(&responses, blowing, &mut poses);
        (poses, blowing)
    }

    fn look(&self, worst: &mut Worst) {
        for place in PLACES {
            for time_s in TIMES_S {
                let (poses, blowing) = self.poses(place, time_s);
                self.look_at_poses(&poses, blowing.try_normalize(), worst);
                // So many whole periods before, the wind was the same.
                let period_s = self.wind.field.period_s();
                let (before, _) = self.poses(place, time_s - (time_s / period_s).floor() * period_s);
                let drift = poses.iter().zip(&before).map(|(now, then)| now.tip_angle.distance(then.tip_angle));
                worst.drift = drift.map(f64::from).fold(worst.drift, f64::max);
            }
        }
    }

    fn look_at_poses(&self, poses: &[BeamPose], downwind: Option<Vec3>, worst: &mut Worst) {
        for ((beam, pose), grown) in self.model.beams.iter().zip(poses).zip(&self.model.skeleton.beams) {
            let (place, turn) = pose.carry(beam, 1.0, beam.base + beam.direction * beam.length_m);
            if !place.is_finite() || !turn.is_finite() {
                worst.not_finite += 1;
                continue;
            }
            let stretch = stretch(beam, pose).max(f64::from(pose.rotation.length() - 1.0).abs());
            worst.stretch = worst.stretch.max(stretch);
            let tip = turn * beam.direction;
            let carried = pose.rotation * beam.direction;
            let Some(downwind) = downwind else { continue };
            let own = f64::from(carried.angle_between(tip) - carried.angle_between(downwind));
            worst.beam_past_wind_rad = worst.beam_past_wind_rad.max(own);
            if grown.order == 0 {
                let mean_wind = self.to_wind.transpose() * Vec3::X;
                let lean = f64::from(beam.direction.angle_between(tip) - beam.direction.angle_between(mean_wind));
                worst.stem_past_wind_rad = worst.stem_past_wind_rad.max(lean);
            }
        }
    }
}
