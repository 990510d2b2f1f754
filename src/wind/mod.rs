//! The wind: one periodic field of turbulent velocity on top of a logarithmic mean profile.
//!
//! After Setas et al., *Dynamic simulation of natural environments* (section 3.1), with its misprints corrected:
//!
//! 1. The mean speed grows with the logarithm of height ([`LogProfile`], equation 10).
//! 2. The turbulence of each component has a known power spectrum ([`TurbulenceComponent`], equations 9), and two
//!    points share less of it the farther apart they are and the faster it varies ([`DecayCoefficients`], equations
//!    11 and 12).
//! 3. [`WindField::synthesise`] draws one realisation with these spectra and cross-spectra (algorithm 3), periodic in
//!    time and across the wind.
//! 4. The realisation drifts along with the mean wind (Taylor's hypothesis, equation 14), so that
//!    [`WindField::sample`] knows the velocity everywhere and always.
//! 5. A slender body in that velocity feels drag and lift ([`drag_per_length`], [`lift_per_length`], equations 15, 16).
//!
//! # Wind coordinates
//!
//! Inside the room velocities are kept as `Vec3` (along, up, across): see [`WindFrame`]. The paper's (u, v, w) are
//! (along, across, up).
//!
//! Everything in this room but its plugin is plain arithmetic without an app.

mod cells;
mod clock;
mod coherence;
mod cross_fade;
mod current;
mod error;
mod factorisation;
mod field;
mod frame;
#[cfg(feature = "render")]
mod gizmos;
mod interpolation;
mod load;
mod plugin;
mod profile;
mod settings;
mod spectrum;
mod synthesis;

pub use cells::WindCell;
pub use clock::WindClock;
pub use cross_fade::{CrossFade, FadeStep};
pub use current::{ActiveWind, DEFAULT_FADE_S, Wind};
pub use error::WindError;
pub use field::WindField;
pub use frame::WindFrame;
#[cfg(feature = "render")]
pub use gizmos::{WindGizmoPlugin, WindGizmos};
pub use load::{AIR_DENSITY_KG_M3, cross_flow_pressure, drag_per_length, lift_per_length};
pub use plugin::WindPlugin;
pub use profile::{LogProfile, REFERENCE_HEIGHT_M, VON_KARMAN};
pub use settings::{FieldResolution, FieldSettings, TurbulenceBand};
pub use spectrum::{CoherenceDecay, DecayCoefficients, TurbulenceComponent};
