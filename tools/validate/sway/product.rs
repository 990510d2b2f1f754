//! How the product moves the tip of a trunk.

use super::crown::Crown;
use bevy::math::{Mat3, Vec3};
use bevy_windwood::{
    dynamics::{BeamPose, SLOPE_TIP, TreeInWind, TreePoser},
    sway::{SwaySettings, WindResponse},
    wind::{FieldSettings, WindField},
};
use rustfft::num_complex::Complex;
use std::sync::Arc;

/// Lateral columns of a wind in which trees stand: far enough apart to be nearly independent.
const COLUMNS: [usize; 4] = [0, 4, 8, 12];

pub fn response(settings: &FieldSettings) -> WindResponse {
    let field = WindField::synthesise(settings).expect("valid settings");
    WindResponse::new(Arc::new(field), &SwaySettings::default())
}

/// The tips of all trunks over a period, (along, across) as a complex number in m, once for each column.
pub fn tips(crowns: &[Crown], response: &WindResponse) -> Vec<Vec<Vec<Complex<f64>>>> {
    let posers: Vec<_> = crowns
        .iter()
        .map(|crown| {
            let (map, wind) = (response.basis.map(), response.beam_wind());
            TreePoser::new(
                &crown.trunk,
                &TreeInWind { map, wind, to_wind: Mat3::IDENTITY, scale: 1.0, leaf_share: 1.0 },
            )
        })
        .collect();
    let resolution = &response.field.settings().resolution;
    let mut poses = vec![BeamPose::REST; crowns.iter().map(|crown| crown.trunk.len()).max().unwrap_or(0)];
    let mut responses = Vec::new();
    let mut tips = vec![vec![Vec::with_capacity(resolution.time_samples as usize); COLUMNS.len()]; crowns.len()];
    for (index, column) in COLUMNS.into_iter().enumerate() {
        let stem = Vec3::new(0.0, 0.0, column as f32 * resolution.column_spacing_m);
        for sample in 0..resolution.time_samples {
            let place = response.place(stem, f64::from(sample) * f64::from(resolution.time_step_s));
            for ((crown, poser), tips) in crowns.iter().zip(&posers).zip(&mut tips) {
                response.table.responses(&place, poser.rows(), &mut responses);
                // Not held to the wind: what saturates is undone below.
                poser.pose(&responses, Vec3::ZERO, &mut poses);
                tips[index].push(free_tip(crown, &poses));
            }
        }
    }
    tips
}

/// Where the poses move the tip before they saturate. The bend of each beam is undone the saturation, and adds what
/// it moves the tip by small angles.
fn free_tip(crown: &Crown, poses: &[BeamPose]) -> Complex<f64> {
    let last = crown.trunk[crown.trunk.len() - 1];
    let tip = last.base + last.direction * last.length_m;
    let mut moved = Vec3::ZERO;
    for (beam, pose) in crown.trunk.iter().zip(poses) {
        let bent = Vec3::from(pose.tip_angle);
        let share = (bent.length() / beam.angle_limit_rad).min(0.999);
        let free = bent / (1.0 - share * share).sqrt();
        let rest = tip - (beam.base + beam.direction * beam.length_m);
        moved += free * (beam.length_m / SLOPE_TIP) + beam.direction.cross(free).cross(rest);
    }
    Complex::new(f64::from(moved.x), f64::from(moved.z))
}
