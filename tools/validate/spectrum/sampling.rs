//! What `WindField::sample` gives on and between the samples, and across the boundary of the period.

use super::target::Target;
use bevy::math::Vec3;
use bevy_windwood::wind::WindField;

/// Worst relative error of mean velocities over a period at many places, on and between the samples, against equation 10.
pub fn log_law_error(field: &WindField, target: &Target) -> f64 {
    let heights_m = [0.2, 1.0, 2.5, 4.0, 10.0, 18.3, 33.0, 40.0, 100.0];
    let error = |index: usize| {
        let height_m: f64 = heights_m[index];
        let expected = target.mean_speed_m_s(height_m);
        let mut sum = 0.0;
        for place in 0..8 {
            let position = Vec3::new(place as f32 * 13.7, height_m as f32, place as f32 * 17.3);
            let at_time = |sample| field.sample(position, (f64::from(sample) + 0.3) * target.time_step_s).x;
            sum += (0..target.samples as u32).map(|sample| f64::from(at_time(sample))).sum::<f64>();
        }
        (sum / (8 * target.samples) as f64 / expected - 1.0).abs()
    };
    (0..heights_m.len()).map(error).fold(0.0, f64::max)
}

/// Continuity of the field from one period to the next.
pub struct Seam {
    /// Greatest difference of velocities a period apart, over the mean speed.
    pub jump: f64,
    /// Rms change over a short step across the boundary of the period, over that elsewhere.
    pub step_ratio: f64,
}

impl Seam {
    pub fn measure(field: &WindField) -> Self {
        let (period_s, width_m) = (field.period_s(), field.width_m() as f32);
        let speed_m_s = f64::from(field.settings().speed);
        let (mut jump, mut at_seam, mut elsewhere) = (0.0, 0.0, 0.0);
        for place in 0..4096_u32 {
            // Multiples of 1/16, so that adding a period does not round.
            let [a, b, c] = [7, 11, 13].map(|stride| f64::from(place * stride % 2048) / 16.0);
            let position = Vec3::new(a as f32, 2.0 + (c / 4.0) as f32, b as f32);
            let later = field.sample(position, c + period_s) - field.sample(position, c);
            // The lags between the columns are other ones in each period: that it repeats holds on the columns.
            let on_column = Vec3::new(position.x, position.y, (place % 512) as f32 * width_m / 16.0);
            let delay_s = field.repeat_delay_s();
            let aside = field.sample(on_column - width_m * Vec3::Z, c - delay_s - 3.0 * period_s);
            let aside = aside - field.sample(on_column, c);
            jump = f64::max(jump, f64::from(later.length().max(aside.length())) / speed_m_s);

            let on_time_seam = Vec3::new(0.0, position.y, position.z);
            let on_side_seam = Vec3::new(position.x, position.y, (place % 512) as f32 * width_m);
            at_seam += time_step(field, on_time_seam, period_s) + side_step(field, on_side_seam, c);
            elsewhere += time_step(field, on_time_seam, c) + side_step(field, on_column, c);
        }
        Self { jump, step_ratio: (at_seam / elsewhere).sqrt() }
    }
}

/// Squared change of the velocity over half a sample of time.
fn time_step(field: &WindField, position: Vec3, time_s: f64) -> f64 {
    let quarter_s = 0.25 * f64::from(field.settings().resolution.time_step_s);
    let change = field.sample(position, time_s + quarter_s) - field.sample(position, time_s - quarter_s);
    f64::from(change.length_squared())
}

/// Squared change of the velocity over half a sample across the wind.
fn side_step(field: &WindField, position: Vec3, time_s: f64) -> f64 {
    let quarter = 0.25 * field.settings().resolution.column_spacing_m * Vec3::Z;
    f64::from((field.sample(position + quarter, time_s) - field.sample(position - quarter, time_s)).length_squared())
}
