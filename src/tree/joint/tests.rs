//! Fillets between a branch and its parent, against plain geometry.

use super::*;
use std::f32::consts::FRAC_PI_2;

fn limb() -> Limb {
    Limb { point: Vec3::new(0.0, 2.0, 0.0), axis: Vec3::Y, radius_m: 0.3, taper: 0.0, beam: 4, at: 0.5, length_m: 4.0 }
}

#[test]
fn a_line_leaves_the_limb_where_the_circle_says() {
    let limb = limb();
    assert!((limb.exit_m(limb.point, Vec3::X) - 0.3).abs() < 1e-6);
    // Off the axis by y it leaves at sqrt(R^2 - y^2), wherever it starts along the axis.
    let from = limb.point + Vec3::new(0.0, 0.7, 0.18);
    assert!((limb.exit_m(from, Vec3::X) - 0.24).abs() < 1e-6);
    // At 30 degrees to the axis it takes twice as far.
    let slanted = Vec3::new(0.5, 0.75_f32.sqrt(), 0.0);
    assert!((limb.exit_m(limb.point, slanted) - 0.6).abs() < 1e-5);
    // A cone of 0.3 - 0.1 y at y = 1.
    let cone = Limb { taper: 0.1, ..limb };
    assert!((cone.exit_m(limb.point + Vec3::Y, Vec3::X) - 0.2).abs() < 1e-5);
    // A line that misses is nearest beside the axis; one along the axis never leaves, but the answer is a number.
    assert!(limb.exit_m(limb.point + Vec3::new(-0.2, 0.0, 0.5), Vec3::X) - 0.2 < 1e-6);
    assert!(limb.exit_m(limb.point, Vec3::Y).is_finite());
}

#[test]
fn a_fillet_leads_from_the_parents_surface_and_normal_to_the_branchs() {
    let limb = limb();
    let tangent = Vec3::new(0.8, 0.6, 0.0);
    let (across, around) = (Vec3::Z, tangent.cross(Vec3::Z));
    let (radius_m, spread_m, rise_m) = (0.1, 0.06, 0.12);
    for side in 0..12 {
        let (sin, cos) = (std::f32::consts::TAU * side as f32 / 12.0).sin_cos();
        let radial = across * cos + around * sin;
        let ring = |phi_rad| Fillet { limb, phi_rad, spread_m, rise_m }.point(limb.point, tangent, radial, radius_m);
        let foot = ring(0.0);
        let off = (foot.position - limb.point).reject_from(limb.axis).length();
        assert!((off - limb.radius_m).abs() < 1e-5, "the foot stands on the surface, not {off} m off the axis");
        assert!(foot.normal.dot(limb.normal(foot.position)) > 0.9999);
        assert_eq!(foot.bound, Some((4, limb.place(foot.position))));
        let neck = ring(FRAC_PI_2);
        let off = (neck.position - limb.point).reject_from(tangent).length();
        assert!((off - radius_m).abs() < 1e-5, "the neck is as wide as the branch, not {off} m");
        assert!(neck.normal.dot(radial) > 0.9999);
        assert!(neck.bound.is_none());
        // The ring between is wider than the neck, and its normal between both.
        let middle = ring(0.7);
        let off = (middle.position - limb.point).reject_from(tangent).length();
        assert!(radius_m < off && off < radius_m + spread_m);
        let above = (middle.position - limb.point).reject_from(limb.axis).length();
        assert!(above > limb.radius_m, "the fillet stands out of the parent");
        let apart = foot.normal.dot(neck.normal) - 1e-5;
        assert!(middle.normal.dot(foot.normal) >= apart && middle.normal.dot(neck.normal) >= apart);
    }
}

#[test]
fn the_foot_of_a_fillet_is_bound_to_the_place_beside_it() {
    let limb = limb();
    assert!((limb.place(Vec3::new(0.3, 3.0, 0.0)) - 0.75).abs() < 1e-6);
    assert_eq!(limb.place(Vec3::new(0.3, 9.0, 0.0)), 1.0);
}
