//! The wind that blows now: built off the frame, and faded in.

use super::{
    FieldSettings, WindField,
    cross_fade::{CrossFade, FadeStep},
};
use crate::retire::retire;
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// How long a change of the wind takes to be felt in full, s.
pub const DEFAULT_FADE_S: f32 = 3.0;

/// The wind of the world. Change it whenever you like: a new field is built in the background and fades in.
///
/// Values that are not numbers are refused and values out of range are brought to the nearest limit, each with one
/// warning; the last good wind blows on.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct Wind {
    /// Mean speed at 10 m above ground, m/s. Range 0..=75. A breeze is 5, a gale 20, a hurricane 33.
    pub speed: f32,
    /// Where the mean wind blows to, as world (X, Z).
    pub direction: Dir2,
    /// Roughness length of the ground, m: 0.01 for short grass to 1 for a pine forest (Setas, 3.1.1).
    pub roughness_m: f32,
    /// Height by which a canopy lifts the profile, m; about 0.7 of the canopy's height inside a closed forest.
    pub displacement_m: f32,
    /// Factor on the strength of gusts; 1 is what the measured spectra say, 0 a steady wind. Range 0..=3.
    pub gustiness: f32,
    /// Another seed is another wind of the same kind.
    pub seed: u64,
    /// How long a change takes to be felt in full, s.
    pub fade_s: f32,
}

impl Default for Wind {
    fn default() -> Self {
        let field = FieldSettings::default();
        Self {
            speed: field.mean_speed_m_s,
            direction: field.direction,
            roughness_m: field.roughness_length_m,
            displacement_m: field.displacement_height_m,
            gustiness: field.gustiness,
            seed: field.seed,
            fade_s: DEFAULT_FADE_S,
        }
    }
}

impl Wind {
    /// Whether every value is a number.
    fn is_finite(&self) -> bool {
        [self.speed, self.roughness_m, self.displacement_m, self.gustiness].iter().all(|value| value.is_finite())
    }

    /// The settings of the field that this wind asks for.
    pub fn field_settings(&self) -> FieldSettings {
        FieldSettings {
            mean_speed_m_s: self.speed,
            direction: self.direction,
            roughness_length_m: self.roughness_m,
            displacement_height_m: self.displacement_m,
            gustiness: self.gustiness,
            seed: self.seed,
            ..FieldSettings::default()
        }
    }
}

/// The wind field in force, and the one that fades in while the wind changes.
#[derive(Resource)]
pub struct ActiveWind {
    fields: Option<CrossFade<Arc<WindField>>>,
    building: Option<Task<Result<WindField, super::WindError>>>,
    wanted: Option<FieldSettings>,
}

impl ActiveWind {
    /// No wind yet.
    pub(super) fn calm() -> Self {
        Self { fields: None, building: None, wanted: None }
    }

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

    /// Whether a first field blows.
    pub fn is_ready(&self) -> bool {
        self.fields.is_some()
    }

    /// Whether the wind that was asked for is all there: nothing is being built and nothing fades.
    pub fn is_settled(&self) -> bool {
        self.building.is_none() && self.fields.as_ref().is_some_and(|fields| fields.to().is_none())
    }
}

/// Starts a build when the wind has changed and no build runs; the latest change always gets its turn.
pub(super) fn rebuild_field(wind: Res<Wind>, mut active: ResMut<ActiveWind>) {
    if active.building.is_some() {
        return;
    }
    let (settings, complaints) = wind.field_settings().clamped();
    if !complaints.is_empty() && wind.is_changed() {
        for complaint in &complaints {
            warn!("wind: {complaint}");
        }
    }
    let unusable = !wind.is_finite() && active.wanted.is_some();
    if unusable || active.wanted.as_ref() == Some(&settings) {
        return;
    }
    active.wanted = Some(settings.clone());
    active.building = Some(AsyncComputeTaskPool::get().spawn(async move { WindField::synthesise(&settings) }));
}

/// Takes over a field that has been built.
pub(super) fn receive_field(wind: Res<Wind>, mut active: ResMut<ActiveWind>) {
    let Some(task) = &mut active.building else { return };
    let Some(built) = block_on(poll_once(task)) else { return };
    active.building = None;
    match built {
        Ok(field) => {
            let field = Arc::new(field);
            match &mut active.fields {
                Some(fields) => fields.succeed(field, wind.fade_s).into_iter().for_each(retire),
                None => active.fields = Some(CrossFade::new(field)),
            }
        }
        Err(error) => warn!("wind: {error}; the last good wind blows on"),
    }
}

pub(super) fn fade_field(time: Res<Time>, mut active: ResMut<ActiveWind>) {
    let Some(fields) = &mut active.fields else { return };
    if let FadeStep::Finished(gone) = fields.advance(time.delta_secs()) {
        retire(gone);
        debug!("wind: the new field has taken over");
    }
}
