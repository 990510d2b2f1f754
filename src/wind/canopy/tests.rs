use super::*;
use approx::assert_relative_eq;

/// Figures of Raupach 1994, worked out by hand for a closed forest of leaf area index 4, and the limits that his paper names.
#[test]
fn closed_stands_have_raupachs_displacement_and_friction() {
    let profile = CanopyProfile::of_stand(20.0, 2.0);
    // s = sqrt(30): d/h = 1 - (1 - 0.00418) / 5.477.
    assert_relative_eq!(profile.displacement_share, 0.8182, epsilon = 1e-3);
    assert_relative_eq!(profile.speed_by_friction, 3.333, epsilon = 1e-3);
    let roughness_share =
        (1.0 - profile.displacement_share) * (SUBLAYER - VON_KARMAN * profile.speed_by_friction).exp();
    // Forests have z0/h of 0.05 to 0.1 (Raupach 1994, figure 1).
    assert!((0.05..0.1).contains(&roughness_share), "{roughness_share}");
    let sparse = CanopyProfile::of_stand(20.0, 0.2);
    let roughness_share = (1.0 - sparse.displacement_share) * (SUBLAYER - VON_KARMAN * sparse.speed_by_friction).exp();
    // His greatest, at an index of some 0.2 to 0.3, is 0.12.
    assert!((0.1..0.13).contains(&roughness_share), "{roughness_share}");
}

#[test]
fn attenuation_is_that_of_measured_canopies() {
    // Cionco 1978: 1 for larch plantations and Christmas trees to 4.4 for a dense gum and maple forest.
    for (index, [least, most]) in [(0.3, [0.5, 1.5]), (1.0, [1.0, 2.7]), (3.0, [2.0, 4.4])] {
        let attenuation = CanopyProfile::of_stand(15.0, index).attenuation;
        assert!((least..most).contains(&attenuation), "{index}: {attenuation}");
    }
}

#[test]
fn packing_keeps_a_canopy_to_its_steps() {
    let exposure = std::array::from_fn(|number| number as f32 / 7.0);
    let canopy = Canopy { height_m: 21.3, frontal_area_index: 1.4, exposure };
    let packed = canopy.pack();
    let (profile, exact) = (packed.profile(), CanopyProfile::of_stand(21.3, 1.4));
    assert!((profile.height_m - 21.3).abs() <= 0.25);
    assert!((profile.speed_by_friction - exact.speed_by_friction).abs() <= 0.04);
    assert!((profile.attenuation - exact.attenuation).abs() <= 0.01);
    assert!((profile.displacement_share - exact.displacement_share).abs() <= 0.002);
    for (number, exposure) in exposure.into_iter().enumerate() {
        assert!((packed.exposure_to(exposure_direction(number)) - exposure).abs() <= 0.04);
    }
    let between = packed.exposure_to(Vec2::from_angle(TAU * 2.5 / 8.0));
    assert!((between - 2.5 / 7.0).abs() <= 0.04, "{between}");
}

#[test]
fn few_trees_are_no_stand() {
    assert_eq!(Canopy::default().pack().exposure, Canopy::OPEN.exposure);
    let sparse = Canopy { height_m: 20.0, frontal_area_index: 0.003, exposure: [0.0; 8] };
    assert!(sparse.pack().exposure_to(Vec2::X) > 0.9);
    let dense = Canopy { frontal_area_index: 1.0, ..sparse };
    assert_eq!(dense.pack().exposure_to(Vec2::X), 0.0);
}

/// The share of the open wind's bending moment that is left behind an edge, against the wind tunnel of Stacey et al. (1994) as
/// Gardiner et al. (2000) fitted it: `(1.7239 s/h + 0.0316)^(x/h)` for a spacing `s` of trees.
#[test]
fn edges_shelter_as_quickly_as_in_the_wind_tunnel() {
    for spacing_by_height in [0.15_f32, 0.25, 0.35] {
        // Spruces with a triangular crown, as wide as they stand apart and half as high as the tree.
        let index = 0.25 / spacing_by_height;
        let tunnel_heights = -1.0 / (1.7239 * spacing_by_height + 0.0316).ln();
        let mut path = UpwindPath::from_open();
        path.pass(20.0, 20.0, index);
        let heights = -1.0 / path.exposure().ln();
        // Loads go with the square of the wind: they fall in half the length of the wind's.
        let of_loads = 0.5 * heights;
        assert!(
            (0.5..2.0).contains(&(of_loads / tunnel_heights)),
            "{spacing_by_height}: {of_loads} heights, in the tunnel {tunnel_heights}"
        );
    }
}

#[test]
fn the_wind_comes_back_in_a_clearing_of_ten_heights() {
    let mut path = UpwindPath::from_open();
    path.pass(200.0, 20.0, 2.0);
    let inside = path.exposure();
    assert!(inside < 0.01);
    path.pass(200.0, 20.0, 0.0);
    assert!((0.8..0.95).contains(&path.exposure()), "{}", path.exposure());
    let mut stepwise = UpwindPath::from_open();
    (0..200).for_each(|_| stepwise.pass(1.0, 20.0, 2.0));
    assert_relative_eq!(stepwise.exposure(), inside, epsilon = 1e-4);
}

#[test]
fn canopies_of_any_numbers_are_finite() {
    for bad in [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30] {
        for canopy in [
            Canopy { height_m: bad, frontal_area_index: 1.0, ..Canopy::default() },
            Canopy { height_m: 10.0, frontal_area_index: bad, ..Canopy::default() },
            Canopy { height_m: 10.0, frontal_area_index: 1.0, exposure: [bad; 8] },
        ] {
            let packed = canopy.pack();
            let CanopyProfile { height_m, speed_by_friction, attenuation, displacement_share } = packed.profile();
            let numbers = [height_m, speed_by_friction, attenuation, displacement_share];
            assert!(numbers.iter().all(|number| number.is_finite()), "{canopy:?}");
            assert!(packed.exposure_to(Vec2::new(0.3, -0.9)).is_finite());
            assert!(packed.exposure_to(Vec2::ZERO).is_finite());
        }
        let mut path = UpwindPath::from_open();
        path.pass(10.0, 10.0, 1.0);
        assert!(path.exposure().is_finite());
    }
}
