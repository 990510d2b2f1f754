//! Measures the wind, the motion of the tree, and what frames cost.

use super::{turntable::StageTree, workbench::Workbench};
use crate::{
    background::{Work, spawn_work},
    editor::{
        costs::{Frame, SpeciesCost},
        tip_motion::{StandsInWind, TipMotion},
        ui::Panel,
        wind_measures::WindMeasures,
    },
    query::TreeRays,
    render::draw::counts::TreesByLod,
    sway::{ActiveSway, InCanopy, WindResponse, uniform_scale, world_from_local},
    timing::SystemTimes,
    tree::{Grown, Season, SpeciesModels, Tree, TreeModel},
    wind::{ActiveWind, REFERENCE_HEIGHT_M, WindCell, WindField, WindGizmos},
};
use bevy::{
    ecs::system::SystemParam,
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::{collections::BTreeMap, sync::Arc};

/// Measurements that are under way, and of what the last ones were.
#[derive(Resource, Default)]
pub(super) struct Measuring {
    wind: Option<Work<WindMeasures>>,
    wind_of: Option<Arc<WindField>>,
    tip: Option<Work<Option<TipMotion>>>,
    /// What the tree of that is called.
    tip_name: String,
    tip_of: Option<(Arc<WindResponse>, AssetId<TreeModel>, StandsInWind)>,
}

/// Leaves are counted in so many steps.
const LEAF_STEPS: f32 = 50.0;
/// Trees farther away are not pointed at, m.
const FARTHEST_TREE_M: f32 = 2000.0;

/// Measures the wind in force, while its panel is open.
pub(super) fn measure_wind(mut workbench: ResMut<Workbench>, wind: Res<ActiveWind>, mut measuring: ResMut<Measuring>) {
    if let Some(task) = &mut measuring.wind {
        let Some(measures) = block_on(poll_once(task)) else { return };
        measuring.wind = None;
        match measures {
            Ok(measures) => workbench.measures = Some(measures),
            Err(panic) => workbench.tell_panic(&panic, "the last wind's measures stay"),
        }
    }
    let Some(field) = wind.newest().filter(|_| workbench.panel == Panel::Wind) else { return };
    if measuring.wind_of.as_ref().is_none_or(|of| !Arc::ptr_eq(of, field)) {
        measuring.wind_of = Some(field.clone());
        let field = field.clone();
        measuring.wind = Some(spawn_work(move || WindMeasures::of(&field, REFERENCE_HEIGHT_M)));
    }
}

/// The tree whose motion is shown: the one that was pointed at last, or else the first that is edited.
#[derive(SystemParam)]
pub(super) struct ShownTree<'w, 's> {
    trees: Query<'w, 's, (&'static Tree, &'static Grown, &'static GlobalTransform, Option<&'static InCanopy>)>,
    staged: Query<'w, 's, (Entity, &'static StageTree)>,
}

impl ShownTree<'_, '_> {
    fn find(&self, pointed: Option<Entity>) -> Option<(&Tree, &Grown, &GlobalTransform, Option<&InCanopy>)> {
        let edited = || self.staged.iter().find(|(_, staged)| !staged.stand.is_saved).map(|(tree, _)| tree);
        let is_there = |tree: &Entity| self.trees.contains(*tree);
        self.trees.get(pointed.filter(is_there).or_else(edited)?).ok()
    }
}

/// Notes the tree under the pointer, while the panel of the wind is open. It stays noted until another is pointed at.
pub(super) fn point_at_tree(mut workbench: ResMut<Workbench>, rays: TreeRays) {
    let workbench = workbench.bypass_change_detection();
    let (Some(at), Some(view)) = (workbench.pointer, &workbench.land.view) else { return };
    let Ok(direction) = Dir3::new(view.direction(at)) else { return };
    let met = rays.trace(view.eye, direction, FARTHEST_TREE_M);
    let tree = met.half.map(|crown| crown.tree).or(met.wood.map(|wood| wood.tree));
    workbench.pointed_tree = tree.or(workbench.pointed_tree);
}

/// Works out how the top of a tree moves in the wind in force.
pub(super) fn measure_tip(
    mut workbench: ResMut<Workbench>,
    sway: Res<ActiveSway>,
    season: Res<Season>,
    models: Res<Assets<TreeModel>>,
    species: Res<SpeciesModels>,
    trees: ShownTree,
    mut measuring: ResMut<Measuring>,
) {
    let workbench = workbench.bypass_change_detection();
    if let Some(task) = &mut measuring.tip {
        let Some(motion) = block_on(poll_once(task)) else { return };
        measuring.tip = None;
        match motion {
            Ok(motion) => workbench.tip = motion.map(|motion| (std::mem::take(&mut measuring.tip_name), motion)),
            Err(panic) => workbench.tell_panic(&panic, "the last tree's motion stays"),
        }
    }
    let response = sway.slots().into_iter().flatten().last().filter(|_| workbench.panel == Panel::Wind);
    let Some((response, (tree, grown, at, canopy))) = response.zip(trees.find(workbench.pointed_tree)) else { return };
    let Some(model) = models.get(&grown.model) else { return };
    let leaf_share = model.leaf_season.share(season.wrapped() + tree.season_shift());
    let stands = StandsInWind {
        place: at.translation(),
        scale: uniform_scale(at),
        world_from_local: world_from_local(at),
        canopy: canopy.copied().unwrap_or_default().0,
        leaf_share: (leaf_share * LEAF_STEPS).round() / LEAF_STEPS,
    };
    let is_known = measuring
        .tip_of
        .as_ref()
        .is_some_and(|(of, id, stood)| Arc::ptr_eq(of, response) && (*id, *stood) == (grown.model.id(), stands));
    if is_known {
        return;
    }
    measuring.tip_of = Some((response.clone(), grown.model.id(), stands));
    measuring.tip_name = species.get(tree.species.id()).map(|baked| baked.species.name.clone()).unwrap_or_default();
    let (response, model) = (response.clone(), model.clone());
    measuring.tip = Some(spawn_work(move || TipMotion::of(&model, &response, &stands)));
}

/// Adds what the frame has cost.
pub(super) fn note_costs(
    time: Res<Time<Real>>,
    times: Option<Res<SystemTimes>>,
    trees: TreesByLod,
    mut workbench: ResMut<Workbench>,
) {
    let systems = times.map(|times| times.iter().collect()).unwrap_or_default();
    let frame = Frame { length: time.delta(), systems, trees: trees.count().0, bytes: trees.table_bytes() };
    workbench.bypass_change_detection().costs.add(frame);
}

/// Counts what the trees of each species cost. It looks at every tree: to be called now and then.
pub(super) fn note_species_costs(
    mut workbench: ResMut<Workbench>,
    trees: Query<(&Tree, &Grown)>,
    models: Res<Assets<TreeModel>>,
    species: Res<SpeciesModels>,
) {
    let mut costs: BTreeMap<&str, SpeciesCost> = BTreeMap::new();
    for (tree, grown) in &trees {
        let known = species.get(tree.species.id()).zip(models.get(&grown.model));
        let Some((baked, model)) = known else { continue };
        let cost = costs.entry(&baked.species.name).or_default();
        cost.trees += 1;
        cost.beams += model.beams.len();
        cost.triangles += (model.wood.indices.len() + model.leaves.indices.len()) / 3;
    }
    let named = costs.into_iter().map(|(name, cost)| SpeciesCost { name: name.to_owned(), ..cost });
    workbench.bypass_change_detection().costs.set_species(named.collect());
}

/// An arrow of the wind about the turntable.
#[derive(Component)]
pub(super) struct StageArrow;

/// Places of the arrows along each axis, and between them, m.
const ARROWS: [i32; 3] = [5, 3, 3];
const BETWEEN_M: f32 = 4.0;

/// Shows or hides the arrows.
pub(super) fn show_arrows(
    mut commands: Commands,
    workbench: Res<Workbench>,
    gizmos: Option<ResMut<WindGizmos>>,
    arrows: Query<Entity, With<StageArrow>>,
) {
    let wanted = workbench.stage.shows_wind && workbench.is_open;
    if wanted != arrows.is_empty() {
        return;
    }
    if let Some(mut gizmos) = gizmos {
        gizmos.enabled = wanted;
    }
    if !wanted {
        arrows.iter().for_each(|arrow| commands.entity(arrow).despawn());
        return;
    }
    let [across, up, deep] = ARROWS;
    for x in 0..across {
        for y in 0..up {
            for z in 0..deep {
                let middle = Vec3::new((across - 1) as f32, 0.0, (deep - 1) as f32) * 0.5;
                let place = (Vec3::new(x as f32, y as f32 + 0.5, z as f32) - middle) * BETWEEN_M;
                commands.spawn((StageArrow, WindCell::above(0.0), Transform::from_translation(place)));
            }
        }
    }
}
