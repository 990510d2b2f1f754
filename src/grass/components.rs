//! Patches of grass, and their blades, which are laid out in the background.

use super::{
    blades::{Blade, layout_blades},
    settings::{GrassLook, GrassResponse, Sward},
};
use crate::{
    background::{Work, spawn_work},
    ground::{Cover, Ground, LevelGround},
    setting::SettingError,
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
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
    /// Where the blades stand, their sizes and shapes. A change lays them out again, in the background.
    pub sward: Sward,
    /// Colours and distances.
    pub look: GrassLook,
    /// How the blades respond to the wind.
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

/// Uneven ground under a [`GrassPatch`], in the patch's own coordinates. Heights are read once, when the blades are laid out;
/// insert another `GrassGround` to have them laid out again. Where the height is not a number, nothing grows: ponds, paths,
/// hearths. Read on a background thread.
#[derive(Component, Clone)]
pub struct GrassGround(pub Arc<dyn Ground>);

/// Woods over a [`GrassPatch`], in the patch's own coordinates: grass below them has less of the sky's light. Read with the ground, on a
/// background thread.
#[derive(Component, Clone)]
pub struct GrassShade(pub Arc<dyn Cover>);

/// The blades of a patch. Written in [`WindwoodSystems::Bake`](crate::WindwoodSystems::Bake).
#[derive(Component, Clone, Debug)]
#[component(immutable)]
pub struct Meadow {
    /// The blades, in the order of their rank: every prefix is a thinner meadow.
    pub blades: Arc<Vec<Blade>>,
    /// The patch that they were laid out for: its settings are valid.
    pub patch: GrassPatch,
}

/// A meadow that is being laid out in the background.
#[derive(Component)]
pub(super) struct MeadowLayout(Work<Meadow>);

/// Starts to lay out meadows that are new or have changed.
pub(super) fn start_meadow_layouts(
    mut commands: Commands,
    patches: Query<
        (Entity, Ref<GrassPatch>, Option<Ref<GrassGround>>, Option<Ref<GrassShade>>, Option<&Meadow>),
        Or<(Changed<GrassPatch>, Changed<GrassGround>, Changed<GrassShade>)>,
    >,
) {
    for (entity, patch, ground, shade, meadow) in &patches {
        if let Err(error) = patch.validate() {
            warn!("grass patch {entity}: {error}; the last good meadow stays");
            continue;
        }
        let is_ground_new = ground.as_ref().is_some_and(Ref::is_changed) || shade.as_ref().is_some_and(Ref::is_changed);
        if let Some(meadow) = meadow.filter(|meadow| meadow.patch.sward == patch.sward && !is_ground_new) {
            // Only the look has changed: the blades stay, and a layout that runs is out of date.
            let blades = meadow.blades.clone();
            commands
                .entity(entity)
                .remove::<MeadowLayout>()
                .insert(Meadow { blades, patch: GrassPatch::clone(&patch) });
            continue;
        }
        let patch = GrassPatch::clone(&patch);
        let ground = ground.map_or_else(|| Arc::new(LevelGround::default()) as Arc<dyn Ground>, |own| own.0.clone());
        let shade = shade.map(|shade| shade.0.clone());
        let task = spawn_work(move || {
            let mut blades = layout_blades(&patch.sward, &ground);
            if let Some(shade) = shade {
                let share = |blade: &Blade| shade.share(blade.root.xz().as_dvec2());
                blades.iter_mut().for_each(|blade| blade.under_trees = share(blade).clamp(0.0, 1.0));
            }
            Meadow { blades: Arc::new(blades), patch }
        });
        commands.entity(entity).insert(MeadowLayout(task));
    }
}

/// Takes over meadows that have been laid out.
pub(super) fn finish_meadow_layouts(mut commands: Commands, mut layouts: Query<(Entity, &mut MeadowLayout)>) {
    for (entity, mut layout) in &mut layouts {
        let Some(meadow) = block_on(poll_once(&mut layout.0)) else { continue };
        let mut entity = commands.entity(entity);
        entity.remove::<MeadowLayout>();
        match meadow {
            Ok(meadow) => drop(entity.insert(meadow)),
            Err(panic) => error!("grass patch {}: {panic}; the last good meadow stays", entity.id()),
        }
    }
}

/// Removes the meadow of a patch that is removed.
pub(super) fn remove_meadow(removed: On<Remove<GrassPatch>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(MeadowLayout, Meadow)>();
    }
}
