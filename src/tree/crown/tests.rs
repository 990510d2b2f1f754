//! What must hold of every painted crown, tried on random settings, and what the papers say of theirs.

use bevy::math::Vec3;
use proptest::prelude::*;
use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

use super::{
    CrownStatistics,
    gardner::{self, GardnerCrown},
    impressionist::{self, CrownForm, ImpressionistCrown},
};
use crate::tree::{leaf_mesh::LeafVertices, skeleton::Skeleton};

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
    fn every_valid_impressionist_crown_is_sound(crown in impressionist_crowns(), seed in any::<u64>()) {
        crown.validate().unwrap();
        let (skeleton, leaves) = grown(&crown, seed);
        check(&skeleton, &leaves);
        prop_assert!(skeleton.clusters.len() <= crown.polygons as usize);
        prop_assert_eq!(CrownStatistics::of(&crown, 1.0, &leaves).outside_envelope_share, 0.0);
    }

    #[test]
    fn every_valid_gardner_crown_is_sound(
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
fn inclination_and_azimuth_are_recovered_from_the_polygons() {
    for (inclination_deg, inclination_spread_deg, azimuth_spread_deg) in [(40.0, 8.0, 20.0), (60.0, 15.0, 45.0)] {
        for form in FORMS {
            for seed in 0..4 {
                let crown = ImpressionistCrown {
                    inclination_deg,
                    inclination_spread_deg,
                    azimuth_spread_deg,
                    polygons: 4000,
                    ..ImpressionistCrown::of_form(form)
                };
                let crown = ImpressionistCrown { gaps: 0.0, ..crown };
                let (_, leaves) = grown(&crown, seed);
                let measured = CrownStatistics::of(&crown, 1.0, &leaves);
                assert_eq!(measured.polygons, 4000);
                // Four standard errors: s / sqrt(n) of the mean, and for a uniform distribution s sqrt(0.2 / n) of the
                // spread.
                let spread = inclination_spread_deg;
                let mean_error = 4.0 * spread / 3.0_f32.sqrt() / 4000.0_f32.sqrt();
                let spread_error = 4.0 * spread * (0.2_f32 / 4000.0).sqrt();
                assert!((measured.inclination_mean_deg - inclination_deg).abs() < mean_error, "{form:?} {measured:?}");
                assert!((measured.inclination_spread_deg - spread).abs() < spread_error, "{form:?} {measured:?}");
                if form != CrownForm::Winter {
                    let azimuth_deg = measured.azimuth_greatest_deg;
                    assert!(
                        (0.99 * azimuth_spread_deg..1.005 * azimuth_spread_deg).contains(&azimuth_deg),
                        "{measured:?}"
                    );
                }
            }
        }
    }
}

/// Kolmogorov & Smirnov: no more than 1.95 / sqrt(n) off at the level 0.1%.
#[test]
fn inclinations_are_uniform_about_their_mean() {
    let crown = ImpressionistCrown { polygons: 3000, gaps: 0.0, ..ImpressionistCrown::default() };
    let share = |normal: Vec3| (normal.y.acos().to_degrees() - 32.0) / 16.0;
    let mut shares: Vec<f32> = (0..10)
        .flat_map(|seed| grown(&crown, seed).0.clusters.into_iter().map(move |cluster| share(cluster.normal)))
        .collect();
    shares.sort_by(f32::total_cmp);
    let count = shares.len() as f32;
    let off = shares.iter().enumerate().map(|(n, share)| (share - (n as f32 + 0.5) / count).abs()).fold(0.0, f32::max);
    assert!(off < 1.95 / count.sqrt(), "{off}");
}

#[test]
fn polygons_grow_linearly_from_the_top_to_the_widest_point() {
    let crown =
        ImpressionistCrown { roughness: 0.0, gaps: 0.0, inclination_spread_deg: 0.0, ..ImpressionistCrown::default() };
    let (skeleton, _) = grown(&crown, 2);
    let profile = crown.profile();
    let linear = |height_m: f32| {
        let share = (profile.top_m - height_m) / (profile.top_m - profile.widest_m());
        crown.least_size_m + (crown.greatest_size_m - crown.least_size_m) * share.clamp(0.0, 1.0)
    };
    // Anchors that were moved inwards have changed their height by up to a size of theirs, not more.
    let slope = (crown.greatest_size_m - crown.least_size_m) / (profile.top_m - profile.widest_m());
    for cluster in &skeleton.clusters {
        let off = (cluster.size_m - linear(cluster.anchor.y)).abs();
        let low = cluster.anchor.y < profile.base_m + crown.greatest_size_m;
        assert!(low || off <= slope * 1.5 * crown.greatest_size_m + 1e-4, "{} at {}", cluster.size_m, cluster.anchor.y);
    }
    let largest = skeleton.clusters.iter().map(|cluster| cluster.size_m).fold(0.0, f32::max);
    assert!((largest - crown.greatest_size_m).abs() < 1e-5);
}

#[test]
fn gaps_are_the_share_that_is_left_out() {
    for form in FORMS {
        let drawn = |gaps: f32| {
            let crown = ImpressionistCrown { gaps, polygons: 2000, ..ImpressionistCrown::of_form(form) };
            grown(&crown, 5).0.clusters.len() as f32 / 2000.0
        };
        assert_eq!(drawn(0.0), 1.0);
        assert_eq!(drawn(1.0), 0.0);
        let shares: Vec<f32> = (0..=20).map(|step| drawn(0.05 * step as f32)).collect();
        assert!(shares.windows(2).all(|pair| pair[1] <= pair[0]), "{form:?}: {shares:?}");
        for (step, share) in shares.iter().enumerate() {
            // The rank is taken among other points of the surface than the polygons'.
            assert!((share - (1.0 - 0.05 * step as f32)).abs() < 0.04, "{form:?}: {shares:?}");
        }
    }
}

#[test]
fn a_gap_takes_the_deepest() {
    let whole = grown(&ImpressionistCrown { gaps: 0.0, ..ImpressionistCrown::default() }, 5).0;
    let gappy = grown(&ImpressionistCrown { gaps: 0.4, ..ImpressionistCrown::default() }, 5).0;
    assert!(gappy.clusters.iter().all(|cluster| cluster.depth < 0.6));
    assert_eq!(gappy.clusters.len(), whole.clusters.iter().filter(|cluster| cluster.depth < 0.6).count());
}

#[test]
fn fewer_polygons_are_the_first_of_more() {
    for form in FORMS {
        let of = |polygons| grown(&ImpressionistCrown { polygons, ..ImpressionistCrown::of_form(form) }, 9).0.clusters;
        let (few, many) = (of(250), of(1000));
        assert!(few.len() > 150 && many.len() > 3 * few.len());
        assert_eq!(few[..], many[..few.len()]);
    }
}

/// The first polygons of many are spread as evenly as all: no octant of the crown is left bare.
#[test]
fn the_first_polygons_go_all_around() {
    let crown = ImpressionistCrown { gaps: 0.0, ..ImpressionistCrown::default() };
    let (skeleton, _) = grown(&crown, 4);
    for count in [32, 64, 200] {
        let mut octants = [0_usize; 8];
        for cluster in &skeleton.clusters[..count] {
            let azimuth = cluster.anchor.z.atan2(cluster.anchor.x) / std::f32::consts::TAU + 0.5;
            octants[(8.0 * azimuth) as usize % 8] += 1;
        }
        let even = count / 8;
        assert!(octants.iter().all(|&n| n.abs_diff(even) <= 2), "{count}: {octants:?}");
    }
}

#[test]
fn distance_draws_fewer_polygons_that_cover_as_much() {
    let crown = ImpressionistCrown::default();
    let (skeleton, near) = grown(&crown, 4);
    let covered = |leaves: &LeafVertices| -> f32 {
        let at = |index: u32| Vec3::from(leaves.positions[index as usize]);
        leaves.indices.chunks_exact(3).map(|t| (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).length()).sum()
    };
    let mut count = near.indices.len();
    for distance_m in [10.0, 60.0, 120.0, 400.0] {
        let leaves = impressionist::leaves_at(&crown, &skeleton, distance_m);
        assert!(leaves.indices.len() <= count);
        count = leaves.indices.len();
        assert!((covered(&leaves) / covered(&near) - 1.0).abs() < 0.1, "{distance_m} m");
    }
    assert_eq!(impressionist::leaves_at(&crown, &skeleton, 10.0), near);
    assert_eq!(crown.polygons_at(80.0), crown.polygons as usize / 2);
    assert_eq!(crown.polygons_at(1e9), 24);
    assert_eq!(crown.polygons_at(f32::NAN), crown.polygons as usize);
}

#[test]
fn roughness_draws_the_deep_ones_inwards_and_the_deep_are_dark() {
    // So small that none must be moved to stay inside, but for the few at the very top.
    let sizes = ImpressionistCrown { least_size_m: 0.02, greatest_size_m: 0.02, ..ImpressionistCrown::default() };
    let smooth = ImpressionistCrown { roughness: 0.0, gaps: 0.0, ..sizes };
    let rough = ImpressionistCrown { roughness: 0.6, ..smooth };
    let (before, leaves) = grown(&smooth, 8);
    let (after, _) = grown(&rough, 8);
    let reach = |anchor: Vec3| anchor.x.hypot(anchor.z);
    for (a, b) in before.clusters.iter().zip(&after.clusters) {
        let expected = reach(a.anchor) * (1.0 - 0.6 * b.depth);
        assert!(a.anchor.y > 13.8 || (reach(b.anchor) - expected).abs() < 0.03, "{} {expected}", reach(b.anchor));
        assert_eq!(a.depth, b.depth);
    }
    for (sway, cluster) in leaves.sway.iter().step_by(3).zip(&before.clusters) {
        // A value of sRGB as light (IEC 61966-2-1, above its toe).
        let light = |value: f32| ((value + 0.055) / 1.055).powf(2.4);
        let [least, greatest] = [smooth.least_brightness, smooth.greatest_brightness];
        let expected = light(greatest + cluster.depth * (least - greatest)) / light(greatest);
        assert!((sway[3] - expected).abs() < 1e-5, "{} against {expected}", sway[3]);
    }
}

#[test]
fn winter_twigs_grow_on_branches() {
    let crown = ImpressionistCrown::of_form(CrownForm::Winter);
    let (skeleton, _) = grown(&crown, 3);
    for cluster in &skeleton.clusters {
        let beam = &skeleton.beams[cluster.beam as usize];
        assert!(beam.order == 2 && beam.path(cluster.at).distance(cluster.anchor) < 1e-3);
        assert!(cluster.axis.y > 0.0, "twigs rise");
    }
}

#[test]
fn the_same_seed_paints_the_same_crown_and_another_seed_another() {
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
fn a_young_tree_is_a_small_one() {
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
fn crowns_survive_writing_and_reading() {
    let crown = ImpressionistCrown::of_form(CrownForm::Conifer);
    assert_eq!(ron::from_str::<ImpressionistCrown>(&ron::to_string(&crown).unwrap()).unwrap(), crown);
    let gardner = GardnerCrown::default();
    assert_eq!(ron::from_str::<GardnerCrown>(&ron::to_string(&gardner).unwrap()).unwrap(), gardner);
    let sparse: ImpressionistCrown = ron::from_str("(form: Winter, gaps: 0.15)").unwrap();
    assert_eq!(sparse, ImpressionistCrown { form: CrownForm::Winter, gaps: 0.15, ..ImpressionistCrown::default() });
    assert!(ron::from_str::<ImpressionistCrown>("(holes: 0.15)").is_err());
}
