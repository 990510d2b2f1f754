//! Crowns without single leaves, after the models of impressionist rendering.
//!
//! There are two. [`impressionist`] covers a partial ellipsoid with some hundred triangles (Starling & Ashdown).
//! [`gardner`] combines textured ellipsoids whose translucency grows towards their outline (Gardner). Both give the
//! same as the branching models do: a [`Skeleton`](super::skeleton::Skeleton) whose beams the wind moves,
//! whose clusters are polygons or ellipsoids, vertices for them, and a texture. Their clusters lie
//! beside their limbs: each is carried rigidly by the nearest place on a limb.

mod billows;
mod crown_wood;
mod ellipsoids;
pub mod gardner;
mod gardner_settings;
pub mod impressionist;
mod impressionist_settings;
mod polygon_texture;
mod polygons;
mod profile;
mod statistics;

pub use statistics::CrownStatistics;

/// A scale of crowns within its domain, 0.02 to 50: what is no size becomes the nearest that is one, NaN the least.
fn clamped_scale(scale: f32) -> f32 {
    if scale > 0.02 { scale.min(50.0) } else { 0.02 }
}

#[cfg(test)]
mod tests;
