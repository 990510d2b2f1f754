//! A sky: a dome around the scene with a colour for each direction, and the light that comes from it.

use super::cameras;
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

/// Light from all around: linear RGB that falls on what faces the zenith, the horizon and the ground, and how bright that is, cd/m^2.
#[derive(Clone, Copy)]
pub struct SkyLight {
    pub zenith: Vec3,
    pub horizon: Vec3,
    pub ground: Vec3,
    pub brightness: f32,
}

impl SkyLight {
    /// Gives this light to every camera that is there or comes, in place of an ambient light that is the same from everywhere.
    pub fn give_to_cameras(self, commands: &mut Commands) {
        commands.insert_resource(GlobalAmbientLight::NONE);
        commands.queue(move |world: &mut World| {
            let light = self.environment(&mut world.resource_mut::<Assets<Image>>());
            cameras::give(world, light);
        });
    }

    fn environment(self, images: &mut Assets<Image>) -> EnvironmentMapLight {
        let colours = [self.zenith, self.horizon, self.ground].map(|it| Color::linear_rgb(it.x, it.y, it.z));
        let [zenith, horizon, ground] = colours;
        EnvironmentMapLight::hemispherical_gradient(images, zenith, horizon, ground).with_intensity(self.brightness)
    }
}
