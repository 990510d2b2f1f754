//! Systems and resources of drawn ground.

pub(super) mod stream;
