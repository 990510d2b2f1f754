//! Carries on the trees that are awake.

use super::{components::LiveSway, pusher::Pushers, settings::LiveSettings, wake::to_local};
use crate::{
    dynamics::{
        BeamLoad, Capsule, Contacts, FrequencyClasses, LiveBeam, LiveSteps,
        stand_wind::{LOW_SHARE, WindAtTree},
    },
    sway::{
        active::{ActiveSway, WeightedResponse},
        articulated::TreePose,
        components::InCanopy,
        stands::{stands_at, uniform_scale, wind_at_tree, world_from_local},
    },
    tree::{Articulated, Grown, Season, Tree, TreeModel},
    wind::{SourceFlow, WindClock, WindSources},
};
use bevy::{math::Vec3A, prelude::*};

/// A load that is spread wider than this, m, is looked at in four places.
const SPREAD_M: f32 = 0.5;

/// What sources blow is looked up anew for each beam so often, Hz: for those that sway slowly, and for the others from this frequency on.
const SLOW_LOOKUPS_HZ: f64 = 15.0;
const FAST_LOOKUPS_HZ: f64 = 30.0;
const FAST_FROM_HZ: f32 = 2.0;

/// A regular tetrahedron, at the distance at which its corners have a standard deviation of 1 in each direction.
const CORNERS: [Vec3; 4] =
    [Vec3::new(1.0, 1.0, 1.0), Vec3::new(1.0, -1.0, -1.0), Vec3::new(-1.0, 1.0, -1.0), Vec3::new(-1.0, -1.0, 1.0)];

/// Carries every tree that is awake over the frame, tree by tree in parallel: blows, winds, then bodies that push.
pub(in crate::sway) fn step_live_trees(
    sway: Res<ActiveSway>,
    clock: Res<WindClock>,
    season: Res<Season>,
    (sources, pushers): (Res<WindSources>, Res<Pushers>),
    models: Res<Assets<TreeModel>>,
    mut steps: Local<LiveSteps>,
    mut trees: Query<(
        (&Tree, &Grown, Option<&InCanopy>),
        (&Transform, &GlobalTransform, Has<ChildOf>),
        Option<&TreePose>,
        &mut LiveSway,
    )>,
) {
    let Some(newest) = sway.now().last() else { return };
    let grid = &newest.response.table.grid;
    let frame_s = clock.time_s - clock.previous_s;
    let steps = steps.renew(grid, frame_s).then_some(&*steps);
    let lookups = Lookups::new(grid.classes, frame_s);
    trees.par_iter_mut().for_each(|((of, grown, canopy), (transform, global, is_child), pose, mut live)| {
        let Some(model) = models.get(&grown.model) else { return };
        let stands = stands_at(transform, global, is_child);
        let scale = uniform_scale(&stands);
        let leaf_share = model.leaf_season.share(season.wrapped() + of.season_shift());
        live.refresh(&sway, (grown.model.id(), model), scale, leaf_share, canopy.copied().unwrap_or_default().0);
        live.begin_frame();
        let local_from_world = world_from_local(&stands).transpose();
        live.feel_blows(&model.beams, &stands, local_from_world, scale);
        let place = TreeInFlows::new(&sources, model, stands, local_from_world);
        if let Some(steps) = steps {
            step(&mut live, &sway, clock.time_s, (steps, lookups), &place);
        }
        let poses = pose.map_or(&[][..], TreePose::beams);
        let contacts = Contacts { beams: &model.beams, poses, scale };
        for body in pushers.now().iter().filter(|body| place.meets(&body.capsule)) {
            contacts.push(&mut live.tree, &to_local(&body.capsule, &stands), body.force_n);
        }
    });
}

/// Every how many frames the load of a beam is looked up.
#[derive(Clone, Copy)]
struct Lookups {
    first_fast: usize,
    slow_frames: u32,
    fast_frames: u32,
}

impl Lookups {
    fn new(classes: FrequencyClasses, frame_s: f64) -> Self {
        let frames = |hz: f64| (1.0 / (hz * frame_s) + 0.01).clamp(1.0, 16.0) as u32;
        Self {
            first_fast: classes.nearest(classes.coordinate(FAST_FROM_HZ)),
            slow_frames: frames(SLOW_LOOKUPS_HZ),
            fast_frames: frames(FAST_LOOKUPS_HZ),
        }
    }

    /// Whether the load of a beam is due. That of its neighbours comes in other frames.
    fn is_due(&self, beam: &LiveBeam, index: usize, frame: u32) -> bool {
        let every = if beam.class < self.first_fast { self.slow_frames } else { self.fast_frames };
        frame <= 1 || frame.wrapping_add(index as u32).is_multiple_of(every)
    }
}

/// A tree, and the flows that reach it.
struct TreeInFlows<'a> {
    /// All that there are.
    sources: &'a [SourceFlow],
    stands: GlobalTransform,
    local_from_world: Mat3,
    scale: f32,
    height_m: f32,
    /// A ball around it in any wind.
    middle: Vec3,
    radius_m: f32,
    /// Whether something reaches it that comes and goes within the frame.
    has_pulse: bool,
}

