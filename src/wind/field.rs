//! The wind field: a mean profile, and one realisation of turbulence that drifts with the mean wind.
//!
//! Taylor's hypothesis (Setas et al., equation 14): the mean wind carries eddies faster than they change. So the velocity
//! at a distance x along the wind is what it was here x / U ago. The field is synthesised over time, and read at
//!
//! ```text
//! tau = t - along / U_c - delay(across)
//! ```
//!
//! The whole field drifts at one speed `U_c`, that of the reference height, so that it stays coherent in height. The delay across
//! the wind is that of [`LateralRule`].
//!
//! The three components are independent. So the field has no shear stress, which in a real boundary layer is `-<u w> = u*^2`.

use super::{
    fast_gusts,
    frame::WindFrame,
    interpolation::{BlendTaps, SplineTaps},
    lateral::LateralRule,
    profile::LogProfile,
    settings::FieldSettings,
    synthesis::{self, Turbulence},
};
use crate::setting::SettingError;
use bevy::{
    math::{Vec3, Vec3A},
    tasks::ComputeTaskPool,
};

/// Turbulence drifts at least this fast, m/s, even in a calm: so places along the wind differ by finite times.
const SLOWEST_DRIFT_M_S: f32 = 0.5;

/// A wind field: velocity anywhere in the world at any time, periodic in time. One width farther across the wind the same columns
/// come again, later: see [`repeat_delay_s`](Self::repeat_delay_s).
///
/// Reading it allocates nothing and takes any position and time, negative ones too.
pub struct WindField {
    settings: FieldSettings,
    frame: WindFrame,
    profile: LogProfile,
    lateral: LateralRule,
    turbulence: Turbulence,
}

impl WindField {
    /// Synthesises the field that `settings` describe.
    ///
    /// Takes some 60 ms on two cores at the default resolution: meant for a loading screen or a background task. Uses
    /// all threads of Bevy's compute pool where it exists. The result is the same, bit by bit, on any number of threads.
    ///
    /// # Errors
    /// The first setting outside its domain.
    pub fn synthesise(settings: &FieldSettings) -> Result<Self, SettingError> {
        settings.validate()?;
        let profile = LogProfile::from_reference(settings.speed, settings.roughness_m, settings.displacement_m);
        let resolution = &settings.resolution;
        let lateral = LateralRule::new(
            resolution.columns as usize,
            resolution.column_spacing_m,
            settings.speed.max(SLOWEST_DRIFT_M_S),
            settings.coherence.along.lateral,
        );
        Ok(Self {
            lateral,
            frame: WindFrame::new(settings.direction),
            turbulence: synthesis::synthesise(settings, &profile, ComputeTaskPool::try_get().map(|pool| &**pool)),
            profile,
            settings: settings.clone(),
        })
    }

    /// Velocity of the air, m/s, in world coordinates: mean wind and turbulence.
    ///
    /// `position` is in world coordinates, m, with y the height above ground. Between the columns and levels of the field the
    /// variance of each component is that on them, to some 5%. Above the highest and below the
    /// lowest level that level's turbulence holds. A place on an axis of the field that is not finite counts as 0.
    pub fn sample(&self, position: Vec3, time_s: f64) -> Vec3 {
        let mean = self.frame.along * self.profile.speed_at(position.y);
        mean + self.frame.to_world(self.turbulence_at(position, time_s))
    }

    /// The turbulent part of [`sample`](Self::sample), m/s, in wind coordinates (along, up, across).
    pub fn turbulence_at(&self, position: Vec3, time_s: f64) -> Vec3 {
        let position = self.frame.to_wind(position);
        let resolution = &self.settings.resolution;
        let time_samples = resolution.time_samples as usize;
        let tau_s = time_s - self.delay_s(position.x, position.z);
        let time = SplineTaps::periodic(tau_s / f64::from(resolution.time_step_s), time_samples);
        let column = self.lateral.taps(position.z);
        let level = self.level_taps(position.y);

        let mut velocity = Vec3A::ZERO;
        for (column, column_weight) in column.indices.into_iter().zip(column.weights) {
            for (level, level_weight) in level.indices.into_iter().zip(level.weights) {
                let series = self.series(column, level);
                let [a, b, c, d] = time.indices.map(|index| series[index]);
                let in_time = a * time.weights[0] + b * time.weights[1] + c * time.weights[2] + d * time.weights[3];
                velocity += in_time * (column_weight * level_weight);
            }
        }
        velocity.into()
    }

