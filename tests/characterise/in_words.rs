//! What is told of patterns in words, and windows that are no rectangles.

use super::*;

#[test]
fn a_stand_that_no_law_describes_is_told_in_words() {
    let folder = folder();
    // A dense corner, a thin rest: no one law has both.
    let dense = random_points(1, 1500).into_iter().map(|[x, y]| [0.2 * x, 0.5 * y]);
    write(&folder, "uneven.csv", csv(dense.chain(random_points(2, 900))));
    let json = found(&folder, &["points", "uneven.csv", "--window", "0,0,60,40"]);
    assert_eq!(json["a_law_fits"], false);
    assert!(notes(&json).last().is_some_and(|note| note.starts_with("!no law fits")), "{:?}", notes(&json));
    write(&folder, "random.csv", csv(random_points(3, 2400)));
    let json = found(&folder, &["points", "random.csv", "--window", "0,0,60,40"]);
    assert_eq!(json["a_law_fits"], true);
    assert!(notes(&json).last().is_some_and(|note| note.starts_with("the law ")), "{:?}", notes(&json));
    let json = found(&folder, &["points", "random.csv", "--window", "0,0,80,40"]);
    assert!(
        notes(&json)[0].starts_with("!the window is wider than the points: towards its greatest x"),
        "{:?}",
        notes(&json)
    );
    let rounded = random_points(4, 600).into_iter().map(|point| point.map(f64::round));
    write(&folder, "rounded.csv", csv(rounded));
    let json = found(&folder, &["points", "rounded.csv", "--window", "0,0,60,40"]);
    assert!(
        notes(&json).iter().any(|note| note.starts_with("!places are given in steps of 1 m")),
        "{:?}",
        notes(&json)
    );
}

#[test]
fn quadrats_wholly_inside_a_round_or_polygonal_window_count() {
    let folder = folder();
    let in_circle = |[x, y]: &[f64; 2]| (x - 30.0).hypot(y - 20.0) <= 18.0;
    let points: Vec<[f64; 2]> = random_points(5, 4000).into_iter().filter(in_circle).collect();
    write(&folder, "plot.csv", csv(points.clone()));
    let json = found(&folder, &["points", "plot.csv", "--window", "circle:30,20,18"]);
    assert_eq!(json["points"], points.len());
    let [columns, rows] = [0, 1].map(|side| number(&json["quadrats"][side]));
    let inside = number(&json["quadrats_inside"]);
    let share =
        inside * number(&json["quadrat_m"][0]) * number(&json["quadrat_m"][1]) / number(&json["window_area_m2"]);
    assert!(inside < columns * rows && (0.85..1.0).contains(&share), "{share} of the circle");
    // A random pattern stays random: quadrats that are cut by the edge would hold too few.
    assert_eq!(json["dispersion"]["verdict"], "random", "{}", json["dispersion"]);
    let error = complaint(&folder, &["points", "plot.csv", "--window", "circle:30,20,15"]);
    assert!(error.contains("is outside the window, but must be in a circle of radius 15 m"), "{error}");

    // The corners of an octagon around the circle.
    let corner = |corner: u32| {
        let angle = f64::from(corner) * std::f64::consts::FRAC_PI_4;
        [30.0 + 19.5 * angle.cos(), 20.0 + 19.5 * angle.sin()]
    };
    write(&folder, "corners.csv", csv((0..8).map(corner)));
    let json = found(&folder, &["points", "plot.csv", "--window", "polygon:corners.csv"]);
    assert_eq!(json["points"], points.len());
    write(&folder, "bow.csv", csv([[0.0, 0.0], [60.0, 40.0], [60.0, 0.0], [0.0, 40.0]]));
    let error = complaint(&folder, &["points", "plot.csv", "--window", "polygon:bow.csv"]);
    assert_eq!(error, "bow.csv: the polygon crosses or touches itself: its edges 1 and 3");
}
