//! The panel of a wood, driven by events.

use super::desk::Desk;
use crate::{
    editor::{
        fields::Row,
        file_session::{FileSession, Message},
        plan_element::Element,
        steps::Steps,
        ui::{Panel, theme::PANEL_WIDTH},
        variants::with_list,
        woods::Tool,
    },
    scatter::{
        ForestPlan,
        plan::{KeepOut, Shape},
    },
};
use bevy::math::Vec2;
use bevy_egui::egui::{Event, Key, Modifiers, MouseWheelUnit, Pos2, Rect, TouchPhase, accesskit::Role, pos2, vec2};
use std::fs;

fn desk() -> Desk {
    let mut desk = Desk::new("oak");
    desk.open(Panel::Woods);
    desk
}

/// Where a place (x, z) on the ground is on the screen.
fn at(desk: &Desk, x: f32, z: f32) -> Pos2 {
    let view = desk.view.as_ref().unwrap();
    let point = view.screen(view.on_ground(Vec2::new(x, z))).unwrap();
    pos2(point.x, point.y)
}

/// A wood of 80 m by 60 m in the middle of the picture.
fn small_wood(desk: &mut Desk) {
    let mut plan = desk.woods.plan().clone();
    let corners_m = vec![[-40.0, -30.0], [40.0, -30.0], [40.0, 30.0], [-40.0, 30.0]];
    plan.areas[0].shape = Shape::Polygon { corners_m };
    desk.woods.session.change(plan, "test");
    desk.woods.session.end_gesture();
}

#[test]
fn a_corner_is_dragged_on_the_ground_in_one_step() {
    let mut desk = desk();
    small_wood(&mut desk);
    let (from, to) = (at(&desk, 40.0, 30.0), at(&desk, 52.0, 41.0));
    desk.drag(&[from, from.lerp(to, 0.5), to]);
    let corner = Element::Area(0).handles(desk.woods.plan())[2];
    assert!(corner.distance(Vec2::new(52.0, 41.0)) < 0.3, "{corner}");
    assert_eq!(desk.woods.corner, Some(2));
    desk.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(Element::Area(0).handles(desk.woods.plan())[2], Vec2::new(40.0, 30.0));
}

#[test]
fn a_drag_beside_the_handles_turns_the_view_and_the_wheel_brings_nearer() {
    let mut desk = desk();
    small_wood(&mut desk);
    let (plan, pose) = (desk.woods.plan().clone(), desk.pose);
    let from = at(&desk, 0.0, 0.0);
    desk.drag(&[from, from + vec2(20.0, 0.0), from + vec2(40.0, 10.0)]);
    assert_eq!(*desk.woods.plan(), plan);
    assert!(desk.pose.turn_rad < pose.turn_rad && desk.pose.rise_rad > pose.rise_rad);
    let wheel = Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 60.0),
        phase: TouchPhase::Move,
        modifiers: Modifiers::NONE,
    };
    desk.frame(vec![Event::PointerMoved(from)]);
    desk.frame(vec![wheel]);
    for _ in 0..10 {
        desk.frame(Vec::new());
    }
    assert!(desk.pose.distance_m < pose.distance_m);
    desk.press("From above");
    assert!(desk.pose.rise_rad > 1.5);
    desk.press("Show all");
    assert!(desk.pose.distance_m > 1000.0);
}

#[test]
fn the_brush_paints_a_mask_and_keeps_paths_free() {
    let mut desk = desk();
    small_wood(&mut desk);
    desk.press("To mask");
    assert!(desk.woods.can_paint());
    desk.press("Thin");
    desk.frame(Vec::new());
    let strength = desk.find(Role::Slider, "Strength");
    desk.click(strength.right_center() - vec2(2.0, 0.0));
    assert!(desk.woods.brush.strength > 0.9);
    let way: Vec<Pos2> = (-4..=4).map(|step| at(&desk, 8.0 * step as f32, 0.0)).collect();
    desk.drag(&way);
    let coverage = |desk: &Desk| {
        let places = [(0.0, 0.0), (0.0, 27.0)].map(bevy::math::DVec2::from);
        desk.woods.plan().areas[0].shape.coverage(places).collect::<Vec<_>>()
    };
    let painted = coverage(&desk);
    assert!(painted[0] < 0.2 && painted[1] > 0.8, "{painted:?}");
    assert_eq!(desk.woods.session.undo_step(), Some("Paint density"));
    desk.press("Keep free");
    desk.drag(&way);
    let KeepOut::Path { points_m, .. } = desk.woods.plan().keep_out.last().unwrap() else { panic!("a path") };
    assert!(points_m.len() > 3 && desk.woods.session.error().is_none());
    desk.click(at(&desk, 30.0, 20.0));
    assert!(matches!(desk.woods.plan().keep_out.last(), Some(KeepOut::Disc { .. })));
}