impl<'a> TreeInFlows<'a> {
    fn new(sources: &'a WindSources, model: &TreeModel, stands: GlobalTransform, local_from_world: Mat3) -> Self {
        let scale = uniform_scale(&stands);
        let middle = stands.transform_point(0.5 * (model.bounds.min + model.bounds.max));
        let radius_m = 0.5 * scale * (model.bounds.max - model.bounds.min).length();
        let (sources, height_m) = (sources.now(), model.height_m());
        let tree = Self { sources, stands, local_from_world, scale, height_m, middle, radius_m, has_pulse: false };
        let has_pulse = tree.flows().any(SourceFlow::is_pulse);
        Self { has_pulse, ..tree }
    }

    /// Those that reach it.
    fn flows(&self) -> impl Iterator<Item = &SourceFlow> {
        let (middle, radius_m) = (self.middle, self.radius_m);
        self.sources.iter().filter(move |flow| flow.place.distance(middle) < flow.reach_m + radius_m)
    }

    /// Whether a body may touch it.
    fn meets(&self, body: &Capsule) -> bool {
        let [a, b] = body.ends;
        a.midpoint(b).distance(self.middle) < self.radius_m + 0.5 * a.distance(b) + body.radius_m
    }

    /// The velocity that sources blow at a place of the world, in the tree's axes, without what comes and goes within the frame.
    fn steady(&self, place: Vec3) -> Vec3 {
        let steady = self.flows().filter(|flow| !flow.is_pulse());
        self.local_from_world * steady.map(|flow| flow.velocity(place)).sum::<Vec3>()
    }

    /// All that sources blow at a share of its height, now.
    fn at_height(&self, share: f32) -> Vec3 {
        let place = self.stands.transform_point(Vec3::Y * (share * self.height_m));
        self.local_from_world * self.flows().map(|flow| flow.velocity(place)).sum::<Vec3>()
    }

    /// The load of a beam in a wind; the steady one where it is due.
    fn load(&self, beam: &LiveBeam, wind: &WindAtTree, is_due: bool) -> BeamLoad {
        if !(is_due || self.has_pulse) {
            return BeamLoad { steady: None, pulse: Vec3A::ZERO };
        }
        let wind = wind.at(beam.load_at.y / self.height_m.max(f32::MIN_POSITIVE));
        let middle = self.stands.transform_point(beam.load_at);
        let spread_m = beam.spread_m * self.scale;
        if spread_m < SPREAD_M {
            let [steady, pulse] = self.load_at(beam, wind, middle);
            return BeamLoad { steady: Some(steady), pulse };
        }
        let (mut steady, mut pulse) = (Vec3A::ZERO, Vec3A::ZERO);
        for corner in CORNERS {
            let [steady_there, pulse_there] = self.load_at(beam, wind, middle + corner * spread_m);
            steady += steady_there * 0.25;
            pulse += pulse_there * 0.25;
        }
        BeamLoad { steady: Some(steady), pulse }
    }

    /// The steady load, and that of pulses, if all were at one place.
    fn load_at(&self, beam: &LiveBeam, wind: Vec3, place: Vec3) -> [Vec3A; 2] {
        let steady = self.steady(place);
        let mut pulse = Vec3A::ZERO;
        for flow in self.flows().filter(|flow| flow.is_pulse()) {
            let loads = flow.pulse(place);
            pulse += loads
                .map(|(velocity, share)| beam.load(wind + steady, self.local_from_world * velocity) * share)
                .sum::<Vec3A>();
        }
        [beam.load(wind, steady), pulse]
    }
}

fn step(
    live: &mut LiveSway,
    sway: &ActiveSway,
    time_s: f64,
    (steps, lookups): (&LiveSteps, Lookups),
    place: &TreeInFlows,
) {
    let LiveSway { beams, tree, stands, wind: blown, frames, .. } = live;
    *blown = WindAtTree::default();
    if place.flows().next().is_none() {
        tree.step(beams, steps, |_, _| BeamLoad::NONE);
        return;
    }
    *blown = WindAtTree { high: place.at_height(1.0), low: place.at_height(LOW_SHARE) };
    let mut wind = WindAtTree::default();
    for (stand, WeightedResponse { response, weight }) in stands.iter().zip(sway.now()) {
        let Some(stand) = stand else { continue };
        let at = response.place(place.stands.translation(), time_s);
        let there = wind_at_tree(response, stand, &at, place.height_m * place.scale);
        wind.high += weight * (place.local_from_world * there.high);
        wind.low += weight * (place.local_from_world * there.low);
    }
    tree.step(beams, steps, |index, beam| place.load(beam, &wind, lookups.is_due(beam, index, *frames)));
}

/// Lets trees sleep that have come to rest, and that nothing touches.
pub(in crate::sway) fn rest_live_trees(
    mut commands: Commands,
    settings: Res<LiveSettings>,
    mut trees: Query<(Entity, &mut LiveSway, Has<Articulated>)>,
) {
    let still_rad =
        if settings.validate().is_ok() { settings.sleep_angle_rad } else { LiveSettings::default().sleep_angle_rad };
    for (entity, mut live, is_articulated) in &mut trees {
        if !std::mem::take(&mut live.is_touched) && live.tree.is_still(still_rad) {
            let mut tree = commands.entity(entity);
            tree.try_remove::<LiveSway>();
            if !is_articulated {
                tree.try_remove::<TreePose>();
            }
        }
    }
}
