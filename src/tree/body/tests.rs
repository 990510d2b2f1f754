use super::{
    limbs::{Limbs, TreeCapsule},
    *,
};
use crate::{
    dynamics::bend::SLOPE_TIP,
    tree::{Species, TreeModel},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

fn oak() -> TreeModel {
    TreeModel::bake(&Species::default(), 90.0, 7)
}

/// Poses of some beams in a wind that bends each towards x, more the thinner it is.
fn bent(beams: &[BeamDynamics], pressure: f32) -> Vec<BeamPose> {
    let free = |beam: &BeamDynamics| {
        Vec3::X.reject_from_normalized(beam.direction) * (SLOPE_TIP * beam.in_leaf.gain * pressure)
    };
    let mut poses = vec![BeamPose::REST; beams.len()];
    TreePoser::bent(beams, free).pose(&[], Vec3::ZERO, &mut poses);
    poses
}

fn random_ray(random: &mut Xoshiro256PlusPlus, height_m: f32) -> BodyRay {
    let mut around = |size: f32| Vec3::from_array(std::array::from_fn(|_| random.random_range(-size..size)));
    let target = Vec3::Y * (0.6 * height_m) + around(0.3 * height_m);
    let origin = target + around(1.0).normalize_or(Vec3::X) * height_m;
    let direction = (target - origin).normalize();
    BodyRay { origin, direction, part_m: [0.0, 3.0 * height_m] }
}

#[test]
fn limbs_are_the_thickest_beams_and_all_that_bear_them() {
    let model = oak();
    let limbs = model.body.limbs.limbs();
    assert!((20..=256).contains(&limbs.len()), "{} limbs", limbs.len());
    let has = |beam: u32| limbs.iter().any(|limb| limb.beam == beam);
    let thinnest_m = limbs.iter().map(|limb| limb.radii_m[0]).fold(f32::INFINITY, f32::min);
    for (index, beam) in (0..).zip(&model.skeleton.beams) {
        assert!(!has(index) || beam.parent.is_none_or(has), "beam {index} without its parent");
        assert!(has(index) || limbs.len() >= 200 || beam.base_radius_m <= 0.02, "{}", beam.base_radius_m);
    }
    assert!(thinnest_m > 0.005, "{thinnest_m}");
    let sapling = TreeModel::bake(&Species::default(), 2.0, 7);
    assert!(!sapling.body.limbs.limbs().is_empty(), "a sapling has a stem");
}

/// The subset of beams is posed by itself, and moves as in the whole tree.
#[test]
fn limbs_are_posed_as_in_the_whole_tree() {
    let model = oak();
    let own = model.body.posed(&bent(model.body.limbs.beams(), 2e4));
    let of_all = model.body.posed_by_all(&bent(&model.beams, 2e4));
    assert_eq!(own, of_all);
    assert_ne!(own, model.body.at_rest());
    let lean_m = own.cones.iter().zip(model.body.at_rest().cones).map(|(a, b)| a.ends[1].x - b.ends[1].x);
    assert!(lean_m.fold(0.0, f32::max) > 0.1);
}

#[test]
fn the_first_hit_is_that_of_a_search_of_all_cones() {
    let model = oak();
    let posed = model.body.posed(&bent(model.body.limbs.beams(), 5e3));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut hits = 0;
    for _ in 0..2000 {
        let ray = random_ray(&mut random, model.height_m());
        let all = posed.cones.iter().filter_map(|cone| cone.hit(ray.origin, ray.direction, 0.0));
        let slow = all.filter(|hit_m| *hit_m <= ray.part_m[1]).reduce(f32::min);
        let fast = model.body.hit(&posed, &ray);
        assert_eq!(fast.map(|hit| hit.distance_m), slow);
        let Some(hit) = fast else { continue };
        hits += 1;
        assert!((0.0..=1.0).contains(&hit.at) && hit.normal.is_normalized());
        assert!(hit.normal.dot(ray.direction) < 1e-3, "the surface faces the ray");
        let short = BodyRay { part_m: [0.0, 0.99 * hit.distance_m], ..ray };
        assert_eq!(model.body.hit(&posed, &short), None, "nothing before it");
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn capsules_hold_the_axis_of_the_wood_and_leave_out_what_is_thin() {
    let model = oak();
    let posed = model.body.at_rest();
    let all = model.body.capsules(&posed, 0.0);
    assert_eq!(all.len(), 2 * model.body.limbs.limbs().len());
    let thick = model.body.capsules(&posed, 0.1);
    assert!(!thick.is_empty() && thick.len() < all.len());
    for TreeCapsule { a, b, radius_m, beam } in thick {
        let wood = &model.skeleton.beams[beam as usize];
        assert!(wood.base_radius_m >= 0.1 && radius_m <= wood.base_radius_m && radius_m >= wood.tip_radius_m);
        let off = |at: Vec3| (0..=40).map(|k| wood.path(0.025 * k as f32).distance(at)).fold(f32::INFINITY, f32::min);
        assert!(off(a) < 0.02 + 0.03 * wood.length_m && off(b) < 0.02 + 0.03 * wood.length_m);
    }
}

/// The sum over the cells against fine steps, each of which looks up the cell that it is in.
#[test]
fn the_depth_along_a_ray_is_that_of_fine_steps() {
    let model = oak();
    let (body, rest) = (&model.body, model.body.at_rest());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    let mut dense = 0;
    for _ in 0..100 {
        let ray = random_ray(&mut random, model.height_m());
        let (mut depth, mut last_m) = (0.0, 0.0);
        body.pass_crown(&rest, &ray, 0.7, |step| {
            let [from_m, to_m] = step.part_m;
            assert!(from_m >= last_m - 1e-3 && to_m > from_m, "{from_m} to {to_m} after {last_m}");
            last_m = to_m;
            depth += step.depth;
        });
        let steps = 100_000_u32;
        let step_m = ray.part_m[1] / steps as f32;
        let at = |step: u32| ray.origin + (step as f32 + 0.5) * step_m * ray.direction;
        let slow = step_m * (0..steps).map(|step| body.crown.extinction(at(step), ray.direction, 0.7)).sum::<f32>();
        assert!((depth - slow).abs() < 2e-3 * (1.0 + slow), "{depth} for {slow}");
        assert!((body.transmittance(&rest, &ray, 0.7) - (-depth).exp()).abs() < 1e-6);
        dense += u32::from(depth > 0.2);
    }
    assert!(dense > 15, "{dense}");
}

/// A crown that is moved as a whole lets through what the crown at rest lets through of a ray that is moved back.
#[test]
fn a_moved_crown_is_met_by_a_moved_ray() {
    let model = oak();
    let (body, rest) = (&model.body, model.body.at_rest());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    for _ in 0..200 {
        let ray = random_ray(&mut random, model.height_m());
        let shift = Vec3::new(1.3, -0.4, -0.8);
        let moved = PosedBody { shifts: vec![shift; rest.shifts.len()], ..rest.clone() };
        let back = BodyRay { origin: ray.origin - shift, ..ray };
        let (one, other) = (body.transmittance(&moved, &ray, 1.0), body.transmittance(&rest, &back, 1.0));
        assert!((one - other).abs() < 2e-3, "{one} for {other}");
    }
}

#[test]
fn crowns_lean_with_the_stem_and_are_thinner_in_winter() {
    let model = oak();
    let body = &model.body;
    let leaning = body.posed(&bent(body.limbs.beams(), 2e4));
    let top = leaning.shifts.last().unwrap();
    assert!(top.x > 0.5 && leaning.shifts[0].length() < 0.5 * top.length(), "{:?}", leaning.shifts);
    let height_m = 0.6 * model.height_m();
    let through = BodyRay { origin: Vec3::new(-40.0, height_m, 0.3), direction: Vec3::X, part_m: [0.0, 80.0] };
    let rows = || (0..30).map(|k| Vec3::new(-40.0, (0.45 + 0.015 * k as f32) * model.height_m(), 0.3));
    let rest = body.at_rest();
    let [summer, winter] = [1.0, 0.0].map(|leaves| {
        rows().map(|origin| body.transmittance(&rest, &BodyRay { origin, ..through }, leaves)).sum::<f32>() / 30.0
    });
    assert!(summer < winter - 0.3 && (0.3..=1.0).contains(&winter), "{summer} and {winter}");
    let beside = BodyRay { origin: Vec3::new(-40.0, height_m, 60.0), ..through };
    assert_eq!(body.transmittance(&rest, &beside, 1.0), 1.0);
}

#[test]
fn odd_rays_and_empty_bodies_are_harmless() {
    let model = oak();
    let posed = model.body.at_rest();
    let odd = [f32::NAN, f32::INFINITY, -1e30, 0.0];
    for bad in odd {
        for ray in [
            BodyRay { origin: Vec3::splat(bad), direction: Vec3::X, part_m: [0.0, 10.0] },
            BodyRay { origin: Vec3::ZERO, direction: Vec3::splat(bad), part_m: [0.0, 10.0] },
            BodyRay { origin: Vec3::Y, direction: Vec3::NEG_Y, part_m: [bad, 10.0] },
            BodyRay { origin: Vec3::Y, direction: Vec3::NEG_Y, part_m: [0.0, bad] },
        ] {
            let _ = model.body.hit(&posed, &ray);
            let share = model.body.transmittance(&posed, &ray, 1.0);
            assert!((0.0..=1.0).contains(&share), "{ray:?}: {share}");
        }
    }
    let nothing = TreeBody { limbs: Limbs::default(), crown: CrownDensity::default() };
    let ray = BodyRay { origin: Vec3::ZERO, direction: Vec3::X, part_m: [0.0, 10.0] };
    assert_eq!(nothing.hit(&nothing.at_rest(), &ray), None);
    assert_eq!(nothing.transmittance(&nothing.at_rest(), &ray, 1.0), 1.0);
}
