//! The wind: one periodic field of turbulent velocity on top of a logarithmic mean profile.
//!
//! After Setas et al., *Dynamic Simulation of Natural Environments in Virtual Reality* (section 3.1), with its misprints corrected:
//!
//! 1. The mean speed grows with the logarithm of height ([`LogProfile`], equation 10).
//! 2. The turbulence of each component has a known power spectrum (`spectrum`, equations 9). Two points share less of
//!    it the farther apart they are and the faster it varies ([`DecayCoefficients`], equations 11 and 12).
//! 3. [`WindField::synthesise`] draws one realisation with these spectra and cross-spectra (algorithm 3), periodic in
//!    time and across the wind.
//! 4. The realisation drifts along with the mean wind (Taylor's hypothesis, equation 14). So [`WindField::sample`] gives
//!    the velocity at any place and time.
//! 5. Between the columns of the realisation, and beyond the last of them, `lateral` keeps its power and coherence.
//! 6. Above some 2 Hz, where places a metre apart share next to nothing, one short series serves all of them:
//!    [`WindField::fast_gusts`].
//! 7. [`cross_flow_pressure`] is the load of that velocity on a slender body (equation 15).
//! 8. Between trees the wind is weaker and gustier: [`Canopy`].
//! 9. What a game blows is added: [`WindSource`], with the flows of `source`.
//!
//! # Files
//! - Plain arithmetic without an app: `settings`, `frame`, `profile`, `spectrum`, `level_spectrum`, `coherence`,
//!   `factorisation`, `synthesis`, `interpolation`, `lateral`, `fast_gusts`, `field`, `pressure`, `canopy`,
//!   `cross_fade`, `source`, `targets`.
//! - For an app: `ecs/clock` ([`WindClock`]), `ecs/active` ([`Wind`], [`ActiveWind`]), `ecs/sources` ([`WindSources`]), `components`
//!   ([`WindCell`], [`WindSource`]),
//!   `gizmos`, `plugin`.
//!
//! # Wind coordinates
//!
//! Inside this room velocities are `Vec3` (along, up, across): see [`WindFrame`]. The paper's (u, v, w) are
//! (along, across, up).

mod canopy;
mod coherence;
mod components;
mod cross_fade;
mod ecs;
mod factorisation;
mod fast_gusts;
mod field;
mod frame;
#[cfg(feature = "render")]
mod gizmos;
mod interpolation;
mod lateral;
mod level_spectrum;
mod plugin;
mod pressure;
mod profile;
mod settings;
mod source;
mod spectrum;
mod synthesis;
#[cfg(feature = "editor")]
mod targets;

pub use crate::constants::REFERENCE_HEIGHT_M;
pub use canopy::{Canopy, EXPOSURE_DIRECTIONS};
pub(crate) use canopy::{CanopyProfile, PackedCanopy, SUBLAYER, UpwindPath, exposure_direction};
pub use components::WindCell;
pub(crate) use ecs::active::NumberedWind;
pub use ecs::{
    active::{ActiveWind, Wind},
    clock::WindClock,
    sources::{WindSource, WindSources},
};
pub use fast_gusts::GustBands;
pub use field::WindField;
pub use frame::WindFrame;
#[cfg(feature = "render")]
pub use gizmos::{WindGizmoPlugin, WindGizmos};
pub use plugin::WindPlugin;
pub use pressure::cross_flow_pressure;
pub use profile::LogProfile;
pub(crate) use profile::VON_KARMAN;
pub use settings::{FieldResolution, FieldSettings, TurbulenceBand};
pub(crate) use source::SourceFlow;
pub use source::SourceKind;
pub use spectrum::{CoherenceDecay, DecayCoefficients};
