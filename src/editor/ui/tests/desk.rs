//! Panels driven by events, without a window. Controls are found by the names that screen readers read out.

use crate::{
    editor::{
        costs::{Costs, Frame as CostFrame, SpeciesCost},
        ground_desk::GroundDesk,
        ground_variogram::GroundVariogram,
        land_pose::LandPose,
        live_settings::LiveSettings,
        quadrat_histogram::QuadratHistogram,
        scene_view::{SceneView, tests::view},
        session::Session,
        spectrum::Band,
        stage::Stage,
        tip_motion::TipMotion,
        ui::{
            Drawn, GroundFacts, LevelSettings, LevelTables, Panel, Subjects, TreeFacts, UiState, WindFacts, WoodsFacts,
            draw, wind_table,
        },
        wind_measures::WindMeasures,
        woods::Woods,
    },
    forest::ForestSettings,
    render::LevelOfDetail,
    terrain::{TurningBands, TurningBandsSettings},
    tree::{Season, Species},
    wind::{FieldSettings, Wind, WindField},
};
use bevy::math::Vec2;
use bevy_egui::egui::{
    Context, Event, FullOutput, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, Shape,
    accesskit::{Node, Role},
    epaint::ClippedShape,
    pos2,
};
use std::{fs, time::Duration};

/// Windows that the panels have to fit: width and height, pixels, and pixels of a point.
pub const WINDOWS: [(f32, f32, f32); 3] = [(1280.0, 720.0, 1.0), (3840.0, 2160.0, 2.0), (1280.0, 720.0, 0.75)];

/// Panels with all that they show.
pub struct Desk {
    _folder: tempfile::TempDir,
    pub context: Context,
    pub state: UiState,
    pub session: Session<Species>,
    pub woods: Woods,
    pub histogram: Option<Result<QuadratHistogram, String>>,
    pub ground: GroundDesk,
    pub variogram: Option<GroundVariogram>,
    pub pose: LandPose,
    pub view: Option<SceneView>,
    pub stage: Stage,
    pub season: Season,
    pub wind: LiveSettings<Wind>,
    pub levels: LiveSettings<LevelSettings>,
    pub tree: TreeFacts,
    pub is_exporting: bool,
    pub planted_share: Option<f32>,
    measures: WindMeasures,
    tip: TipMotion,
    costs: Costs,
    pub is_frozen: bool,
    pub size: (f32, f32, f32),
    output: Option<FullOutput>,
    time_s: f64,
}

/// The motion of some tree.
fn tip() -> TipMotion {
    let series: Vec<[f64; 2]> = (0..256).map(|sample| [0.5 * f64::from(sample), 0.1]).collect();
    let spectrum = vec![Band { frequency_hz: 0.1, value: 1e-3 }, Band { frequency_hz: 1.0, value: 1e-4 }];
    TipMotion { height_m: 16.2, along: series.clone(), across: series, spectrum, own: vec![("trunk", 0.4)] }
}

