//! Crowns as painters make them: the impression of foliage without its leaves.
//!
//! Two models. [`impressionist`] clothes a partial ellipsoid in some hundred triangles (Starling & Ashdown),
//! [`gardner`] masses textured ellipsoids whose translucency grows towards their outline (Gardner). Both answer the
//! same questions as the branching models do: a [`Skeleton`](super::skeleton::Skeleton) whose beams the wind moves,
//! whose clusters are polygons or ellipsoids, vertices for them, and a texture. Their clusters hang in the air off
//! their limbs, as a painter's do: each is carried rigidly by the place on the limb that is nearest.

mod billows;
mod ellipsoids;
mod frame;
pub mod gardner;
pub mod impressionist;
mod polygon_texture;
mod polygons;
mod profile;
mod statistics;

pub use ellipsoids::silhouette_alpha;
pub use statistics::CrownStatistics;

#[cfg(test)]
mod tests;
