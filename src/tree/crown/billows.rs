//! The 3-D texture of an impressionist crown: where it billows out, and where it falls back into gaps.
//!
//! Starling & Ashdown take one value of Perlin's noise (1985) for each polygon; it displaces, darkens and removes. Here
//! the value is its rank among values all over the crown, so that it is spread evenly over 0 to 1 whatever the noise
//! does: a threshold of 0.7 then keeps seven tenths of the polygons, neither more nor less. A conifer's boughs stand in
//! tiers: a saw-tooth over the height, deep above each tier's rim, stronger than the noise.

use bevy::math::Vec3;
use noise::{NoiseFn, Perlin};

use super::profile::Profile;

/// Weight and scale of the second octave of the noise.
const FINE: [f64; 2] = [0.45, 2.3];
/// Conifers: tiers per billow across the crown and per diameter of its height, weight of the noise against a tier, and
/// how much it tilts a tier's rim.
const TIERS_PER_BILLOW: f32 = 1.3;
const TIER_NOISE: f32 = 0.55;
const TIER_TILT: f32 = 0.35;

pub(super) struct Billows {
    noise: Perlin,
    /// Billows per metre.
    density: f64,
    /// Height of a tier, m; `None` for crowns without.
    tier_m: Option<f32>,
    /// Raw values all over the crown, sorted.
    ranks: Vec<f32>,
}

impl Billows {
    /// `across` billows over the crown's diameter, not yet ranked.
    pub(super) fn new(profile: &Profile, across: f32, tiers: bool, seed: u32) -> Self {
        let density = across / (2.0 * profile.radius_m);
        let tier_m = tiers.then(|| 1.0 / (TIERS_PER_BILLOW * density).max(1e-3));
        Self { noise: Perlin::new(seed), density: f64::from(density), tier_m, ranks: Vec::new() }
    }

    /// Ranks depths among those of `places`, which are to be like those that will be asked for.
    pub(super) fn rank_among(&mut self, places: &[Vec3]) {
        self.ranks = places.iter().map(|&place| self.raw(place)).collect();
        self.ranks.sort_by(f32::total_cmp);
    }

    /// Share of the places that billow farther out than this one, above 0 and below 1.
    pub(super) fn depth(&self, point: Vec3) -> f32 {
        let raw = self.raw(point);
        let below = self.ranks.partition_point(|&other| other < raw);
        (below as f32 + 0.5) / (self.ranks.len() + 1) as f32
    }

    fn raw(&self, point: Vec3) -> f32 {
        let place = point.as_dvec3() * self.density;
        let octave = |scale: f64| self.noise.get((place * scale).to_array());
        let noise = (octave(1.0) + FINE[0] * octave(FINE[1])) as f32;
        self.tier_m.map_or(noise, |tier_m| (point.y / tier_m + TIER_TILT * noise).rem_euclid(1.0) + TIER_NOISE * noise)
    }
}
