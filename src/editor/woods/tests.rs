use super::*;
use crate::editor::file_session::FileSession;
use std::path::Path;

const MIXED: &str = include_str!("../../../assets/forests/mixed.forest.ron");

fn woods() -> Woods {
    let plan = ForestPlan::from_ron(MIXED).unwrap();
    Woods::new(Session::new(Path::new("mixed.forest.ron"), plan))
}

#[test]
fn a_drag_of_a_corner_is_one_step() {
    let mut woods = woods();
    let before = woods.plan().clone();
    woods.take(Element::Area(0), 2);
    for x in [181.0, 200.0, 222.22] {
        woods.drag(Vec2::new(x, -320.0));
    }
    woods.release();
    assert_eq!(Element::Area(0).handles(woods.plan())[2], Vec2::new(222.2, -320.0));
    assert_eq!(woods.session.undo_step(), Some("Move a corner"));
    woods.session.undo();
    assert_eq!(*woods.plan(), before);
    assert!(!woods.is_held());
}

#[test]
fn an_outline_that_crosses_itself_is_told_and_can_be_dragged_back() {
    let mut woods = woods();
    woods.take(Element::Area(0), 0);
    woods.drag(Vec2::new(320.0, 300.0));
    assert!(woods.session.error().unwrap().contains("crossing itself"));
    woods.drag(Vec2::new(-330.0, -300.0));
    assert_eq!(woods.session.error(), None);
}

#[test]
fn density_is_painted_and_taken_away() {
    let mut woods = woods();
    woods.choose(Element::Area(0));
    woods.tool = Tool::Thicken;
    assert!(!woods.can_paint() && !woods.press(Vec2::ZERO), "a polygon cannot be painted");
    woods.convert(true);
    assert!(woods.can_paint() && woods.session.error().is_none());
    let coverage = |woods: &Woods, x: f64, z: f64| {
        woods.plan().areas[0].shape.coverage([bevy::math::DVec2::new(x, z)]).next().unwrap()
    };
    assert!(coverage(&woods, 0.0, 0.0) > 0.9);
    woods.tool = Tool::Thin;
    woods.brush = Brush { radius_m: 40.0, strength: 1.0, falloff: 0.3 };
    assert!(woods.press(Vec2::new(-60.0, 0.0)));
    woods.drag(Vec2::new(60.0, 0.0));
    woods.release();
    assert!(coverage(&woods, 0.0, 0.0) < 0.1 && coverage(&woods, 0.0, 120.0) > 0.9);
    assert_eq!(woods.session.undo_step(), Some("Paint density"));
    woods.tool = Tool::Thicken;
    woods.press(Vec2::ZERO);
    woods.release();
    assert!(coverage(&woods, 0.0, 0.0) > 0.9);
    assert_eq!(woods.session.error(), None);
    woods.convert(false);
    assert!(!woods.can_paint());
}

#[test]
fn a_stroke_keeps_a_path_free_and_a_click_a_clearing() {
    let mut woods = woods();
    woods.tool = Tool::KeepFree;
    woods.brush.radius_m = 5.0;
    woods.press(Vec2::new(0.0, 200.0));
    woods.release();
    assert_eq!(woods.plan().keep_out[5], KeepOut::Disc { centre_m: [0.0, 200.0], radius_m: 5.0 });
    woods.press(Vec2::new(-100.0, -250.0));
    (0..=50).for_each(|step| woods.drag(Vec2::new(-100.0 + 2.0 * step as f32, -250.0)));
    woods.release();
    let KeepOut::Path { points_m, width_m } = &woods.plan().keep_out[6] else { panic!("a path") };
    assert_eq!((*width_m, points_m.first(), points_m.len()), (10.0, Some(&[-100.0, -250.0]), 26));
    assert_eq!((woods.chosen(), woods.session.error()), (Some(Element::KeepOut(6)), None));
    woods.session.undo();
    woods.session.undo();
    assert_eq!(woods.plan().keep_out.len(), 5);
    assert_eq!(woods.chosen(), None, "what undoing has taken away is not chosen");
}

#[test]
fn areas_and_corners_come_and_go() {
    let mut woods = woods();
    woods.add_area(Vec2::new(700.0, 0.0));
    assert_eq!((woods.chosen(), woods.session.error()), (Some(Element::Area(3)), None));
    woods.add_corner();
    assert_eq!(Element::Area(3).handles(woods.plan()).len(), 5);
    assert_eq!(woods.corner, Some(1));
    woods.remove_corner();
    woods.remove_chosen();
    assert_eq!((woods.plan().areas.len(), woods.chosen()), (3, Some(Element::Area(0))));
    let mut steps = 0;
    while woods.session.undo_step().is_some() {
        woods.session.undo();
        steps += 1;
    }
    assert_eq!((steps, woods.plan()), (4, &ForestPlan::from_ron(MIXED).unwrap()));
}

#[test]
fn the_table_is_that_of_the_chosen_area_and_outlasts_errors() {
    let mut woods = woods();
    let first = woods.area_table().unwrap();
    assert!(Arc::ptr_eq(&first, &woods.area_table().unwrap()));
    let mut plan = woods.plan().clone();
    plan.areas[0].density_per_ha = -1.0;
    woods.session.change(plan, "Density");
    assert!(Arc::ptr_eq(&first, &woods.area_table().unwrap()));
    woods.choose(Element::Area(1));
    assert!(woods.area_table().is_some_and(|table| table.path == "areas[1]"));
    woods.choose(Element::KeepOut(0));
    assert_eq!(woods.area_table(), None);
}
