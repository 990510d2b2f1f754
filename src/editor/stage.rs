//! What stands on the turntable: which trees, of which ages and seasons, and from where they are looked at.

use bevy::math::{Vec2, Vec3};

use super::diagram::View;
use crate::tree::Season;

/// Which trees stand beside one another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// One, of the age and at the season that are set.
    #[default]
    One,
    /// Of five ages.
    Ages,
    /// In winter, spring, summer and autumn.
    Seasons,
    /// Four individuals.
    Variants,
}

impl Arrangement {
    /// All of them, with their names and what they show.
    pub const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::One, "One", "One tree"),
        (Self::Ages, "Ages", "Five ages, from a sapling to a tree beyond maturity"),
        (Self::Seasons, "Seasons", "Winter, spring, summer and autumn"),
        (Self::Variants, "Variants", "Four individuals"),
    ];
}

/// Ages of the row, as shares of the mature age.
const AGES: [f32; 5] = [0.08, 0.2, 0.45, 1.0, 1.8];
/// Individuals of the row.
pub const VARIANTS: u32 = 4;
/// For a drag over a point, rad.
const DRAG_RAD: f32 = 0.006;
/// For a point of the wheel, as a share of the distance.
const WHEEL: f32 = 0.0025;
const DISTANCES: [f32; 2] = [0.15, 3.0];
const RISES_RAD: [f32; 2] = [-0.2, 1.4];
/// Between the crowns of neighbours, as a share of their mean width.
const GAP: f32 = 0.12;

/// What stands on the turntable, and the view of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// What is shown of each tree.
    pub view: View,
    /// Which trees there are.
    pub arrangement: Arrangement,
    /// Whether the tree of the file stands beside the one that is edited.
    pub compares: bool,
    /// As a share of the mature age.
    pub age_share: f32,
    /// Whether it turns by itself.
    pub turns: bool,
    /// About the tree, rad.
    pub turn_rad: f32,
    /// Above the level, rad.
    pub rise_rad: f32,
    /// Distance of the eye, as a share of that from which all is seen.
    pub distance: f32,
    /// Whether arrows show the wind about the tree.
    pub shows_wind: bool,
    /// Whether the crown's envelope is drawn over it, with handles to drag.
    pub shows_envelope: bool,
}

impl Default for Stage {
    fn default() -> Self {
        Self {
            view: View::Lit,
            arrangement: Arrangement::One,
            compares: false,
            age_share: 1.0,
            turns: false,
            turn_rad: 0.25,
            rise_rad: 0.12,
            distance: 1.0,
            shows_wind: false,
            shows_envelope: false,
        }
    }
}

/// A tree of the stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// As a share of the mature age.
    pub age_share: f32,
    /// How far it is ahead of the season, days.
    pub season_days: f32,
    /// Which of the variants it is.
    pub variant: u32,
    /// Whether it is the tree of the file.
    pub is_saved: bool,
}

impl Stage {
    /// The trees, from left to right, at a time of the year.
    pub fn stands(&self, season: Season) -> Vec<Stand> {
        let one = Stand { age_share: self.age_share, season_days: 0.0, variant: 0, is_saved: false };
        let mut stands: Vec<Stand> = match self.arrangement {
            Arrangement::One => vec![one],
            Arrangement::Ages => AGES.map(|age_share| Stand { age_share, ..one }).into(),
            Arrangement::Seasons => {
                let seasons = [Season::WINTER, Season::SPRING, Season::SUMMER, Season::AUTUMN];
                let days = |at: Season| 365.0 * ((at.year - season.year + 0.5).rem_euclid(1.0) - 0.5);
                seasons.map(|at| Stand { season_days: days(at), ..one }).into()
            }
            Arrangement::Variants => (0..VARIANTS).map(|variant| Stand { variant, ..one }).collect(),
        };
        if self.compares {
            stands.insert(0, Stand { is_saved: true, ..one });
        }
        stands
    }

    /// A drag by so many points turns.
    pub fn turn(&mut self, drag: Vec2) {
        self.turn_rad = (self.turn_rad - DRAG_RAD * drag.x) % std::f32::consts::TAU;
        self.rise_rad = (self.rise_rad + DRAG_RAD * drag.y).clamp(RISES_RAD[0], RISES_RAD[1]);
    }

    /// The wheel, by so many points, brings nearer and farther.
    pub fn approach(&mut self, points: f32) {
        let factor = (-WHEEL * points.clamp(-400.0, 400.0)).exp();
        self.distance = (self.distance * factor).clamp(DISTANCES[0], DISTANCES[1]);
    }

    /// How many variants of the species have to be grown for it.
    pub fn variants(&self) -> u32 {
        if self.arrangement == Arrangement::Variants { VARIANTS } else { 1 }
    }

