//! Physical constants that more than one room uses.

/// Height above ground at which a mean wind speed is given, m: the meteorological standard.
pub const REFERENCE_HEIGHT_M: f32 = 10.0;

/// Density of dry air at sea level and 15 degrees C, kg/m^3 (International Standard Atmosphere, ISO 2533:1975).
pub(crate) const AIR_DENSITY_KG_M3: f64 = 1.225;
