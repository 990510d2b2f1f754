//! Ground from Bevy's meshes.

use super::{error::TerrainError, triangle_ground::TriangleGround};
use crate::setting::SettingError;
use bevy::{
    mesh::{PrimitiveTopology, VertexAttributeValues},
    prelude::*,
};

impl TriangleGround {
    /// Ground of a mesh that stands in the world as `place` says: the `GlobalTransform` of its entity, or a `Transform`.
    ///
    /// The mesh must still be in main memory: a file's is, where it is loaded with `RenderAssetUsages::MAIN_WORLD`, which is usual.
    ///
    /// # Errors
    /// [`TerrainError::Setting`] for a mesh that has no list of triangles or no positions of three numbers, and as [`new`](Self::new).
    pub fn from_mesh(mesh: &Mesh, place: impl Into<GlobalTransform>) -> Result<Self, TerrainError> {
        if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
            let found = format!("{:?}", mesh.primitive_topology());
            return Err(SettingError::new("mesh.primitive_topology", found, "TriangleList").into());
        }
        let Ok(VertexAttributeValues::Float32x3(positions)) = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) else {
            let allowed = "there, with three numbers each, in main memory";
            return Err(SettingError::new("mesh.ATTRIBUTE_POSITION", "not", allowed).into());
        };
        let place = place.into();
        let corners: Vec<Vec3> =
            positions.iter().map(|position| place.transform_point(Vec3::from(*position))).collect();
        let indices: Vec<u32> = match mesh.try_indices() {
            Ok(indices) => indices.iter().map(|index| index as u32).collect(),
            Err(_) => (0..corners.len() as u32).collect(),
        };
        Self::new(&corners, &indices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::Ground;
    use bevy::{asset::RenderAssetUsages, math::DVec2};

    #[test]
    fn a_mesh_is_ground_where_it_stands() {
        let mesh = Mesh::from(Plane3d::default().mesh().size(20.0, 10.0));
        let tilt = Transform::from_xyz(100.0, 7.0, -40.0).with_rotation(Quat::from_rotation_z(0.25));
        let ground = TriangleGround::from_mesh(&mesh, tilt).unwrap();
        let rise = f64::from(0.25_f32.tan());
        for x in [-9.0, 0.0, 3.0] {
            let height_m = ground.height_m(DVec2::new(100.0 + x, -42.0));
            assert!((height_m - 7.0 - rise * x).abs() < 1e-4, "{height_m} at {x}");
        }
        assert!((ground.gradient(DVec2::new(100.0, -40.0)) - DVec2::new(rise, 0.0)).length() < 1e-5);
        assert!(ground.height_m(DVec2::new(100.0, -46.0)).is_nan());
    }

    #[test]
    fn what_is_no_mesh_of_triangles_is_refused() {
        let error = |mesh: Mesh| match TriangleGround::from_mesh(&mesh, Transform::IDENTITY) {
            Ok(_) => panic!("it should have been refused"),
            Err(error) => error.to_string(),
        };
        let lines = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default());
        assert_eq!(error(lines), "`mesh.primitive_topology` is LineList, but must be TriangleList");
        let empty = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
        assert!(error(empty).starts_with("`mesh.ATTRIBUTE_POSITION` is not, but must be there"));
    }
}
