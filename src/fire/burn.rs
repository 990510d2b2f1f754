//! Fires, and what is known to be good of them.

use super::{
    flicker::Flicker,
    rhombs::{Rhomb, grow, height_m},
    settings::{FireLook, FireShape},
};
use crate::setting::SettingError;
use bevy::prelude::*;
use std::sync::Arc;

/// A fire that burns at this entity's place.
///
/// A fire with a setting out of range is refused with one warning; the last good one burns on.
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

/// What burns at an entity: the fire as it was when its settings were last good. Written in
/// [`WindwoodSystems::Grow`](crate::WindwoodSystems::Grow).
#[derive(Component, Clone, Debug)]
#[component(immutable)]
pub struct Burning {
    /// Its settings.
    pub fire: Fire,
    /// Its flames.
    pub rhombs: Arc<Vec<Rhomb>>,
    /// Height of the highest flame, m.
    pub height_m: f32,
    /// Its rhythm.
    pub flicker: Flicker,
}

impl From<&Fire> for Burning {
    fn from(fire: &Fire) -> Self {
        let rhombs = grow(&fire.shape);
        Self {
            height_m: height_m(&rhombs),
            rhombs: Arc::new(rhombs),
            flicker: Flicker::new(fire.look.flicker_hz, fire.look.flicker_depth, fire.shape.seed),
            fire: fire.clone(),
        }
    }
}

/// Kindles fires that are new or have changed. A millisecond at most, so it need not leave the frame.
pub(super) fn kindle_fires(mut commands: Commands, fires: Query<(Entity, &Fire), Changed<Fire>>) {
    for (entity, fire) in &fires {
        if let Err(error) = fire.validate() {
            warn!("fire {entity}: {error}; the last good fire burns on");
            continue;
        }
        commands.entity(entity).insert(Burning::from(fire));
    }
}

/// A fire that is taken off an entity goes out.
pub(super) fn put_out_fire(removed: On<Remove<Fire>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<Burning>();
    }
}
