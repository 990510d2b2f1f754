//! The envelope of a crown as something that is dragged in the picture: its base, its top, and how wide it is.

use bevy::math::Vec3;

use crate::tree::{
    Growth, Species,
    growth::envelope::{Envelope, EnvelopeShape},
};

/// What is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnvelopeHandle {
    Base,
    Top,
    Radius,
}

/// Points of an outline's side.
const POINTS: u32 = 32;
/// Sizes are kept to so many parts of a metre.
const PARTS_OF_A_METRE: f32 = 10.0;
/// The least that is left of a crown's height.
const LEAST_HEIGHT_M: f32 = 0.5;

/// The envelope of a tree of some share of its mature age, if its species has one.
pub fn envelope_of(species: &Species, age_share: f32) -> Option<Envelope> {
    let Growth::ReevesBlau(growth) = &species.growth else { return None };
    let stage = species.age.stage(age_share * species.age.mature_years);
    Some(growth.envelope.scaled(stage.height, stage.crown))
}

/// One side of its outline, from the base to the top. `side` is the level direction in which it lies.
pub fn outline(envelope: &Envelope, side: Vec3) -> Vec<Vec3> {
    let place = |point: u32| {
        let share = point as f32 / POINTS as f32;
        let height_m = envelope.base_m + share * (envelope.top_m - envelope.base_m);
        let axis = height_m * Vec3::Y;
        axis + envelope.exit_distance_m(axis, side) * side
    };
    (0..=POINTS).map(place).collect()
}

/// Its handles: two on the axis, and one at the widest place of that side.
pub fn handles(envelope: &Envelope, side: Vec3) -> [(EnvelopeHandle, Vec3); 3] {
    let widest_m = match envelope.shape {
        EnvelopeShape::Ellipsoid | EnvelopeShape::Cylinder => 0.5 * (envelope.base_m + envelope.top_m),
        EnvelopeShape::Cone | EnvelopeShape::Paraboloid | EnvelopeShape::Dome => envelope.base_m,
        EnvelopeShape::InvertedCone => envelope.top_m,
    };
    [
        (EnvelopeHandle::Base, envelope.base_m * Vec3::Y),
        (EnvelopeHandle::Top, envelope.top_m * Vec3::Y),
        (EnvelopeHandle::Radius, widest_m * Vec3::Y + envelope.radius_m * side),
    ]
}

/// The species whose envelope, at that share of the mature age, has a handle at another height, or that radius, m.
pub fn with_handle_at(species: &Species, age_share: f32, handle: EnvelopeHandle, to_m: f32) -> Option<Species> {
    let mut changed = species.clone();
    let stage = species.age.stage(age_share * species.age.mature_years);
    let Growth::ReevesBlau(growth) = &mut changed.growth else { return None };
    let envelope = &mut growth.envelope;
    let grown = match handle {
        EnvelopeHandle::Base | EnvelopeHandle::Top => stage.height,
        EnvelopeHandle::Radius => stage.crown,
    };
    let to_m = (to_m / grown * PARTS_OF_A_METRE).round() / PARTS_OF_A_METRE;
    if !to_m.is_finite() {
        return None;
    }
    match handle {
        EnvelopeHandle::Base => envelope.base_m = to_m.clamp(0.0, envelope.top_m - LEAST_HEIGHT_M),
        EnvelopeHandle::Top => envelope.top_m = to_m.clamp(envelope.base_m + LEAST_HEIGHT_M, 120.0),
        EnvelopeHandle::Radius => envelope.radius_m = to_m.clamp(0.1, 60.0),
    }
    Some(changed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn handles_lie_on_the_outline_of_every_shape() {
        for shape in [
            EnvelopeShape::Ellipsoid,
            EnvelopeShape::Cone,
            EnvelopeShape::Paraboloid,
            EnvelopeShape::Cylinder,
            EnvelopeShape::Dome,
            EnvelopeShape::InvertedCone,
        ] {
            let envelope = Envelope { shape, ..Envelope::default() };
            let side = Vec3::new(0.6, 0.0, 0.8);
            let outline = outline(&envelope, side);
            let [_, _, (_, widest)] = handles(&envelope, side);
            let distance = |point: &Vec3| point.distance(widest);
            let nearest = outline.iter().map(distance).fold(f32::INFINITY, f32::min);
            assert!(nearest < 0.5, "{shape:?}: {nearest} m off");
            let widest_m = outline.iter().map(|point| point.x.hypot(point.z)).fold(0.0, f32::max);
            assert!((widest_m / envelope.radius_m - 1.0).abs() < 0.01, "{shape:?}: {widest_m}");
        }
    }

    #[test]
    fn a_handle_that_is_dragged_is_where_it_was_dragged_to() {
        let species = Species::default();
        for age_share in [1.0, 0.4] {
            for (handle, to_m) in
                [(EnvelopeHandle::Base, 1.0), (EnvelopeHandle::Top, 15.0), (EnvelopeHandle::Radius, 4.0)]
            {
                let changed = with_handle_at(&species, age_share, handle, to_m).unwrap();
                let envelope = envelope_of(&changed, age_share).unwrap();
                let own = match handle {
                    EnvelopeHandle::Base => envelope.base_m,
                    EnvelopeHandle::Top => envelope.top_m,
                    EnvelopeHandle::Radius => envelope.radius_m,
                };
                assert!((own - to_m).abs() < 0.06, "{handle:?} at {age_share}: {own}");
            }
        }
        let upside_down = with_handle_at(&species, 1.0, EnvelopeHandle::Top, -7.0).unwrap();
        assert!(envelope_of(&upside_down, 1.0).is_some_and(|envelope| envelope.top_m > envelope.base_m));
        assert_eq!(with_handle_at(&species, 1.0, EnvelopeHandle::Top, f32::NAN), None);
    }
}
