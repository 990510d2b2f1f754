//! The system sets of this crate, and their order.

use bevy::{camera::visibility::VisibilitySystems, prelude::*};

/// The sets that all systems of this crate belong to. Order your own systems against these.
///
/// | schedule | order |
/// |---|---|
/// | `PreUpdate` | `AdvanceWind` |
/// | `Update` | `Stream`, `Bake`, `SelectLod` |
/// | `PostUpdate` | `Pose`, transform propagation, `Upload` and `Query`; `Cull` beside it, before visibility is propagated |
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WindwoodSystems {
    /// In `PreUpdate`. The clock moves on, wind fields that are ready are taken over, every
    /// [`WindCell`](crate::wind::WindCell) gets the wind at its place. Change the [`Wind`](crate::wind::Wind) before it, or
    /// in `Update` for the next frame.
    AdvanceWind,
    /// In `Update`. Cells of forests and chunks of ground come and go about the viewers, and colliders of trees. Nothing precedes it: move viewers
    /// before it.
    Stream,
    /// In `Update`, after `Stream`. Species that were loaded or changed are baked in the background, and so are meadows and
    /// flames. Trees get their models. Meshes, textures and materials that are ready are handed over.
    Bake,
    /// In `Update`, after `Bake`. Every tree gets its level of detail, for every viewer as it stood in the last frame.
    SelectLod,
    /// In `PostUpdate`, after Bevy has updated the frusta of cameras and lights and before it propagates visibility. Cells of
    /// forests outside all of them are hidden.
    Cull,
    /// In `PostUpdate`, before transforms are propagated. Articulated trees move their beams and leaves, by the wind of
    /// `AdvanceWind`.
    Pose,
    /// In `PostUpdate`, after transforms are propagated. Trees that have come or moved are noted, for rays and for what touches them in the next
    /// frame, and listeners are told.
    Query,
    /// In `PostUpdate`, after transforms are propagated. The clock of the frame, and tables that changed, are sent to the
    /// GPU.
    Upload,
}

/// Orders the sets. Every plugin that adds systems to one of them calls this: it does no harm to do so again.
pub(crate) fn configure_sets(app: &mut App) {
    use WindwoodSystems::{Bake, Cull, Pose, Query, SelectLod, Stream, Upload};
    app.configure_sets(Update, (Stream, Bake, SelectLod).chain()).configure_sets(
        PostUpdate,
        (
            Pose.before(TransformSystems::Propagate),
            Cull.after(VisibilitySystems::UpdateFrusta).before(VisibilitySystems::VisibilityPropagate),
            Query.after(TransformSystems::Propagate),
            Upload.after(TransformSystems::Propagate),
        ),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Resource, Default)]
    struct Ran(Vec<WindwoodSystems>);

    fn note(set: WindwoodSystems) -> impl FnMut(ResMut<Ran>) {
        move |mut ran: ResMut<Ran>| ran.0.push(set)
    }

    #[test]
    fn sets_of_a_schedule_run_in_their_documented_order() {
        use WindwoodSystems::{Bake, Pose, SelectLod, Stream, Upload};
        let mut app = App::new();
        app.init_resource::<Ran>();
        // Once for each plugin.
        (0..2).for_each(|_| configure_sets(&mut app));
        for set in [SelectLod, Bake, Stream] {
            app.add_systems(Update, note(set).in_set(set));
        }
        for set in [Upload, Pose] {
            app.add_systems(PostUpdate, note(set).in_set(set));
        }
        app.update();
        assert_eq!(app.world().resource::<Ran>().0, [Stream, Bake, SelectLod, Pose, Upload]);
    }
}
