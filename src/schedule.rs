//! When our systems run.

use bevy::prelude::SystemSet;

/// The sets that our systems belong to. Order your own systems against these.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WindwoodSystems {
    /// In `PreUpdate`. The clock moves on, finished wind fields are taken over, every [`WindCell`](crate::wind::WindCell)
    /// gets the wind of its place. Change the [`Wind`](crate::wind::Wind) before it (or in `Update`, for the next frame).
    AdvanceWind,
    /// In `Update`. Species that were loaded or changed are baked in the background, and trees get their models; ground
    /// about the viewers is built.
    Grow,
    /// In `PostUpdate`, before transforms are propagated. Articulated trees move their beams and leaves.
    Pose,
    /// In `PostUpdate`, after `Pose`. The clock of the frame, and tables that changed, go to the graphics processor.
    Upload,
}