    /// One velocity per time sample at column `column` (counted round the period) and `height_m` above ground, m/s, in
    /// wind coordinates (along with the mean wind, up, across). Replaces what is in `out`.
    ///
    /// Column c is at c times the column spacing across the wind. At along = 0 it is passed by these samples later by the column's
    /// share of [`repeat_delay_s`](Self::repeat_delay_s).
    pub fn column_velocities(&self, column: usize, height_m: f32, out: &mut Vec<Vec3>) {
        let resolution = &self.settings.resolution;
        let column = column % resolution.columns as usize;
        let mean = Vec3A::X * self.profile.speed_at(height_m);
        let BlendTaps { indices, weights } = self.level_taps(height_m);
        let [a, b, c, d] = indices.map(|level| self.series(column, level));
        out.clear();
        out.extend((0..resolution.time_samples as usize).map(|time| {
            let turbulence = a[time] * weights[0] + b[time] * weights[1] + c[time] * weights[2] + d[time] * weights[3];
            Vec3::from(mean + turbulence)
        }));
    }

    /// One short period of the turbulence above some 2 Hz ([`GustBands`](super::GustBands)) at `height_m` above ground, m/s in wind
    /// coordinates: evenly spaced samples, a power of two of them. All places have it, each at another time. It is not the
    /// realisation that [`sample`](Self::sample) gives up to half the field's sampling rate. Zero in a calm.
    #[must_use]
    pub fn fast_gusts(&self, height_m: f32) -> Vec<Vec3> {
        fast_gusts::synthesise(&self.settings, &self.profile, height_m)
    }

    /// How much later than at the origin of wind coordinates a sample passes a place `along_m` down the wind and `across_m`
    /// across it, s.
    pub(crate) fn delay_s(&self, along_m: f32, across_m: f32) -> f64 {
        f64::from(along_m) / f64::from(self.convective_speed_m_s()) + self.lateral.delay_s(across_m)
    }

    /// How it is read across the wind.
    pub(crate) fn lateral(&self) -> &LateralRule {
        &self.lateral
    }

    /// What the field was made from.
    pub fn settings(&self) -> &FieldSettings {
        &self.settings
    }

    /// The directions of its wind coordinates.
    pub fn frame(&self) -> &WindFrame {
        &self.frame
    }

    /// Its mean wind.
    pub fn profile(&self) -> &LogProfile {
        &self.profile
    }

    /// The time after which it repeats, s.
    pub fn period_s(&self) -> f64 {
        self.settings.resolution.period_s()
    }

    /// The distance across the wind after which its columns come again, m: each later by [`repeat_delay_s`](Self::repeat_delay_s).
    pub fn width_m(&self) -> f64 {
        self.settings.resolution.width_m()
    }

    /// How much later the same gusts blow one [`width_m`](Self::width_m) farther across the wind, s.
    ///
    /// So the same gust blows at the same moment only where so many widths add up to a whole number of periods: 21 of them, or
    /// 2.7 km, for the default field, and in proportion to the speed. Exactly so only on the columns: the lags between them do
    /// not repeat.
    pub fn repeat_delay_s(&self) -> f64 {
        f64::from(self.lateral.slowness_s_m) * self.width_m()
    }

    /// The speed with which the turbulence drifts along, m/s: the mean speed at 10 m, but at least 0.5.
    pub(crate) fn convective_speed_m_s(&self) -> f32 {
        self.settings.speed.max(SLOWEST_DRIFT_M_S)
    }

    /// How much of the variance of u, v and w (along, across, up) lies in the band of frequencies that the field
    /// resolves, as the mean over its levels; 0 in a calm.
    pub fn resolved_fraction(&self) -> [f32; 3] {
        self.turbulence.resolved_fraction
    }

    fn level_taps(&self, height_m: f32) -> BlendTaps {
        let resolution = &self.settings.resolution;
        BlendTaps::in_height(height_m / resolution.level_spacing_m - 1.0, resolution.levels as usize)
    }

    fn series(&self, column: usize, level: usize) -> &[Vec3A] {
        let resolution = &self.settings.resolution;
        let samples = resolution.time_samples as usize;
        let start = (column * resolution.levels as usize + level) * samples;
        &self.turbulence.velocities[start..start + samples]
    }
}

#[cfg(test)]
mod tests {
    use super::{super::settings::FieldResolution, *};
    use bevy::math::{Dir2, Vec2};

    fn small_settings() -> FieldSettings {
        FieldSettings {
            direction: Dir2::new(Vec2::new(0.6, 0.8)).unwrap(),
            resolution: FieldResolution { time_samples: 64, columns: 8, levels: 4, ..Default::default() },
            ..Default::default()
        }
    }

    fn small_field() -> WindField {
        WindField::synthesise(&small_settings()).unwrap()
    }

    /// Places and times that fall between all samples, near and far.
    fn places() -> impl Iterator<Item = (Vec3, f64)> {
        (-40..40).map(|index| {
            let index = index as f32;
            (Vec3::new(7.3 * index, 4.0 + 0.13 * index, 3.1 * index), f64::from(index) * 1.37)
        })
    }

    #[test]
    fn bad_settings_are_refused() {
        let settings = FieldSettings { gustiness: f32::NAN, ..small_settings() };
        assert!(WindField::synthesise(&settings).is_err_and(|error| error.field == "gustiness"));
    }

