//! The workbench as a resource.

use std::path::{Path, PathBuf};

use crate::{
    background::WorkerPanic,
    editor::{
        costs::Costs,
        document::Document,
        fields::Section,
        file_session::{FileSession, Message},
        ground_desk::{GroundDesk, GroundKind},
        ground_variogram::GroundVariogram,
        land_pose::LandPose,
        live_settings::LiveSettings,
        plan_element::Element,
        quadrat_histogram::QuadratHistogram,
        scene_view::SceneView,
        session::Session,
        stage::Stage,
        steps::Steps,
        tip_motion::TipMotion,
        ui::{LevelSettings, LevelTables, Panel, TreeFacts, UiState, dialogs::Dialog, wind_table},
        wind_measures::WindMeasures,
        woods::Woods,
    },
    forest::ForestSettings,
    render::LevelOfDetail,
    scatter::ForestPlan,
    terrain::{SplineGroundSettings, TurningBandsSettings},
    tree::Species,
    wind::Wind,
};
use bevy::prelude::*;
use bevy_egui::egui::Rect;

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
    pub(super) session: Session<Species>,
    pub(super) woods: Woods,
    pub(super) ground: GroundDesk,
    /// From where a wood or ground is looked at, on the turntable.
    pub(super) pose: LandPose,
    pub(super) land: LandFacts,
    pub(super) ui: UiState,
    /// The assets that show the species as it is edited, and as it is in its file.
    pub(super) shown: Handle<Species>,
    pub(super) saved: Handle<Species>,
    pub(super) has_turntable: bool,
    pub(super) tree: TreeFacts,
    pub(super) legend: Vec<(String, [f32; 3])>,
    pub(super) measures: Option<WindMeasures>,
    /// What a tree is called, and how its top moves.
    pub(super) tip: Option<(String, TipMotion)>,
    /// Where the pointer is in the picture, points.
    pub(super) pointer: Option<Vec2>,
    /// The tree that it pointed at last, while the panel of the wind was open.
    pub(super) pointed_tree: Option<Entity>,
    pub(super) costs: Costs,
    pub(super) is_cancelled: bool,
    pub(super) is_quitting: bool,
    /// Where the tree is to be exported to.
    pub(super) export_to: Option<PathBuf>,
    pub(super) is_exporting: bool,
    pub(super) is_export_cancelled: bool,
    /// What the panels leave free, in points; and how many pixels a point has.
    pub(super) picture: Option<(Rect, f32)>,
    pub(super) wind: LiveSettings<Wind>,
    pub(super) levels: LiveSettings<LevelSettings>,
    pub(super) wind_table: Section,
    pub(super) level_tables: LevelTables,
}

/// What is known of the wood and the ground that are shown.
#[derive(Default)]
pub(super) struct LandFacts {
    /// The picture, if there is one.
    pub view: Option<SceneView>,
    pub histogram: Option<Result<QuadratHistogram, String>>,
    pub stems: usize,
    pub is_growing: bool,
    /// The share of the forest that is planted as a changed plan says; none where all is.
    pub planted_share: Option<f32>,
    pub variogram: Option<GroundVariogram>,
    pub is_building: bool,
}

/// The session of a file; of a new one where it cannot be read.
fn session_of<T: Document>(path: Option<&Path>, new: T) -> Session<T> {
    let Some(path) = path else { return Session::new(&PathBuf::from(format!("new{}", T::EXTENSION)), new) };
    Session::open(path).unwrap_or_else(|error| {
        warn!("workbench: {error}; a new {} is begun", T::NAME);
        Session::new(path, new)
    })
}

impl Workbench {
    /// A workbench with files; with new ones, where they cannot be read. `ground` is of either kind.
    pub(super) fn new(species: Option<&Path>, plan: Option<&Path>, ground: Option<&Path>, has_turntable: bool) -> Self {
        let session = session_of(species, Species { name: "new".into(), ..Species::default() });
        let is_spline = |path: &&Path| path.to_string_lossy().ends_with(<SplineGroundSettings as Document>::EXTENSION);
        let random = session_of(ground.filter(|path| !is_spline(path)), TurningBandsSettings::default());
        let spline = session_of(ground.filter(is_spline), SplineGroundSettings::default());
        let mut ground_desk = GroundDesk::new(random, spline);
        ground_desk.is_shown = has_turntable;
        if ground.is_some_and(|path| is_spline(&path)) {
            ground_desk.kind = GroundKind::Spline;
        }
        Self {
            is_open: false,
            panel: Panel::default(),
            stage: Stage::default(),
            is_frozen: false,
            session,
            woods: Woods::new(session_of(plan, ForestPlan::default())),
            ground: ground_desk,
            pose: LandPose::default(),
            land: LandFacts::default(),
            ui: UiState::default(),
            shown: Handle::default(),
            saved: Handle::default(),
            has_turntable,
            tree: TreeFacts::default(),
            legend: Vec::new(),
            measures: None,
            tip: None,
            pointer: None,
            pointed_tree: None,
            costs: Costs::default(),
            is_cancelled: false,
            is_quitting: false,
            export_to: None,
            is_exporting: false,
            is_export_cancelled: false,
            picture: None,
            wind: LiveSettings::new(Wind::default()),
            levels: LiveSettings::new(LevelSettings::default()),
            wind_table: wind_table(&Wind::default()),
            level_tables: LevelTables::new(&LevelOfDetail::default(), &ForestSettings::default()),
        }
    }

