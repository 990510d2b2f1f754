//! Prepared species: meshes, textures and materials, made off the frame.

pub(crate) mod images;
pub(crate) mod library;
pub(crate) mod lod_meshes;
pub(crate) mod materials;
pub(crate) mod prepare;
pub(crate) mod tree_material;
