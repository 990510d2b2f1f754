//! Fires, and the flames that are generated for them.

use super::{
    flicker::Flicker,
    rhombs::{Rhomb, grow_rhombs, height_m},
    settings::{FireLook, FireShape},
};
use crate::setting::SettingError;
use bevy::prelude::*;
use std::sync::Arc;

/// A fire that burns at this entity's place.
///
/// A fire with a setting out of range is refused with one warning; the last good one stays.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform, Visibility)]
pub struct Fire {
    /// The shape of the flames.
    pub shape: FireShape,
    /// How they look and shine.
    pub look: FireLook,
}

impl Fire {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.shape.validate().map_err(|error| error.inside("shape"))?;
        self.look.validate().map_err(|error| error.inside("look"))
    }
}

/// The flames of a fire, for the settings when they were last valid. Written in
/// [`WindwoodSystems::Bake`](crate::WindwoodSystems::Bake).
#[derive(Component, Clone, Debug)]
#[component(immutable)]
pub struct Flames {
    /// The fire that they were generated for: its settings are valid.
    pub fire: Fire,
    /// Their shapes.
    pub rhombs: Arc<Vec<Rhomb>>,
    /// Height of the highest flame, m.
    pub height_m: f32,
    /// How their brightness varies in time.
    pub flicker: Flicker,
}

impl From<&Fire> for Flames {
    fn from(fire: &Fire) -> Self {
        let rhombs = grow_rhombs(&fire.shape);
        Self {
            height_m: height_m(&rhombs),
            rhombs: Arc::new(rhombs),
            flicker: Flicker::new(fire.look.flicker_hz, fire.look.flicker_depth, fire.shape.seed),
            fire: fire.clone(),
        }
    }
}

/// Generates the flames of fires that are new or have changed. It takes a millisecond at most, so it runs on the frame.
pub(super) fn generate_flames(mut commands: Commands, fires: Query<(Entity, &Fire), Changed<Fire>>) {
    for (entity, fire) in &fires {
        if let Err(error) = fire.validate() {
            warn!("fire {entity}: {error}; the last good fire stays");
            continue;
        }
        commands.entity(entity).insert(Flames::from(fire));
    }
}

/// Removes the flames of a fire that is removed.
pub(super) fn remove_flames(removed: On<Remove<Fire>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<Flames>();
    }
}
