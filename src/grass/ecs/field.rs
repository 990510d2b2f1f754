//! Fields of grass without end: patches that come and go about the viewers.

use crate::{
    grass::{
        components::{GrassGround, GrassPatch, GrassShade},
        field_grid::{GridPatch, patches_within},
    },
    ground::{Cover, Ground, LevelGround},
    setting::{SettingError, require},
    viewpoint::Viewpoints,
};
use bevy::{camera::visibility::RenderLayers, math::DVec2, prelude::*};
use std::{collections::BTreeMap, sync::Arc};

/// The farthest that grass is seen, in sides of a patch: some 800 patches.
const MOST_SIDES: f32 = 16.0;
/// A patch stays until it is so much farther than it came, as a share of its side.
const MARGIN_SHARE: f32 = 0.5;
/// Patches are looked for anew when a viewer has moved so far, m.
const STEP_M: f32 = 1.0;

/// Grass all over the ground, of which patches about every [`Viewpoint`](crate::Viewpoint) are there, as far as grass is seen. The ground is
/// that of the entity's [`GrassGround`]; without one it is the plane of its transform. Patches have the render layers that the field has
/// when they come, and cast no shadows where it has `NotShadowCaster`.
///
/// A field with a setting out of range is refused with one warning; the last good one stays.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform, Visibility, GrassFieldPatches)]
pub struct GrassField {
    /// What is repeated, each time with other blades. `sward.width_m` and `sward.depth_m` are those of a patch, and patches are there as far
    /// as `look.vanishes_at_m`: at most 16 times the smaller of the two.
    pub patch: GrassPatch,
    /// Patches that come in one frame, at most, the nearest first: 1 to 10000.
    pub patches_per_frame: u32,
}

impl Default for GrassField {
    fn default() -> Self {
        Self { patch: GrassPatch::default(), patches_per_frame: 4 }
    }
}

impl GrassField {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.patch.validate().map_err(|error| error.inside("patch"))?;
        let most_m = MOST_SIDES * self.side_m().min_element();
        require("patch.look.vanishes_at_m", self.patch.look.vanishes_at_m, 1.0..=most_m)?;
        require("patches_per_frame", self.patches_per_frame as f32, 1.0..=1e4)
    }

    /// The patch at a place of the grid, with blades of its own.
    fn patch_at(&self, place: GridPatch) -> GrassPatch {
        let mut patch = self.patch.clone();
        patch.sward.seed = place.seed(patch.sward.seed);
        patch
    }

    fn side_m(&self) -> Vec2 {
        Vec2::new(self.patch.sward.width_m, self.patch.sward.depth_m)
    }
}

/// The patches of a [`GrassField`] that are there.
#[derive(Component, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub struct GrassFieldPatches {
    /// The last valid settings; none before.
    field: Option<GrassField>,
    patches: BTreeMap<GridPatch, Entity>,
    /// Where the viewers were, in the field's (x, z), m.
    viewers_m: Vec<Vec2>,
    is_complete: bool,
}

impl GrassFieldPatches {
    /// Whether a patch is there wherever one is wanted. Its blades may still be on their way.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// The patches, in the order of their places.
    pub fn iter(&self) -> impl Iterator<Item = Entity> + '_ {
        self.patches.values().copied()
    }
}

/// The ground of a field, or the woods over it, seen from the origin of one of its patches.
struct Moved<T: ?Sized> {
    whole: Arc<T>,
    origin: DVec2,
}

impl Ground for Moved<dyn Ground> {
    fn height_m(&self, place: DVec2) -> f64 {
        self.whole.height_m(self.origin + place)
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        self.whole.gradient(self.origin + place)
    }
}

impl Cover for Moved<dyn Cover> {
    fn share(&self, place: DVec2) -> f32 {
        self.whole.share(self.origin + place)
    }
}

/// A field, and what its patches take over from it.
type FieldData = (
    Entity,
    Ref<'static, GrassField>,
    &'static GlobalTransform,
    Option<Ref<'static, GrassGround>>,
    Option<Ref<'static, GrassShade>>,
    Option<&'static RenderLayers>,
    &'static mut GrassFieldPatches,
);

/// Takes over changed settings and ground.
pub(crate) fn apply_grass_fields(
    mut commands: Commands,
    mut fields: Query<FieldData, Or<(Changed<GrassField>, Changed<GrassGround>, Changed<GrassShade>)>>,
) {
    for (entity, field, _, ground, shade, _, mut patches) in &mut fields {
        if field.is_changed() && patches.field.as_ref() != Some(&field) {
            if let Err(error) = field.validate() {
                warn!("grass field {entity}: {error}; the last good field stays");
                continue;
            }
            patches.replace(&field, &mut commands);
        }
        let is_shade_new = shade.is_some_and(|shade| shade.is_changed() && !shade.is_added());
        if is_shade_new || ground.is_some_and(|ground| ground.is_changed() && !ground.is_added()) {
            patches.remove_all(&mut commands);
        }
    }
}

