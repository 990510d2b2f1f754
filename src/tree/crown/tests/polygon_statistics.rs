//! The polygons of impressionist crowns against the statements of the paper.

use super::{FORMS, grown};
use crate::tree::{
    bounds::MOST_ENLARGED,
    crown::{
        CrownStatistics,
        impressionist::{self, CrownForm, ImpressionistCrown},
    },
    vertices::LeafVertices,
};
use bevy::math::Vec3;

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
fn gaps_leave_out_the_deepest_polygons() {
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
fn the_first_polygons_are_spread_all_around() {
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
    assert_eq!(crown.polygon_share_at(80.0), 0.5);
    assert!(
        crown.polygon_share_at(f32::INFINITY).sqrt().recip() <= MOST_ENLARGED + 1e-6,
        "bounds have room for no more"
    );
    assert_eq!(crown.polygon_share_at(f32::NAN), 1.0);
}

#[test]
fn roughness_moves_deep_polygons_inwards_and_they_are_darker() {
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
