//! What forest and ground know of one another.

use crate::{
    ground::Ground,
    scatter::Planter,
    terrain::{Cover, chunk::drawn_height_m},
};
use bevy::math::DVec2;
use std::sync::Arc;

/// Ground as it is drawn at its finest, for stems to stand on.
pub struct StandingGround {
    ground: Arc<dyn Ground>,
    finest_cell_m: f64,
}

impl StandingGround {
    /// The ground of a terrain whose finest cells are so wide, m.
    pub fn new(ground: Arc<dyn Ground>, finest_cell_m: f32) -> Self {
        Self { ground, finest_cell_m: f64::from(finest_cell_m) }
    }
}

impl Ground for StandingGround {
    fn height_m(&self, place: DVec2) -> f64 {
        drawn_height_m(&self.ground, self.finest_cell_m, place).into()
    }

    /// That of the ground itself: its triangles would have steps.
    fn gradient(&self, place: DVec2) -> DVec2 {
        self.ground.gradient(place)
    }
}

/// The woods of a plan, as the ground sees them.
pub struct PlanCover {
    planter: Planter,
    ground: StandingGround,
}

/// Ground under one crown, on average, m^2: Hemery, Savill & Pryor (2005) have crowns of 4 to 9 m across for stems of 20
/// to 40 cm (cited from memory).
const CROWN_M2: f32 = 30.0;

impl PlanCover {
    /// The woods that `planter` plants on that ground.
    pub fn new(planter: Planter, ground: Arc<dyn Ground>) -> Self {
        Self { planter, ground: StandingGround::new(ground, 1.0) }
    }
}

impl Cover for PlanCover {
    /// With stems at random, a place is under none of their crowns with the probability exp(-density x crown).
    fn share(&self, place: DVec2) -> f32 {
        let per_m2 = self.planter.density_per_ha(place, &self.ground) * 1e-4;
        1.0 - (-per_m2 * CROWN_M2).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scatter::{ForestPlan, plan::Area},
        terrain::Layers,
    };

    #[test]
    fn cover_is_that_of_random_crowns_inside_the_area_and_none_outside() {
        let plan =
            ForestPlan { areas: vec![Area { density_per_ha: 300.0, ..Area::default() }], ..ForestPlan::default() };
        let cover = PlanCover::new(Planter::new(&plan).unwrap(), Arc::new(Layers::default()));
        assert!((cover.share(DVec2::ZERO) - (1.0 - (-0.9f32).exp())).abs() < 1e-6);
        assert_eq!(cover.share(DVec2::new(60.0, 0.0)), 0.0);
    }

    #[test]
    fn stems_stand_on_the_drawn_triangles() {
        struct Bowl;
        impl Ground for Bowl {
            fn height_m(&self, place: DVec2) -> f64 {
                0.01 * place.length_squared()
            }
            fn gradient(&self, place: DVec2) -> DVec2 {
                0.02 * place
            }
        }
        let ground = StandingGround::new(Arc::new(Bowl), 4.0);
        // Half way along the side from (4, 0) to (8, 0).
        assert!((ground.height_m(DVec2::new(6.0, 0.0)) - 0.01 * (16.0 + 64.0) / 2.0).abs() < 1e-6);
        assert!((ground.slope(DVec2::new(10.0, 0.0)) - 0.2).abs() < 1e-6);
    }
}
