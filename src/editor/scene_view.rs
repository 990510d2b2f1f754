//! A view of the ground: which place a point of the picture shows, and where a place is in it.

use std::sync::Arc;

use bevy::math::{DVec2, Mat4, Vec2, Vec3, Vec4Swizzles};

use crate::ground::Ground;

/// How far one looks for the ground along a ray, m.
const FARTHEST_M: f32 = 30_000.0;
/// Steps of that look, and halvings of the last one.
const MOST_STEPS: u32 = 2000;
const HALVINGS: u32 = 40;
/// The least step, m.
const LEAST_STEP_M: f32 = 0.2;
/// Depth of a point that tells the direction in which one looks. It is a thousand times as far as the near plane (depth 1): a nearer one is
/// lost in the eye's own coordinates.
const FAR_DEPTH: f32 = 1e-3;
/// Steps along a line that follows the ground, m, and how many there are at most.
const LINE_STEP_M: f32 = 8.0;
const MOST_LINE_STEPS: f32 = 24.0;

/// A camera over the ground, and the part of the screen that it fills.
#[derive(Clone)]
pub struct SceneView {
    pub clip_from_world: Mat4,
    pub world_from_clip: Mat4,
    pub eye: Vec3,
    /// The corners of its picture, points.
    pub min: Vec2,
    pub max: Vec2,
    pub ground: Arc<dyn Ground>,
}

impl SceneView {
    /// The height of the ground at a place (x, z), m; 0 where there is none.
    pub fn height_m(&self, place: Vec2) -> f32 {
        let height_m = self.ground.height_m(place.as_dvec2());
        if height_m.is_finite() { height_m as f32 } else { 0.0 }
    }

    /// A place on the ground.
    pub fn on_ground(&self, place: Vec2) -> Vec3 {
        Vec3::new(place.x, self.height_m(place), place.y)
    }

    /// Where a point of the world is on the screen, points; none behind the eye.
    pub fn screen(&self, point: Vec3) -> Option<Vec2> {
        let clip = self.clip_from_world * point.extend(1.0);
        if clip.w <= 1e-3 {
            return None;
        }
        let ndc = clip.xy() / clip.w;
        let share = Vec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
        Some(self.min + share * (self.max - self.min))
    }

    /// The direction in which a point of the screen looks.
    pub fn direction(&self, at: Vec2) -> Vec3 {
        let share = (at - self.min) / (self.max - self.min);
        let ndc = Vec3::new(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, FAR_DEPTH);
        (self.world_from_clip.project_point3(ndc) - self.eye).normalize_or(Vec3::NEG_Y)
    }

    /// The place (x, z) on the ground that a point of the screen shows, m; none in the sky.
    pub fn place(&self, at: Vec2) -> Option<Vec2> {
        let direction = self.direction(at);
        let over = |way_m: f32| {
            let point = self.eye + direction * way_m;
            f64::from(point.y) - self.ground.height_m(DVec2::new(f64::from(point.x), f64::from(point.z)))
        };
        let (mut low_m, mut high_m) = (0.0, 0.0);
        for _ in 0..MOST_STEPS {
            let clearance_m = over(high_m);
            if clearance_m <= 0.0 {
                for _ in 0..HALVINGS {
                    let middle_m = 0.5 * (low_m + high_m);
                    if over(middle_m) > 0.0 { low_m = middle_m } else { high_m = middle_m }
                }
                let point = self.eye + direction * high_m;
                return Some(Vec2::new(point.x, point.z));
            }
            low_m = high_m;
            // On slopes of less than 1 no ground is passed over.
            let step_m = if clearance_m.is_finite() { 0.5 * clearance_m as f32 } else { 10.0 };
            high_m += step_m.max(LEAST_STEP_M);
            if high_m > FARTHEST_M {
                return None;
            }
        }
        None
    }

    /// The height, m, at which the upright line over a place is nearest to what a point of the screen shows. None where one looks along
    /// that line.
    pub fn height_at(&self, place: Vec2, at: Vec2) -> Option<f32> {
        let direction = self.direction(at);
        let foot = Vec3::new(place.x, 0.0, place.y);
        let (away, along) = (self.eye - foot, direction.y);
        let level = 1.0 - along * along;
        if level < 1e-4 {
            return None;
        }
        // The nearest points of two lines.
        let height_m = (away.y - along * direction.dot(away)) / level;
        height_m.is_finite().then_some(height_m)
    }

