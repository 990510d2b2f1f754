//! What a tree is made of.
