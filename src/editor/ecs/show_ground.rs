//! Shows ground as it is edited: it is built in the background, and then takes the place of the terrain. Fits maps.

use super::workbench::Workbench;
use crate::{
    background::{Work, spawn_work},
    editor::{
        ground_desk::{Fitting, GroundPlan},
        ground_variogram::GroundVariogram,
        map_fit::{MapFit, NoFit, Progress},
    },
    ground::Ground,
    terrain::{SplineGround, Terrain, TerrainChunks, TurningBands},
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::{
    sync::Arc,
    time::{Duration, Instant},
};

/// Ground that is dragged through many forms is raised once the last is drawn, or after so long.
const LONGEST_WAIT: Duration = Duration::from_millis(700);

/// The terrain of the turntable.
#[derive(Component)]
pub(super) struct LandTerrain;

/// Ground that was built last, and what is under way.
#[derive(Resource, Default)]
pub(super) struct BuiltGround {
    pub ground: Option<Arc<dyn Ground>>,
    of: Option<GroundPlan>,
    building: Option<Work<Option<Built>>>,
    raised: Option<Arc<dyn Ground>>,
    since: Option<Instant>,
    fitting: Option<Work<Result<MapFit, NoFit>>>,
}

/// Ground, and its variogram where it is random.
struct Built {
    ground: Arc<dyn Ground>,
    variogram: Option<GroundVariogram>,
}

impl BuiltGround {
    /// The height of the ground at a place (x, z), m; 0 where there is none.
    pub fn height_m(&self, place: Vec2) -> f32 {
        let height_m = self.ground.as_ref().map_or(0.0, |ground| ground.height_m(place.as_dvec2()));
        if height_m.is_finite() { height_m as f32 } else { 0.0 }
    }
}

fn build(plan: &GroundPlan) -> Option<Built> {
    Some(match plan {
        GroundPlan::Random(settings) => {
            let field = TurningBands::new(settings).ok()?;
            Built { variogram: GroundVariogram::of(&field), ground: Arc::new(field) }
        }
        GroundPlan::Spline(settings) => Built { ground: Arc::new(SplineGround::new(settings).ok()?), variogram: None },
        GroundPlan::Map(fit) => Built { ground: Arc::new(fit.map.clone()), variogram: None },
    })
}

/// Builds the ground in the background, whenever it is another.
pub(super) fn build_ground(mut workbench: ResMut<Workbench>, mut built: ResMut<BuiltGround>) {
    let workbench = workbench.bypass_change_detection();
    if let Some(task) = &mut built.building {
        let Some(done) = block_on(poll_once(task)) else { return };
        built.building = None;
        match done {
            Ok(Some(done)) => {
                built.ground = Some(done.ground);
                workbench.land.variogram = done.variogram;
            }
            Ok(None) => {}
            Err(panic) => workbench.tell_panic(&panic, "the last good ground stays"),
        }
    }
    workbench.land.is_building = false;
    let is_wanted = workbench.panel.is_of_land() || built.of.is_some();
    let Some(plan) = workbench.ground.plan().filter(|plan| is_wanted && built.of.as_ref() != Some(plan)) else {
        return;
    };
    workbench.land.is_building = true;
    built.of = Some(plan.clone());
    built.building = Some(spawn_work(move || build(&plan)));
}

/// Has the terrain be the ground that was built, where that is wanted: our own, or else the game's.
pub(super) fn raise_ground(
    mut commands: Commands,
    workbench: Res<Workbench>,
    mut built: ResMut<BuiltGround>,
    terrains: Query<(Entity, &Terrain, Option<&TerrainChunks>, Has<LandTerrain>)>,
) {
    let Some(ground) = built.ground.clone().filter(|_| workbench.ground.is_shown) else { return };
    if built.raised.as_ref().is_some_and(|raised| Arc::ptr_eq(raised, &ground)) {
        return;
    }
    let terrain = terrains.iter().find(|(.., is_ours)| *is_ours == workbench.has_turntable);
    let is_drawn = terrain.is_none_or(|(_, _, chunks, _)| chunks.is_none_or(TerrainChunks::is_complete));
    let has_waited = built.since.is_none_or(|since| since.elapsed() > LONGEST_WAIT);
    if !is_drawn && !has_waited {
        return;
    }
    let cover = terrain.and_then(|(_, terrain, ..)| terrain.cover.clone());
    let new = Terrain { ground: ground.clone(), cover };
    let mut entity = match terrain {
        Some((entity, ..)) => commands.entity(entity),
        None => commands.spawn_empty(),
    };
    entity.insert(new);
    if workbench.has_turntable {
        entity.insert(LandTerrain);
    }
    (built.raised, built.since) = (Some(ground), Some(Instant::now()));
}

/// Fits the map that is asked for, in the background.
pub(super) fn fit_map(mut workbench: ResMut<Workbench>, mut built: ResMut<BuiltGround>) {
    let workbench = workbench.bypass_change_detection();
    if let Some(task) = &mut built.fitting {
        let Some(fit) = block_on(poll_once(task)) else { return };
        built.fitting = None;
        workbench.ground.take_fit(fit.unwrap_or_else(|panic| Err(NoFit::Failed(panic.to_string()))));
    }
    if matches!(workbench.ground.fitting, Fitting::Wanted) {
        let progress = Arc::new(Progress::default());
        let (request, shared) = (workbench.ground.request.clone(), progress.clone());
        workbench.ground.fitting = Fitting::Running(progress);
        built.fitting = Some(spawn_work(move || MapFit::of(&request, &shared)));
    }
}

#[cfg(test)]
mod tests;
