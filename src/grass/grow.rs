//! Patches of grass, and the meadows that grow from them in the background.

use super::{
    blades::{Blade, lay_out},
    settings::{GrassLook, GrassResponse, Sward},
};
use crate::setting::SettingError;
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::sync::Arc;

/// A patch of grass about this entity, drawn as one. The entity's transform is the plane it grows on, unless it has a
/// [`GrassGround`].
///
/// A patch with a setting out of range is refused with one warning; the last good meadow stays.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform, Visibility)]
pub struct GrassPatch {
    /// Where the blades stand and what they are like. A change lays them out anew, in the background.
    pub sward: Sward,
    /// Colours and distances.
    pub look: GrassLook,
    /// How the blades answer the wind.
    pub response: GrassResponse,
}

impl GrassPatch {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.sward.validate().map_err(|error| error.inside("sward"))?;
        self.look.validate().map_err(|error| error.inside("look"))?;
        self.response.validate().map_err(|error| error.inside("response"))
    }
}

/// Uneven ground under a [`GrassPatch`]: the height, m, at the patch's own (x, z), both in the patch's coordinates. Heights
/// are read once, when the meadow grows; put in another `GrassGround` to have it grow anew. Where the height is not a number,
/// nothing grows: ponds, paths, hearths. Called on a background thread.
#[derive(Component, Clone)]
pub struct GrassGround(pub Arc<dyn Fn(Vec2) -> f32 + Send + Sync>);

/// What grew on a patch. Written in [`WindwoodSystems::Grow`](crate::WindwoodSystems::Grow).
#[derive(Component, Clone, Debug)]
#[component(immutable)]
pub struct Meadow {
    /// The blades, in the order of their rank: every prefix is a thinner meadow.
    pub blades: Arc<Vec<Blade>>,
    /// The patch as it was, with settings that are known to be good.
    pub patch: GrassPatch,
}

/// A meadow that is being laid out.
#[derive(Component)]
pub(super) struct Sowing(Task<Meadow>);

/// Starts laying out what is new or has changed.
pub(super) fn sow_patches(
    mut commands: Commands,
    patches: Query<
        (Entity, Ref<GrassPatch>, Option<Ref<GrassGround>>, Option<&Meadow>),
        Or<(Changed<GrassPatch>, Changed<GrassGround>)>,
    >,
) {
    for (entity, patch, ground, meadow) in &patches {
        if let Err(error) = patch.validate() {
            warn!("grass patch {entity}: {error}; the last good meadow stays");
            continue;
        }
        let is_levelled = ground.as_ref().is_some_and(Ref::is_changed);
        if let Some(meadow) = meadow.filter(|meadow| meadow.patch.sward == patch.sward && !is_levelled) {
            // Only the look has changed: the blades stay, and what may be growing is out of date.
            let blades = meadow.blades.clone();
            commands.entity(entity).remove::<Sowing>().insert(Meadow { blades, patch: GrassPatch::clone(&patch) });
            continue;
        }
        let (patch, ground) = (GrassPatch::clone(&patch), ground.map(|ground| ground.0.clone()));
        let task = AsyncComputeTaskPool::get().spawn(async move {
            let height_m = |at: Vec2| ground.as_ref().map_or(0.0, |ground| ground(at));
            Meadow { blades: Arc::new(lay_out(&patch.sward, height_m)), patch }
        });
        commands.entity(entity).insert(Sowing(task));
    }
}

/// Takes over meadows that have been laid out.
pub(super) fn receive_meadows(mut commands: Commands, mut sowing: Query<(Entity, &mut Sowing)>) {
    for (entity, mut sowing) in &mut sowing {
        if let Some(meadow) = block_on(poll_once(&mut sowing.0)) {
            commands.entity(entity).remove::<Sowing>().insert(meadow);
        }
    }
}

/// A patch that is taken off an entity takes its meadow with it.
pub(super) fn clear_patch(removed: On<Remove<GrassPatch>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(Sowing, Meadow)>();
    }
}