    /// Opens the species of a file; asks first where changes would be lost.
    pub fn open_file(&mut self, path: &Path) {
        self.session.open_another(path);
    }

    /// Opens the plan of a forest; asks first where changes would be lost.
    pub fn open_plan(&mut self, path: &Path) {
        self.woods.session.open_another(path);
        self.show_whole_plan();
    }

    /// Opens ground of either kind, by the ending of its file; asks first where changes would be lost.
    pub fn open_ground(&mut self, path: &Path) {
        self.ground.open(path);
    }

    /// Looks at the whole plan from above, at an angle over the level, degrees.
    pub fn look_at_plan(&mut self, rise_deg: f32) {
        self.show_whole_plan();
        self.look_at_place(self.pose.middle, self.pose.distance_m, rise_deg);
    }

    /// Looks at a place (x, z), m, from a distance, m, at an angle over the level, degrees.
    pub fn look_at_place(&mut self, place: Vec2, distance_m: f32, rise_deg: f32) {
        self.pose = LandPose { middle: place, distance_m, rise_rad: rise_deg.to_radians(), ..self.pose };
    }

    fn show_whole_plan(&mut self) {
        let plan = self.woods.plan();
        self.pose.show(Element::all(plan).flat_map(|element| element.handles(plan)).collect::<Vec<_>>());
    }

    /// Everything that has a file.
    pub(super) fn files(&mut self) -> [(Panel, &mut dyn FileSession); 4] {
        [
            (Panel::Species, &mut self.session as &mut dyn FileSession),
            (Panel::Woods, &mut self.woods.session),
            (Panel::Ground, &mut self.ground.random),
            (Panel::Ground, &mut self.ground.spline),
        ]
    }

    /// Whether the program may end: else the first file with unsaved changes is shown, and asked about.
    pub(super) fn may_quit(&mut self) -> bool {
        let asks = self.files().into_iter().position(|(_, files)| !files.may_quit());
        let Some(number) = asks else { return true };
        self.panel = [Panel::Species, Panel::Woods, Panel::Ground, Panel::Ground][number];
        match number {
            2 => self.ground.kind = GroundKind::Random,
            3 => self.ground.kind = GroundKind::Spline,
            _ => {}
        }
        false
    }

    /// The species as it is edited.
    pub fn species(&self) -> &Species {
        self.session.document()
    }

    /// Changes the species; `step` is what undoing it is called.
    pub fn change(&mut self, species: Species, step: &str) {
        self.session.change(species, step);
        self.session.end_gesture();
    }

    /// Undoes everything.
    pub fn undo_all(&mut self) {
        fn undo_all(steps: &mut dyn Steps) {
            while steps.undo_step().is_some() {
                steps.undo();
            }
        }
        self.files().into_iter().for_each(|(_, files)| undo_all(files));
        undo_all(&mut self.wind);
        undo_all(&mut self.levels);
    }

    /// Tells once that work in the background has failed, and what stays.
    pub(super) fn tell_panic(&mut self, panic: &WorkerPanic, stays: &str) {
        error!("workbench: {panic}; {stays}");
        let message = Some(Message::Failed(format!("{panic}; {stays}")));
        match self.panel {
            Panel::Woods => self.woods.session.message = message,
            Panel::Ground => self.ground.tell(message),
            Panel::Species | Panel::Wind | Panel::Levels => self.session.message = message,
        }
    }

    /// Whether what is asked for is there: the tree, the wood or the ground as it is edited, and what is measured of it.
    pub fn is_settled(&self) -> bool {
        let is_measured = match self.panel {
            Panel::Wind => self.measures.is_some() && self.tip.is_some(),
            Panel::Woods => !self.land.is_growing && !self.land.is_building && self.land.histogram.is_some(),
            Panel::Ground => !self.land.is_building && self.ground.plan().is_some(),
            Panel::Species | Panel::Levels => true,
        };
        if self.panel.is_of_land() {
            return is_measured && self.land.view.is_some();
        }
        !self.tree.is_growing && is_measured && self.picture.is_some()
    }

    /// Shows the fields that have these letters; all, if there are none.
    pub fn find_field(&mut self, letters: &str) {
        letters.clone_into(&mut self.ui.filter);
    }

    /// Shows the list of shortcuts, or another dialog.
    pub fn show_dialog(&mut self, dialog: Option<Dialog>) {
        self.ui.dialog = dialog;
    }
}
