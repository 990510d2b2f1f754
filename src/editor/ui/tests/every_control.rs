//! Every control of every panel changes something, and what it changes in settings is taken back by one undo.

use super::desk::Desk;
use crate::editor::{
    fields::{Row, Section},
    ground_desk::GroundKind,
    ui::{Panel, theme::PANEL_WIDTH},
};
use bevy_egui::egui::{
    Event, Key, Modifiers, Rect,
    accesskit::{Node, Role},
    pos2, vec2,
};

/// So high that nothing has to be scrolled to.
const WINDOW: (f32, f32, f32) = (1280.0, 9000.0, 1.0);
/// Between the bar on top and the one at the bottom.
const FIELDS: Rect = Rect { min: pos2(0.0, 34.0), max: pos2(PANEL_WIDTH, 8930.0) };

impl Desk {
    /// Settings that are undone, as text.
    fn settings(&self) -> String {
        let documents = (self.session.document(), self.woods.plan(), self.ground.random.document());
        format!("{documents:?} {:?} {:?} {:?}", self.ground.spline.document(), self.wind.value(), self.levels.value())
    }

    /// All that a control may change, as text.
    fn all(&self) -> String {
        let view = (&self.stage, self.season, self.is_frozen, self.pose, &self.state.filter, &self.state.randomiser);
        let woods = (self.woods.tool, self.woods.brush, self.woods.chosen, self.woods.corner, &self.woods.mask_path);
        let ground = (self.ground.kind, &self.ground.request, self.ground.is_shown, self.ground.chosen_fit);
        format!("{} {view:?} {woods:?} {ground:?}", self.settings())
    }

    /// Controls of a role in the panel with the fields, from top to bottom.
    fn of_role(&self, role: Role) -> Vec<(Node, String, Rect)> {
        let is_one = |(node, _, at): &(Node, String, Rect)| {
            node.role() == role && FIELDS.contains_rect(*at) && !node.is_disabled()
        };
        let mut controls: Vec<_> = self.controls().into_iter().filter(is_one).collect();
        controls.sort_by(|a, b| a.2.top().total_cmp(&b.2.top()).then(a.2.left().total_cmp(&b.2.left())));
        controls
    }

    fn rest(&mut self) {
        (0..3).for_each(|_| drop(self.frame(Vec::new())));
    }

    /// Opens the sections with these titles.
    fn unfold(&mut self, titles: &[String]) {
        for title in titles {
            let folded = self.of_role(Role::Button).into_iter().find(|(_, name, _)| name == title);
            let Some((_, _, at)) = folded else { continue };
            let below = |desk: &Self| desk.controls().len();
            let before = below(self);
            self.click(at.left_center() + vec2(30.0, 0.0));
            // What a section opens and closes takes some frames.
            (0..8).for_each(|_| drop(self.frame(Vec::new())));
            if below(self) < before {
                self.click(at.left_center() + vec2(30.0, 0.0));
                (0..8).for_each(|_| drop(self.frame(Vec::new())));
            }
        }
    }

    /// Checks that something was done, and that settings are as before after one undo.
    fn expect_change(&mut self, before: &[String; 2], what: &str) {
        let [settings, all] = before;
        assert_ne!(self.all(), *all, "{what} changes nothing");
        if self.settings() != *settings {
            self.key(Modifiers::COMMAND, Key::Z);
            assert_eq!(self.settings(), *settings, "{what} is not one step");
        }
        self.rest();
    }

    fn before(&self) -> [String; 2] {
        [self.settings(), self.all()]
    }

    fn change_sliders(&mut self) -> usize {
        let sliders = self.of_role(Role::Slider);
        for (_, name, at) in &sliders {
            let before = self.before();
            let at_share = |share: f32| at.left_center() + vec2(share * at.width(), 0.0);
            self.drag(&[at_share(0.3), at_share(0.4)]);
            if self.all() == before[1] {
                self.drag(&[at_share(0.6), at_share(0.75)]);
            }
            self.expect_change(&before, &format!("the slider of {name}"));
        }
        sliders.len()
    }

