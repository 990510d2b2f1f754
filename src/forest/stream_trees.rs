//! Streams the trees of near cells about the viewers.

use super::cells::ForestCells;
use crate::{cells::ViewerPose, viewpoint::Viewpoints};
use bevy::{ecs::system::SystemParam, prelude::*, tasks::AsyncComputeTaskPool};

/// Which trees are drawn. Where nothing draws, all count as drawn.
#[derive(SystemParam)]
pub(super) struct DrawnTrees<'w, 's> {
    #[cfg(feature = "render")]
    capabilities: Option<Res<'w, crate::render::RenderCapabilities>>,
    #[cfg(feature = "render")]
    drawn: Query<'w, 's, (), With<crate::render::TreeMeshes>>,
    #[cfg(feature = "render")]
    trees: Query<'w, 's, (), With<crate::tree::Tree>>,
    #[cfg(not(feature = "render"))]
    marker: std::marker::PhantomData<(&'w (), &'s ())>,
}

impl DrawnTrees<'_, '_> {
    /// A tree that the game has despawned counts as drawn: nothing waits for it.
    #[cfg(feature = "render")]
    fn contains(&self, tree: Entity) -> bool {
        self.capabilities.is_none() || self.drawn.contains(tree) || !self.trees.contains(tree)
    }

    #[cfg(not(feature = "render"))]
    fn contains(&self, _: Entity) -> bool {
        true
    }
}

/// Keeps trees about the viewers: they come nearest first, and go a cell or so a frame.
pub(super) fn stream_trees(
    mut commands: Commands,
    viewpoints: Viewpoints,
    drawn: DrawnTrees,
    mut places: Local<Vec<ViewerPose>>,
    mut forests: Query<(Entity, &mut ForestCells)>,
) {
    viewpoints.fill(&mut places);
    for (entity, mut forest) in &mut forests {
        let (planter, ground) = (forest.shared_planter(), forest.ground());
        let (near, species, settings) = forest.parts();
        near.receive(entity, species, &mut commands);
        near.follow(&places, |cell| {
            let (planter, ground) = (planter.clone(), ground.clone());
            AsyncComputeTaskPool::get().spawn(async move {
                let mut planted = Vec::new();
                planter.plant(cell, &ground, &mut planted);
                planted
            })
        });
        near.clear(&mut commands);
        near.note_drawn(|tree| drawn.contains(tree), &mut commands);
        near.spawn(settings, species, &mut commands);
    }
}
