//! What a tree has while it is awake.

use crate::{
    dynamics::{
        BeamDynamics, BeamWind, LiveBeam, LiveTree,
        stand_wind::{StandWind, WindAtTree},
        strike,
    },
    sway::active::{ActiveSway, WeightedResponse},
    tree::TreeModel,
    wind::Canopy,
};
use bevy::{math::Vec3A, prelude::*};

/// A tree that is awake: something has touched it, and it has not come to rest. It is our own: a clone of the tree sleeps.
#[derive(Component, Default)]
#[component(clone_behavior = Ignore)]
pub struct LiveSway {
    pub(super) beams: Vec<LiveBeam>,
    pub(super) tree: LiveTree,
    /// The wind in the tree's stand, for each wind that blows.
    pub(super) stands: [Option<StandWind>; 2],
    made_for: Option<(u64, AssetId<TreeModel>, f32, f32, Canopy)>,
    /// Blows that it has yet to feel: place and impulse, in the world.
    pub(super) blows: Vec<[Vec3; 2]>,
    /// Frames since it woke up.
    pub(super) frames: u32,
    /// Whether something touches it in this frame.
    pub(super) is_touched: bool,
    /// The wind of sources at the tree, in its axes.
    pub(super) wind: WindAtTree,
    /// One frame ago: free angles, and the wind of sources.
    pub(super) angles_before: Vec<Vec3A>,
    pub(super) wind_before: WindAtTree,
}

impl LiveSway {
    /// A tree that is about to feel a blow.
    pub(super) fn struck(blow: [Vec3; 2]) -> Self {
        Self { blows: vec![blow], is_touched: true, ..Self::default() }
    }

    /// A tree that is touched otherwise.
    pub(super) fn touched() -> Self {
        Self { is_touched: true, ..Self::default() }
    }

    /// Number of its beams.
    #[cfg(feature = "render")]
    pub(crate) fn len(&self) -> usize {
        self.tree.len()
    }

    /// What is added to the free tip angle of each beam, in the order of the model's, rad, tree-local.
    pub fn angles(&self) -> impl Iterator<Item = Vec3A> {
        self.tree.angles()
    }

    /// The same one frame ago.
    #[cfg(feature = "render")]
    pub(crate) fn angles_before(&self) -> impl Iterator<Item = Vec3A> {
        self.angles_before.iter().copied()
    }

    /// The wind of sources at the tree, which its leaves feel, in its axes.
    pub(crate) fn wind(&self) -> WindAtTree {
        self.wind
    }

    /// The same one frame ago.
    #[cfg(feature = "render")]
    pub(crate) fn wind_before(&self) -> WindAtTree {
        self.wind_before
    }

    /// Prepares its beams anew when the wind, the model, its size, its share of leaves or its stand is another.
    pub(super) fn refresh(
        &mut self,
        sway: &ActiveSway,
        (id, model): (AssetId<TreeModel>, &TreeModel),
        scale: f32,
        leaf_share: f32,
        canopy: Canopy,
    ) {
        let key = Some((sway.generation(), id, scale, leaf_share, canopy));
        if self.made_for == key {
            return;
        }
        // Another model has other beams: what these did is over.
        if self.made_for.is_some_and(|(_, before, ..)| before != id) {
            self.tree = LiveTree::default();
        }
        self.stands = [None; 2];
        let mut newest: Option<BeamWind> = None;
        for (stand, WeightedResponse { response, .. }) in self.stands.iter_mut().zip(sway.now()) {
            let wind = response.beam_wind_in(&canopy);
            *stand = Some(wind.stand);
            newest = Some(wind);
        }
        let Some(wind) = newest else { return };
        self.beams.clear();
        self.beams.extend(model.beams.iter().map(|beam| LiveBeam::new(beam, &wind, scale, leaf_share)));
        self.tree.prepare(&self.beams, &wind.grid);
        self.made_for = key;
    }

    /// Feels the blows that have come.
    pub(super) fn feel_blows(&mut self, beams: &[BeamDynamics], stands: &GlobalTransform, local: Mat3, scale: f32) {
        let local_from_world = stands.affine().inverse();
        for [place, impulse_n_s] in self.blows.drain(..) {
            strike(&mut self.tree, beams, scale, local_from_world.transform_point3(place), local * impulse_n_s);
        }
    }

    /// Notes what is now as what was, before a step.
    pub(super) fn begin_frame(&mut self) {
        self.angles_before.clear();
        self.angles_before.extend(self.tree.angles());
        self.wind_before = self.wind;
        self.frames = self.frames.wrapping_add(1);
    }
}
