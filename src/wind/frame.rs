//! Wind coordinates: the frame in which the mean wind blows along the first axis.
//!
//! Wind coordinates are (along, up, across): along = where the mean wind blows to, up = the world's Y,
//! across = along x up. The frame is right-handed, as the world is.

use bevy::math::{Dir2, Mat3, Vec3};

/// Turns vectors between world coordinates and wind coordinates (along, up, across).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindFrame {
    /// Where the mean wind blows to: a horizontal unit vector in world coordinates.
    pub along: Vec3,
    /// To the right of it, seen from above with the wind blowing away: a horizontal unit vector in world coordinates.
    pub across: Vec3,
}

impl WindFrame {
    /// The frame of a wind that blows towards `direction`, in the world's (X, Z).
    pub fn new(direction: Dir2) -> Self {
        let along = Vec3::new(direction.x, 0.0, direction.y);
        Self { along, across: Vec3::new(-along.z, 0.0, along.x) }
    }

    /// World vector to (along, up, across).
    pub fn to_wind(&self, world: Vec3) -> Vec3 {
        Vec3::new(world.dot(self.along), world.y, world.dot(self.across))
    }

    /// The rotation that turns world vectors to (along, up, across).
    #[must_use]
    pub fn wind_from_world(&self) -> Mat3 {
        Mat3::from_cols(self.along, Vec3::Y, self.across).transpose()
    }

    /// (along, up, across) to world vector.
    pub fn to_world(&self, wind: Vec3) -> Vec3 {
        self.along * wind.x + Vec3::Y * wind.y + self.across * wind.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Vec2;

    #[test]
    fn wind_coordinates_are_right_handed_along_up_across() {
        let frame = WindFrame::new(Dir2::new(Vec2::new(0.6, -0.8)).unwrap());
        assert!(frame.across.abs_diff_eq(frame.along.cross(Vec3::Y), 1e-7));
        assert!(frame.to_wind(frame.along).abs_diff_eq(Vec3::X, 1e-6));
        assert!(frame.to_wind(Vec3::Y).abs_diff_eq(Vec3::Y, 1e-6));
        assert!(frame.to_wind(frame.across).abs_diff_eq(Vec3::Z, 1e-6));
    }

    #[test]
    fn to_world_inverts_to_wind() {
        let vector = Vec3::new(1.0, -2.0, 3.0);
        for step in 0..16 {
            let frame = WindFrame::new(Dir2::new(Vec2::from_angle(step as f32 * 0.4)).unwrap());
            // A few roundings of f32 on components of about 3.
            assert!(frame.to_world(frame.to_wind(vector)).abs_diff_eq(vector, 2e-6));
        }
    }
}
