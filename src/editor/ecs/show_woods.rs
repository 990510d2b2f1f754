//! Shows a plan as it is edited: the asset is changed, and the forest grows to it in the background; what stays as it is stays standing.

use super::workbench::Workbench;
use crate::{
    background::{Work, spawn_work},
    editor::{file_session::FileSession, plan_element::Element, quadrat_histogram::QuadratHistogram, ui::Panel},
    forest::{Forest, ForestCells},
    scatter::{ForestPlan, plan::Area},
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::time::{Duration, Instant};

/// While a plan is dragged through many, the next is shown once the last is planted, or after so long.
const LONGEST_WAIT: Duration = Duration::from_millis(500);

/// The plan as it was last given to the assets, and the counts that are under way.
#[derive(Resource, Default)]
pub(super) struct AppliedPlan {
    pub handle: Handle<ForestPlan>,
    plan: Option<ForestPlan>,
    since: Option<Instant>,
    /// Whether the forest is still to be planted as the plan says, and the newest of its generations before.
    is_planting: bool,
    generation_before: Option<u64>,
    counting: Option<Work<Result<QuadratHistogram, String>>>,
    counted: Option<Counted>,
}

/// What a histogram is of.
#[derive(Clone, PartialEq)]
struct Counted {
    number: usize,
    area: Area,
    cell_m: f32,
    seed: u64,
}

/// Gives the asset the plan, once it is valid and the last one has been planted.
pub(super) fn apply_plan(
    workbench: Res<Workbench>,
    mut applied: ResMut<AppliedPlan>,
    mut assets: ResMut<Assets<ForestPlan>>,
    server: Res<AssetServer>,
    forests: Query<(&Forest, Option<&ForestCells>)>,
) {
    if applied.plan.is_none() && workbench.panel != Panel::Woods {
        return;
    }
    choose_asset(&workbench, &mut applied, &assets, &server);
    let wanted = workbench.woods.plan();
    if applied.plan.as_ref() == Some(wanted) || wanted.validate().is_err() {
        return;
    }
    let is_planted = of_plan(&forests, &applied.handle).all(|cells| cells.is_some_and(ForestCells::is_planted));
    let has_waited = applied.since.is_none_or(|since| since.elapsed() > LONGEST_WAIT);
    if !is_planted && !has_waited {
        return;
    }
    let generation = newest_generation(&forests, &applied.handle);
    match assets.insert(&applied.handle, wanted.clone()) {
        Ok(()) => {
            (applied.plan, applied.since) = (Some(wanted.clone()), Some(Instant::now()));
            (applied.is_planting, applied.generation_before) = (true, generation);
        }
        Err(error) => warn!("workbench: the plan cannot be shown: {error}"),
    }
}

/// In a game, the asset that the game has loaded from the file; else one of our own.
fn choose_asset(workbench: &Workbench, applied: &mut AppliedPlan, assets: &Assets<ForestPlan>, server: &AssetServer) {
    if workbench.has_turntable {
        if applied.handle == Handle::default() {
            applied.handle = assets.reserve_handle();
        }
        return;
    }
    let name = workbench.woods.session.path().file_name();
    let is_of_file = |id: &AssetId<ForestPlan>| {
        server.get_path(*id).is_some_and(|path| path.path().file_name() == name && name.is_some())
    };
    if applied.handle == Handle::default() || !is_of_file(&applied.handle.id()) {
        let loaded = assets.ids().find(is_of_file).and_then(|id| server.get_id_handle(id));
        match loaded {
            // It is there already as it is in its file.
            Some(loaded) => (applied.plan, applied.handle) = (assets.get(&loaded).cloned(), loaded),
            None if applied.handle == Handle::default() => applied.handle = assets.reserve_handle(),
            None => {}
        }
    }
}

/// Counts the quadrats of the chosen area in the background, whenever the area is another.
pub(super) fn count_quadrats(mut workbench: ResMut<Workbench>, mut applied: ResMut<AppliedPlan>) {
    let workbench = workbench.bypass_change_detection();
    if let Some(task) = &mut applied.counting {
        let Some(histogram) = block_on(poll_once(task)) else { return };
        applied.counting = None;
        workbench.land.histogram = Some(histogram.unwrap_or_else(|panic| Err(panic.to_string())));
    }
    if workbench.panel != Panel::Woods {
        return;
    }
    let plan = workbench.woods.plan();
    let Some(Element::Area(number)) = workbench.woods.chosen() else {
        (workbench.land.histogram, applied.counted) = (None, None);
        return;
    };
    let counted = Counted { number, area: plan.areas[number].clone(), cell_m: plan.cell_m, seed: plan.seed };
    // What is not valid has no pattern: the last one stays.
    if applied.counted.as_ref() == Some(&counted) || plan.validate().is_err() {
        return;
    }
    let areas = plan.areas[..=number].to_vec();
    let alone = ForestPlan { areas, cell_m: plan.cell_m, seed: plan.seed, ..ForestPlan::default() };
    applied.counted = Some(counted);
    applied.counting = Some(spawn_work(move || QuadratHistogram::of(&alone, number)));
}

/// Notes what stands, and whether more is to come.
pub(super) fn note_woods(
    mut workbench: ResMut<Workbench>,
    mut applied: ResMut<AppliedPlan>,
    forests: Query<(&Forest, Option<&ForestCells>)>,
) {
    let workbench = workbench.bypass_change_detection();
    let here = || of_plan(&forests, &applied.handle);
    let is_shown = applied.plan.as_ref() == Some(workbench.woods.plan()) || workbench.woods.session.error().is_some();
    let is_planted = |cells: &ForestCells| cells.is_planted() && cells.is_complete() && cells.is_up_to_date();
    workbench.land.stems = here().flatten().map(|cells| cells.store().plants()).sum();
    workbench.land.is_growing = !is_shown || !here().all(|cells| cells.is_some_and(is_planted));
    // What has to be planted because somebody goes about is no work of the plan's.
    let has_begun = applied.is_planting && newest_generation(&forests, &applied.handle) > applied.generation_before;
    let unplanted = here().flatten().filter(|cells| !cells.is_planted());
    workbench.land.planted_share = unplanted.map(ForestCells::planted_share).reduce(f32::min).filter(|_| has_begun);
    if has_begun && workbench.land.planted_share.is_none() {
        applied.is_planting = false;
    }
}

/// The forests of a plan; those that have not begun have no cells.
fn of_plan<'a>(
    forests: &'a Query<(&Forest, Option<&ForestCells>)>,
    plan: &'a Handle<ForestPlan>,
) -> impl Iterator<Item = Option<&'a ForestCells>> {
    forests.iter().filter(|(forest, _)| forest.plan == *plan).map(|(_, cells)| cells)
}

/// The newest generation of the forests of a plan; none where none has begun.
fn newest_generation(forests: &Query<(&Forest, Option<&ForestCells>)>, plan: &Handle<ForestPlan>) -> Option<u64> {
    of_plan(forests, plan).flatten().map(ForestCells::generation).max()
}

#[cfg(test)]
mod tests;