/// Has patches come where a viewer comes near, and go where none is.
pub(crate) fn move_grass_fields(
    mut commands: Commands,
    viewpoints: Viewpoints,
    mut fields: Query<FieldData>,
    mut viewers_m: Local<Vec<Vec2>>,
) {
    for (entity, _, transform, ground, shade, layers, mut patches) in &mut fields {
        let to_field = transform.affine().inverse();
        viewers_m.clear();
        viewers_m.extend(viewpoints.iter().map(|place| to_field.transform_point3(place).xz()));
        viewers_m.retain(|place| place.is_finite());
        let patches = patches.bypass_change_detection();
        if !patches.take_viewers(&viewers_m) && patches.is_complete {
            continue;
        }
        let Some(field) = patches.field.clone() else { continue };
        patches.remove_far(&field, &mut commands);
        let ground = ground.map_or_else(|| Arc::new(LevelGround::default()) as Arc<dyn Ground>, |it| it.0.clone());
        for patch in patches.take_wanted(&field) {
            let middle_m = patch.middle_m(field.side_m());
            let grass = field.patch_at(patch);
            let origin = middle_m.as_dvec2();
            let moved = Moved { whole: ground.clone(), origin };
            let at = Transform::from_xyz(middle_m.x, 0.0, middle_m.y);
            let mut spawned = commands.spawn((ChildOf(entity), grass, GrassGround(Arc::new(moved)), at));
            if let Some(shade) = &shade {
                spawned.insert(GrassShade(Arc::new(Moved { whole: shade.0.clone(), origin })));
            }
            if let Some(layers) = layers {
                spawned.insert(layers.clone());
            }
            patches.patches.insert(patch, spawned.id());
        }
    }
}

/// Removes the patches of a field that is removed.
pub(crate) fn remove_grass_field(
    removed: On<Remove<GrassField>>,
    mut commands: Commands,
    mut fields: Query<&mut GrassFieldPatches>,
) {
    let Ok(mut patches) = fields.get_mut(removed.entity) else { return };
    patches.remove_all(&mut commands);
    patches.field = None;
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<GrassFieldPatches>();
    }
}

impl GrassFieldPatches {
    /// Takes over valid settings. Patches of the same size stay, and get them.
    fn replace(&mut self, field: &GrassField, commands: &mut Commands) {
        if self.field.as_ref().is_some_and(|old| old.side_m() != field.side_m()) {
            self.remove_all(commands);
        }
        for (place, entity) in &self.patches {
            if let Ok(mut entity) = commands.get_entity(*entity) {
                entity.try_insert(field.patch_at(*place));
            }
        }
        self.field = Some(field.clone());
        self.is_complete = false;
    }

    fn remove_all(&mut self, commands: &mut Commands) {
        std::mem::take(&mut self.patches).into_values().for_each(|patch| remove(patch, commands));
        self.is_complete = false;
    }

    /// Notes where the viewers are. Returns whether one of them has come, gone or moved.
    fn take_viewers(&mut self, places_m: &[Vec2]) -> bool {
        let rests = |(now, then): (&Vec2, &Vec2)| now.distance(*then) < STEP_M;
        if places_m.len() == self.viewers_m.len() && places_m.iter().zip(&self.viewers_m).all(rests) {
            return false;
        }
        self.viewers_m.clear();
        self.viewers_m.extend_from_slice(places_m);
        true
    }

    /// Distance of a patch from the nearest viewer, m.
    fn distance_m(&self, patch: GridPatch, side_m: Vec2) -> f32 {
        self.viewers_m.iter().map(|viewer_m| patch.distance_m(side_m, *viewer_m)).fold(f32::INFINITY, f32::min)
    }

    fn remove_far(&mut self, field: &GrassField, commands: &mut Commands) {
        let side_m = field.side_m();
        let reach_m = field.patch.look.vanishes_at_m + MARGIN_SHARE * side_m.max_element();
        let is_far = |patch: &GridPatch| self.distance_m(*patch, side_m) > reach_m;
        let far: Vec<GridPatch> = self.patches.keys().copied().filter(is_far).collect();
        far.iter().filter_map(|patch| self.patches.remove(patch)).for_each(|entity| remove(entity, commands));
    }

    /// The patches that come now, the nearest first.
    fn take_wanted(&mut self, field: &GrassField) -> Vec<GridPatch> {
        let (side_m, reach_m) = (field.side_m(), field.patch.look.vanishes_at_m);
        let near = self.viewers_m.iter().flat_map(|viewer_m| patches_within(side_m, *viewer_m, reach_m));
        let mut wanted: Vec<GridPatch> = near.filter(|patch| !self.patches.contains_key(patch)).collect();
        wanted.sort_by(|a, b| {
            let distances = [*a, *b].map(|patch| self.distance_m(patch, side_m));
            distances[0].total_cmp(&distances[1]).then(a.cmp(b))
        });
        wanted.dedup();
        let now = field.patches_per_frame as usize;
        self.is_complete = wanted.len() <= now;
        wanted.truncate(now);
        wanted
    }
}

/// A game may have despawned the patch.
fn remove(patch: Entity, commands: &mut Commands) {
    if let Ok(mut patch) = commands.get_entity(patch) {
        patch.try_despawn();
    }
}

#[cfg(test)]
mod tests;
