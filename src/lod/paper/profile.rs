//! The crown as a solid of revolution: its radius by height, fitted to where the leaves are.
//!
//! Reeves & Blau's trees have a bounding volume that could be taken as it is. This one serves crowns of all growth models,
//! and follows what light, damage and chance have left of them.

use bevy::math::{Vec2, Vec3};

use crate::tree::TreeModel;

/// Least radius, m: a leaf.
const LEAST_RADIUS_M: f32 = 0.02;

/// A solid of revolution about an upright axis.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::lod) struct CrownProfile {
    /// Where the axis stands: tree-local x and z, m.
    pub axis: Vec2,
    /// Height of the crown's lower end, m.
    pub base_m: f32,
    /// Height of its upper end, m.
    pub top_m: f32,
    /// Radii at even heights from the base to the top, m; straight between them.
    pub radii_m: Vec<f32>,
}

/// What makes the crown: the middles of the leaves' triangles, or of the branches' where there are no leaves.
pub(in crate::lod) fn crown_points(model: &TreeModel) -> Vec<Vec3> {
    if !model.leaves.indices.is_empty() {
        return middles(&model.leaves.positions, &model.leaves.indices, |_| true);
    }
    let order = |corner: u32| model.skeleton.beams[model.wood.sway[corner as usize][0] as usize].order;
    middles(&model.wood.positions, &model.wood.indices, |triple| triple.iter().any(|&corner| order(corner) > 0))
}

fn middles(positions: &[[f32; 3]], indices: &[u32], wanted: impl Fn(&[u32]) -> bool) -> Vec<Vec3> {
    let middle =
        |triple: &[u32]| triple.iter().map(|&corner| Vec3::from_array(positions[corner as usize])).sum::<Vec3>() / 3.0;
    indices.chunks_exact(3).filter(|triple| wanted(triple)).map(middle).collect()
}

impl CrownProfile {
    /// The profile of so many `segments` around points, of which it encloses the share `enclosed` (rounded up to whole
    /// points); none where there are no points.
    pub fn around(points: &[Vec3], segments: usize, enclosed: f32) -> Option<Self> {
        if points.is_empty() {
            return None;
        }
        let axis = points.iter().map(|point| Vec2::new(point.x, point.z)).sum::<Vec2>() / points.len() as f32;
        let (low, high) = points.iter().fold((f32::MAX, f32::MIN), |(low, high), p| (low.min(p.y), high.max(p.y)));
        let mut profile = Self { axis, base_m: low, top_m: high.max(low + LEAST_RADIUS_M), radii_m: Vec::new() };
        let places: Vec<Vec2> = points.iter().map(|&point| profile.place(point)).collect();
        let step_m = (profile.top_m - profile.base_m) / segments as f32;
        profile.radii_m = (0..=segments)
            .map(|ring| radius_at_m(&places, profile.base_m + ring as f32 * step_m, 0.5 * step_m, enclosed))
            .collect();
        // The shape is right now; its size decides how much is inside.
        let mut excess: Vec<f32> = places.iter().map(|place| place.x / profile.radius_m(place.y)).collect();
        let scale = quantile(&mut excess, enclosed);
        profile.radii_m.iter_mut().for_each(|radius_m| *radius_m = (*radius_m * scale).max(LEAST_RADIUS_M));
        Some(profile)
    }

    /// Distance of a point from the axis, m.
    pub fn distance_m(&self, point: Vec3) -> f32 {
        self.axis.distance(Vec2::new(point.x, point.z))
    }

    /// Distance of a point from the axis and its height, m.
    fn place(&self, point: Vec3) -> Vec2 {
        Vec2::new(self.distance_m(point), point.y)
    }

    /// Radius at a height, m; beyond the ends that of the ends.
    pub fn radius_m(&self, height_m: f32) -> f32 {
        let segments = self.radii_m.len() - 1;
        let at = (height_m - self.base_m) / (self.top_m - self.base_m) * segments as f32;
        let at = at.clamp(0.0, segments as f32);
        let low = (at as usize).min(segments - 1);
        self.radii_m[low] + (self.radii_m[low + 1] - self.radii_m[low]) * (at - low as f32)
    }

    /// Whether a point lies inside.
    #[cfg(test)]
    pub fn encloses(&self, point: Vec3) -> bool {
        let place = self.place(point);
        (self.base_m..=self.top_m).contains(&place.y) && place.x <= self.radius_m(place.y) * (1.0 + 1e-5)
    }

