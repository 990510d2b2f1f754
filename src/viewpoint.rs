//! From where the world is looked at.

use crate::cells;
use bevy::prelude::*;

/// A place about which ground and forest are kept fine. Every `Camera3d` has one; on a server give it to the players. A
/// camera that is switched off does not count.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default)]
#[require(Transform)]
pub struct Viewpoint;

/// The places of all viewpoints that count.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct Viewpoints<'w, 's> {
    places: Query<'w, 's, (&'static GlobalTransform, Option<&'static Camera>), With<Viewpoint>>,
}

impl Viewpoints<'_, '_> {
    /// Their places in the world; none that is not a number.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.frames().map(GlobalTransform::translation)
    }

    /// Fills `viewpoints` with where they are and where they look.
    pub(crate) fn fill(&self, viewpoints: &mut Vec<cells::ViewerPose>) {
        viewpoints.clear();
        let one = |at: &GlobalTransform| cells::ViewerPose { eye_m: at.translation(), forward: at.forward().as_vec3() };
        viewpoints.extend(self.frames().map(one));
    }

    fn frames(&self) -> impl Iterator<Item = &GlobalTransform> {
        let counts = |camera: Option<&Camera>| camera.is_none_or(|camera| camera.is_active);
        let places = self.places.iter().filter(move |(_, camera)| counts(*camera));
        places.map(|(place, _)| place).filter(|place| place.translation().is_finite())
    }
}

/// Gives every camera a [`Viewpoint`].
pub(crate) fn give_cameras_viewpoints(app: &mut App) {
    app.register_type::<Viewpoint>();
    // Whoever has done so before did the same.
    let _ = app.try_register_required_components::<Camera3d, Viewpoint>();
}
