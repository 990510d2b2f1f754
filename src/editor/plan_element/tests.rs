use super::*;

const MIXED: &str = include_str!("../../../assets/forests/mixed.forest.ron");

fn mixed() -> ForestPlan {
    ForestPlan::from_ron(MIXED).unwrap()
}

#[test]
fn every_handle_of_every_element_can_be_dragged() {
    let plan = mixed();
    for element in Element::all(&plan) {
        let handles = element.handles(&plan);
        assert!(handles.len() >= 2, "{element:?}");
        for (number, place) in handles.iter().enumerate() {
            let wanted = rounded(*place + Vec2::new(3.21, 1.77));
            let moved = element.with_handle_at(&plan, number, wanted).unwrap();
            assert!(moved.validate().is_ok(), "{element:?}: {:?}", moved.validate());
            assert_ne!(moved, plan);
            let there = element.handles(&moved)[number];
            // A radius has one number: its handle goes around.
            let is_rim = matches!(element, Element::KeepOut(0)) && number == 1;
            assert!(is_rim || there.distance(wanted) < 0.1, "{element:?}, {number}: {there} for {wanted}");
        }
    }
}

#[test]
fn a_corner_of_a_rectangle_takes_its_two_sides_along() {
    let plan = mixed();
    let moved = Element::Area(1).with_handle_at(&plan, 1, Vec2::new(520.04, -160.0)).unwrap();
    assert_eq!(moved.areas[1].shape, Shape::Rectangle { min_m: [360.0, -160.0], max_m: [520.0, 120.0] });
    let masked = Element::Area(2).with_handle_at(&plan, 3, Vec2::new(-500.0, 240.0)).unwrap();
    let Shape::Mask { min_m, max_m, rows } = &masked.areas[2].shape else { panic!("a mask") };
    assert_eq!((*min_m, *max_m, rows.len()), ([-500.0, -220.0], [-280.0, 240.0], 8));
}

#[test]
fn discs_and_houses_have_a_handle_for_their_size() {
    let plan = mixed();
    let wider = Element::KeepOut(0).with_handle_at(&plan, 1, Vec2::new(60.0, 100.0)).unwrap();
    assert_eq!(wider.keep_out[0], KeepOut::Disc { centre_m: [60.0, 40.0], radius_m: 60.0 });
    let house = Element::KeepOut(1);
    let turn = Vec2::from_angle(25_f32.to_radians());
    let larger = house.with_handle_at(&plan, 1, Vec2::new(20.0, 85.0) + turn.rotate(Vec2::new(10.0, 7.0))).unwrap();
    let KeepOut::House { size_m, centre_m, .. } = larger.keep_out[1] else { panic!("a house") };
    assert_eq!(centre_m, [20.0, 85.0]);
    assert!((size_m[0] - 20.0).abs() <= 0.11 && (size_m[1] - 14.0).abs() <= 0.11, "{size_m:?}");
}

#[test]
fn corners_come_in_the_nearest_edge_and_go() {
    let plan = mixed();
    let (more, corner) = Element::Area(0).with_corner_near(&plan, Vec2::new(-190.0, -330.0)).unwrap();
    assert_eq!((corner, Element::Area(0).handles(&more)[1]), (1, Vec2::new(-190.0, -320.0)));
    assert_eq!(Element::Area(0).without_corner(&more, corner), Some(plan.clone()));
    // The last edge of a polygon leads back to its beginning; that of a path does not.
    let (_, corner) = Element::Area(0).with_corner_near(&plan, Vec2::new(-310.0, -180.0)).unwrap();
    assert_eq!(corner, 11);
    let (path, corner) = Element::KeepOut(4).with_corner_near(&plan, Vec2::new(-400.0, 0.0)).unwrap();
    assert!(corner < 4 && path.keep_out[4] != plan.keep_out[4]);
    assert_eq!(Element::Area(1).with_corner_near(&plan, Vec2::ZERO), None, "a rectangle has four");
}

#[test]
fn a_polygon_keeps_three_corners_and_a_path_two_points() {
    for (element, least) in [(Element::Area(0), 3), (Element::KeepOut(2), 3), (Element::KeepOut(4), 2)] {
        let mut plan = mixed();
        while let Some(fewer) = element.without_corner(&plan, 0) {
            plan = fewer;
        }
        assert_eq!(element.handles(&plan).len(), least);
    }
}

#[test]
fn a_shape_becomes_a_mask_of_the_same_ground() {
    let plan = mixed();
    let mask = as_mask(&plan.areas[0].shape).unwrap();
    let area = ForestPlan { areas: vec![Area { shape: mask.clone(), ..Area::default() }], ..ForestPlan::default() };
    area.validate().unwrap();
    let places: Vec<DVec2> =
        (0..4096).map(|index| DVec2::new(f64::from(index % 64), f64::from(index / 64)) * 11.0 - 350.0).collect();
    let before = plan.areas[0].shape.coverage(places.clone());
    let differ = before.zip(mask.coverage(places)).filter(|(polygon, mask)| (polygon - mask).abs() > 0.5).count();
    assert!(differ < 100, "{differ} of 4096 places");
    assert_eq!(as_mask(&mask), None);
    let Some(Shape::Polygon { corners_m }) = as_polygon(&mask) else { panic!("a polygon") };
    assert_eq!(corners_m.len(), 4);
}

#[test]
fn elements_have_names_and_go() {
    let plan = mixed();
    let names: Vec<String> = Element::all(&plan).map(|element| element.name(&plan)).collect();
    assert_eq!(names[..4], ["old forest", "plantation", "young growth", "clearing 1"]);
    let removed = Element::Area(1).removed(&plan);
    assert_eq!(removed.areas.len(), 2);
    assert!(Element::KeepOut(4).exists(&removed) && !Element::Area(2).exists(&removed));
    let new = new_area(&plan, Vec2::new(1.0, 2.0));
    let more = ForestPlan { areas: vec![new], ..ForestPlan::default() };
    more.validate().unwrap();
}
