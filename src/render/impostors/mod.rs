//! Impostors: far trees as quads that show views of an atlas. A forest plants them: `forest/impostors`.

pub(crate) mod material;
pub(crate) mod mesh;
pub(crate) mod near_mask;
