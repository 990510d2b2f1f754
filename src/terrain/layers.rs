//! Ground as the sum of grounds.

use crate::ground::Ground;
use bevy::math::DVec2;
use std::sync::Arc;

/// The sum of several grounds, such as hills formed by hand with random detail; empty, the plane at elevation 0.
#[derive(Clone, Default)]
pub struct Layers(pub Vec<Arc<dyn Ground>>);

impl Ground for Layers {
    fn height_m(&self, place: DVec2) -> f64 {
        self.0.iter().map(|layer| layer.height_m(place)).sum()
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        self.0.iter().map(|layer| layer.gradient(place)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use bevy::math::Vec3;

    #[test]
    fn layers_add_up() {
        let layers = Layers(vec![Arc::new(|at: DVec2| 0.5 * at.x), Arc::new(|at: DVec2| -0.2 * at.x)]);
        assert_relative_eq!(layers.height_m(DVec2::new(10.0, 3.0)), 3.0, epsilon = 1e-12);
        assert_relative_eq!(layers.gradient(DVec2::ZERO).x, 0.3, epsilon = 1e-12);
        assert_eq!(Layers::default().normal(DVec2::ONE), Vec3::Y);
    }
}