    fn change_numbers(&mut self) -> usize {
        let numbers = self.of_role(Role::SpinButton);
        for (node, name, at) in &numbers {
            let now = node.numeric_value().unwrap_or_default();
            let [low, high] = [node.min_numeric_value(), node.max_numeric_value()].map(|end| end.unwrap_or(now + 7.0));
            let ends = [low.max(now - 10.0), high.min(now + 10.0)];
            let other =
                if now - ends[0] > ends[1] - now { 0.3 * ends[0] + 0.7 * now } else { 0.3 * ends[1] + 0.7 * now };
            let whole = if other > now { other.ceil() } else { other.floor() };
            for wanted in [other, whole] {
                let before = self.before();
                self.type_into(*at, &format!("{wanted}"));
                if self.all() != before[1] {
                    self.expect_change(&before, &format!("the number {name}"));
                    break;
                }
                assert_ne!(wanted, whole, "the number {name} stays {now} when {other} or {whole} is typed");
            }
        }
        numbers.len()
    }

    fn type_into(&mut self, at: Rect, text: &str) {
        self.click(at.center());
        self.key(Modifiers::COMMAND, Key::A);
        self.frame(vec![Event::Text(text.to_owned())]);
        self.key(Modifiers::NONE, Key::Enter);
        self.rest();
    }

    fn change_texts(&mut self) -> usize {
        let texts = self.of_role(Role::TextInput);
        for (_, name, at) in &texts {
            let before = self.before();
            self.type_into(*at, "birch");
            self.expect_change(&before, &format!("the text {name}"));
            // What is looked for hides the other fields.
            self.state.filter.clear();
            self.rest();
        }
        texts.len()
    }

    fn change_switches(&mut self) -> usize {
        let switches = self.of_role(Role::CheckBox);
        for (_, name, at) in &switches {
            let before = self.before();
            self.click(at.left_center() + vec2(8.0, 0.0));
            self.expect_change(&before, &format!("the switch {name}"));
        }
        switches.len()
    }

    /// Chooses another entry of every list.
    fn change_lists(&mut self) -> usize {
        let lists = self.of_role(Role::ComboBox);
        for (node, name, at) in &lists {
            let before = self.before();
            let chosen = self.woods.chosen;
            let known: Vec<String> = self.nodes().into_iter().map(|(_, name, _)| name).collect();
            self.click(at.center());
            self.rest();
            let now = node.value().unwrap_or_default().to_owned();
            let is_entry = |(role, entry, _): &(Role, String, Rect)| {
                *role == Role::Button && *entry != now && !known.contains(entry)
            };
            let entry = self.nodes().into_iter().find(is_entry);
            let (_, entry, at) = entry.unwrap_or_else(|| panic!("the list {name} has one entry"));
            self.click(at.center());
            self.rest();
            self.expect_change(&before, &format!("{entry} of the list {name}"));
            // Another element has other fields.
            self.woods.chosen = chosen;
            self.rest();
        }
        lists.len()
    }

    /// Presses all buttons of these names.
    fn press_all(&mut self, names: &[&str]) -> usize {
        let is_named = |(_, name, _): &(Node, String, Rect)| names.contains(&name.as_str());
        let buttons: Vec<_> = self.of_role(Role::Button).into_iter().filter(is_named).collect();
        for (_, name, at) in &buttons {
            let before = self.before();
            self.click(at.center());
            self.expect_change(&before, &format!("the button {name} at {at:?}"));
        }
        buttons.len()
    }

    /// Changes everything in sight, and returns how many controls there were.
    fn change_everything(&mut self) -> usize {
        let changed = [
            self.change_sliders(),
            self.change_numbers(),
            self.change_texts(),
            self.change_switches(),
            self.change_lists(),
            self.press_all(&["Another", "Add one like the last", "Remove the last"]),
        ];
        changed.iter().sum()
    }
}