    /// Where the eye is that sees all, and where it looks: trees of a height, m, side by side over a width, m, in a picture of that
    /// ratio of width to height and that vertical field of view, rad.
    pub fn eye(&self, height_m: f32, width_m: f32, aspect: f32, field_rad: f32) -> [Vec3; 2] {
        let extent_m = (1.14 * height_m).max(1.06 * width_m / aspect).max(0.2);
        let far_m = 0.5 * extent_m / (0.5 * field_rad).tan() + 0.15 * width_m.min(height_m);
        let middle = Vec3::Y * 0.49 * height_m;
        let (sine, cosine) = self.rise_rad.sin_cos();
        let towards = Vec3::new(self.turn_rad.sin() * cosine, sine, self.turn_rad.cos() * cosine);
        let eye = middle + towards * (far_m * self.distance);
        // The eye stays over the ground.
        [Vec3::new(eye.x, eye.y.max(0.05 * height_m + 0.1), eye.z), middle]
    }
}

/// Where trees of these widths, m, stand in a row about the middle: places along it, and its whole width, m.
pub fn places_m(widths_m: &[f32]) -> (Vec<f32>, f32) {
    let mean_m = widths_m.iter().sum::<f32>() / widths_m.len().max(1) as f32;
    let gap_m = GAP * mean_m;
    let mut at_m = 0.0;
    let mut places: Vec<f32> = Vec::new();
    for width_m in widths_m {
        places.push(at_m + 0.5 * width_m);
        at_m += width_m + gap_m;
    }
    let whole_m = (at_m - gap_m).max(0.0);
    places.iter_mut().for_each(|place| *place -= 0.5 * whole_m);
    (places, whole_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_do_not_touch_and_the_row_is_in_the_middle() {
        let widths = [4.0, 10.0, 6.0];
        let (places, whole) = places_m(&widths);
        for pair in [0, 1] {
            assert!(places[pair] + 0.5 * widths[pair] < places[pair + 1] - 0.5 * widths[pair + 1]);
        }
        assert!((places[0] - 2.0 + 0.5 * whole).abs() < 1e-5 && (places[2] + 3.0 - 0.5 * whole).abs() < 1e-5);
        assert_eq!(places_m(&[]), (vec![], 0.0));
        assert_eq!(places_m(&[5.0]), (vec![0.0], 5.0));
    }

    #[test]
    fn the_eye_sees_all_of_the_row() {
        for (height_m, width_m, aspect) in [(20.0, 15.0, 1.2), (2.0, 30.0, 0.7), (40.0, 5.0, 2.0)] {
            for rise_rad in [0.0, 0.4] {
                let stage = Stage { rise_rad, turn_rad: 0.0, ..Stage::default() };
                let [eye, middle] = stage.eye(height_m, width_m, aspect, 0.6);
                let forward = (middle - eye).normalize();
                let (right, up) = (Vec3::X, Vec3::X.cross(forward));
                for corner in [[-1.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [1.0, 1.0]] {
                    let point = Vec3::new(0.5 * width_m * corner[0], height_m * corner[1], 0.0) - eye;
                    let depth = point.dot(forward);
                    let (x, y) = (point.dot(right) / depth, point.dot(up) / depth);
                    let half = 0.3_f32.tan();
                    assert!(
                        x.abs() < half * aspect && y.abs() < half,
                        "{corner:?} of {height_m} x {width_m}: {x}, {y}"
                    );
                }
            }
        }
    }

    #[test]
    fn drags_and_the_wheel_stay_within_limits() {
        let mut stage = Stage::default();
        stage.turn(Vec2::new(10.0, 1e4));
        assert_eq!(stage.rise_rad, RISES_RAD[1]);
        assert!(stage.turn_rad < Stage::default().turn_rad);
        (0..100).for_each(|_| stage.approach(400.0));
        assert_eq!(stage.distance, DISTANCES[0]);
        (0..100).for_each(|_| stage.approach(-400.0));
        assert_eq!(stage.distance, DISTANCES[1]);
    }

    #[test]
    fn seasons_are_shifted_to_those_of_the_row() {
        let stage = Stage { arrangement: Arrangement::Seasons, compares: true, ..Stage::default() };
        let stands = stage.stands(Season::SUMMER);
        assert_eq!((stands.len(), stands[0].is_saved), (5, true));
        let years: Vec<f32> = stands[1..].iter().map(|stand| Season::SUMMER.year + stand.season_days / 365.0).collect();
        let wanted = [Season::WINTER, Season::SPRING, Season::SUMMER, Season::AUTUMN].map(|season| season.year);
        let is_near = |(a, b): (&f32, &f32)| (a - b - (a - b).round()).abs() < 1e-4;
        assert!(years.iter().zip(&wanted).all(is_near), "{years:?}");
        assert!(stands.iter().all(|stand| stand.season_days.abs() <= 182.6));
    }
}
