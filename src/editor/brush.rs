//! The brush that paints masks of density.
//!
//! A mask has ten levels. A stroke is painted on levels between them, so that many light dabs add up; the mask gets the nearest.

use bevy::math::Vec2;

use crate::scatter::plan::{Place, Shape};

/// The level of full density.
const FULL: f32 = 9.0;

/// A brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Radius, m.
    pub radius_m: f32,
    /// What a dab adds in the middle, as a share of the full density; below 0 it takes away.
    pub strength: f32,
    /// Share of the radius over which the strength falls to nothing: 0 for a hard edge, 1 for a soft one from the middle on.
    pub falloff: f32,
}

impl Default for Brush {
    fn default() -> Self {
        Self { radius_m: 20.0, strength: 0.25, falloff: 0.7 }
    }
}

impl Brush {
    /// What a dab adds at a distance from its middle, m: the strength within, falling off as a half wave of a cosine.
    pub fn dab(&self, distance_m: f32) -> f32 {
        let at = distance_m / self.radius_m.max(1e-3);
        if at >= 1.0 {
            return 0.0;
        }
        let falloff = self.falloff.clamp(0.0, 1.0);
        let into = (at - (1.0 - falloff)) / falloff.max(1e-6);
        let share = if into <= 0.0 { 1.0 } else { 0.5 + 0.5 * (std::f32::consts::PI * into.min(1.0)).cos() };
        self.strength * share
    }
}

/// A stroke over a mask.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    min_m: Place,
    max_m: Place,
    columns: usize,
    /// Level of each point, 0 to 9.
    levels: Vec<f32>,
    last: Option<Vec2>,
}

impl Stroke {
    /// Begins a stroke on a mask. None on other shapes.
    pub fn begin(shape: &Shape) -> Option<Self> {
        let Shape::Mask { min_m, max_m, rows } = shape else { return None };
        let level = |sign: char| sign.to_digit(10).unwrap_or(0) as f32;
        Some(Self {
            min_m: *min_m,
            max_m: *max_m,
            columns: rows.first()?.len(),
            levels: rows.iter().flat_map(|row| row.chars().map(level)).collect(),
            last: None,
        })
    }

    /// Moves the brush to a place (x, z), m: dabs a quarter of its radius apart.
    pub fn move_to(&mut self, brush: &Brush, place: Vec2) {
        let step_m = (0.25 * brush.radius_m).max(0.1);
        let Some(last) = self.last else {
            self.dab(brush, place);
            self.last = Some(place);
            return;
        };
        let way = place - last;
        let steps = (way.length() / step_m) as u32;
        for step in 1..=steps {
            self.dab(brush, last + way.normalize_or_zero() * step_m * step as f32);
        }
        self.last = Some(last + way.normalize_or_zero() * step_m * steps as f32);
    }

    fn dab(&mut self, brush: &Brush, place: Vec2) {
        let rows = self.levels.len() / self.columns.max(1);
        let (min, max) = (Vec2::from(self.min_m), Vec2::from(self.max_m));
        let point = (max - min) / Vec2::new(self.columns as f32, rows as f32);
        for (index, level) in self.levels.iter_mut().enumerate() {
            let at = Vec2::new((index % self.columns) as f32, (index / self.columns) as f32) + 0.5;
            let added = FULL * brush.dab(place.distance(min + point * at));
            if added != 0.0 {
                *level = (*level + added).clamp(0.0, FULL);
            }
        }
    }

    /// The mask as it is now.
    pub fn shape(&self) -> Shape {
        let sign = |level: &f32| match level.round() as u32 {
            0 => '.',
            level => char::from_digit(level, 10).unwrap_or('9'),
        };
        let rows = self.levels.chunks(self.columns).map(|row| row.iter().map(sign).collect()).collect();
        Shape::Mask { min_m: self.min_m, max_m: self.max_m, rows }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mask(sign: &str) -> Shape {
        Shape::Mask { min_m: [0.0; 2], max_m: [100.0; 2], rows: vec![sign.repeat(50); 50] }
    }

    fn levels(shape: &Shape) -> Vec<u32> {
        let Shape::Mask { rows, .. } = shape else { panic!("a mask") };
        rows.iter().flat_map(|row| row.chars().map(|sign| sign.to_digit(10).unwrap_or(0))).collect()
    }

    #[test]
    fn a_dab_falls_from_its_strength_to_nothing_at_its_edge() {
        let brush = Brush { radius_m: 10.0, strength: 0.8, falloff: 0.5 };
        assert_eq!([0.0, 5.0, 10.0, 11.0].map(|at| brush.dab(at)), [0.8, 0.8, 0.0, 0.0]);
        assert!((brush.dab(7.5) - 0.4).abs() < 1e-6);
        let hard = Brush { falloff: 0.0, ..brush };
        assert_eq!([9.99, 10.0].map(|at| hard.dab(at)), [0.8, 0.0]);
        assert!(Brush { radius_m: 0.0, ..brush }.dab(0.0).is_finite());
    }

    #[test]
    fn one_dab_paints_a_disc_and_nothing_else() {
        let mut stroke = Stroke::begin(&mask(".")).unwrap();
        stroke.move_to(&Brush { radius_m: 20.0, strength: 1.0, falloff: 0.0 }, Vec2::new(50.0, 50.0));
        let painted = levels(&stroke.shape());
        let area_m2 = painted.iter().filter(|level| **level == 9).count() as f32 * 4.0;
        assert!((area_m2 / (std::f32::consts::PI * 400.0) - 1.0).abs() < 0.02, "{area_m2} m^2");
        assert_eq!(painted.iter().filter(|level| ![0, 9].contains(*level)).count(), 0);
    }

    /// What is left after so many light dabs is their sum, though each is less than a level.
    #[test]
    fn light_dabs_add_up_and_never_leave_the_levels() {
        let brush = Brush { radius_m: 200.0, strength: 0.04, falloff: 0.0 };
        let mut stroke = Stroke::begin(&mask(".")).unwrap();
        for dabs in 1..=40 {
            stroke.last = None;
            stroke.move_to(&brush, Vec2::splat(50.0));
            let wanted = (9.0 * 0.04 * dabs as f32).min(9.0).round() as u32;
            assert!(levels(&stroke.shape()).iter().all(|level| *level == wanted), "after {dabs}");
        }
        stroke.last = None;
        stroke.move_to(&Brush { strength: -2.0, ..brush }, Vec2::splat(50.0));
        assert_eq!(stroke.shape(), mask("."));
    }

    #[test]
    fn a_stroke_has_no_gaps_however_far_apart_the_pointer_is_seen() {
        let brush = Brush { radius_m: 8.0, strength: 1.0, falloff: 0.0 };
        let mut fast = Stroke::begin(&mask(".")).unwrap();
        let mut slow = fast.clone();
        fast.move_to(&brush, Vec2::new(10.0, 50.0));
        fast.move_to(&brush, Vec2::new(90.0, 50.0));
        (0..=80).for_each(|step| slow.move_to(&brush, Vec2::new(10.0 + step as f32, 50.0)));
        assert_eq!(levels(&fast.shape()), levels(&slow.shape()));
        let painted = levels(&fast.shape());
        assert!((5..45).all(|column| painted[25 * 50 + column] == 9));
        assert!(Stroke::begin(&Shape::default()).is_none());
    }
}
