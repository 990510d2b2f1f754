//! How a beam answers a load.

pub mod leaf;
