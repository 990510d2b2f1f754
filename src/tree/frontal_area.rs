//! The area that a tree shows the wind.

use super::skeleton::Skeleton;
use bevy::math::Vec2;

/// Layers of height in which the outline's width is measured.
const LAYERS: usize = 12;

/// Area of a tree's outline as seen from the side, in the mean of two directions, m^2: in each of some layers of height as wide as
/// leaves and wood reach there.
#[must_use]
pub(crate) fn frontal_area_m2(skeleton: &Skeleton) -> f32 {
    let tips = skeleton.clusters.iter().flat_map(|c| [c.anchor, c.anchor + c.axis * c.size_m]);
    let wood = skeleton.beams.iter().flat_map(|beam| [0.0, 0.5, 1.0].map(|s| beam.path(s)));
    let points: Vec<_> = tips.chain(wood).collect();
    let top_m = points.iter().map(|point| point.y).fold(0.0, f32::max);
    let mut layers = [[Vec2::INFINITY, Vec2::NEG_INFINITY]; LAYERS];
    for point in points {
        let layer = (point.y / top_m * LAYERS as f32).clamp(0.0, (LAYERS - 1) as f32) as usize;
        let place = Vec2::new(point.x, point.z);
        layers[layer] = [layers[layer][0].min(place), layers[layer][1].max(place)];
    }
    let widths = layers.iter().map(|[min, max]| (*max - *min).max(Vec2::ZERO).element_sum() / 2.0);
    widths.sum::<f32>() * top_m / LAYERS as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{individual::grow, species::Species};

    #[test]
    fn an_oak_shows_the_wind_what_its_crown_is_wide_and_high() {
        let species = Species::default();
        let oak = grow(&species, species.age.mature_years, 3);
        let reach = oak.clusters.iter().map(|cluster| cluster.anchor.x.hypot(cluster.anchor.z)).fold(0.0, f32::max);
        let area_m2 = frontal_area_m2(&oak);
        // An ellipse of that width, and as high as the tree but for a trunk of a sixth, and a box around both.
        let box_m2 = 2.0 * reach * oak.height_m();
        assert!((0.5..0.9).contains(&(area_m2 / box_m2)), "{area_m2} m^2 of {box_m2}");
        let young = grow(&species, 30.0, 3);
        assert!(frontal_area_m2(&young) < 0.5 * area_m2);
    }
}
