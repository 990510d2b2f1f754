//! The wind.
