//! The tables in force, built off the frame, and their fade from one wind to the next.

use super::response::{SwaySettings, WindResponse};
use crate::{
    background::drop_in_background,
    wind::{ActiveWind, CrossFade, FadeStep, Wind, WindClock, WindField},
};
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// The tables that trees read now, in two slots between which a change of the wind fades.
///
/// A slot is rewritten only while it has no weight, now and one frame ago, so neither poses nor motion vectors ever jump.
#[derive(Resource, Default)]
pub struct ActiveSway {
    responses: Option<CrossFade<Arc<WindResponse>>>,
    building: Option<Task<WindResponse>>,
    /// A wind whose tables are built, until it begins to blow.
    incoming: Option<Arc<WindResponse>>,
    /// Whether an incoming wind has to be released before it begins.
    holds_incoming: bool,
    is_released: bool,
    source: Option<(Arc<WindField>, SwaySettings)>,
    /// Whether slot B holds the fade's `from` and slot A its `to`.
    swapped: bool,
    blend: f32,
    previous_blend: f32,
    generation: u64,
}

/// One wind with its weight.
#[derive(Clone, Copy)]
pub struct WeightedResponse<'a> {
    /// The tables.
    pub response: &'a WindResponse,
    /// 0..=1; the weights of all add up to 1.
    pub weight: f32,
}

impl ActiveSway {
    /// The one or two winds that blow now.
    pub fn now(&self) -> impl Iterator<Item = WeightedResponse<'_>> {
        let (from, to, weight) = match &self.responses {
            Some(fade) => (Some(fade.from()), fade.to(), fade.weight()),
            None => (None, None, 0.0),
        };
        let from = from.map(|response| WeightedResponse { response, weight: 1.0 - weight });
        let to = to.map(|response| WeightedResponse { response, weight });
        from.into_iter().chain(to)
    }

    /// Whether the first tables are there and trees sway.
    pub fn is_ready(&self) -> bool {
        self.responses.is_some()
    }

    /// Whether nothing is being built and nothing fades.
    pub fn is_settled(&self) -> bool {
        self.building.is_none()
            && self.incoming.is_none()
            && self.responses.as_ref().is_some_and(|fade| fade.to().is_none())
    }

    /// Grows whenever [`now`](Self::now) yields other winds than before.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The winds in the slots A and B, for renderers.
    pub fn slots(&self) -> [Option<&Arc<WindResponse>>; 2] {
        let Some(fade) = &self.responses else { return [None, None] };
        if self.swapped { [fade.to(), Some(fade.from())] } else { [Some(fade.from()), fade.to()] }
    }

    /// Weight of slot B now and one frame ago, for renderers.
    pub fn blends(&self) -> [f32; 2] {
        [self.blend, self.previous_blend]
    }

    /// From now on, each new wind waits for [`release_incoming`](Self::release_incoming) before it begins: for renderers that have to
    /// prepare its tables.
    pub fn hold_incoming(&mut self) {
        self.holds_incoming = true;
    }

    /// The wind that waits.
    pub fn incoming(&self) -> Option<&Arc<WindResponse>> {
        self.incoming.as_ref()
    }

    /// Lets the wind that waits begin.
    pub fn release_incoming(&mut self) {
        self.is_released = true;
    }
}

/// Starts a build when a new field blows or the settings have changed, and no build runs.
pub(super) fn rebuild_tables(wind: Res<ActiveWind>, settings: Res<SwaySettings>, mut sway: ResMut<ActiveSway>) {
    let Some(field) = wind.newest() else { return };
    if sway.building.is_some() || sway.incoming.is_some() {
        return;
    }
    let wanted = settings.clamped();
    let same = |(built, with): &(Arc<WindField>, SwaySettings)| Arc::ptr_eq(built, field) && *with == wanted;
    if sway.source.as_ref().is_some_and(same) {
        return;
    }
    if settings.is_changed() && wanted != *settings {
        warn!("sway: {:?} is out of range; {wanted:?} is used", *settings);
    }
    sway.source = Some((field.clone(), wanted.clone()));
    let field = field.clone();
    sway.building = Some(AsyncComputeTaskPool::get().spawn(async move { WindResponse::new(field, &wanted) }));
}

/// Takes over tables that have been built, and moves the fade on. The resource counts as changed only in frames in which another wind is
/// taken over or fades.
pub(super) fn fade_tables(wind: Res<Wind>, time: Res<Time>, mut sway: ResMut<ActiveSway>) {
    if sway.bypass_change_detection().advance(wind.fade_s, time.delta_secs()) {
        sway.set_changed();
    }
}

impl ActiveSway {
    /// Moves on by a frame. Returns whether it yields anything else than in the last one.
    fn advance(&mut self, fade_s: f32, delta_s: f32) -> bool {
        if let Some(built) = self.building.as_mut().and_then(|task| block_on(poll_once(task))) {
            self.building = None;
            self.incoming = Some(Arc::new(built));
            self.is_released = !self.holds_incoming;
        }
        let generation = self.generation;
        if let Some(built) = self.incoming.take_if(|_| self.is_released) {
            match &mut self.responses {
                Some(fade) => fade.succeed(built, fade_s).into_iter().for_each(drop_in_background),
                None => {
                    self.responses = Some(CrossFade::new(built));
                    self.generation += 1;
                }
            }
        }
        let blends = [self.blend, self.previous_blend];
        self.previous_blend = self.blend;
        let Some(fade) = &mut self.responses else { return false };
        match fade.advance(delta_s) {
            FadeStep::Began => self.generation += 1,
            // The slot that has faded in keeps its tables: now it is the one that the next fade starts from.
            FadeStep::Finished(gone) => {
                drop_in_background(gone);
                self.swapped = !self.swapped;
                self.generation += 1;
            }
            FadeStep::Running | FadeStep::Rest => {}
        }
        let weight = fade.weight();
        self.blend = if self.swapped { 1.0 - weight } else { weight };
        self.generation != generation || blends != [self.blend, self.previous_blend]
    }
}

/// A time in the period of one wind, s: exact for days, where an `f32` of the time itself would not be.
pub fn wrapped_time_s(response: &WindResponse, time_s: f64) -> f64 {
    time_s.rem_euclid(response.field.period_s())
}

/// Length after which the flutter of leaves, and whatever else has a rhythm of its own, repeats itself, s. It is no wind's
/// own, so that flutter does not jump when one wind fades into another.
pub const FLUTTER_PERIOD_S: f64 = 128.0;

/// A time in the period of the leaves' flutter, s.
pub fn leaf_clock_s(time_s: f64) -> f32 {
    time_s.rem_euclid(FLUTTER_PERIOD_S) as f32
}

/// What the sway systems need to know of the moment.
pub(super) fn is_windy(sway: Res<ActiveSway>, clock: Res<WindClock>) -> bool {
    sway.is_ready() && (clock.is_changed() || sway.is_changed())
}
