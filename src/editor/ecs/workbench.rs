//! The workbench as a resource, and the system that draws its panels.

use std::path::{Path, PathBuf};

use crate::{
    editor::{
        costs::Costs,
        fields::Section,
        session::Session,
        stage::Stage,
        tip_motion::TipMotion,
        ui::{self, LevelTables, Panel, Subjects, TreeFacts, UiState, WindFacts, wind_table},
        wind_measures::WindMeasures,
    },
    forest::ForestSettings,
    render::LevelOfDetail,
    sway::ActiveSway,
    tree::{Season, Species},
    wind::{ActiveWind, Wind},
};
use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts,
    egui::{Id, LayerId, Rect, Ui, UiBuilder},
};

/// The workbench: what is edited, and what is shown of it.
#[derive(Resource)]
pub struct Workbench {
    /// Whether its panels are there.
    pub is_open: bool,
    /// Which panel is open.
    pub panel: Panel,
    /// What stands on the turntable.
    pub stage: Stage,
    /// Whether levels, streaming and culling stay as they are, while the camera goes elsewhere.
    pub is_frozen: bool,
    pub(super) session: Session,
    ui: UiState,
    /// The assets that show the species as it is edited, and as it is in its file.
    pub(super) shown: Handle<Species>,
    pub(super) saved: Handle<Species>,
    pub(super) has_turntable: bool,
    pub(super) tree: TreeFacts,
    pub(super) legend: Vec<(String, [f32; 3])>,
    pub(super) measures: Option<WindMeasures>,
    pub(super) tip: Option<TipMotion>,
    pub(super) costs: Costs,
    pub(super) is_cancelled: bool,
    pub(super) is_quitting: bool,
    /// What the panels leave free, in points; and how many pixels a point has.
    pub(super) picture: Option<(Rect, f32)>,
    wind_table: Section,
    level_tables: LevelTables,
}

impl Workbench {
    /// A workbench with a species from a file; with the default species, if the file cannot be read.
    pub(super) fn new(path: Option<&Path>, has_turntable: bool) -> Self {
        let path = path.map_or_else(|| PathBuf::from("new.species.ron"), Path::to_owned);
        let new = || Session::new(&path, Species { name: "new".into(), ..Species::default() });
        let session = Session::open(&path).unwrap_or_else(|error| {
            warn!("workbench: {error}; a new species is begun");
            new()
        });
        Self {
            is_open: false,
            panel: Panel::default(),
            stage: Stage::default(),
            is_frozen: false,
            session,
            ui: UiState::default(),
            shown: Handle::default(),
            saved: Handle::default(),
            has_turntable,
            tree: TreeFacts::default(),
            legend: Vec::new(),
            measures: None,
            tip: None,
            costs: Costs::default(),
            is_cancelled: false,
            is_quitting: false,
            picture: None,
            wind_table: wind_table(&Wind::default()),
            level_tables: LevelTables::new(&LevelOfDetail::default(), &ForestSettings::default()),
        }
    }

    /// Opens the species of a file; asks first where changes would be lost.
    pub fn open_file(&mut self, path: &Path) {
        self.session.open_another(path);
    }

    /// The species as it is edited.
    pub fn species(&self) -> &Species {
        self.session.species()
    }

    /// Changes the species; `step` is what undoing it is called.
    pub fn change(&mut self, species: Species, step: &str) {
        self.session.change(species, step);
        self.session.end_gesture();
    }

    /// Undoes everything.
    pub fn undo_all(&mut self) {
        while self.session.history().undo_step().is_some() {
            self.session.undo();
        }
    }

    /// Whether what is asked for is there: the tree as it is edited, and, in the panel of the wind, what is measured of it.
    pub fn is_settled(&self) -> bool {
        let is_measured = self.panel != Panel::Wind || (self.measures.is_some() && self.tip.is_some());
        !self.tree.is_growing && is_measured && self.picture.is_some()
    }

    /// Shows the fields that have these letters; all, if there are none.
    pub fn find_field(&mut self, letters: &str) {
        letters.clone_into(&mut self.ui.filter);
    }

    /// Shows the list of shortcuts, or another dialog.
    pub fn show_dialog(&mut self, dialog: Option<ui::dialogs::Dialog>) {
        self.ui.dialog = dialog;
    }
}

/// What the panels edit besides the species.
#[derive(SystemParam)]
pub(super) struct Edited<'w, 's> {
    season: ResMut<'w, Season>,
    wind: ResMut<'w, Wind>,
    levels: ResMut<'w, LevelOfDetail>,
    forests: Query<'w, 's, &'static mut ForestSettings>,
    active_wind: Res<'w, ActiveWind>,
    sway: Res<'w, ActiveSway>,
}

/// Draws the panels, and takes over what was changed in them. What was not changed does not count as changed.
pub(super) fn draw_panels(mut contexts: EguiContexts, mut workbench: ResMut<Workbench>, edited: Edited) {
    let Ok(context) = contexts.ctx_mut().cloned() else { return };
    let Edited { mut season, mut wind, mut levels, mut forests, active_wind, sway } = edited;
    let whole = UiBuilder::new().layer_id(LayerId::background()).max_rect(context.viewport_rect());
    let mut ui = Ui::new(context.clone(), Id::new("windwood workbench"), whole);
    let workbench = workbench.bypass_change_detection();
    let (mut new_season, mut new_wind, mut new_levels) = (*season, wind.clone(), levels.clone());
    let forest = forests.iter_mut().next();
    let mut new_forest = forest.as_ref().map(|forest| (**forest).clone());
    workbench.ui.panel = workbench.panel;
    let drawn = ui::draw(
        &mut ui,
        &mut workbench.ui,
        Subjects {
            session: &mut workbench.session,
            stage: &mut workbench.stage,
            season: &mut new_season,
            wind: &mut new_wind,
            wind_table: &workbench.wind_table,
            wind_facts: WindFacts {
                measures: workbench.measures.as_ref(),
                tip: workbench.tip.as_ref(),
                is_changing: !active_wind.is_settled() || !sway.is_settled(),
            },
            levels: &mut new_levels,
            forest: new_forest.as_mut(),
            level_tables: &workbench.level_tables,
            is_frozen: &mut workbench.is_frozen,
            costs: &workbench.costs,
            tree: &workbench.tree,
            legend: &workbench.legend,
            has_turntable: workbench.has_turntable,
        },
    );
    workbench.panel = workbench.ui.panel;
    workbench.picture = Some((drawn.picture, context.pixels_per_point()));
    workbench.is_quitting |= drawn.is_quitting;
    workbench.is_cancelled |= drawn.is_cancelled;
    season.set_if_neq(new_season);
    wind.set_if_neq(new_wind);
    levels.set_if_neq(new_levels);
    if let Some((mut forest, new)) = forest.zip(new_forest) {
        forest.set_if_neq(new);
    }
}
