//! How a beam answers a load.
