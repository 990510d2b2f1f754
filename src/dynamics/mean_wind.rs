//! The mean wind at the height of a load, by that of which a table holds the responses.

use crate::wind::LogProfile;

/// The mean wind over height, and the height at which a table's wind is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanWind {
    /// Mean speed at the table's height, m/s.
    pub speed_m_s: f32,
    /// z0, m.
    pub roughness_m: f32,
    /// d, m.
    pub displacement_m: f32,
    /// 1 / ln((h - d) / z0), with h the table's height.
    pub inverse_log: f32,
}

/// The logarithm of the table's height over the roughness length is at least this, so that all ratios are finite: the
/// profile holds from some e roughness lengths on.
const LEAST_LOG: f32 = 1.0;

impl MeanWind {
    /// The wind of a profile, for a table of its wind at `table_height_m` above ground.
    #[must_use]
    pub fn new(profile: &LogProfile, table_height_m: f32) -> Self {
        let LogProfile { roughness_m, displacement_m, .. } = *profile;
        let log = ((table_height_m - displacement_m) / roughness_m).max(1.0).ln().max(LEAST_LOG);
        Self { speed_m_s: profile.speed_at(table_height_m), roughness_m, displacement_m, inverse_log: 1.0 / log }
    }

    /// A wind over open country (z0 = 0.1 m) that is taken at 10 m: for bounds, and for pictures that serve all winds.
    #[must_use]
    pub(crate) fn open_country(speed_m_s: f32) -> Self {
        Self::new(&LogProfile::from_reference(speed_m_s, 0.1, 0.0), crate::constants::REFERENCE_HEIGHT_M)
    }

    /// Mean speed at a height above ground over that at the table's height: the logarithmic law (eq. 10), and 0 below
    /// z0 + d.
    #[must_use]
    pub fn ratio(&self, height_m: f32) -> f32 {
        let ratio = ((height_m - self.displacement_m) / self.roughness_m).max(1.0).ln() * self.inverse_log;
        if ratio.is_finite() { ratio } else { 0.0 }
    }

    /// By how much loads at any height that trees have may be greater than over [open country](Self::open_country).
    #[must_use]
    pub(crate) fn most_by_open_country(&self) -> f32 {
        let open = Self::open_country(1.0);
        let heights = (0..).map(|step| 1.0 + 3.0 * step as f32).take_while(|height_m| *height_m <= TALLEST_M);
        let by_open = |height_m: f32| self.ratio(height_m) / open.ratio(height_m);
        // Mean loads go with the square of the ratio, gusts with the ratio.
        heights.map(by_open).map(|ratio| ratio.max(ratio * ratio)).fold(0.0, f32::max)
    }
}

/// No tree is taller, m: the tallest that is known is a redwood of 116 m.
const TALLEST_M: f32 = 120.0;

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Values of the log law by hand: ln(2 / z0) / ln(10 / z0), squared.
    #[test]
    fn pressure_near_the_ground_depends_on_the_roughness() {
        for (roughness_m, expected) in [(0.01, 0.588), (0.3, 0.293), (1.0, 0.0906)] {
            let wind = MeanWind::new(&LogProfile::from_reference(8.0, roughness_m, 0.0), 10.0);
            assert_relative_eq!(wind.ratio(2.0).powi(2), expected, max_relative = 5e-3);
        }
    }

    #[test]
    fn a_table_of_another_height_is_of_the_same_wind() {
        let profile = LogProfile::from_reference(8.0, 0.1, 2.0);
        let at = |height_m| MeanWind::new(&profile, height_m);
        for height_m in [2.5, 5.0, 20.0, 50.0] {
            let [low, high] = [at(5.0), at(30.0)].map(|wind| wind.speed_m_s * wind.ratio(height_m));
            assert_relative_eq!(low, high, max_relative = 1e-5);
        }
    }

    #[test]
    fn ratios_are_finite_in_any_wind() {
        for (roughness_m, displacement_m, table_height_m) in [(2.0, 4.5, 1.0), (2.0, 20.0, 10.0), (1e-4, 0.0, 100.0)] {
            let profile = LogProfile::from_reference(75.0, roughness_m, displacement_m);
            let wind = MeanWind::new(&profile, table_height_m);
            for height_m in [f32::NEG_INFINITY, -1.0, 0.0, 1.0, 100.0, f32::INFINITY, f32::NAN] {
                let ratio = wind.ratio(height_m);
                assert!(ratio.is_finite() && ratio >= 0.0, "{ratio}");
            }
        }
    }
}
