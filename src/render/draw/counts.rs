//! How many trees are drawn at which level, for diagnostics and gizmos.

use crate::{
    lod::MOST_LEVELS,
    render::{
        instances::{components::TreeInstance, tables::InstanceTables},
        lod::thresholds::LodSelection,
    },
};
use bevy::{ecs::system::SystemParam, prelude::*};

/// The levels of all trees.
#[derive(SystemParam)]
pub(crate) struct TreesByLod<'w, 's> {
    trees: Query<'w, 's, (&'static LodSelection, &'static GlobalTransform), With<TreeInstance>>,
    tables: Option<Res<'w, InstanceTables>>,
}

impl TreesByLod<'_, '_> {
    /// Trees of each level, and how many of them fade into the next.
    pub fn count(&self) -> ([usize; MOST_LEVELS], usize) {
        let mut count = ([0; MOST_LEVELS], 0);
        for (selection, _) in &self.trees {
            count.0[usize::from(selection.lod).min(MOST_LEVELS - 1)] += 1;
            count.1 += usize::from(selection.is_fading);
        }
        count
    }

    /// Size of the tables of trees on the GPU, bytes.
    pub fn table_bytes(&self) -> usize {
        self.tables.as_ref().map_or(0, |tables| tables.bytes())
    }

    /// Where each tree stands, and its level.
    pub fn iter(&self) -> impl Iterator<Item = (Vec3, usize)> + '_ {
        self.trees.iter().map(|(selection, at)| (at.translation(), usize::from(selection.lod)))
    }
}