/// Titles of a section's sections, from the outside in.
fn titles(section: &Section) -> Vec<String> {
    let inside = section.rows.iter().filter_map(|row| match row {
        Row::Section(inside) => Some(inside),
        Row::Field(_) => None,
    });
    inside.flat_map(|inside| std::iter::once(inside.title.clone()).chain(titles(inside))).collect()
}

fn desk(species: &str, panel: Panel) -> Desk {
    let mut desk = Desk::new(species);
    desk.size = WINDOW;
    desk.open(panel);
    desk
}

#[test]
fn every_control_of_a_species_changes_it_and_is_undone() {
    for species in ["maple", "impression_summer", "aono_kunii"] {
        let mut desk = desk(species, Panel::Species);
        let titles = titles(desk.session.table());
        desk.unfold(&titles);
        let changed = desk.change_everything();
        assert!(changed > 80, "{species}: {changed} controls");
    }
}

#[test]
fn every_control_of_woods_changes_them_and_is_undone() {
    let mut desk = desk("oak", Panel::Woods);
    let mut titles = titles(&desk.woods.area_table().unwrap());
    titles.extend(["oak", "fir", "The whole plan"].map(str::to_owned));
    desk.unfold(&titles);
    let changed = desk.change_everything();
    assert!(changed > 40, "{changed} controls");
}

#[test]
fn every_control_of_the_ground_changes_it_and_is_undone() {
    let mut desk = desk("oak", Panel::Ground);
    let random = desk.change_everything();
    desk.press("Control points");
    assert_eq!(desk.ground.kind, GroundKind::Spline);
    let titles = titles(desk.ground.spline.table());
    desk.unfold(&titles);
    let spline = desk.change_everything();
    desk.press("Real map");
    let map = desk.change_everything();
    assert!(random > 15 && spline > 8 && map > 6, "{random}, {spline}, {map} controls");
}

#[test]
fn every_control_of_the_wind_and_the_levels_changes_them_and_is_undone() {
    let mut wind = desk("oak", Panel::Wind);
    let changed = wind.change_everything();
    assert!(changed > 12, "{changed} controls of the wind");
    let mut levels = desk("oak", Panel::Levels);
    let tables = super::super::LevelTables::new(&Default::default(), &Default::default());
    let titles: Vec<String> = [&tables.levels, &tables.forest].into_iter().flat_map(titles).collect();
    levels.unfold(&titles);
    let changed = levels.change_everything();
    assert!(changed > 20, "{changed} controls of the levels");
}

/// Several changes of all kinds, undone to the start: what is there is what was there, and redone it is what it was.
#[test]
fn the_wind_and_the_levels_are_undone_to_the_start() {
    for panel in [Panel::Wind, Panel::Levels] {
        let mut desk = desk("oak", panel);
        let original = desk.settings();
        let sliders = desk.of_role(Role::Slider);
        for (_, _, at) in &sliders {
            let at_share = |share: f32| at.left_center() + vec2(share * at.width(), 0.0);
            desk.drag(&[at_share(0.2), at_share(0.35)]);
        }
        let changed = desk.settings();
        assert_ne!(changed, original);
        let steps = |desk: &mut Desk, key: (Modifiers, Key)| (0..sliders.len()).for_each(|_| desk.key(key.0, key.1));
        steps(&mut desk, (Modifiers::COMMAND, Key::Z));
        assert_eq!(desk.settings(), original);
        steps(&mut desk, (Modifiers::COMMAND | Modifiers::SHIFT, Key::Z));
        assert_eq!(desk.settings(), changed);
        desk.press("Undo");
        assert_ne!(desk.settings(), changed);
        desk.press("Redo");
        assert_eq!(desk.settings(), changed);
    }
}
