//! To what trees are exposed, and what room they need because of it.

use super::active::{ActiveSway, WeightedResponse};
use crate::tree::{Season, SwayBounds, TreeModel, phenology::Phenology};
use bevy::{camera::primitives::Aabb, prelude::*};

/// How hard the winds may press on a tree, and the time of the year.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exposure {
    /// At most, on any beam, while the winds of now blow, m²/s²; infinite while none is known. It goes in steps, so that boxes
    /// are not made anew for every little change.
    pressure: f32,
    /// Of the year.
    week: u8,
}

impl Default for Exposure {
    fn default() -> Self {
        Self { pressure: f32::INFINITY, week: 0 }
    }
}

/// From one step of pressures to the next: tip angles and boxes grow by less.
const STEP: f32 = 1.3;
/// The least step: a breath of air, m²/s².
const LEAST_PRESSURE: f32 = 0.1;
/// Weeks of a year.
const WEEKS: f32 = 52.0;

impl Exposure {
    fn new(strongest: Option<f32>, season: Season) -> Self {
        let step = |pressure: f32| STEP.powf((pressure.max(LEAST_PRESSURE).ln() / STEP.ln()).ceil());
        Self {
            pressure: strongest.filter(|pressure| pressure.is_finite()).map_or(f32::INFINITY, step),
            week: (season.wrapped() * WEEKS) as u8,
        }
    }

    /// The box around a tree, with leaves that drift from it, tree-local, m.
    pub fn bounds(&self, model: &TreeModel, phenology: &Phenology) -> SwayBounds {
        let SwayBounds { min, max } = model.bounds_under(self.pressure);
        let sheds = phenology.may_shed(f32::from(self.week) / WEEKS);
        let aside = if sheds { Vec3::new(Phenology::DRIFT_M, 0.0, Phenology::DRIFT_M) } else { Vec3::ZERO };
        SwayBounds { min: min - aside, max: max + aside }
    }

    /// The same as the renderer has it.
    pub(super) fn aabb(&self, model: &TreeModel, phenology: &Phenology) -> Aabb {
        let SwayBounds { min, max } = self.bounds(model, phenology);
        Aabb::from_min_max(min, max)
    }
}

/// Finds out to what trees are exposed, when another wind begins or ends to blow, or another week.
pub(super) fn find_exposure(sway: Res<ActiveSway>, season: Res<Season>, mut exposure: ResMut<Exposure>) {
    let pressures = sway.now().map(|WeightedResponse { response, .. }| response.strongest_pressure);
    exposure.set_if_neq(Exposure::new(pressures.reduce(f32::max), *season));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Species;

    #[test]
    fn pressures_are_never_rounded_down() {
        for pressure in [0.0, 0.3, 7.0, 333.0, 1e5] {
            let stepped = Exposure::new(Some(pressure), Season::SUMMER).pressure;
            assert!(stepped >= pressure * 0.9999 && stepped <= 1.31 * pressure.max(LEAST_PRESSURE), "{stepped}");
        }
        assert_eq!(Exposure::new(None, Season::SUMMER).pressure, f32::INFINITY);
        assert_eq!(Exposure::new(Some(f32::NAN), Season::SUMMER).pressure, f32::INFINITY);
    }

    #[test]
    fn leaves_that_drift_need_room_aside() {
        let species = Species::default();
        let model = TreeModel::bake(&species, 40.0, 1);
        let width = |season| {
            let SwayBounds { min, max } = Exposure::new(Some(50.0), season).bounds(&model, &species.phenology);
            max.x - min.x
        };
        let more_m = width(Season { year: 0.87 }) - width(Season::SUMMER);
        assert!((more_m - 2.0 * Phenology::DRIFT_M).abs() < 1e-4, "{more_m}");
    }
}
