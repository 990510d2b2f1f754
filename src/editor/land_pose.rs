//! From where a wood or a piece of ground is looked at.

use bevy::math::{Vec2, Vec3};

/// For a drag over a point, rad.
const DRAG_RAD: f32 = 0.006;
/// For a point of the wheel, as a share of the distance.
const WHEEL: f32 = 0.0025;
const DISTANCES_M: [f32; 2] = [5.0, 20_000.0];
/// Straight down is not quite straight, so that there is an upper edge.
const RISES_RAD: [f32; 2] = [0.05, 1.569];
/// The eye stays so high over the ground, m.
const LEAST_CLEARANCE_M: f32 = 2.0;

/// A view around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LandPose {
    /// The place (x, z) in the middle, m.
    pub middle: Vec2,
    pub distance_m: f32,
    /// About the middle, rad.
    pub turn_rad: f32,
    /// Above the level, rad.
    pub rise_rad: f32,
}

impl Default for LandPose {
    fn default() -> Self {
        Self { middle: Vec2::ZERO, distance_m: 900.0, turn_rad: 0.0, rise_rad: 0.75 }
    }
}

impl LandPose {
    /// From straight above, north up.
    pub fn look_down(&mut self) {
        (self.turn_rad, self.rise_rad) = (0.0, RISES_RAD[1]);
    }

    /// Aslant.
    pub fn look_aslant(&mut self) {
        self.rise_rad = Self::default().rise_rad;
    }

    /// A drag by so many points turns.
    pub fn turn(&mut self, drag: Vec2) {
        self.turn_rad = (self.turn_rad - DRAG_RAD * drag.x) % std::f32::consts::TAU;
        self.rise_rad = (self.rise_rad + DRAG_RAD * drag.y).clamp(RISES_RAD[0], RISES_RAD[1]);
    }

    /// A drag by so many points of a picture of that height shifts the middle.
    pub fn shift(&mut self, drag: Vec2, picture_height: f32) {
        let metres = self.distance_m / picture_height.max(1.0);
        let turned = Vec2::from_angle(-self.turn_rad).rotate(Vec2::new(drag.x, drag.y / self.rise_rad.sin().max(0.2)));
        self.middle -= turned * metres;
    }

    /// The wheel, by so many points, brings nearer and farther.
    pub fn approach(&mut self, points: f32) {
        let factor = (-WHEEL * points.clamp(-400.0, 400.0)).exp();
        self.distance_m = (self.distance_m * factor).clamp(DISTANCES_M[0], DISTANCES_M[1]);
    }

    /// Shows the rectangle around places (x, z).
    pub fn show(&mut self, places: impl IntoIterator<Item = Vec2>) {
        let bounds = places.into_iter().fold(None, |bounds: Option<[Vec2; 2]>, place| {
            Some(bounds.map_or([place; 2], |[min, max]| [min.min(place), max.max(place)]))
        });
        let Some([min, max]) = bounds else { return };
        self.middle = 0.5 * (min + max);
        self.distance_m = (1.9 * (max - min).max_element()).clamp(60.0, DISTANCES_M[1]);
    }

    /// Where the eye is, and where it looks, over ground of those heights, m.
    pub fn eye(&self, height_m: impl Fn(Vec2) -> f32) -> [Vec3; 2] {
        let target = Vec3::new(self.middle.x, height_m(self.middle), self.middle.y);
        let (sine, cosine) = self.rise_rad.sin_cos();
        let towards = Vec3::new(self.turn_rad.sin() * cosine, sine, self.turn_rad.cos() * cosine);
        let eye = target + towards * self.distance_m;
        let floor_m = height_m(Vec2::new(eye.x, eye.z)) + LEAST_CLEARANCE_M;
        [Vec3::new(eye.x, eye.y.max(floor_m), eye.z), target]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eye_stays_over_the_ground_and_sees_the_middle() {
        let mut pose = LandPose { rise_rad: 0.05, distance_m: 100.0, ..LandPose::default() };
        let [eye, target] = pose.eye(|place| if place.length() > 50.0 { 80.0 } else { 0.0 });
        assert_eq!((eye.y, target), (82.0, Vec3::ZERO));
        pose.look_down();
        let [eye, _] = pose.eye(|_| 10.0);
        assert!((eye - Vec3::new(0.0, 110.0, 0.0)).length() < 0.3, "{eye}");
        assert!(eye.z > 0.0, "north is up");
        pose.look_aslant();
        assert_eq!(pose.rise_rad, LandPose::default().rise_rad);
    }

    #[test]
    fn drags_and_the_wheel_stay_within_limits() {
        let mut pose = LandPose::default();
        pose.turn(Vec2::new(10.0, 1e4));
        assert_eq!(pose.rise_rad, RISES_RAD[1]);
        (0..100).for_each(|_| pose.approach(400.0));
        assert_eq!(pose.distance_m, DISTANCES_M[0]);
        (0..100).for_each(|_| pose.approach(-400.0));
        assert_eq!(pose.distance_m, DISTANCES_M[1]);
        pose.show([Vec2::new(-100.0, 0.0), Vec2::new(300.0, 50.0)]);
        assert_eq!((pose.middle, pose.distance_m), (Vec2::new(100.0, 25.0), 760.0));
        let before = pose;
        pose.show([]);
        assert_eq!(pose, before);
        // What is dragged to the right comes along.
        pose.turn_rad = 0.0;
        pose.shift(Vec2::new(10.0, 0.0), 500.0);
        assert!(pose.middle.x < before.middle.x && pose.middle.y == before.middle.y);
    }
}
