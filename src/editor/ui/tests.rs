//! The panels driven by events, without a window. Controls are found by the names that screen readers read out.

use super::*;
use crate::{
    editor::{costs::Frame as CostFrame, stage::Arrangement, wind_measures::WindMeasures},
    tree::{Growth, Species},
    wind::{FieldSettings, WindField},
};
use bevy_egui::egui::{
    Context, Event, FullOutput, Key, Modifiers, PointerButton, Pos2, RawInput, Shape, Theme, ThemePreference,
    accesskit::{Node, Role},
    pos2,
};
use std::{fs, time::Duration};

/// Windows that the panels have to fit: width and height, pixels, and pixels of a point.
const WINDOWS: [(f32, f32, f32); 3] = [(1280.0, 720.0, 1.0), (3840.0, 2160.0, 2.0), (1280.0, 720.0, 0.75)];

/// Panels with all that they show.
struct Desk {
    _folder: tempfile::TempDir,
    context: Context,
    state: UiState,
    session: Session,
    stage: Stage,
    season: Season,
    wind: Wind,
    levels: LevelOfDetail,
    forest: ForestSettings,
    measures: WindMeasures,
    costs: Costs,
    is_frozen: bool,
    size: (f32, f32, f32),
    output: Option<FullOutput>,
    time_s: f64,
}

