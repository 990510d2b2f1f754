//! Drops the copies of meshes on the CPU once the renderer has them.
//!
//! Why not by `RenderAssetUsages::RENDER_WORLD`: of a mesh that is moved out of the main world, Bevy 0.20 computes the box anew, which it
//! cannot once positions are compressed. Every vertex would then lie in the origin. A mesh that is copied keeps its box.

use bevy::{asset::RenderAssetUsages, prelude::*};

/// Frames until a mesh that was added has been copied to the renderer, and one more.
const FRAMES: usize = 3;

/// Meshes whose copies are still there, by how many frames ago they were added.
#[derive(Resource, Default)]
pub(crate) struct MeshCopies([Vec<AssetId<Mesh>>; FRAMES]);

impl MeshCopies {
    /// Adds a mesh as an asset.
    pub fn add(&mut self, mesh: Mesh, meshes: &mut Assets<Mesh>) -> Handle<Mesh> {
        let handle = meshes.add(mesh);
        self.0[0].push(handle.id());
        handle
    }
}

pub(crate) fn drop_mesh_copies(mut copies: ResMut<MeshCopies>, mut meshes: ResMut<Assets<Mesh>>) {
    let copies = &mut copies.bypass_change_detection().0;
    copies.rotate_right(1);
    for id in copies[0].drain(..) {
        // One that has gone meanwhile, or was dropped otherwise, has no copy.
        let Some(mesh) = meshes.bypass_change_detection().get_mut_untracked(id) else { continue };
        drop(mesh.take_gpu_data());
        // A renderer that gets another device asks for all meshes again, and this one has no vertices to give.
        mesh.asset_usage = RenderAssetUsages::MAIN_WORLD;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::ecs::system::RunSystemOnce;

    #[test]
    fn a_copy_stays_until_the_renderer_has_had_a_frame_for_it() {
        let mut world = World::new();
        world.init_resource::<MeshCopies>();
        let (mut meshes, mut copies) = (Assets::<Mesh>::default(), MeshCopies::default());
        let mesh = copies.add(Sphere::new(1.0).into(), &mut meshes);
        world.insert_resource(meshes);
        world.insert_resource(copies);
        for frame in 1..=FRAMES + 1 {
            world.run_system_once(drop_mesh_copies).expect("it runs");
            let mesh = world.resource::<Assets<Mesh>>().get(&mesh).expect("the asset stays");
            let has_vertices = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).is_ok();
            assert_eq!(has_vertices, frame < FRAMES, "frame {frame}");
        }
    }
}
