//! How hard the winds press on trees, and the bounds that trees need because of it.

use crate::{
    sway::{ActiveSway, WeightedResponse},
    tree::{PressureStep, Season, SwayBounds, TreeModel, phenology::Phenology},
};
use bevy::{camera::primitives::Aabb, prelude::*};

/// How hard the winds may press on a tree, and the time of the year.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub(crate) struct WindExposure {
    /// At most, on any beam, while the winds of now blow; the limit while none is known.
    pressure: PressureStep,
    /// Of the year.
    week: u8,
}

impl Default for WindExposure {
    fn default() -> Self {
        Self { pressure: PressureStep::LIMIT, week: 0 }
    }
}

/// Weeks of a year.
const WEEKS: f32 = 52.0;

impl WindExposure {
    fn new(strongest: Option<f32>, season: Season) -> Self {
        Self {
            pressure: strongest.map_or(PressureStep::LIMIT, PressureStep::of),
            week: (season.wrapped() * WEEKS) as u8,
        }
    }

    /// The box around a tree, with leaves that drift from it, tree-local, m.
    pub fn bounds(&self, model: &TreeModel, phenology: &Phenology) -> SwayBounds {
        let SwayBounds { min, max } = model.bounds_at(self.pressure);
        let sheds = phenology.may_shed(f32::from(self.week) / WEEKS);
        let aside = if sheds { Vec3::new(Phenology::DRIFT_M, 0.0, Phenology::DRIFT_M) } else { Vec3::ZERO };
        SwayBounds { min: min - aside, max: max + aside }
    }

    /// The same as the renderer has it.
    pub(crate) fn aabb(&self, model: &TreeModel, phenology: &Phenology) -> Aabb {
        let SwayBounds { min, max } = self.bounds(model, phenology);
        Aabb::from_min_max(min, max)
    }
}

/// Updates the exposure when another wind begins or ends to blow, or another week.
pub(crate) fn update_wind_exposure(sway: Res<ActiveSway>, season: Res<Season>, mut exposure: ResMut<WindExposure>) {
    let pressures = sway.now().map(|WeightedResponse { response, .. }| response.strongest_pressure);
    exposure.set_if_neq(WindExposure::new(pressures.reduce(f32::max), *season));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Species;

    #[test]
    fn bounds_hold_any_wind_while_none_is_known() {
        for unknown in [None, Some(f32::NAN)] {
            assert_eq!(WindExposure::new(unknown, Season::SUMMER).pressure, PressureStep::LIMIT);
        }
    }

    #[test]
    fn drifting_leaves_widen_the_bounds() {
        let species = Species::default();
        let model = TreeModel::bake(&species, 40.0, 1);
        let width = |season| {
            let SwayBounds { min, max } = WindExposure::new(Some(50.0), season).bounds(&model, &species.phenology);
            max.x - min.x
        };
        let more_m = width(Season { year: 0.87 }) - width(Season::SUMMER);
        assert!((more_m - 2.0 * Phenology::DRIFT_M).abs() < 1e-4, "{more_m}");
    }
}
