//! The wind that levels are baked for: a fresh breeze.

/// Mean speed at 10 m, m/s: the middle of a fresh breeze (Beaufort 5, 8.0 to 10.7 m/s).
pub(super) const MEAN_SPEED_M_S: f32 = 9.4;
/// The intensity for which the load basis was found ([`load_basis`](crate::dynamics::load_basis)).
pub(super) const TURBULENCE_INTENSITY: f32 = 0.2;
