//! The tables in force, built off the frame, and their fade from one wind to the next.

use super::response::{SwaySettings, WindResponse};
use crate::{
    background::{Work, drop_in_background, spawn_work},
    wind::{ActiveWind, NumberedWind, WindClock},
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// The tables that trees read now, in two slots between which a change of the wind fades.
///
/// The fade is that of [`ActiveWind`]: each new wind waits until its tables are there, and then field and tables begin together.
/// A slot is rewritten only while it has no weight, now and one frame ago, so neither poses nor motion vectors ever jump.
#[derive(Resource, Default)]
pub struct ActiveSway {
    slots: [Option<NumberedResponse>; 2],
    /// The slot of the wind that fades out, or that blows alone.
    from: usize,
    building: Option<(u64, Work<WindResponse>)>,
    /// The tables of the incoming wind, until they are released.
    incoming: Option<NumberedResponse>,
    /// Whether they have to be released before their wind begins.
    holds_incoming: bool,
    is_released: bool,
    /// Tables of winds that are released and have not begun.
    ready: Vec<NumberedResponse>,
    settings: SwaySettings,
    weight: f32,
    blend: f32,
    previous_blend: f32,
    generation: u64,
}

/// The tables of the wind of a number.
struct NumberedResponse {
    number: u64,
    response: Arc<WindResponse>,
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
        let weighted = |slot: usize, weight: f32| {
            self.slots[slot].as_ref().map(|wind| WeightedResponse { response: &wind.response, weight })
        };
        [weighted(self.from, 1.0 - self.weight), weighted(1 - self.from, self.weight)].into_iter().flatten()
    }

    /// Whether the first tables are there and trees sway.
    pub fn is_ready(&self) -> bool {
        self.slots[self.from].is_some()
    }

    /// Whether nothing is being built and nothing fades.
    pub fn is_settled(&self) -> bool {
        self.building.is_none() && self.incoming.is_none() && self.ready.is_empty() && self.now().count() == 1
    }

    /// Grows whenever [`now`](Self::now) yields other winds than before.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The winds in the slots A and B, for renderers.
    pub fn slots(&self) -> [Option<&Arc<WindResponse>>; 2] {
        self.slots.each_ref().map(|slot| slot.as_ref().map(|wind| &wind.response))
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
        self.incoming.as_ref().map(|wind| &wind.response)
    }

    /// Lets the wind that waits begin.
    pub fn release_incoming(&mut self) {
        self.is_released = true;
    }
}

/// Starts a build when a wind waits for its tables, and lets the newest wind come in again when the settings have changed.
pub(super) fn rebuild_tables(mut wind: ResMut<ActiveWind>, settings: Res<SwaySettings>, mut sway: ResMut<ActiveSway>) {
    if sway.building.is_some() || sway.incoming.is_some() {
        return;
    }
    let wanted = settings.clamped();
    if settings.is_changed() && wanted != *settings {
        warn!("sway: {:?} is out of range; {wanted:?} is used", *settings);
    }
    if wind.incoming().is_none() && sway.is_ready() && sway.settings != wanted {
        wind.repeat_newest();
    }
    let Some(NumberedWind { number, field }) = wind.incoming().cloned() else { return };
    if sway.ready.iter().any(|wind| wind.number == number) {
        return;
    }
    sway.settings = wanted.clone();
    sway.building = Some((number, spawn_work(move || WindResponse::new(field, &wanted))));
}

/// Takes over tables that have been built, and releases their wind.
pub(super) fn finish_tables(mut wind: ResMut<ActiveWind>, mut sway: ResMut<ActiveSway>) {
    let sway = sway.bypass_change_detection();
    if let Some((number, task)) = &mut sway.building
        && let Some(built) = block_on(poll_once(task))
    {
        match built {
            Ok(built) => {
                sway.incoming = Some(NumberedResponse { number: *number, response: Arc::new(built) });
                sway.is_released = !sway.holds_incoming;
            }
            Err(panic) => {
                error!("sway: {panic}; the last good wind stays in force");
                wind.bypass_change_detection().refuse_incoming(*number);
            }
        }
        sway.building = None;
    }
    if let Some(tables) = sway.incoming.take_if(|_| sway.is_released) {
        // What it answers does not change by this.
        wind.bypass_change_detection().release_incoming(tables.number);
        sway.ready.push(tables);
    }
}

/// Puts the tables of the winds that blow into the slots. The resource counts as changed only in frames in which another wind is
/// taken over or fades.
pub(super) fn follow_wind(wind: Res<ActiveWind>, mut sway: ResMut<ActiveSway>) {
    if sway.bypass_change_detection().follow(&wind) {
        sway.set_changed();
    }
}

impl ActiveSway {
    /// Follows the winds' transition by a frame. Returns whether it yields anything else than in the last one.
    fn follow(&mut self, wind: &ActiveWind) -> bool {
        let Some((from, to, weight)) = wind.transition() else { return false };
        let generation = self.generation;
        // The slot that has faded in keeps its tables: it is the one that the next fade starts from.
        if !self.holds(self.from, from.number) && self.holds(1 - self.from, from.number) {
            self.from = 1 - self.from;
        }
        self.fill(self.from, Some(from.number));
        self.fill(1 - self.from, to.map(|wind| wind.number));
        for overtaken in self.ready.extract_if(.., |tables| !wind.has(tables.number)) {
            drop_in_background(overtaken.response);
        }
        self.weight = weight;
        let blends = [self.blend, self.previous_blend];
        self.previous_blend = self.blend;
        self.blend = if self.from == 1 { 1.0 - weight } else { weight };
        self.generation != generation || blends != [self.blend, self.previous_blend]
    }

    fn holds(&self, slot: usize, number: u64) -> bool {
        self.slots[slot].as_ref().is_some_and(|tables| tables.number == number)
    }

    /// Puts the tables of a wind into a slot.
    fn fill(&mut self, slot: usize, number: Option<u64>) {
        if self.slots[slot].as_ref().map(|tables| tables.number) == number {
            return;
        }
        let place = self.ready.iter().position(|tables| Some(tables.number) == number);
        let tables = place.map(|place| self.ready.swap_remove(place));
        let replaced = std::mem::replace(&mut self.slots[slot], tables);
        replaced.into_iter().for_each(|tables| drop_in_background(tables.response));
        self.generation += 1;
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
