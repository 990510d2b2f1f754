//! Growing skeletons: age, the envelope that bounds a crown, the generators of branches, damage, and the pipe model that
//! gives wood its thickness.

pub mod age;
pub mod aono_kunii;
pub mod damage;
pub mod envelope;
pub(super) mod grower;
pub(super) mod habit;
pub mod phyllotaxis;
pub(super) mod pipes;
pub mod reeves_blau;
mod stems;
pub mod trunk;
pub mod zaharia;

pub use grower::BEAMS_LIMIT;
pub use phyllotaxis::Phyllotaxis;
