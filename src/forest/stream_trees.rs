//! Streams the trees of near cells about the viewers.

use super::{
    cells::ForestCells,
    messages::{TreeEntered, TreeLeft},
};
use crate::{cells::ViewerPose, scatter::Planted, viewpoint::Viewpoints};
use bevy::{ecs::system::SystemParam, prelude::*};

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

/// The render layers of a forest, where anything is drawn.
#[cfg(feature = "render")]
type Layers = Option<&'static bevy::camera::visibility::RenderLayers>;
#[cfg(not(feature = "render"))]
type Layers = ();

/// Keeps trees about the viewers: they come nearest first, and go a cell or so a frame.
pub(super) fn stream_trees(
    mut commands: Commands,
    viewpoints: Viewpoints,
    drawn: DrawnTrees,
    mut places: Local<Vec<ViewerPose>>,
    mut forests: Query<(Entity, &mut ForestCells, Layers)>,
    mut entered: MessageWriter<TreeEntered>,
    mut left: MessageWriter<TreeLeft>,
) {
    viewpoints.fill(&mut places);
    for (entity, mut forest, layers) in &mut forests {
        #[cfg(feature = "render")]
        let impostors = forest.impostors();
        let give = |tree: &mut EntityCommands, plant: &Planted| {
            #[cfg(feature = "render")]
            {
                if let Some(impostors) = &impostors {
                    tree.insert(impostors.of(plant));
                }
                if let Some(layers) = layers {
                    tree.insert(layers.clone());
                }
            }
            #[cfg(not(feature = "render"))]
            let ((), ..) = (layers, tree, plant);
        };
        let (near, species, settings, plant) = forest.parts();
        near.receive(entity, species, &mut commands);
        near.follow(&places, plant);
        near.clear(&mut commands);
        near.note_drawn(|tree| drawn.contains(tree), &mut commands);
        near.spawn(settings.trees_per_frame, species, give, &mut commands);
        near.tell(entity, &mut entered, &mut left);
    }
}
