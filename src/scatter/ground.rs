//! The ground, as planting reads it.

/// Ground on which plants stand. This crate's terrain implements it; so may a game for its own ground.
pub trait Ground {
    /// Height at a place, m. Where it is not a finite number there is no ground, and nothing grows.
    fn height_m(&self, x_m: f32, z_m: f32) -> f32;

    /// Steepness at a place: rise over run, 0 on the level.
    fn slope(&self, x_m: f32, z_m: f32) -> f32;
}

impl<T: Ground + ?Sized> Ground for std::sync::Arc<T> {
    fn height_m(&self, x_m: f32, z_m: f32) -> f32 {
        (**self).height_m(x_m, z_m)
    }

    fn slope(&self, x_m: f32, z_m: f32) -> f32 {
        (**self).slope(x_m, z_m)
    }
}

/// Level ground at a height, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelGround(pub f32);

impl Ground for LevelGround {
    fn height_m(&self, _: f32, _: f32) -> f32 {
        self.0
    }

    fn slope(&self, _: f32, _: f32) -> f32 {
        0.0
    }
}
