//! What must hold of every crown of polygons or ellipsoids, checked on random settings.

mod polygon_statistics;

use bevy::math::Vec3;
use proptest::prelude::*;
use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

use super::{
    CrownStatistics,
    gardner::{self, GardnerCrown},
    impressionist::{self, CrownForm, ImpressionistCrown},
};
use crate::tree::{skeleton::Skeleton, vertices::LeafVertices};

const FORMS: [CrownForm; 3] = [CrownForm::Normal, CrownForm::Winter, CrownForm::Conifer];

fn seeded(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

fn grown(crown: &ImpressionistCrown, seed: u64) -> (Skeleton, LeafVertices) {
    let skeleton = impressionist::grow(crown, 1.0, &mut seeded(seed));
    let leaves = impressionist::leaves(crown, &skeleton);
    (skeleton, leaves)
}

fn check(skeleton: &Skeleton, leaves: &LeafVertices) {
    for (index, beam) in skeleton.beams.iter().enumerate() {
        assert!(beam.base.is_finite() && beam.bow.is_finite() && beam.length_m > 0.0);
        assert!((beam.direction.length() - 1.0).abs() < 1e-4 && (0.0..=1.0).contains(&beam.attach));
        assert!(0.0 < beam.tip_radius_m && beam.tip_radius_m <= beam.base_radius_m);
        let Some(parent) = beam.parent else { continue };
        assert!((parent as usize) < index, "parents come first");
        let parent = &skeleton.beams[parent as usize];
        assert!(beam.base.distance(parent.path(beam.attach)) < 1e-3 * skeleton.height_m().max(1.0));
        assert!(beam.order == parent.order || beam.order == parent.order + 1);
    }
    for cluster in &skeleton.clusters {
        assert!((cluster.beam as usize) < skeleton.beams.len() && cluster.size_m > 0.0);
        assert!((cluster.axis.length() - 1.0).abs() < 1e-4 && (cluster.normal.length() - 1.0).abs() < 1e-4);
        assert!(cluster.axis.dot(cluster.normal).abs() < 1e-3);
        assert!([cluster.at, cluster.depth, cluster.tint, cluster.phase].iter().all(|v| (0.0..=1.0).contains(v)));
    }
    let count = leaves.positions.len();
    assert!([leaves.normals.len(), leaves.uvs.len(), leaves.sway.len()].iter().all(|&len| len == count));
    assert!(leaves.axis.len() == count && leaves.anchor.len() == count && leaves.indices.len().is_multiple_of(3));
    assert!(leaves.indices.iter().all(|&index| (index as usize) < count));
    assert!(leaves.positions.iter().flatten().all(|value| value.is_finite()));
    assert!(leaves.normals.iter().all(|&normal| (Vec3::from(normal).length() - 1.0).abs() < 1e-3));
    assert!(leaves.uvs.iter().flatten().all(|value| (0.0..=1.0).contains(value)));
    for [beam, at, phase, light] in &leaves.sway {
        assert!(beam.fract() == 0.0 && (*beam as usize) < skeleton.beams.len());
        assert!([at, phase, light].iter().all(|share| (0.0..=1.0).contains(*share)));
    }
}

/// A value of a domain, its ends among the likeliest.
fn within(low: f32, high: f32) -> impl Strategy<Value = f32> {
    prop_oneof![1 => Just(low), 1 => Just(high), 3 => low..=high]
}

prop_compose! {
    fn impressionist_crowns()(
        form in prop::sample::select(FORMS.to_vec()),
        (height_m, diameter_m, crown_size) in (within(0.5, 120.0), within(0.2, 120.0), within(0.1, 1.0)),
        (widest_at, tip_point, curve) in (within(0.0, 0.9), within(0.0, 1.0), within(1.0, 6.0)),
        (polygons, least_size_m, greatest_size_m) in (1_u32..150, within(0.02, 10.0), within(0.02, 10.0)),
        (width, roughness) in (within(0.05, 2.0), within(0.0, 0.9)),
        (distortion, gaps) in (within(0.2, 32.0), within(0.0, 1.0)),
        (inclination_deg, inclination_spread_deg) in (within(0.0, 90.0), within(0.0, 45.0)),
        (azimuth_spread_deg, hue_deg, saturation) in (within(0.0, 90.0), within(0.0, 360.0), within(0.0, 1.0)),
        (greatest_brightness, dark, full_detail_m) in (within(0.0, 1.0), within(0.0, 1.0), within(1.0, 1e4)),
        (trunk_radius_m, limbs, branches) in (within(0.01, 5.0), 1_u32..=48, 0_u32..=12),
    ) -> ImpressionistCrown {
        ImpressionistCrown {
            form, height_m, diameter_m, crown_size, widest_at, tip_point, curve, polygons, least_size_m,
            greatest_size_m, width, raggedness: 0.5, roughness, distortion, gaps, inclination_deg, inclination_spread_deg,
            azimuth_spread_deg, hue_deg, saturation, least_brightness: dark * greatest_brightness, greatest_brightness,
            full_detail_m, trunk_radius_m, limbs, branches,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn every_valid_impressionist_crown_grows_a_valid_tree(crown in impressionist_crowns(), seed in any::<u64>()) {
        crown.validate().unwrap();
        let (skeleton, leaves) = grown(&crown, seed);
        check(&skeleton, &leaves);
        prop_assert!(skeleton.clusters.len() <= crown.polygons as usize);
        prop_assert_eq!(CrownStatistics::of(&crown, 1.0, &leaves).outside_envelope_share, 0.0);
    }

    #[test]
    fn every_valid_gardner_crown_grows_a_valid_tree(
        (height_m, diameter_m, crown_size) in (within(0.5, 120.0), within(0.2, 120.0), within(0.1, 1.0)),
        (ellipsoids, size, size_spread, spread) in (1_u32..=24, within(0.05, 1.0), within(0.0, 0.9), within(0.0, 1.0)),
        (facets, trunk_radius_m, seed) in (2_u32..=6, within(0.01, 5.0), any::<u64>()),
    ) {
        let crown = GardnerCrown {
            height_m, diameter_m, crown_size, ellipsoids, size, size_spread, spread, facets, trunk_radius_m,
            ..GardnerCrown::default()
        };
        crown.validate().unwrap();
        let skeleton = gardner::grow(&crown, 1.0, &mut seeded(seed));
        let leaves = gardner::leaves(&crown, &skeleton);
        check(&skeleton, &leaves);
        prop_assert_eq!(leaves.indices.len() as u32, ellipsoids * 3 * 8 * facets * facets);
        // All ellipsoids lie within the crown's.
        let envelope = skeleton.envelope;
        for &position in &leaves.positions {
            let point = envelope.centre() + (Vec3::from(position) - envelope.centre()) * 0.999;
            let girth_m = envelope.girth_m(point.y);
            prop_assert!(point.x.hypot(point.z) <= girth_m + 1e-3 * diameter_m, "{point} in {envelope:?}");
        }
    }
}

#[test]
fn a_crown_is_determined_by_its_seed() {
    let gardner = |seed| gardner::grow(&GardnerCrown::default(), 1.0, &mut seeded(seed));
    assert_eq!(gardner(1), gardner(1));
    assert_ne!(gardner(1), gardner(2));
    for form in FORMS {
        let crown = ImpressionistCrown::of_form(form);
        assert_eq!(grown(&crown, 1), grown(&crown, 1));
        assert_ne!(grown(&crown, 1), grown(&crown, 2));
    }
}

#[test]
fn a_young_crown_is_a_scaled_one() {
    let crown = ImpressionistCrown::default();
    for scale in [0.1, 0.5] {
        let small = impressionist::grow(&crown, scale, &mut seeded(6));
        let whole = impressionist::grow(&crown, 1.0, &mut seeded(6));
        assert!((small.height_m() / whole.height_m() - scale).abs() < 1e-3);
        let leaves = impressionist::leaves(&crown, &small);
        assert_eq!(CrownStatistics::of(&crown, scale, &leaves).outside_envelope_share, 0.0);
    }
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let skeleton = impressionist::grow(&crown, scale, &mut seeded(6));
        check(&skeleton, &impressionist::leaves(&crown, &skeleton));
        let skeleton = gardner::grow(&GardnerCrown::default(), scale, &mut seeded(6));
        check(&skeleton, &gardner::leaves(&GardnerCrown::default(), &skeleton));
    }
}

#[test]
fn ellipsoids_have_their_own_normals_and_face_outwards() {
    let crown = GardnerCrown { facets: 12, ..GardnerCrown::default() };
    let skeleton = gardner::grow(&crown, 1.0, &mut seeded(1));
    let leaves = gardner::leaves(&crown, &skeleton);
    let at = |index: u32| Vec3::from(leaves.positions[index as usize]);
    let mut narrow = 0;
    for triangle in leaves.indices.chunks_exact(3) {
        let facet = (at(triangle[1]) - at(triangle[0])).cross(at(triangle[2]) - at(triangle[0]));
        let mean: Vec3 = triangle.iter().map(|&index| Vec3::from(leaves.normals[index as usize])).sum();
        // Facets of 1/12 of a quarter turn are off by half of that, 4 degrees, and some more where the chart is
        // stretched.
        let facing = facet.normalize().dot(mean.normalize());
        assert!(facing > 0.98, "{facing}");
        narrow += usize::from(facet.length() < 1e-5);
    }
    assert_eq!(narrow, 0);
}

#[test]
fn a_field_out_of_range_is_named() {
    let error = ImpressionistCrown { gaps: 1.5, ..ImpressionistCrown::default() }.validate().unwrap_err();
    assert_eq!(error.to_string(), "`gaps` is 1.5, but must be 0 to 1");
    let error = ImpressionistCrown { height_m: f32::NAN, ..ImpressionistCrown::default() }.validate().unwrap_err();
    assert!(error.to_string().starts_with("`height_m` is NaN"));
    let mut crown = GardnerCrown::default();
    crown.texture.terms = 0;
    assert_eq!(crown.validate().unwrap_err().to_string(), "`texture.terms` is 0, but must be 1 to 12");
    FORMS.into_iter().for_each(|form| ImpressionistCrown::of_form(form).validate().unwrap());
    GardnerCrown::default().validate().unwrap();
}

#[test]
fn crowns_read_back_what_they_write() {
    let crown = ImpressionistCrown::of_form(CrownForm::Conifer);
    assert_eq!(ron::from_str::<ImpressionistCrown>(&ron::to_string(&crown).unwrap()).unwrap(), crown);
    let gardner = GardnerCrown::default();
    assert_eq!(ron::from_str::<GardnerCrown>(&ron::to_string(&gardner).unwrap()).unwrap(), gardner);
    let sparse: ImpressionistCrown = ron::from_str("(form: Winter, gaps: 0.15)").unwrap();
    assert_eq!(sparse, ImpressionistCrown { form: CrownForm::Winter, gaps: 0.15, ..ImpressionistCrown::default() });
    assert!(ron::from_str::<ImpressionistCrown>("(holes: 0.15)").is_err());
}