    #[test]
    fn field_is_periodic_in_time_and_later_one_width_across_the_wind() {
        let field = small_field();
        for (position, time_s) in places() {
            let here = field.sample(position, time_s);
            assert!(field.sample(position, time_s + 5.0 * field.period_s()).abs_diff_eq(here, 1e-5));
        }
        for column in -9..9 {
            let column_m = column as f32 * field.settings().resolution.column_spacing_m;
            let at = |across_m: f32| field.frame().to_world(Vec3::new(3.0, 7.0, across_m));
            let here = field.sample(at(column_m), 2.3);
            let there = field.sample(at(column_m + field.width_m() as f32), 2.3 + field.repeat_delay_s());
            // The place itself rounds: some 1e-5 m, with slopes of about 1 m/s a metre.
            assert!(there.abs_diff_eq(here, 2e-4), "{there} is not {here}");
        }
    }

    #[test]
    fn turbulence_drifts_with_the_mean_wind() {
        // Along x, so that the place across does not round: the lags between columns change by seconds in a metre.
        let field = WindField::synthesise(&FieldSettings { direction: Dir2::X, ..small_settings() }).unwrap();
        for (position, time_s) in places() {
            let later = field.sample(position + field.frame().along * 20.0, time_s + 20.0 / 8.0);
            // As above; and the round trip through 20 m moves the time by some 1e-6 s.
            assert!(later.abs_diff_eq(field.sample(position, time_s), 2e-4));
        }
    }

    #[test]
    fn column_velocities_are_the_samples_of_the_field_on_its_columns() {
        let field = small_field();
        let mut velocities = vec![Vec3::NAN; 3];
        for (column, height_m) in [(0, 2.5), (3, 6.1), (10, 30.0)] {
            field.column_velocities(column, height_m, &mut velocities);
            assert_eq!(velocities.len(), 64);
            for (time, velocity) in velocities.iter().enumerate() {
                let position = field.frame().to_world(Vec3::new(0.0, height_m, column as f32 * 8.0));
                let later_s = column as f64 / 8.0 * field.repeat_delay_s();
                let sampled = field.frame().to_wind(field.sample(position, time as f64 / 16.0 + later_s));
                // The delay rounds to some 1e-7 s; weights on a column round to some 1e-7 of several m/s.
                assert!(sampled.abs_diff_eq(*velocity, 1e-4), "{sampled} is not {velocity}");
            }
        }
    }

    #[test]
    fn mean_over_a_period_is_the_profile_along_the_wind() {
        let field = small_field();
        for height_m in [0.05, 1.0, 7.7, 60.0] {
            let at_time = |time: i32| field.sample(Vec3::new(5.0, height_m, -3.0), f64::from(time) / 16.0 + 0.02);
            let mean = (0..64).map(at_time).sum::<Vec3>() / 64.0;
            let profile = field.frame().along * field.profile().speed_at(height_m);
            // Sums of 64 numbers of about 10 in f32.
            assert!(mean.abs_diff_eq(profile, 1e-4), "{mean} is not {profile}");
        }
    }

    #[test]
    fn calm_field_is_zero_and_finite() {
        let calm = FieldSettings { speed: 0.0, ..small_settings() };
        let field = WindField::synthesise(&calm).unwrap();
        assert_eq!(field.resolved_fraction(), [0.0; 3]);
        assert_eq!(field.convective_speed_m_s(), 0.5);
        for (position, time_s) in places() {
            assert_eq!(field.sample(position, time_s), Vec3::ZERO);
        }
    }

    #[test]
    fn extreme_settings_give_finite_fields() {
        let resolution = FieldResolution { time_samples: 16, columns: 1, levels: 1, ..small_settings().resolution };
        let nearly_calm = FieldSettings { speed: 1e-30, ..small_settings() };
        let single = FieldSettings { speed: 75.0, gustiness: 3.0, resolution, ..small_settings() };
        let mut fully_coherent = small_settings();
        for decay in [
            &mut fully_coherent.coherence.along,
            &mut fully_coherent.coherence.across,
            &mut fully_coherent.coherence.up,
        ] {
            (decay.lateral, decay.vertical) = (0.0, 0.0);
        }
        for settings in [nearly_calm, single, fully_coherent] {
            let field = WindField::synthesise(&settings).unwrap();
            assert!(places().all(|(position, time_s)| field.sample(position, time_s).is_finite()));
        }
    }

    #[test]
    fn velocity_is_finite_at_any_position_and_time() {
        let field = small_field();
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN] {
            for position in [Vec3::new(bad, 2.0, 1.0), Vec3::new(1.0, bad, 1.0), Vec3::new(1.0, 2.0, bad)] {
                assert!(field.sample(position, 1.0).is_finite());
            }
            assert!(field.sample(Vec3::ONE, f64::from(bad)).is_finite());
            assert!(field.sample(Vec3::ONE, f64::MAX).is_finite());
            let mut velocities = Vec::new();
            field.column_velocities(usize::MAX, bad, &mut velocities);
            assert!(velocities.iter().all(|velocity| velocity.is_finite()));
        }
    }
}