    /// Whether a cone comes nearer to the profile than an ellipsoid, each as wide as is best.
    pub fn is_conical(&self) -> bool {
        let count = self.radii_m.len() as f32;
        // The middle of each ring's share of the height.
        let up = |ring: usize| (ring as f32 + 0.5) / count;
        let misfit = |outline: &dyn Fn(f32) -> f32| {
            let (mut both, mut own) = (0.0, 0.0);
            for (ring, radius_m) in self.radii_m.iter().enumerate() {
                both += outline(up(ring)) * radius_m;
                own += outline(up(ring)).powi(2);
            }
            // Sum of squares left by the best multiple of the outline, but for what both have in common.
            -both * both / own
        };
        misfit(&|up| 1.0 - up) < misfit(&|up| (1.0 - (2.0 * up - 1.0).powi(2)).sqrt())
    }

    /// Area of the silhouette, m^2.
    pub fn silhouette_m2(&self) -> f32 {
        let step_m = (self.top_m - self.base_m) / (self.radii_m.len() - 1) as f32;
        self.radii_m.windows(2).map(|pair| (pair[0] + pair[1]) * step_m).sum()
    }
}

/// The radius within which `enclosed` of the points about a height lie, m; the band widens until there are some.
fn radius_at_m(places: &[Vec2], height_m: f32, half_band_m: f32, enclosed: f32) -> f32 {
    let mut half_band_m = half_band_m;
    loop {
        let near = places.iter().filter(|place| (place.y - height_m).abs() <= half_band_m);
        let mut distances: Vec<f32> = near.map(|place| place.x).collect();
        if !distances.is_empty() {
            return quantile(&mut distances, enclosed).max(LEAST_RADIUS_M);
        }
        half_band_m *= 2.0;
    }
}

/// The least of the values that the share `enclosed` of them does not exceed.
fn quantile(values: &mut [f32], enclosed: f32) -> f32 {
    let place = ((enclosed * values.len() as f32).ceil() as usize).clamp(1, values.len()) - 1;
    *values.select_nth_unstable_by(place, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// Points all over a solid of revolution, its radius given by the share of its height.
    fn solid(radius_m: impl Fn(f32) -> f32) -> Vec<Vec3> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
        let mut point = || {
            let (up, turn): (f32, f32) = (random.random(), random.random_range(0.0..std::f32::consts::TAU));
            let out_m = radius_m(up) * random.random::<f32>().sqrt();
            Vec3::new(1.0 + out_m * turn.cos(), 2.0 + 10.0 * up, -0.5 + out_m * turn.sin())
        };
        (0..4000).map(|_| point()).collect()
    }

    #[test]
    fn cones_are_told_from_ellipsoids() {
        let cone = CrownProfile::around(&solid(|up| 3.0 * (1.0 - up)), 8, 0.95).unwrap();
        assert!(cone.is_conical());
        let ellipsoid = CrownProfile::around(&solid(|up| 4.0 * (up * (1.0 - up)).sqrt()), 8, 0.95).unwrap();
        assert!(!ellipsoid.is_conical());
        assert!((ellipsoid.axis - Vec2::new(1.0, -0.5)).length() < 0.1);
        // An ellipse of 10 m by 4 m, of whose points the outermost twentieth is outside.
        let ellipse_m2 = std::f32::consts::PI * 5.0 * 2.0;
        assert!((ellipsoid.silhouette_m2() / ellipse_m2 - 1.0).abs() < 0.05, "{}", ellipsoid.silhouette_m2());
    }

    #[test]
    fn a_profile_encloses_the_share_asked_for() {
        let points = solid(|up| 1.0 + 2.0 * up);
        for enclosed in [0.5, 0.9, 1.0] {
            let profile = CrownProfile::around(&points, 6, enclosed).unwrap();
            let inside = points.iter().filter(|point| profile.encloses(**point)).count() as f32 / points.len() as f32;
            assert!((inside - enclosed).abs() < 1e-3, "{inside} for {enclosed}");
        }
    }

    #[test]
    fn one_point_has_a_profile() {
        assert!(CrownProfile::around(&[], 8, 0.95).is_none());
        let one = CrownProfile::around(&[Vec3::new(1.0, 2.0, 3.0)], 8, 0.95).unwrap();
        assert!(one.encloses(Vec3::new(1.0, 2.0, 3.0)) && one.radii_m.iter().all(|radius_m| radius_m.is_finite()));
        assert!(!one.encloses(Vec3::new(1.0, 3.0, 3.0)));
    }
}
