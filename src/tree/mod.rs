//! What a tree is made of: its species, its skeleton of beams, its wood, leaves and their textures.
//!
//! A [`Species`](species::Species) is a page of numbers; [`skeleton::grow`] makes one individual of it from a seed;
//! [`mesh::wood`] and [`leaf_mesh::leaves`] give it a surface, [`bark`] and [`leaf_texture`] paint it.

pub mod bark;
pub mod foliage;
pub mod growth;
pub mod leaf_mesh;
pub mod leaf_texture;
pub mod mesh;
pub mod skeleton;
pub mod species;
pub mod texture;
mod tube;

#[cfg(test)]
mod tests;
