//! Draws stumps.

use super::components::Stump;
use bevy::{camera::visibility::RenderLayers, prelude::*};

/// Wood that was cut, linear.
const WOOD: LinearRgba = LinearRgba::rgb(0.29, 0.19, 0.11);

/// The mesh and the material of all stumps.
#[derive(Clone)]
pub(in crate::forest) struct StumpLook(Mesh3d, MeshMaterial3d<StandardMaterial>);

/// Draws stumps that are new, on the layers of their forest.
pub(in crate::forest) fn draw_stumps(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut look: Local<Option<StumpLook>>,
    added: Query<(Entity, &Stump), Added<Stump>>,
    parents: Query<&ChildOf>,
    layers: Query<&RenderLayers>,
) {
    for (entity, stump) in &added {
        let StumpLook(mesh, material) = look.get_or_insert_with(|| {
            // Its foot is at the origin, as that of the tree.
            let mesh = Cylinder::new(1.0, 1.0).mesh().resolution(16).build().translated_by(0.5 * Vec3::Y);
            let material = StandardMaterial { base_color: WOOD.into(), perceptual_roughness: 0.95, ..default() };
            StumpLook(Mesh3d(meshes.add(mesh)), MeshMaterial3d(materials.add(material)))
        });
        let mut drawn = commands.entity(entity);
        drawn.insert((mesh.clone(), material.clone()));
        drawn.entry::<Transform>().and_modify({
            let scale = Vec3::new(stump.radius_m, stump.height_m, stump.radius_m);
            move |mut at| at.scale = scale
        });
        if let Some(layers) = parents.iter_ancestors(entity).find_map(|parent| layers.get(parent).ok()) {
            drawn.insert(layers.clone());
        }
    }
}
