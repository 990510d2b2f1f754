//! What was found, in words: what is odd about a table of places, and whether a law fits.

use crate::{
    note::Note,
    window::{Side, Window},
};
use bevy::math::DVec2;
use bevy_windwood::scatter::counts::Fit;
use std::collections::HashMap;

/// A law fits if more than this share of its own patterns differs from it as much as the real one.
pub const FITS: f64 = 0.01;
/// Probability below which a strip without points at the edge of a window is no chance.
const EMPTY_BY_CHANCE: f64 = 1e-4;
/// Steps to which places are rounded, m: decimal ones, and feet.
const STEPS_M: [f64; 21] = [
    100.0, 50.0, 20.0, 10.0, 5.0, 3.048, 2.0, 1.524, 1.0, 0.5, 0.3048, 0.25, 0.2, 0.1, 0.05, 0.03048, 0.025, 0.02,
    0.01, 0.005, 0.001,
];
/// Share of the coordinates that must have the step: a few may have been measured in another way.
const SHARE_OF_STEPS: f64 = 0.99;
/// How far from a step a coordinate may be, as a share of it.
const STEP_TOLERANCE: f64 = 1e-3;
/// A step above this share of a quadrat's side moves plants from one quadrat into the next.
const COARSE_STEP: f64 = 0.05;
/// A step below this share is not worth a word.
const FINE_STEP: f64 = 0.002;

/// What is odd about the places: doubled, rounded, or all in a part of their window.
pub fn about_places(points: &[DVec2], window: &Window, quadrat_m: DVec2) -> Vec<Note> {
    let mut notes: Vec<Note> = doubled(points).into_iter().chain(rounded(points, quadrat_m)).collect();
    notes.extend(Side::ALL.into_iter().filter_map(|side| empty_strip(points, window, quadrat_m, side)));
    notes
}

/// Points that stand where others do.
fn doubled(points: &[DVec2]) -> Option<Note> {
    let mut at_place: HashMap<[u64; 2], usize> = HashMap::new();
    for point in points {
        // Adding 0 makes one of both zeros.
        *at_place.entry((point + 0.0).to_array().map(f64::to_bits)).or_default() += 1;
    }
    let doubled = points.len() - at_place.len();
    let most = at_place.values().copied().max().unwrap_or_default();
    (doubled > 0).then(|| {
        Note::warning(format!(
            "{doubled} points stand where others do, up to {most} at one place: if they are the same plants, or stems of one, they look like \
             clumps, and have to be taken out"
        ))
    })
}

/// The step to which places were rounded, m.
fn step_m(points: &[DVec2]) -> Option<f64> {
    let first = *points.first()?;
    let has_step = |step_m: f64| {
        let on_step = |point: &DVec2| {
            let steps = (point - first) / step_m;
            (steps - steps.round()).abs().max_element() < STEP_TOLERANCE
        };
        points.iter().filter(|point| on_step(point)).count() as f64 >= SHARE_OF_STEPS * points.len() as f64
    };
    STEPS_M.into_iter().find(|&step_m| has_step(step_m))
}

/// Places that were rounded, where that matters.
fn rounded(points: &[DVec2], quadrat_m: DVec2) -> Option<Note> {
    let step_m = step_m(points)?;
    let side_m = quadrat_m.min_element();
    if step_m < FINE_STEP * side_m {
        None
    } else if step_m < COARSE_STEP * side_m {
        Some(Note::new(format!("places are given in steps of {step_m} m: fine enough for quadrats of {side_m:.2} m")))
    } else {
        Some(Note::warning(format!(
            "places are given in steps of {step_m} m, which is much for quadrats of {side_m:.2} m: counts follow the rounding, unless \
             --quadrats makes them many steps wide"
        )))
    }
}

/// A strip along one side of the window without points, wider than chance makes it.
fn empty_strip(points: &[DVec2], window: &Window, quadrat_m: DVec2, side: Side) -> Option<Note> {
    let coordinates = || {
        points.iter().map(|point| match side {
            Side::West | Side::East => point.x,
            Side::South | Side::North => point.y,
        })
    };
    let (least, greatest) =
        (coordinates().fold(f64::INFINITY, f64::min), coordinates().fold(f64::NEG_INFINITY, f64::max));
    let (outermost, gap_m, quadrat_m) = match side {
        Side::West => (least, least - window.min_m.x, quadrat_m.x),
        Side::East => (greatest, window.max_m.x - greatest, quadrat_m.x),
        Side::South => (least, least - window.min_m.y, quadrat_m.y),
        Side::North => (greatest, window.max_m.y - greatest, quadrat_m.y),
    };
    let by_chance = (1.0 - window.share_beyond(side, outermost)).powf(points.len() as f64);
    (gap_m > quadrat_m && by_chance < EMPTY_BY_CHANCE).then(|| {
        Note::warning(format!(
            "the window is wider than the points: towards its {} there are none for {gap_m:.2} m. If nothing was recorded there, a smaller \
             --window is right; empty quadrats look like clumps elsewhere",
            side.name()
        ))
    })
}

