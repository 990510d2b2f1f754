//! The paper's low level: "four non-textured polygons: two perpendicular rectangles to depict the trunk, and two
//! perpendicular triangles (bounding volume - cone) or ellipses (bounding volume - ellipsoid) to depict the crown"
//! (Setas et al., section 4.1.2). They stand still.
//!
//! The crown's polygons cover as much of the picture as the full tree's crown does: they are smaller than its outline by
//! what shines through it.

use bevy::math::Vec3;
use std::f32::consts::{PI, TAU};

use super::envelope::EnvelopeLevel;
use crate::{lod::bake::scene::Scene, tree::TreeModel};

/// Corners of an ellipse.
const ELLIPSE_CORNERS: u32 = 12;
/// How far the trunk reaches into the crown, as a share of the crown's height.
const INTO_CROWN: f32 = 0.3;
/// How much the normals of a crown lean up at its middle: it is lit from above.
const NORMAL_LIFT: f32 = 0.5;

/// Vertices of the four polygons; to be drawn from both sides.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrossedPolygons {
    /// Positions, local to the tree, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals: out of the trunk, and out of the crown as of a round one.
    pub normals: Vec<[f32; 3]>,
    /// Linear colours, the mean of trunk or crown.
    pub colours: Vec<[f32; 3]>,
    /// Triangles.
    pub indices: Vec<u32>,
}

/// The four polygons of a model; without a crown, the two of the trunk.
#[must_use]
pub fn crossed_polygons(scene: &Scene, model: &TreeModel, crown: Option<&EnvelopeLevel>) -> CrossedPolygons {
    let mut out = CrossedPolygons::default();
    let height_m = crown.map_or(model.height_m(), |crown| {
        crown.profile.base_m + INTO_CROWN * (crown.profile.top_m - crown.profile.base_m)
    });
    let radius_m = model.skeleton.beams.first().map_or(0.0, |beam| beam.base_radius_m);
    for side in [Vec3::X, Vec3::Z] {
        out.rectangle(side * radius_m, height_m, scene.stem_colour());
    }
    if let Some(crown) = crown {
        for side in [Vec3::X, Vec3::Z] {
            out.crown(crown, side);
        }
    }
    out
}

impl CrossedPolygons {
    fn push(&mut self, position: Vec3, normal: Vec3, colour: [f32; 3]) {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.colours.push(colour);
    }

    /// A polygon as a fan about its first corner.
    fn fan(&mut self, first: u32) {
        let last = self.positions.len() as u32 - 1;
        self.indices.extend((first + 1..last).flat_map(|corner| [first, corner, corner + 1]));
    }

    fn rectangle(&mut self, half: Vec3, height_m: f32, colour: [f32; 3]) {
        let first = self.positions.len() as u32;
        for (side, up_m) in [(-1.0, 0.0), (1.0, 0.0), (1.0, height_m), (-1.0, height_m)] {
            let out = half * side;
            self.push(out + Vec3::Y * up_m, out.normalize_or(Vec3::X), colour);
        }
        self.fan(first);
    }

    fn crown(&mut self, crown: &EnvelopeLevel, side: Vec3) {
        let profile = &crown.profile;
        let first = self.positions.len() as u32;
        let middle = Vec3::new(profile.axis.x, 0.5 * (profile.base_m + profile.top_m), profile.axis.y);
        // Seen through both halves of the envelope.
        let opaque = 1.0 - (1.0 - crown.coverage).powi(2);
        let area_m2 = opaque * profile.silhouette_m2();
        let shrunk = opaque.sqrt();
        let half_height_m = 0.5 * shrunk * (profile.top_m - profile.base_m);
        let corner = |out: &mut Self, across_m: f32, up_m: f32| {
            let reach = side * across_m + Vec3::Y * up_m;
            let lifted = reach / half_height_m + Vec3::Y * NORMAL_LIFT;
            out.push(middle + reach, lifted.normalize_or(Vec3::Y), crown.mean_colour);
        };
        if profile.is_conical() {
            let half_width_m = area_m2 / (2.0 * half_height_m);
            // The apex stays where it is.
            let top_m = 0.5 * (profile.top_m - profile.base_m);
            let base_m = top_m - 2.0 * half_height_m;
            corner(self, -half_width_m, base_m);
            corner(self, half_width_m, base_m);
            corner(self, 0.0, top_m);
        } else {
            // The polygon has a little less area than the ellipse through its corners.
            let step_rad = TAU / ELLIPSE_CORNERS as f32;
            let half_width_m = area_m2 / (PI * half_height_m) * (step_rad / step_rad.sin());
            for index in 0..ELLIPSE_CORNERS {
                let (sin, cos) = (index as f32 * step_rad).sin_cos();
                corner(self, half_width_m * cos, half_height_m * sin);
            }
        }
        self.fan(first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        lod::settings::EnvelopeSettings,
        tree::{Species, textures::species_textures},
    };

    fn planted(text: &str) -> (CrossedPolygons, EnvelopeLevel) {
        let species = Species::from_ron(text).unwrap();
        let model = TreeModel::bake(&species, species.age.mature_years, 1);
        let scene = Scene::new(&species, &model, &species_textures(&species));
        let settings = EnvelopeSettings { width_texels: 32, height_texels: 32, ..EnvelopeSettings::default() };
        let crown = EnvelopeLevel::bake(&scene, &species, &model, &settings).unwrap();
        (crossed_polygons(&scene, &model, Some(&crown)), crown)
    }

    fn area_m2(polygons: &CrossedPolygons, triangles: std::ops::Range<usize>) -> f32 {
        let corner = |index: u32| Vec3::from_array(polygons.positions[index as usize]);
        polygons.indices[3 * triangles.start..3 * triangles.end]
            .chunks_exact(3)
            .map(|triple| {
                0.5 * (corner(triple[1]) - corner(triple[0])).cross(corner(triple[2]) - corner(triple[0])).length()
            })
            .sum()
    }

    #[test]
    fn a_fir_has_triangles_and_an_oak_has_ellipses() {
        let (fir, _) = planted(include_str!("../../../assets/species/fir.species.ron"));
        assert_eq!(fir.indices.len(), 3 * (4 + 2));
        let (oak, _) = planted(include_str!("../../../assets/species/oak.species.ron"));
        assert_eq!(oak.indices.len(), 3 * (4 + 2 * (ELLIPSE_CORNERS as usize - 2)));
        let green = |colour: &[f32; 3]| colour[1] > colour[0] && colour[1] > colour[2];
        assert_eq!(oak.colours.iter().filter(|colour| green(colour)).count(), 2 * ELLIPSE_CORNERS as usize);
    }

    #[test]
    fn each_polygon_of_a_crown_covers_what_the_crown_does() {
        for text in [
            include_str!("../../../assets/species/fir.species.ron"),
            include_str!("../../../assets/species/oak.species.ron"),
        ] {
            let (polygons, crown) = planted(text);
            let each = (polygons.indices.len() / 3 - 4) / 2;
            let opaque = 1.0 - (1.0 - crown.coverage).powi(2);
            let expected_m2 = opaque * crown.profile.silhouette_m2();
            for half in 0..2 {
                let found_m2 = area_m2(&polygons, 4 + half * each..4 + (half + 1) * each);
                assert!((found_m2 / expected_m2 - 1.0).abs() < 1e-3, "{found_m2} for {expected_m2}");
            }
        }
    }
}
