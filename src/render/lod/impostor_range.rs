//! Where impostors stand for trees.

use bevy::prelude::*;

/// Where the impostors of far trees begin. It is written by what draws them.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ImpostorRange {
    /// No impostor stands for a tree nearer than this, m; none while there are no impostors.
    pub from_m: Option<f32>,
}