/// Whether a law fits. `wider` is a size of quadrats, columns and rows, at which one would.
pub fn about_laws(fits: &[Fit], wider: Option<[u32; 2]>) -> Note {
    let fitting = fits.iter().find(|fit| fit.goodness.is_some_and(|goodness| goodness.p >= FITS));
    if let Some(fit) = fitting {
        let p = fit.goodness.map_or(f64::NAN, |goodness| goodness.p);
        let name = fit.law.model().kind().name();
        return Note::new(format!(
            "the law {name} fits: {:.0} of 100 of its patterns differ from it as much as this one",
            100.0 * p
        ));
    }
    let tested = fits.iter().filter_map(|fit| fit.goodness).map(|goodness| goodness.p).reduce(f64::max);
    let Some(p) = tested else {
        return Note::warning(
            "no law could be tested: too few quadrats hold different numbers of points. Take more points or other --quadrats",
        );
    };
    let advice = match wider {
        Some([columns, rows]) => format!("With --quadrats {columns}x{rows} one does"),
        None => "Nor with other quadrats. The density may differ from part to part: a law describes one kind of stand, so take a part of the \
                 window, or an area in the plan for each"
            .to_owned(),
    };
    Note::warning(format!(
        "no law fits: of 1000 patterns of the best one, {:.0} differ from it as much as this one. The simulated pattern has the right number \
         of points, but not their arrangement. {advice}",
        1000.0 * p
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window() -> Window {
        Window::rectangle(DVec2::ZERO, DVec2::new(100.0, 50.0)).unwrap()
    }

    /// Places without a pattern: the fractional parts of multiples of two irrational numbers.
    fn places(number: u32) -> Vec<DVec2> {
        let part = |index: u32, factor: f64| (f64::from(index) * factor).fract();
        (0..number)
            .map(|index| DVec2::new(100.0 * part(index, 0.754_877_666), 50.0 * part(index, 0.569_840_291)))
            .collect()
    }

    fn told(points: &[DVec2], window: &Window) -> Vec<String> {
        let notes = about_places(points, window, DVec2::splat(5.0));
        notes.into_iter().map(|note| format!("{} {}", note.is_warning, note.text)).collect()
    }

    #[test]
    fn nothing_is_odd_about_places_without_a_pattern() {
        assert_eq!(told(&places(400), &window()), [""; 0]);
    }

    #[test]
    fn doubled_points_are_counted() {
        let mut points = places(80);
        points.extend(points.clone());
        points.extend(points[..80].to_vec());
        let told = told(&points, &window());
        assert!(told[0].starts_with("true 160 points stand where others do, up to 3 at one place"), "{told:?}");
        assert!(doubled(&[DVec2::new(0.0, 1.0), DVec2::new(-0.0, 1.0)]).is_some());
    }

    #[test]
    fn rounded_places_are_found_by_their_step() {
        let round = |step: f64, offset: f64| -> Vec<DVec2> {
            places(400).into_iter().map(|point| (point / step).round() * step + offset).collect()
        };
        for step in [5.0, 1.0, 0.5, 0.1, 0.3048] {
            assert_eq!(step_m(&round(step, 0.37)), Some(step));
        }
        assert_eq!(step_m(&places(400)), None);
        assert!(rounded(&round(1.0, 0.0), DVec2::splat(5.0)).is_some_and(|note| note.is_warning));
        assert!(rounded(&round(0.1, 0.0), DVec2::splat(5.0)).is_some_and(|note| !note.is_warning));
        assert_eq!(rounded(&round(0.001, 0.0), DVec2::splat(5.0)), None);
    }

    #[test]
    fn a_window_wider_than_its_points_is_told_by_its_side() {
        let wide = Window::rectangle(DVec2::new(0.0, -20.0), DVec2::new(130.0, 50.0)).unwrap();
        let told = told(&places(400), &wide);
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].contains("towards its greatest x there are none for 30."), "{told:?}");
        assert!(told[1].contains("towards its least y there are none for 20."), "{told:?}");
        // The box around a circle has corners without points, but the circle has none.
        let circle = Window::circle(DVec2::new(50.0, 25.0), 25.0).unwrap();
        let inside: Vec<DVec2> = places(800).into_iter().filter(|point| circle.contains(*point)).collect();
        assert_eq!(about_places(&inside, &circle, DVec2::splat(2.0)), []);
    }
}