#[test]
fn a_mask_is_saved_as_a_picture_and_loaded_in_one_step() {
    let mut desk = desk();
    small_wood(&mut desk);
    desk.press("To mask");
    let path = desk.woods.session.path().with_file_name("density.png");
    desk.woods.mask_path = path.display().to_string();
    desk.frame(Vec::new());
    desk.press("Save mask");
    assert!(path.exists(), "{:?}", desk.woods.mask_error);
    let saved = desk.woods.plan().clone();
    let mut other = saved.clone();
    let Shape::Mask { rows, .. } = &mut other.areas[0].shape else { panic!("a mask") };
    rows.iter_mut().for_each(|row| *row = "5".repeat(row.len()));
    desk.woods.session.change(other.clone(), "test");
    desk.woods.session.end_gesture();
    desk.press("Load mask");
    assert_eq!(*desk.woods.plan(), saved);
    desk.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(*desk.woods.plan(), other, "loading is one step");
    fs::write(&path, "no picture").unwrap();
    desk.press("Load mask");
    desk.frame(Vec::new());
    assert_eq!(*desk.woods.plan(), other, "a bad file leaves the mask as it is");
    let texts = desk.texts();
    assert!(texts.iter().any(|text| text.contains("density.png: the picture cannot be read")), "{texts:?}");
}

/// The forest grows to a changed plan: the bar tells how far it is, and *Cancel* takes the change back.
#[test]
fn planting_has_a_bar_and_is_cancelled_by_taking_the_change_back() {
    let mut desk = desk();
    let original = desk.woods.plan().clone();
    let has =
        |desk: &Desk, role: Role, name: &str| desk.nodes().iter().any(|(own, text, _)| *own == role && text == name);
    let has_bar = |desk: &Desk| has(desk, Role::ProgressIndicator, "Planting");
    assert!(!has_bar(&desk));
    desk.planted_share = Some(0.4);
    (0..2).for_each(|_| drop(desk.frame(Vec::new())));
    assert!(has_bar(&desk) && !has(&desk, Role::Button, "Cancel"), "there is nothing to take back yet");
    small_wood(&mut desk);
    (0..2).for_each(|_| drop(desk.frame(Vec::new())));
    assert!(desk.clipped_texts().is_empty(), "{:?}", desk.clipped_texts());
    let at = desk.find(Role::Button, "Cancel").center();
    assert!(desk.press_and_see(at).cancelled.planting);
    assert_eq!(*desk.woods.plan(), original);
    desk.planted_share = None;
    (0..2).for_each(|_| drop(desk.frame(Vec::new())));
    assert!(!has_bar(&desk));
}

/// Every slider in sight is dragged; then all is taken back, and the file is saved byte for byte.
#[test]
fn every_slider_changes_the_plan_and_is_undone() {
    let mut desk = desk();
    let bytes = fs::read(desk.woods.session.path()).unwrap();
    let original = desk.woods.plan().clone();
    let panel = Rect::from_min_max(pos2(0.0, 200.0), pos2(PANEL_WIDTH, 650.0));
    let is_in_panel = |(role, _, at): &(Role, String, Rect)| *role == Role::Slider && panel.contains_rect(*at);
    let sliders: Vec<_> = desk.nodes().into_iter().filter(is_in_panel).collect();
    assert!(sliders.len() >= 5, "{sliders:?}");
    for (_, name, at) in &sliders {
        let before = desk.woods.plan().clone();
        let way: Vec<Pos2> = [0.3, 0.45, 0.6].map(|share| at.left_center() + vec2(share * at.width(), 0.0)).into();
        desk.drag(&way);
        assert_ne!(*desk.woods.plan(), before, "{name}");
        // A density that does not fit the least distance is told, and the next change begins from what was.
        desk.key(Modifiers::COMMAND, Key::Z);
        assert_eq!(*desk.woods.plan(), before, "a drag of {name} is one step");
    }
    assert_eq!(*desk.woods.plan(), original);
    desk.key(Modifiers::COMMAND, Key::S);
    assert_eq!(fs::read(desk.woods.session.path()).unwrap(), bytes);
}