impl Desk {
    fn new(species: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format!("{species}.species.ron"));
        let shipped = format!("{}/assets/species/{species}.species.ron", env!("CARGO_MANIFEST_DIR"));
        fs::copy(shipped, &path).unwrap();
        let context = Context::default();
        context.enable_accesskit();
        let mut costs = Costs::default();
        let systems = vec![("select_lods", Duration::from_micros(40)), ("pose_trees", Duration::from_micros(9))];
        (0..90).for_each(|_| {
            let length = Duration::from_millis(16);
            costs.add(CostFrame { length, systems: systems.clone(), trees: [12, 345, 6789], bytes: 1 << 22 });
        });
        let field = WindField::synthesise(&FieldSettings::default()).unwrap();
        let mut desk = Self {
            _folder: folder,
            context,
            state: UiState::default(),
            session: Session::open(&path).unwrap(),
            stage: Stage::default(),
            season: Season::SUMMER,
            wind: Wind::default(),
            levels: LevelOfDetail::default(),
            forest: ForestSettings::default(),
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

    fn frame(&mut self, events: Vec<Event>) -> Drawn {
        let (width, height, scale) = self.size;
        let mut input = RawInput { events, time: Some(self.time_s), ..RawInput::default() };
        input.screen_rect = Some(Rect::from_min_max(pos2(0.0, 0.0), pos2(width / scale, height / scale)));
        input.viewports.entry(input.viewport_id).or_default().native_pixels_per_point = Some(scale);
        self.time_s += 0.1;
        let tables = LevelTables::new(&self.levels, &self.forest);
        let wind_table = wind_table(&self.wind);
        let tree =
            TreeFacts { height_m: 16.2, beams: 1234, triangles: 34567, grown_in_ms: Some(84.0), is_growing: false };
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
                wind_facts: WindFacts { measures: Some(&self.measures), tip: None, is_changing: false },
                levels: &mut self.levels,
                forest: Some(&mut self.forest),
                level_tables: &tables,
                is_frozen: &mut self.is_frozen,
                costs: &self.costs,
                tree: &tree,
                legend: &legend,
                has_turntable: true,
            };
            drawn = Some(draw(ui, &mut self.state, subjects));
        });
        self.output = Some(output);
        drawn.unwrap()
    }

    fn key(&mut self, modifiers: Modifiers, key: Key) {
        for pressed in [true, false] {
            self.frame(vec![Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }]);
        }
    }

    fn click(&mut self, at: Pos2) {
        self.frame(vec![Event::PointerMoved(at)]);
        for pressed in [true, false] {
            let button = PointerButton::Primary;
            self.frame(vec![Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE }]);
        }
        self.frame(Vec::new());
    }

    /// What a screen reader is told: role, name, place.
    fn nodes(&self) -> Vec<(Role, String, Rect)> {
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
        nodes.values().filter_map(|node| Some((node.role(), name(node), place(node)?))).collect()
    }

    fn find(&self, role: Role, name: &str) -> Rect {
        let found = self.nodes().into_iter().find(|(own, text, _)| *own == role && text == name);
        found.unwrap_or_else(|| panic!("no {role:?} `{name}` in {:#?}", self.nodes())).2
    }

    fn press(&mut self, name: &str) {
        let at = self.find(Role::Button, name).center();
        self.click(at);
    }

    /// Texts that are cut off at the left or the right.
    fn clipped_texts(&self) -> Vec<String> {
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

const ROLES_WITH_NAMES: [Role; 6] =
    [Role::Button, Role::CheckBox, Role::Slider, Role::SpinButton, Role::ComboBox, Role::TextInput];

#[test]
fn every_panel_opens_by_its_keys_and_leaves_the_tree_in_sight() {
    for size in WINDOWS {
        let mut desk = Desk::new("oak");
        desk.size = size;
        for (key, panel) in [(Key::Num2, Panel::Wind), (Key::Num3, Panel::Levels), (Key::Num1, Panel::Species)] {
            desk.key(Modifiers::COMMAND, key);
            let drawn = desk.frame(Vec::new());
            assert_eq!(desk.state.panel, panel);
            let whole = desk.context.viewport_rect();
            assert!(whole.contains_rect(drawn.picture), "{panel:?}: {drawn:?}");
            assert!(drawn.picture.width() > 0.35 * whole.width(), "{panel:?} in {size:?}: {drawn:?}");
            assert!(drawn.picture.height() > 0.65 * whole.height(), "{panel:?} in {size:?}: {drawn:?}");
        }
    }
}

#[test]
fn no_text_is_cut_off() {
    for size in WINDOWS {
        for species in ["oak", "impression_summer", "aono_kunii"] {
            let mut desk = Desk::new(species);
            desk.size = size;
            for panel in [Panel::Species, Panel::Wind, Panel::Levels] {
                desk.state.panel = panel;
                for _ in 0..3 {
                    desk.frame(Vec::new());
                }
                let cut = desk.clipped_texts();
                assert!(cut.is_empty(), "{species}, {panel:?}, {size:?}: {cut:#?}");
            }
        }
    }
}

#[test]
fn screen_readers_are_told_a_name_for_every_control() {
    for theme in [Theme::Dark, Theme::Light] {
        let mut desk = Desk::new("impression_summer");
        desk.context.set_theme(ThemePreference::from(theme));
        for panel in [Panel::Species, Panel::Wind, Panel::Levels] {
            desk.state.panel = panel;
            for _ in 0..2 {
                desk.frame(Vec::new());
            }
            let nodes = desk.nodes();
            let controls = nodes.iter().filter(|(role, ..)| ROLES_WITH_NAMES.contains(role));
            assert!(controls.clone().count() > 20, "{panel:?}");
            for (role, name, place) in controls {
                assert!(!name.trim().is_empty(), "{panel:?}: a {role:?} at {place:?} has no name");
            }
        }
    }
}

/// Every slider in sight is dragged, one step each; then all is taken back.
#[test]
fn every_slider_changes_the_species_and_is_undone() {
    let mut desk = Desk::new("impression_summer");
    let original = desk.session.species().clone();
    let bytes = fs::read(desk.session.path()).unwrap();
    let panel = Rect::from_min_max(pos2(0.0, 160.0), pos2(PANEL_WIDTH, 660.0));
    let sliders: Vec<(String, Rect)> = desk
        .nodes()
        .into_iter()
        .filter(|(role, _, at)| *role == Role::Slider && panel.contains_rect(*at))
        .map(|(_, name, at)| (name, at))
        .collect();
    assert!(sliders.len() > 8, "{sliders:?}");
    for (number, (name, at)) in sliders.iter().enumerate() {
        let before = desk.session.species().clone();
        let [from, to] = [0.3, 0.6].map(|share| at.left_center() + vec2(share * at.width(), 0.0));
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        desk.frame(vec![Event::PointerMoved(from)]);
        desk.frame(vec![button(from, true)]);
        for step in 1..=4 {
            desk.frame(vec![Event::PointerMoved(from.lerp(to, 0.25 * step as f32))]);
        }
        desk.frame(vec![button(to, false)]);
        desk.frame(Vec::new());
        assert_ne!(*desk.session.species(), before, "{name}");
        let mut steps = 0;
        while desk.session.history().undo_step().is_some() {
            desk.session.undo();
            steps += 1;
        }
        assert_eq!(steps, number + 1, "a drag of {name} is one step");
        (0..steps).for_each(|_| desk.session.redo());
    }
    (0..sliders.len()).for_each(|_| desk.key(Modifiers::COMMAND, Key::Z));
    assert_eq!(*desk.session.species(), original);
    desk.key(Modifiers::COMMAND, Key::S);
    assert_eq!(fs::read(desk.session.path()).unwrap(), bytes);
}

#[test]
fn fields_are_found_by_their_letters_and_reset() {
    let mut desk = Desk::new("oak");
    desk.state.filter = "density".into();
    desk.frame(Vec::new());
    let slider = desk.find(Role::Slider, "Density");
    desk.click(slider.left_center() + vec2(0.9 * slider.width(), 0.0));
    assert!(desk.session.species().wood.density_kg_m3 > 1500.0);
    assert!(desk.session.is_changed());
    desk.press("Reset Density");
    assert_eq!(desk.session.species().wood.density_kg_m3, 1000.0);
    desk.state.filter = "no such field".into();
    desk.frame(Vec::new());
    assert!(
        desk.nodes().iter().all(|(role, name, at)| *role != Role::Slider || at.left() > PANEL_WIDTH || name.is_empty())
    );
}

#[test]
fn buttons_of_the_session_do_what_they_say() {
    let mut desk = Desk::new("oak");
    let original = desk.session.species().clone();
    desk.press("Randomise");
    assert_ne!(*desk.session.species(), original);
    desk.press("Undo");
    assert_eq!(*desk.session.species(), original);
    desk.press("Redo");
    assert_ne!(*desk.session.species(), original);
    desk.press("Save");
    assert_eq!(Species::from_ron(&fs::read_to_string(desk.session.path()).unwrap()).unwrap(), *desk.session.species());
    assert!(!desk.session.is_changed());
}

#[test]
fn files_are_opened_and_saved_by_dialogs_and_broken_ones_are_told() {
    let mut desk = Desk::new("oak");
    let folder = desk.session.path().parent().unwrap().to_owned();
    fs::write(folder.join("broken.species.ron"), "(name: ").unwrap();
    desk.key(Modifiers::COMMAND, Key::O);
    assert!(matches!(desk.state.dialog, Some(Dialog::Open(_))));
    desk.press("broken");
    desk.press("Open");
    assert_eq!((desk.state.dialog.clone(), desk.session.species().name.as_str()), (None, "oak"));
    let Some(crate::editor::session::Message::Failed(error)) = &desk.session.message else { panic!("no message") };
    assert!(error.contains("broken.species.ron"), "{error}");
    desk.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    let Some(Dialog::SaveAs(field)) = &mut desk.state.dialog else { panic!("no dialog") };
    field.path = folder.join("elm").display().to_string();
    desk.frame(Vec::new());
    desk.frame(Vec::new());
    // The panel has a button of that name, too.
    let is_in_dialog = |(role, name, at): &(Role, String, Rect)| {
        *role == Role::Button && name == "Save" && at.center().x > PANEL_WIDTH
    };
    let save = desk.nodes().into_iter().find(is_in_dialog).unwrap().2.center();
    desk.click(save);
    assert!(folder.join("elm.species.ron").exists(), "{:?}", desk.session.message);
    desk.key(Modifiers::COMMAND, Key::O);
    desk.key(Modifiers::NONE, Key::Escape);
    desk.frame(Vec::new());
    assert_eq!(desk.state.dialog, None);
}

#[test]
fn nothing_else_is_done_while_a_question_waits() {
    let mut desk = Desk::new("oak");
    desk.press("Randomise");
    assert!(!desk.session.may_quit());
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    let changed = desk.session.species().clone();
    desk.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(*desk.session.species(), changed);
    desk.press("Cancel");
    assert_eq!(desk.session.question, None);
    assert!(!desk.session.may_quit());
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    let at = desk.find(Role::Button, "Do not save").center();
    desk.frame(vec![Event::PointerMoved(at)]);
    let press =
        |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    desk.frame(vec![press(true)]);
    assert!(desk.frame(vec![press(false)]).is_quitting);
}

#[test]
fn the_stage_is_set_by_its_bar() {
    let mut desk = Desk::new("oak");
    for (view, name, _) in crate::editor::diagram::View::ALL.into_iter().rev() {
        desk.press(name);
        assert_eq!(desk.stage.view, view);
    }
    desk.press("Ages");
    assert_eq!(desk.stage.arrangement, Arrangement::Ages);
    let compare = desk.find(Role::CheckBox, "Beside the saved").center();
    desk.click(compare);
    assert!(desk.stage.compares);
    desk.key(Modifiers::COMMAND, Key::T);
    assert!(desk.stage.turns);
}

#[test]
fn the_wind_and_the_levels_are_set_by_their_panels() {
    let mut desk = Desk::new("oak");
    desk.key(Modifiers::COMMAND, Key::Num2);
    desk.frame(Vec::new());
    let speed = desk.find(Role::Slider, "Speed");
    desk.click(speed.left_center() + vec2(0.5 * speed.width(), 0.0));
    assert!((20.0..55.0).contains(&desk.wind.speed), "{}", desk.wind.speed);
    desk.key(Modifiers::COMMAND, Key::Num3);
    desk.frame(Vec::new());
    let fade = desk.find(Role::Slider, "Fade");
    desk.click(fade.left_center() + vec2(0.9 * fade.width(), 0.0));
    assert!(desk.levels.fade > 0.2 && desk.levels.validate().is_ok());
    let freeze = desk.find(Role::CheckBox, "Freeze, and fly out to look").center();
    desk.click(freeze);
    assert!(desk.is_frozen);
}

#[test]
fn another_model_of_growth_is_chosen_from_its_list() {
    let mut desk = Desk::new("oak");
    let combo = desk.find(Role::ComboBox, "Growth").center();
    desk.click(combo);
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    desk.press("Impressionist");
    assert!(matches!(desk.session.species().growth, Growth::Impressionist(_)));
    desk.key(Modifiers::COMMAND, Key::Z);
    assert!(matches!(desk.session.species().growth, Growth::ReevesBlau(_)));
}
