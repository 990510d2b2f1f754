//! Prepared species: meshes, textures and materials, made off the frame.

pub(crate) mod images;
pub(crate) mod library;
pub(crate) mod load_parts;
pub(crate) mod lod_meshes;
pub(crate) mod materials;
pub(crate) mod mesh_copies;
pub(crate) mod packed_vertices;
pub(crate) mod part_demand;
pub(crate) mod part_set;
pub(crate) mod prepare;
pub(crate) mod tree_material;
