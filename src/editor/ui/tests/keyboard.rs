//! The keyboard alone: every control is reached by Tab and changed by keys, and so is the picture.

use super::{ROLES_WITH_NAMES, desk::Desk};
use crate::{
    editor::{
        plan_element::Element,
        ui::{Panel, dialogs::Dialog, shortcuts::SHORTCUTS},
    },
    scatter::plan::{KeepOut, Shape},
};
use bevy_egui::egui::{Event, Key, Modifiers, Rect, accesskit::Role};
use std::collections::BTreeSet;

impl Desk {
    /// The name and place of what has the focus.
    fn focused(&self) -> Option<(Role, String, Rect)> {
        self.focused_control().map(|(node, name, at)| (node.role(), name, at))
    }

    /// Presses Tab until the control of that role and name has the focus.
    fn tab_to(&mut self, role: Role, name: &str) {
        for _ in 0..400 {
            if self.focused().is_some_and(|(own, text, _)| own == role && text.starts_with(name)) {
                return;
            }
            self.key(Modifiers::NONE, Key::Tab);
        }
        panic!("Tab never comes to the {role:?} `{name}`");
    }
}

#[test]
fn tab_comes_to_every_control() {
    for (panel, _) in Panel::ALL {
        let mut desk = Desk::new("impression_summer");
        desk.size = (1280.0, 4000.0, 1.0);
        desk.open(panel);
        let key = |(role, name, at): &(Role, String, Rect)| format!("{role:?} {name} {:.0} {:.0}", at.min.x, at.min.y);
        let is_control = |(node, ..): &(bevy_egui::egui::accesskit::Node, String, Rect)| {
            ROLES_WITH_NAMES.contains(&node.role()) && !node.is_disabled()
        };
        let all: BTreeSet<String> = desk
            .controls()
            .iter()
            .filter(|control| is_control(control))
            .map(|(node, name, at)| key(&(node.role(), name.clone(), *at)))
            .collect();
        let mut reached = BTreeSet::new();
        for _ in 0..2 * all.len() + 8 {
            desk.key(Modifiers::NONE, Key::Tab);
            reached.extend(desk.focused().map(|focused| key(&focused)));
        }
        let missed: Vec<&String> = all.difference(&reached).collect();
        assert!(missed.is_empty(), "{panel:?}: {missed:#?}");
    }
}

#[test]
fn arrows_change_a_slider_and_a_number_is_typed() {
    let mut desk = Desk::new("oak");
    desk.open(Panel::Wind);
    let before = desk.wind.value().clone();
    desk.tab_to(Role::Slider, "Speed");
    desk.key(Modifiers::NONE, Key::ArrowRight);
    assert!(desk.wind.value().speed > before.speed);
    desk.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(*desk.wind.value(), before);
    desk.tab_to(Role::SpinButton, "Gustiness");
    desk.key(Modifiers::COMMAND, Key::A);
    desk.frame(vec![Event::Text("0.5".into())]);
    desk.key(Modifiers::NONE, Key::Enter);
    assert_eq!(desk.wind.value().gustiness, 0.5);
}

#[test]
fn a_button_is_pressed_and_a_list_is_chosen_from() {
    let mut desk = Desk::new("oak");
    desk.open(Panel::Ground);
    desk.tab_to(Role::Button, "Control points");
    desk.key(Modifiers::NONE, Key::Space);
    assert_eq!(desk.ground.kind, crate::editor::ground_desk::GroundKind::Spline);
}

#[test]
fn a_wood_is_edited_without_a_pointer() {
    let mut desk = Desk::new("oak");
    desk.open(Panel::Woods);
    let mut plan = desk.woods.plan().clone();
    let corners_m = vec![[-40.0, -30.0], [40.0, -30.0], [40.0, 30.0], [-40.0, 30.0]];
    plan.areas[0].shape = Shape::Polygon { corners_m };
    desk.woods.session.change(plan, "test");
    desk.frame(Vec::new());
    // A corner is chosen by its number and moved by its place.
    desk.tab_to(Role::SpinButton, "Corner");
    desk.frame(vec![Event::Text("3".into())]);
    desk.key(Modifiers::NONE, Key::Enter);
    assert_eq!(desk.woods.corner, Some(2));
    desk.tab_to(Role::SpinButton, "Its place");
    desk.key(Modifiers::COMMAND, Key::A);
    desk.frame(vec![Event::Text("52".into())]);
    desk.key(Modifiers::NONE, Key::Enter);
    assert_eq!(Element::Area(0).handles(desk.woods.plan())[2].x, 52.0);
    // The picture is turned and shifted, and the tool put down in its middle.
    desk.tab_to(Role::Button, "Keep free");
    desk.key(Modifiers::NONE, Key::Space);
    desk.tab_to(Role::Unknown, "Picture of the land");
    let pose = desk.pose;
    desk.key(Modifiers::NONE, Key::ArrowLeft);
    assert_ne!(desk.pose.turn_rad, pose.turn_rad);
    desk.key(Modifiers::SHIFT, Key::ArrowUp);
    assert_ne!(desk.pose.middle, pose.middle);
    desk.key(Modifiers::NONE, Key::PageUp);
    assert!(desk.pose.distance_m < pose.distance_m);
    let kept = desk.woods.plan().keep_out.len();
    desk.key(Modifiers::NONE, Key::Space);
    assert!(desk.woods.is_held());
    desk.key(Modifiers::NONE, Key::Space);
    assert!(!desk.woods.is_held());
    assert!(matches!(desk.woods.plan().keep_out[kept..], [KeepOut::Disc { .. }]));
    assert!(desk.focused().is_some_and(|(_, name, _)| name.starts_with("Picture")), "arrows do not lead away");
}

#[test]
fn the_tree_is_turned_without_a_pointer() {
    let mut desk = Desk::new("oak");
    desk.tab_to(Role::Unknown, "Picture of the tree");
    let before = desk.stage.clone();
    desk.key(Modifiers::NONE, Key::ArrowRight);
    desk.key(Modifiers::NONE, Key::PageUp);
    assert!(desk.stage.turn_rad != before.turn_rad && desk.stage.distance < before.distance);
}

#[test]
fn a_question_mark_lists_every_shortcut() {
    let mut desk = Desk::new("oak");
    desk.key(Modifiers::NONE, Key::Questionmark);
    assert_eq!(desk.state.dialog, Some(Dialog::Shortcuts));
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    let texts = desk.texts();
    for shortcut in &SHORTCUTS {
        assert!(texts.contains(&shortcut.keys()), "{} is not listed", shortcut.keys());
        assert!(texts.contains(&shortcut.what.to_owned()), "{} is not listed", shortcut.what);
    }
    assert!(desk.clipped_texts().is_empty(), "{:?}", desk.clipped_texts());
}