#[test]
fn the_law_is_chosen_from_its_list_and_species_are_added() {
    let mut desk = desk();
    let combo = desk.find(Role::ComboBox, "Pattern").center();
    desk.click(combo);
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    desk.press("Poisson Poisson");
    assert!(format!("{:?}", desk.woods.plan().areas[0].pattern).starts_with("PoissonPoisson"));
    let species = |desk: &mut Desk| {
        let table = desk.woods.area_table().unwrap();
        let of_stock = |row: &Row| match row {
            Row::Section(section) => section.path.ends_with(".stock").then_some(section.rows.len()),
            Row::Field(_) => None,
        };
        table.rows.iter().find_map(of_stock).unwrap()
    };
    assert_eq!(species(&mut desk), 2);
    let longer = with_list(desk.woods.plan(), "areas[0].stock", true).unwrap();
    desk.woods.session.change(longer, "test");
    desk.frame(Vec::new());
    assert_eq!(species(&mut desk), 3);
}

#[test]
fn areas_are_added_chosen_and_removed_by_their_buttons() {
    let mut desk = desk();
    desk.press("New area");
    assert_eq!(desk.woods.plan().areas.len(), 4);
    desk.press("Remove");
    assert_eq!(desk.woods.plan().areas.len(), 3);
    let combo = desk.find(Role::ComboBox, "Chosen").center();
    desk.click(combo);
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    desk.press("clearing 1");
    assert_eq!(desk.woods.chosen(), Some(Element::KeepOut(0)));
    let radius = desk.find(Role::Slider, "Radius");
    desk.click(radius.left_center() + vec2(0.5 * radius.width(), 0.0));
    assert!(!matches!(desk.woods.plan().keep_out[0], KeepOut::Disc { radius_m: 46.0, .. }));
}

#[test]
fn plans_are_saved_with_their_comments_and_broken_ones_are_told() {
    let mut desk = desk();
    let path = desk.woods.session.path().to_owned();
    let own = fs::read_to_string(&path).unwrap();
    let wide = Element::Area(0).with_handle_at(desk.woods.plan(), 2, Vec2::new(181.5, -310.0)).unwrap();
    desk.woods.session.change(wide.clone(), "test");
    desk.frame(Vec::new());
    desk.press("Save");
    let saved = fs::read_to_string(&path).unwrap();
    assert_eq!(saved, own.replace("(180.0, -310.0)", "(181.5, -310.0)"));
    let broken = path.with_file_name("broken.forest.ron");
    fs::write(&broken, "(areas: [(densty: 3)])").unwrap();
    desk.key(Modifiers::COMMAND, Key::O);
    desk.press("broken");
    desk.press("Open");
    let Some(Message::Failed(error)) = &desk.woods.session.message else { panic!("no message") };
    assert!(error.contains("broken.forest.ron") && error.contains("densty"), "{error}");
    assert_eq!(*desk.woods.plan(), wide, "the old plan stays");
    desk.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    let mut wrong = wide;
    wrong.areas[0].density_per_ha = -1.0;
    desk.woods.session.change(wrong, "test");
    desk.frame(Vec::new());
    desk.press("Save");
    assert_eq!(ForestPlan::from_ron(&fs::read_to_string(&path).unwrap()).unwrap().areas[0].density_per_ha, 180.0);
}

#[test]
fn tools_are_chosen_by_their_buttons() {
    let mut desk = desk();
    for (tool, name, _) in Tool::ALL.into_iter().rev() {
        desk.press(name);
        assert_eq!(desk.woods.tool, tool);
    }
}
