//! The panel of the ground, driven by events.

use super::desk::Desk;
use crate::editor::{
    file_session::FileSession,
    ground_desk::{Fitting, GroundKind},
    map_fit::{MapFit, MapRequest, Progress},
    spline_points::control_points,
    steps::Steps,
    ui::{Panel, theme::PANEL_WIDTH},
};
use bevy_egui::egui::{Key, Modifiers, Pos2, Rect, accesskit::Role, pos2, vec2};
use std::{fs, sync::Arc};

fn desk() -> Desk {
    let mut desk = Desk::new("oak");
    desk.open(Panel::Ground);
    desk
}

#[test]
fn every_slider_of_random_ground_changes_it_and_is_undone() {
    let mut desk = desk();
    let original = desk.ground.random.document().clone();
    let panel = Rect::from_min_max(pos2(0.0, 150.0), pos2(PANEL_WIDTH, 650.0));
    let is_in_panel = |(role, _, at): &(Role, String, Rect)| *role == Role::Slider && panel.contains_rect(*at);
    let sliders: Vec<_> = desk.nodes().into_iter().filter(is_in_panel).collect();
    assert!(sliders.len() >= 7, "{sliders:?}");
    for (_, name, at) in &sliders {
        let way: Vec<Pos2> = [0.3, 0.5, 0.7].map(|share| at.left_center() + vec2(share * at.width(), 0.0)).into();
        desk.drag(&way);
        assert_ne!(*desk.ground.random.document(), original, "{name}");
        desk.key(Modifiers::COMMAND, Key::Z);
        assert_eq!(*desk.ground.random.document(), original, "a drag of {name} is one step");
    }
    desk.key(Modifiers::COMMAND, Key::S);
    let path = desk.ground.random.path().to_owned();
    assert!(path.exists() && !desk.ground.random.is_changed(), "{:?}", desk.ground.random.message);
}

#[test]
fn a_model_is_chosen_from_its_list() {
    let mut desk = desk();
    let combo = desk.find(Role::ComboBox, "Model").center();
    desk.click(combo);
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    desk.press("Fractal");
    assert_eq!(desk.ground.random.document().model.name(), "fractal");
    assert!(desk.ground.random.error().is_none());
}

#[test]
fn a_control_point_is_dragged_upwards_in_the_picture() {
    let mut desk = desk();
    desk.press("Control points");
    assert_eq!(desk.ground.kind, GroundKind::Spline);
    let bytes = fs::read(desk.ground.spline.path()).unwrap();
    let view = desk.view.clone().unwrap();
    let middle = 0.5 * (view.min + view.max);
    let points = control_points(desk.ground.spline.document());
    let distance = |at: bevy::math::Vec3| view.screen(at).map_or(f32::INFINITY, |at| at.distance(middle));
    let (point, at) = points.into_iter().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1))).unwrap();
    let [from, to] = [at, at + 12.0 * bevy::math::Vec3::Y].map(|at| {
        let at = view.screen(at).unwrap();
        pos2(at.x, at.y)
    });
    desk.drag(&[from, from.lerp(to, 0.5), to]);
    assert_eq!(desk.ground.point, Some(point));
    assert!((desk.ground.point_height_m().unwrap() - at.y - 12.0).abs() < 0.3, "{:?}", desk.ground.point_height_m());
    assert_eq!(desk.ground.spline.undo_step(), Some("Move a control point"));
    desk.key(Modifiers::COMMAND, Key::Z);
    desk.key(Modifiers::COMMAND, Key::S);
    assert_eq!(fs::read(desk.ground.spline.path()).unwrap(), bytes);
    desk.press("New patch");
    desk.press("Remove patch");
    assert_eq!(desk.ground.spline.document().patches.len(), 5);
}

#[test]
fn a_map_is_fitted_cancelled_and_made_more_of() {
    let mut desk = desk();
    desk.press("Real map");
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/terrain/rmnp-dem-16bit.png").to_owned();
    desk.ground.request = MapRequest { path, cell_x_m: 233.0, cell_z_m: 234.0, metres_per_unit: 1.0 };
    desk.frame(Vec::new());
    desk.press("Fit");
    assert!(matches!(desk.ground.fitting, Fitting::Wanted));
    let progress = Arc::new(Progress::default());
    desk.ground.fitting = Fitting::Running(progress.clone());
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    desk.press("Cancel");
    desk.ground.take_fit(MapFit::of(&desk.ground.request.clone(), &progress));
    assert!(desk.ground.fit.is_none() && matches!(desk.ground.fitting, Fitting::Idle));
    desk.ground.take_fit(MapFit::of(&desk.ground.request.clone(), &Progress::default()));
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    // A path may be longer than the field in which it is typed.
    let cut: Vec<String> = desk.clipped_texts().into_iter().filter(|text| !text.contains("dem-16bit.png at")).collect();
    assert!(cut.is_empty(), "{cut:?}");
    let combo = desk.find(Role::ComboBox, "Model").center();
    desk.click(combo);
    for _ in 0..2 {
        desk.frame(Vec::new());
    }
    let second = desk.ground.fit.as_ref().map(|fit| fit.fits[1]).unwrap();
    desk.press(&format!("{}, error {:.3}", second.model.name(), second.residual));
    assert_eq!(desk.ground.chosen_fit, 1);
    desk.press("More of its kind");
    assert_eq!(desk.ground.kind, GroundKind::Random);
    assert_eq!(desk.ground.random.document().model, second.model);
    assert!(desk.pose.distance_m > 5000.0);
}

#[test]
fn broken_ground_is_told_and_the_old_stays() {
    let mut desk = desk();
    desk.press("Control points");
    let path = desk.ground.spline.path().to_owned();
    fs::write(path.with_file_name("broken.ground.ron"), "(cell_x_m: -1.0)").unwrap();
    desk.key(Modifiers::COMMAND, Key::O);
    desk.press("broken");
    desk.press("Open");
    assert_eq!(control_points(desk.ground.spline.document()).len(), 50);
    assert!(format!("{:?}", desk.ground.spline.message).contains("`cell_x_m` is -1"));
}