    /// A line over places (x, z) along the ground, as points of the screen; it breaks where it is out of sight behind the eye.
    pub fn line(&self, places: &[Vec2], is_closed: bool) -> Vec<Vec<Vec2>> {
        let mut parts = vec![Vec::new()];
        let ends = if is_closed { places.len() + 1 } else { places.len() };
        let corner = |number: usize| places[number % places.len()];
        for number in 1..ends {
            let (from, to) = (corner(number - 1), corner(number));
            let steps = (from.distance(to) / LINE_STEP_M).ceil().clamp(1.0, MOST_LINE_STEPS) as u32;
            let first = u32::from(number > 1);
            for step in first..=steps {
                let place = from.lerp(to, step as f32 / steps as f32);
                match self.screen(self.on_ground(place)) {
                    Some(point) => parts.last_mut().into_iter().for_each(|part| part.push(point)),
                    None => parts.push(Vec::new()),
                }
            }
        }
        parts.retain(|part| part.len() > 1);
        parts
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use bevy::{
        camera::{CameraProjection, PerspectiveProjection},
        math::Vec3Swizzles,
        prelude::Transform,
    };

    /// A camera 200 m over a place, that looks down at it aslant.
    pub fn view(ground: impl Ground + 'static, min: Vec2, max: Vec2) -> SceneView {
        let eye = Vec3::new(0.0, 200.0, 150.0);
        let world_from_view = Transform::from_translation(eye).looking_at(Vec3::ZERO, Vec3::Y).to_matrix();
        let aspect = (max.x - min.x) / (max.y - min.y);
        let camera = PerspectiveProjection { aspect_ratio: aspect, fov: 0.8, ..PerspectiveProjection::default() };
        let clip_from_view = camera.get_clip_from_view();
        let clip_from_world = clip_from_view * world_from_view.inverse();
        SceneView {
            clip_from_world,
            world_from_clip: clip_from_world.inverse(),
            eye,
            min,
            max,
            ground: Arc::new(ground),
        }
    }

    fn hills(at: DVec2) -> f64 {
        8.0 * (at.x / 25.0).sin() * (at.y / 31.0).cos()
    }

    const CORNERS: [Vec2; 2] = [Vec2::new(400.0, 40.0), Vec2::new(880.0, 600.0)];

    #[test]
    fn a_place_that_is_shown_is_found_again() {
        let view = view(hills, CORNERS[0], CORNERS[1]);
        for x in -4..=4 {
            for z in -4..=4 {
                let place = Vec2::new(x as f32, z as f32) * 13.0;
                let at = view.screen(view.on_ground(place)).unwrap();
                let found = view.place(at).unwrap();
                assert!(found.distance(place) < 0.05, "{place}: {found}");
            }
        }
        let middle = view.screen(Vec3::ZERO).unwrap();
        assert!(middle.distance(0.5 * (CORNERS[0] + CORNERS[1])) < 0.01);
    }

    #[test]
    fn there_is_no_place_in_the_sky_and_no_point_behind_the_eye() {
        let mut view = view(|_| 0.0, CORNERS[0], CORNERS[1]);
        assert_eq!(view.screen(Vec3::new(0.0, 300.0, 400.0)), None);
        view.ground = Arc::new(|_| f64::NAN);
        assert_eq!(view.place(Vec2::new(640.0, 300.0)), None);
        assert_eq!(view.on_ground(Vec2::ONE), Vec3::new(1.0, 0.0, 1.0));
    }

    #[test]
    fn a_point_that_is_dragged_upright_follows_the_pointer() {
        let view = view(hills, CORNERS[0], CORNERS[1]);
        for height_m in [-30.0, 0.0, 42.0] {
            let point = Vec3::new(20.0, height_m, -35.0);
            let at = view.screen(point).unwrap();
            assert!((view.height_at(point.xz(), at).unwrap() - height_m).abs() < 0.01);
        }
        let below = SceneView { eye: Vec3::new(0.0, 200.0, 0.0), ..view };
        assert!(below.height_at(Vec2::ZERO, below.min).is_some());
    }

    #[test]
    fn lines_follow_the_ground_and_break_behind_the_eye() {
        let view = view(hills, CORNERS[0], CORNERS[1]);
        let places = [Vec2::new(-40.0, -40.0), Vec2::new(40.0, -40.0), Vec2::new(40.0, 40.0)];
        let closed = view.line(&places, true);
        assert_eq!(closed.len(), 1);
        assert!(closed[0].len() > 30 && closed[0].first() == closed[0].last());
        let middle = view.screen(view.on_ground(Vec2::new(0.0, -40.0))).unwrap();
        assert!(closed[0].iter().any(|point| point.distance(middle) < 0.1));
        assert!(view.line(&[Vec2::ZERO, Vec2::new(0.0, 900.0), Vec2::new(30.0, 0.0)], false).len() == 2);
        assert!(view.line(&[], true).is_empty());
    }
}
