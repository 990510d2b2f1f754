//! Trees in the wind.
