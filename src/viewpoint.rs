//! From where the world is looked at.

use crate::cells;
use bevy::prelude::*;

/// A place about which ground and forest are kept fine. Every `Camera3d` has one; on a server give it to the players. A
/// camera that is switched off does not count.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default)]
#[require(Transform)]
pub struct Viewpoint;

/// A place, and the camera that looks from there, if one does.
type ViewpointData = (&'static GlobalTransform, Option<&'static Camera>, Option<&'static Projection>);

/// The places of all viewpoints that count.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct Viewpoints<'w, 's> {
    places: Query<'w, 's, ViewpointData, With<Viewpoint>>,
}

impl Viewpoints<'_, '_> {
    /// Their places in the world; none that is not a number.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.active().map(|(at, ..)| at.translation())
    }

    /// Fills `viewpoints` with where they are and where they look.
    pub(crate) fn fill(&self, viewpoints: &mut Vec<cells::ViewerPose>) {
        viewpoints.clear();
        let pose =
            |at: &GlobalTransform| cells::ViewerPose { eye_m: at.translation(), forward: at.forward().as_vec3() };
        viewpoints.extend(self.active().map(|(at, ..)| pose(at)));
    }

    /// Where they are in the world, and their cameras.
    pub(crate) fn active(&self) -> impl Iterator<Item = (&GlobalTransform, Option<&Camera>, Option<&Projection>)> {
        let is_active = |camera: Option<&Camera>| camera.is_none_or(|camera| camera.is_active);
        self.places.iter().filter(move |(at, camera, _)| at.translation().is_finite() && is_active(*camera))
    }
}

/// Gives every camera a [`Viewpoint`].
pub(crate) fn give_cameras_viewpoints(app: &mut App) {
    app.register_type::<Viewpoint>();
    // Whoever has done so before did the same.
    let _ = app.try_register_required_components::<Camera3d, Viewpoint>();
}