impl Desk {
    pub fn new(species: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format!("{species}.species.ron"));
        let shipped = format!("{}/assets/species/{species}.species.ron", env!("CARGO_MANIFEST_DIR"));
        fs::copy(shipped, &path).unwrap();
        let shipped = |path: &str| {
            let from = format!("{}/assets/{path}", env!("CARGO_MANIFEST_DIR"));
            let to = folder.path().join(path.rsplit('/').next().unwrap());
            fs::copy(from, &to).unwrap();
            to
        };
        let woods = Woods::new(Session::open(&shipped("forests/mixed.forest.ron")).unwrap());
        let histogram = Some(QuadratHistogram::of(woods.plan(), 0));
        let random = Session::new(&folder.path().join("hills.bands.ron"), TurningBandsSettings::default());
        let spline = Session::open(&shipped("terrain/five_patches.ground.ron")).unwrap();
        let field = TurningBands::new(random.document()).unwrap();
        let variogram = GroundVariogram::of(&field);
        let context = Context::default();
        context.enable_accesskit();
        let mut costs = Costs::default();
        let systems = vec![("select_lods", Duration::from_micros(40)), ("pose_trees", Duration::from_micros(9))];
        (0..90).for_each(|_| {
            let length = Duration::from_millis(16);
            costs.add(CostFrame { length, systems: systems.clone(), trees: [12, 345, 6789], bytes: 1 << 22 });
        });
        let of =
            |name: &str, trees| SpeciesCost { name: name.into(), trees, beams: 900 * trees, triangles: 34_567 * trees };
        costs.set_species(vec![of("oak", 321), of("scots_pine", 1234)]);
        let field = WindField::synthesise(&FieldSettings::default()).unwrap();
        let mut desk = Self {
            _folder: folder,
            context,
            state: UiState::default(),
            session: Session::open(&path).unwrap(),
            woods,
            histogram,
            ground: GroundDesk::new(random, spline),
            variogram,
            pose: LandPose::default(),
            view: None,
            stage: Stage::default(),
            season: Season::SUMMER,
            wind: LiveSettings::new(Wind::default()),
            levels: LiveSettings::new(LevelSettings {
                levels: LevelOfDetail::default(),
                forest: Some(ForestSettings::default()),
            }),
            tree: TreeFacts {
                height_m: 16.2,
                beams: 1234,
                triangles: 34567,
                grown_in_ms: Some(84.0),
                is_growing: false,
            },
            is_exporting: false,
            planted_share: None,
            tip: tip(),
            measures: WindMeasures::of(&field, 10.0),
            costs,
            is_frozen: false,
            size: WINDOWS[0],
            output: None,
            time_s: 0.0,
        };
        // Panels know their sizes after the first frame.
        for _ in 0..3 {
            desk.frame(Vec::new());
        }
        desk
    }

    /// Opens a panel whose picture is of a wood or of ground, seen aslant from above.
    pub fn open(&mut self, panel: Panel) {
        self.state.panel = panel;
        for _ in 0..3 {
            let picture = self.frame(Vec::new()).picture;
            let [min, max] = [picture.min, picture.max].map(|corner| Vec2::new(corner.x, corner.y));
            self.view = Some(view(|_| 0.0, min, max));
        }
    }

    pub fn frame(&mut self, events: Vec<Event>) -> Drawn {
        let (width, height, scale) = self.size;
        let mut input = RawInput { events, time: Some(self.time_s), ..RawInput::default() };
        input.screen_rect = Some(Rect::from_min_max(pos2(0.0, 0.0), pos2(width / scale, height / scale)));
        input.viewports.entry(input.viewport_id).or_default().native_pixels_per_point = Some(scale);
        self.time_s += 0.1;
        let tables = LevelTables::new(&self.levels.value().levels, &ForestSettings::default());
        let wind_table = wind_table(self.wind.value());
        let tree = self.tree.clone();
        let legend = [("order 0: 3 beams".to_owned(), [0.9, 0.8, 0.2])];
        let mut drawn = None;
        let context = self.context.clone();
        let output = context.run_ui(input, |ui| {
            let subjects = Subjects {
                session: &mut self.session,
                stage: &mut self.stage,
                season: &mut self.season,
                wind: &mut self.wind,
                wind_table: &wind_table,
                wind_facts: WindFacts {
                    measures: Some(&self.measures),
                    tip: Some(("oak", &self.tip)),
                    is_changing: false,
                },
                woods: &mut self.woods,
                woods_facts: WoodsFacts {
                    histogram: self.histogram.as_ref(),
                    stems: 4321,
                    is_growing: true,
                    planted_share: self.planted_share,
                },
                ground: &mut self.ground,
                ground_facts: GroundFacts { variogram: self.variogram.as_ref(), is_building: true },
                pose: &mut self.pose,
                view: self.view.as_ref(),
                levels: &mut self.levels,
                level_tables: &tables,
                is_frozen: &mut self.is_frozen,
                costs: &self.costs,
                tree: &tree,
                is_exporting: self.is_exporting,
                legend: &legend,
                has_turntable: true,
            };
            drawn = Some(draw(ui, &mut self.state, subjects));
        });
        self.output = Some(output);
        drawn.unwrap()
    }

    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        for pressed in [true, false] {
            let held = Event::ModifiersChanged(if pressed { modifiers } else { Modifiers::NONE });
            self.frame(vec![held, Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }]);
        }
    }

    pub fn click(&mut self, at: Pos2) {
        self.frame(vec![Event::PointerMoved(at)]);
        for pressed in [true, false] {
            self.frame(vec![Self::button(at, pressed)]);
        }
        self.frame(Vec::new());
    }

    /// Presses and releases the main button, and returns what came of it.
    pub fn press_and_see(&mut self, at: Pos2) -> Drawn {
        self.frame(vec![Event::PointerMoved(at)]);
        self.frame(vec![Self::button(at, true)]);
        self.frame(vec![Self::button(at, false)])
    }

    pub fn button(at: Pos2, pressed: bool) -> Event {
        Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
    }

    /// Drags with the main button through points of the screen.
    pub fn drag(&mut self, through: &[Pos2]) {
        let (first, last) = (through[0], through[through.len() - 1]);
        self.frame(vec![Event::PointerMoved(first)]);
        self.frame(vec![Self::button(first, true)]);
        for at in through {
            self.frame(vec![Event::PointerMoved(*at)]);
        }
        self.frame(vec![Self::button(last, false)]);
        self.frame(Vec::new());
    }

    /// What a screen reader is told: role, name, place.
    pub fn nodes(&self) -> Vec<(Role, String, Rect)> {
        self.controls().into_iter().map(|(node, name, place)| (node.role(), name, place)).collect()
    }

    /// The same, with all that is told of each.
    pub fn controls(&self) -> Vec<(Node, String, Rect)> {
        let update = self.output.as_ref().and_then(|output| output.platform_output.accesskit_update.clone()).unwrap();
        let nodes: std::collections::BTreeMap<_, Node> = update.nodes.iter().cloned().collect();
        let own_name = |node: &Node| node.label().or(node.value()).unwrap_or_default().to_owned();
        let name = |node: &Node| {
            let by: Vec<String> = node.labelled_by().iter().filter_map(|id| nodes.get(id)).map(own_name).collect();
            if by.is_empty() { own_name(node) } else { by.join(" ") }
        };
        let place = |node: &Node| {
            let at = node.bounds()?;
            Some(Rect::from_min_max(pos2(at.x0 as f32, at.y0 as f32), pos2(at.x1 as f32, at.y1 as f32)))
        };
        nodes.values().filter_map(|node| Some((node.clone(), name(node), place(node)?))).collect()
    }

    /// What has the focus, as screen readers are told.
    pub fn focused_control(&self) -> Option<(Node, String, Rect)> {
        let update = self.output.as_ref()?.platform_output.accesskit_update.as_ref()?;
        let (_, node) = update.nodes.iter().find(|(id, _)| *id == update.focus)?;
        let bounds = node.bounds()?;
        self.controls().into_iter().find(|(own, ..)| own.bounds() == Some(bounds) && own.role() == node.role())
    }

    /// All texts that are drawn.
    pub fn texts(&self) -> Vec<String> {
        let shapes = self.output.iter().flat_map(|output| &output.shapes);
        let text = |shape: &ClippedShape| match &shape.shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        };
        shapes.filter_map(text).collect()
    }

    pub fn find(&self, role: Role, name: &str) -> Rect {
        let found = self.nodes().into_iter().find(|(own, text, _)| *own == role && text == name);
        found.unwrap_or_else(|| panic!("no {role:?} `{name}` in {:#?}", self.nodes())).2
    }

    pub fn press(&mut self, name: &str) {
        let at = self.find(Role::Button, name).center();
        self.click(at);
    }

    /// Texts that are cut off at the left or the right.
    pub fn clipped_texts(&self) -> Vec<String> {
        let mut cut = Vec::new();
        for clipped in self.output.iter().flat_map(|output| &output.shapes) {
            let Shape::Text(text) = &clipped.shape else { continue };
            let at = text.visual_bounding_rect();
            let (clip, is_seen) = (clipped.clip_rect, at.intersects(clipped.clip_rect));
            if is_seen && (at.left() < clip.left() - 1.0 || at.right() > clip.right() + 1.0 || text.galley.elided) {
                cut.push(format!("{} at {at:?} in {clip:?}", text.galley.text()));
            }
        }
        cut
    }
}
