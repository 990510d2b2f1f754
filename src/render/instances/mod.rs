//! Instances: the tables of all trees, which rows are whose, and which trees are posed.

pub(crate) mod assign;
pub(crate) mod components;
pub(crate) mod rows;
pub(crate) mod tables;
pub(crate) mod tag;
pub(crate) mod track;
pub(crate) mod workgroups;
