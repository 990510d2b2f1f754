//! The wind at a place among trees.

use crate::{
    dynamics::stand_wind::StandWind,
    query::rustle::nearness,
    sway::{ActiveSway, InCanopy, WeightedResponse, WindResponse},
    tree::TreePlaces,
    wind::{ActiveWind, WindClock, WindSources},
};
use bevy::{ecs::system::SystemParam, prelude::*};

/// Trees that are nearer than this shelter a place, m.
const SHELTER_M: f32 = 16.0;
/// How much the open counts beside them: little, so that it makes itself felt only where the last trees end.
const OPEN_SHARE: f32 = 0.02;

/// Asks for the wind at a place: among trees it is weaker than in the open, and gustier. For sails, clothes, smoke and sound.
///
/// The stands of the trees within 16 m count, the nearer the more ([`InCanopy`]): over ground that is told the answer is continuous.
/// Where there are none it is what [`ActiveWind::sample`] says. What [`WindSource`](crate::wind::WindSource)s blow is added as it is: trees
/// do not shelter from it.
#[derive(SystemParam)]
pub struct WindInTrees<'w, 's> {
    wind: Res<'w, ActiveWind>,
    sway: Res<'w, ActiveSway>,
    clock: Res<'w, WindClock>,
    sources: Res<'w, WindSources>,
    places: Res<'w, TreePlaces>,
    canopies: Query<'w, 's, (&'static GlobalTransform, Option<&'static InCanopy>)>,
}

/// The wind at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WindAt {
    /// Now, with what sources blow, m/s in world axes.
    pub velocity: Vec3,
    /// The mean speed, without sources, m/s.
    pub mean_m_s: f32,
    /// Standard deviation of gusts along the wind, without sources, m/s.
    pub deviation_m_s: f32,
}

impl WindAt {
    fn add(&mut self, share: f32, other: Self) {
        self.velocity += share * other.velocity;
        self.mean_m_s += share * other.mean_m_s;
        self.deviation_m_s += share * other.deviation_m_s;
    }
}

impl WindInTrees<'_, '_> {
    /// The wind at a place in the world, m, now. `ground_m` is the height of the ground there; without one it is that of the nearest tree's
    /// foot, or 0.
    #[must_use]
    pub fn at(&self, place: Vec3, ground_m: Option<f32>) -> WindAt {
        if !place.is_finite() {
            return WindAt::default();
        }
        let (mut nearest_m, mut foot_m, mut whole) = (f32::INFINITY, 0.0, OPEN_SHARE);
        self.trees_about(place, |distance_m, at, _| {
            if distance_m < nearest_m {
                (nearest_m, foot_m) = (distance_m, at.translation().y);
            }
            whole += nearness(distance_m, SHELTER_M);
        });
        let height_m = place.y - ground_m.unwrap_or(foot_m);
        let mut sum = WindAt::default();
        for WeightedResponse { response, weight } in self.sway.now() {
            let table = response.table.velocity(&response.place(place, self.clock.time_s));
            let open = self.open(response, place, height_m);
            sum.add(weight * OPEN_SHARE / whole, open);
            self.trees_about(place, |distance_m, _, InCanopy(canopy)| {
                let stand = in_stand(response, &response.stand_wind(&canopy), height_m, table);
                sum.add(weight * nearness(distance_m, SHELTER_M) / whole, stand);
            });
        }
        if self.sway.now().next().is_none() {
            sum.velocity = self.wind.sample(place.with_y(height_m), self.clock.time_s);
        }
        sum.velocity += self.sources.velocity(place);
        sum
    }

    /// Visits the trees that shelter a place: their distance on the map, m, and where and in what stand they stand.
    fn trees_about(&self, place: Vec3, mut visit: impl FnMut(f32, &GlobalTransform, InCanopy)) {
        self.places.within(place.xz(), SHELTER_M, |tree, distance_m| {
            if let Ok((at, canopy)) = self.canopies.get(tree) {
                visit(distance_m, at, canopy.copied().unwrap_or_default());
            }
        });
    }

    /// Speed of the wind in a tree's crown at a height above its foot, m/s.
    pub(super) fn speed_in_crown(&self, foot: Vec3, height_m: f32, canopy: &InCanopy) -> f32 {
        let winds = self.sway.now().map(|WeightedResponse { response, weight }| {
            let table = response.table.velocity(&response.place(foot, self.clock.time_s));
            weight * in_stand(response, &response.stand_wind(&canopy.0), height_m, table).velocity
        });
        (winds.sum::<Vec3>() + self.sources.velocity(foot + Vec3::Y * height_m)).length()
    }

    fn open(&self, response: &WindResponse, place: Vec3, height_m: f32) -> WindAt {
        let stand = StandWind::open(response.mean_wind);
        let velocity = response.field.sample(place.with_y(height_m), self.clock.time_s);
        WindAt { velocity, ..in_stand(response, &stand, height_m, Vec3::ZERO) }
    }
}

/// The wind at a height in a stand, where the table's wind has that velocity, m/s in wind coordinates.
fn in_stand(response: &WindResponse, stand: &StandWind, height_m: f32, table: Vec3) -> WindAt {
    let height_m = height_m.max(0.0);
    let (speeds, by_m_s) = (stand.speeds(height_m), stand.table_speed_m_s());
    let finite = |value: f32| if value.is_finite() { value } else { 0.0 };
    WindAt {
        velocity: response.field.frame().to_world(stand.velocity(height_m, table)),
        mean_m_s: finite(by_m_s * speeds.mean),
        // That of open country holds for a gustiness of 1.
        deviation_m_s: finite(by_m_s * speeds.gusts * response.field.settings().gustiness),
    }
}
