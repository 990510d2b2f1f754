//! Impostors: pictures of a tree from all over the upper hemisphere, three of which are mixed towards any eye. They serve
//! where the paper has its low level, which shows one side of a tree only.

pub(super) mod atlas;
pub(super) mod frame;
pub(super) mod octahedral;
pub(super) mod sway;
