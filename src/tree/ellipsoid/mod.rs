//! Textured ellipsoids: Gardner's crowns are made of them, and Zaharia's leaves are small, thin ones.
//!
//! `surface` is what can be chosen about their surface, `chart` how a sphere is laid out on a square, `mesh` their vertices,
//! `texture` their colour and mask. How the mask makes a solid translucent towards its outline is explained in
//! [`gardner`](super::crown::gardner).

mod chart;
mod mesh;
mod surface;
mod texture;

pub(super) use mesh::Ellipsoid;
pub use surface::EllipsoidSurface;
pub use texture::silhouette_alpha;
pub(super) use texture::texture;
