//! The mesh entities of trees: they are spawned, swapped and removed as levels are selected.

pub(crate) mod bare;
pub(crate) mod bounds;
pub(crate) mod components;
pub(crate) mod counts;
pub(crate) mod forget;
pub(crate) mod growth;
pub(crate) mod layers;
pub(crate) mod mesh_entities;
pub(crate) mod removal;
pub(crate) mod waiting;
