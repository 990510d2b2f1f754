//! A sky: a dome around the scene with a colour for each direction.

use bevy::{
    light::{NotShadowCaster, NotShadowReceiver},
    mesh::VertexAttributeValues,
    prelude::*,
};

/// A dome of that radius, m, with so many sectors and stacks. `colour` gives linear RGB for a direction.
pub fn dome(radius_m: f32, [sectors, stacks]: [u32; 2], colour: impl Fn(Vec3) -> Vec3) -> Mesh {
    let mut dome = Sphere::new(radius_m).mesh().uv(sectors, stacks);
    let of_vertex = |position: &[f32; 3]| colour(Vec3::from_array(*position) / radius_m).extend(1.0).to_array();
    let colours: Vec<[f32; 4]> = match dome.attribute(Mesh::ATTRIBUTE_POSITION) {
        Some(VertexAttributeValues::Float32x3(positions)) => positions.iter().map(of_vertex).collect(),
        _ => Vec::new(),
    };
    dome.insert_attribute(Mesh::ATTRIBUTE_COLOR, colours);
    dome
}

/// The components of a dome: neither lit, nor in fog, nor in the way of shadows.
pub fn bundle(dome: Mesh, meshes: &mut Assets<Mesh>, materials: &mut Assets<StandardMaterial>) -> impl Bundle + use<> {
    let air = StandardMaterial { unlit: true, fog_enabled: false, cull_mode: None, ..default() };
    (Mesh3d(meshes.add(dome)), MeshMaterial3d(materials.add(air)), NotShadowCaster, NotShadowReceiver)
}
