//! The panels driven by events: what all of them have in common.

mod desk;
mod every_control;
mod ground;
mod keyboard;
mod manners;
mod species;
mod woods;

use super::*;
use crate::editor::stage::Arrangement;
use bevy_egui::egui::{Key, Modifiers, Theme, ThemePreference, accesskit::Role, pos2};
use desk::{Desk, WINDOWS};

const ROLES_WITH_NAMES: [Role; 6] =
    [Role::Button, Role::CheckBox, Role::Slider, Role::SpinButton, Role::ComboBox, Role::TextInput];

#[test]
fn every_panel_opens_by_its_keys_and_leaves_the_tree_in_sight() {
    for size in WINDOWS {
        let mut desk = Desk::new("oak");
        desk.size = size;
        let keys = [Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num1];
        let panels = [Panel::Woods, Panel::Ground, Panel::Wind, Panel::Levels, Panel::Species];
        for (key, panel) in keys.into_iter().zip(panels) {
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
            for (panel, _) in Panel::ALL {
                desk.open(panel);
                let cut = desk.clipped_texts();
                assert!(cut.is_empty(), "{species}, {panel:?}, {size:?}: {cut:#?}");
            }
        }
    }
}

#[test]
fn controls_stay_in_their_panel() {
    let mut desk = Desk::new("oak");
    for (panel, _) in Panel::ALL {
        desk.open(panel);
        let fields = Rect::from_min_max(pos2(0.0, 40.0), pos2(PANEL_WIDTH, 680.0));
        for (role, name, at) in desk.nodes() {
            let is_of_fields = ROLES_WITH_NAMES.contains(&role) && fields.contains(at.left_center());
            assert!(!is_of_fields || at.right() <= PANEL_WIDTH, "{panel:?}: {role:?} `{name}` at {at:?}");
        }
    }
}

#[test]
fn screen_readers_are_told_a_name_for_every_control() {
    for theme in [Theme::Dark, Theme::Light] {
        let mut desk = Desk::new("impression_summer");
        desk.context.set_theme(ThemePreference::from(theme));
        for (panel, _) in Panel::ALL {
            desk.open(panel);
            let nodes = desk.nodes();
            let controls = nodes.iter().filter(|(role, ..)| ROLES_WITH_NAMES.contains(role));
            assert!(controls.clone().count() > 15, "{panel:?}");
            for (role, name, place) in controls {
                assert!(!name.trim().is_empty(), "{panel:?}: a {role:?} at {place:?} has no name");
            }
        }
    }
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
    desk.key(Modifiers::COMMAND, Key::Num4);
    desk.frame(Vec::new());
    let speed = desk.find(Role::Slider, "Speed");
    desk.click(speed.left_center() + vec2(0.5 * speed.width(), 0.0));
    let speed_m_s = desk.wind.value().speed;
    assert!((20.0..55.0).contains(&speed_m_s), "{speed_m_s}");
    desk.key(Modifiers::COMMAND, Key::Num5);
    desk.frame(Vec::new());
    let fade = desk.find(Role::Slider, "Fade");
    desk.click(fade.left_center() + vec2(0.9 * fade.width(), 0.0));
    assert!(desk.levels.value().levels.fade > 0.2 && desk.levels.value().levels.validate().is_ok());
    let freeze = desk.find(Role::CheckBox, "Freeze, and fly out to look").center();
    desk.click(freeze);
    assert!(desk.is_frozen);
}
