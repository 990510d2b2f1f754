//! The wind that a game asks for, and the field in force: built in the background, then faded in.
//!
//! What else belongs to a wind, such as the tables of trees, fades by the same clock. Who makes it holds each new wind back
//! until it is there ([`ActiveWind::hold_incoming`]), knows it by its number, and follows [`ActiveWind::transition`].

use crate::{
    background::{Work, drop_in_background, spawn_work},
    setting::SettingError,
    wind::{
        cross_fade::{CrossFade, FadeStep},
        field::WindField,
        settings::FieldSettings,
    },
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
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

/// One wind of those that came one after another.
#[derive(Clone)]
pub(crate) struct NumberedWind {
    /// Another number is another wind, even if the field is the same one.
    pub number: u64,
    pub field: Arc<WindField>,
}

/// The wind field in force, and the one that fades in while the wind changes.
///
/// It counts as changed only in frames in which one of its methods answers differently than before: a build begins or
/// ends, a new field is there, or a fade runs.
#[derive(Resource, Default)]
pub struct ActiveWind {
    winds: Option<CrossFade<NumberedWind>>,
    build: Option<Work<Result<WindField, SettingError>>>,
    requested: Option<FieldSettings>,
    /// A wind that is built, until it begins.
    incoming: Option<NumberedWind>,
    /// Whether an incoming wind has to be released before it begins.
    holds_incoming: bool,
    is_released: bool,
    /// How many winds there were so far.
    count: u64,
}

impl ActiveWind {
    /// Wind velocity in world axes, m/s, at `position` (its y is the height above ground, m) and time `time_s`.
    /// Still air until the first field is built.
    pub fn sample(&self, position: Vec3, time_s: f64) -> Vec3 {
        let Some(winds) = &self.winds else { return Vec3::ZERO };
        let from = winds.from().field.sample(position, time_s);
        match winds.to() {
            Some(to) => from.lerp(to.field.sample(position, time_s), winds.weight()),
            None => from,
        }
    }

    /// The newest field that has been built: the one in force once all fading is done.
    pub fn newest(&self) -> Option<&Arc<WindField>> {
        let begun = || self.winds.as_ref().map(CrossFade::newest);
        self.incoming.as_ref().or_else(begun).map(|wind| &wind.field)
    }

    /// Whether the first field is in force.
    pub fn is_ready(&self) -> bool {
        self.winds.is_some()
    }

    /// Whether the wind that was asked for is in force: nothing is being built and nothing fades.
    pub fn is_settled(&self) -> bool {
        let is_still = |winds: &CrossFade<NumberedWind>| winds.values().count() == 1;
        self.build.is_none() && self.incoming.is_none() && self.winds.as_ref().is_some_and(is_still)
    }

    /// From now on, each new wind waits for [`release_incoming`](Self::release_incoming) before it begins: for those that have to
    /// prepare something that belongs to it.
    pub(crate) fn hold_incoming(&mut self) {
        self.holds_incoming = true;
    }

    /// The wind that waits.
    pub(crate) fn incoming(&self) -> Option<&NumberedWind> {
        self.incoming.as_ref()
    }

    /// Lets the wind of that number begin, if it waits.
    pub(crate) fn release_incoming(&mut self, number: u64) {
        self.is_released |= self.incoming.as_ref().is_some_and(|wind| wind.number == number);
    }

    /// Forgets the wind of that number, if it waits: what belongs to it cannot be prepared.
    pub(crate) fn refuse_incoming(&mut self, number: u64) {
        self.incoming.take_if(|wind| wind.number == number).into_iter().for_each(drop_in_background);
    }

    /// Lets the newest field come in once more, as another wind, where none is built and none waits: what belongs to it is to be
    /// prepared anew.
    pub(crate) fn repeat_newest(&mut self) {
        if self.incoming.is_none()
            && self.build.is_none()
            && let Some(field) = self.newest().cloned()
        {
            self.announce(field);
        }
    }

    /// The winds that blow now, that which fades out first, and the weight of the second.
    pub(crate) fn transition(&self) -> Option<(&NumberedWind, Option<&NumberedWind>, f32)> {
        self.winds.as_ref().map(|winds| (winds.from(), winds.to(), winds.weight()))
    }

    /// Whether the wind of that number blows, or will.
    pub(crate) fn has(&self, number: u64) -> bool {
        let winds = self.winds.iter().flat_map(CrossFade::values).chain(&self.incoming);
        winds.into_iter().any(|wind| wind.number == number)
    }

    fn announce(&mut self, field: Arc<WindField>) {
        self.count += 1;
        self.incoming = Some(NumberedWind { number: self.count, field });
        self.is_released = !self.holds_incoming;
    }

    /// Lets the incoming wind begin if it is released. Returns whether it was.
    fn take_incoming(&mut self, fade_s: f32) -> bool {
        let Some(wind) = self.incoming.take_if(|_| self.is_released) else { return false };
        match &mut self.winds {
            Some(winds) => winds.succeed(wind, fade_s).into_iter().for_each(drop_in_background),
            None => self.winds = Some(CrossFade::new(wind)),
        }
        true
    }
}

/// Starts a build when the wind has changed, no build runs and no wind waits. Changes meanwhile are taken up after it.
pub(in crate::wind) fn start_field_build(wind: Res<Wind>, mut active: ResMut<ActiveWind>) {
    if wind.is_changed() {
        wind.field_settings().clamped().1.iter().for_each(|error| warn!("wind: {error}"));
    }
    if active.build.is_some() || active.incoming.is_some() {
        return;
    }
    let settings = wind.field_settings().clamped().0;
    let is_refused = !wind.is_finite() && active.requested.is_some();
    if is_refused || active.requested.as_ref() == Some(&settings) {
        return;
    }
    active.requested = Some(settings.clone());
    active.build = Some(spawn_work(move || WindField::synthesise(&settings)));
}

/// Takes over a field that has been built, at once or when it is released.
pub(in crate::wind) fn finish_field_build(wind: Res<Wind>, mut active: ResMut<ActiveWind>) {
    if active.bypass_change_detection().take_incoming(wind.fade_s) {
        active.set_changed();
    }
    // Polling is no change.
    let Some(build) = &mut active.bypass_change_detection().build else { return };
    let Some(built) = block_on(poll_once(build)) else { return };
    active.build = None;
    match built {
        Ok(Ok(field)) => {
            active.announce(Arc::new(field));
            active.take_incoming(wind.fade_s);
        }
        Ok(Err(error)) => warn!("wind: {error}; the last good wind stays in force"),
        Err(panic) => error!("wind: {panic}; the last good wind stays in force"),
    }
}

/// Advances the fade from one field to the next.
pub(in crate::wind) fn fade_fields(time: Res<Time>, mut active: ResMut<ActiveWind>) {
    let Some(winds) = &mut active.bypass_change_detection().winds else { return };
    match winds.advance(time.delta_secs()) {
        FadeStep::Rest => return,
        FadeStep::Began | FadeStep::Running => {}
        FadeStep::Finished(replaced) => {
            drop_in_background(replaced);
            debug!("wind: the new field is in force");
        }
    }
    active.set_changed();
}
