//! The wind that a game asks for, and the field in force: built in the background, then faded in.

use crate::{
    background::drop_in_background,
    setting::SettingError,
    wind::{
        cross_fade::{CrossFade, FadeStep},
        field::WindField,
        settings::FieldSettings,
    },
};
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// The wind of the world. Change it at any time: a new field is built in the background and fades in.
///
/// Values that are not numbers are refused, and values out of range are brought to the nearest limit, each with one
/// warning. Where a value is refused, the last good wind stays in force.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct Wind {
    /// Mean speed at 10 m above ground, m/s. Range 0..=75. A breeze is 5, a gale 20, a hurricane 33.
    pub speed: f32,
    /// Where the mean wind blows to, as world (X, Z).
    pub direction: Dir2,
    /// Roughness length of the ground, m: 0.01 for short grass to 1 for a pine forest (Setas, 3.1.1).
    pub roughness_m: f32,
    /// Height by which a canopy lifts the profile, m. About 0.7 of the canopy's height inside a closed forest.
    pub displacement_m: f32,
    /// Factor on the strength of gusts. 1 is what the measured spectra say, 0 a steady wind. Range 0..=3.
    pub gustiness: f32,
    /// Another seed is another wind of the same kind.
    pub seed: u64,
    /// How long a change takes to reach its full effect, s.
    pub fade_s: f32,
}

impl Default for Wind {
    fn default() -> Self {
        let FieldSettings { speed, direction, roughness_m, displacement_m, gustiness, seed, .. } =
            FieldSettings::default();
        Self { speed, direction, roughness_m, displacement_m, gustiness, seed, fade_s: 3.0 }
    }
}

impl Wind {
    /// Whether every value is a number.
    fn is_finite(&self) -> bool {
        [self.speed, self.roughness_m, self.displacement_m, self.gustiness].iter().all(|value| value.is_finite())
    }

    /// The settings of the field that this wind asks for.
    fn field_settings(&self) -> FieldSettings {
        let Self { speed, direction, roughness_m, displacement_m, gustiness, seed, .. } = *self;
        FieldSettings { speed, direction, roughness_m, displacement_m, gustiness, seed, ..FieldSettings::default() }
    }
}

/// The wind field in force, and the one that fades in while the wind changes.
///
/// It counts as changed only in frames in which one of its methods answers differently than before: a build begins or
/// ends, a new field is there, or a fade runs.
#[derive(Resource, Default)]
pub struct ActiveWind {
    fields: Option<CrossFade<Arc<WindField>>>,
    build: Option<Task<Result<WindField, SettingError>>>,
    requested: Option<FieldSettings>,
}

impl ActiveWind {
    /// Wind velocity in world axes, m/s, at `position` (its y is the height above ground, m) and time `time_s`.
    /// Still air until the first field is built.
    pub fn sample(&self, position: Vec3, time_s: f64) -> Vec3 {
        let Some(fields) = &self.fields else { return Vec3::ZERO };
        let from = fields.from().sample(position, time_s);
        match fields.to() {
            Some(to) => from.lerp(to.sample(position, time_s), fields.weight()),
            None => from,
        }
    }

    /// The newest field that has been built: the one in force once all fading is done.
    pub fn newest(&self) -> Option<&Arc<WindField>> {
        self.fields.as_ref().map(CrossFade::newest)
    }

    /// Whether the first field is in force.
    pub fn is_ready(&self) -> bool {
        self.fields.is_some()
    }

    /// Whether the wind that was asked for is in force: nothing is being built and nothing fades.
    pub fn is_settled(&self) -> bool {
        self.build.is_none() && self.fields.as_ref().is_some_and(|fields| fields.to().is_none())
    }
}

/// Starts a build when the wind has changed and no build runs. Changes during a build are taken up after it.
pub(in crate::wind) fn start_field_build(wind: Res<Wind>, mut active: ResMut<ActiveWind>) {
    if active.build.is_some() {
        return;
    }
    let (settings, errors) = wind.field_settings().clamped();
    if wind.is_changed() {
        errors.iter().for_each(|error| warn!("wind: {error}"));
    }
    let is_refused = !wind.is_finite() && active.requested.is_some();
    if is_refused || active.requested.as_ref() == Some(&settings) {
        return;
    }
    active.requested = Some(settings.clone());
    active.build = Some(AsyncComputeTaskPool::get().spawn(async move { WindField::synthesise(&settings) }));
}

/// Takes over a field that has been built.
pub(in crate::wind) fn finish_field_build(wind: Res<Wind>, mut active: ResMut<ActiveWind>) {
    // Polling is no change.
    let Some(build) = &mut active.bypass_change_detection().build else { return };
    let Some(built) = block_on(poll_once(build)) else { return };
    active.build = None;
    match built {
        Ok(field) => {
            let field = Arc::new(field);
            match &mut active.fields {
                Some(fields) => fields.succeed(field, wind.fade_s).into_iter().for_each(drop_in_background),
                None => active.fields = Some(CrossFade::new(field)),
            }
        }
        Err(error) => warn!("wind: {error}; the last good wind stays in force"),
    }
}

/// Advances the fade from one field to the next.
pub(in crate::wind) fn fade_fields(time: Res<Time>, mut active: ResMut<ActiveWind>) {
    let Some(fields) = &mut active.bypass_change_detection().fields else { return };
    match fields.advance(time.delta_secs()) {
        FadeStep::Rest => return,
        FadeStep::Began | FadeStep::Running => {}
        FadeStep::Finished(replaced) => {
            drop_in_background(replaced);
            debug!("wind: the new field is in force");
        }
    }
    active.set_changed();
}
