use super::*;
use crate::cells::{cell::Cell, store::CellStore, store::tests::forest};
use bevy::{
    math::{IVec2, Mat4, proj::perspective_infinite_reverse},
    prelude::Transform,
    shape::ViewFrustum,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

/// Height and reach of full-grown trees, m.
const HEIGHT_M: f32 = 25.0;
const REACH_M: f32 = 6.0;

/// A box about the trees of a cell.
fn box_of_trees((cell, content): (IVec2, &Cell), cell_m: f32) -> Option<Bounds> {
    let [lowest_m, highest_m] = content.ground_m()?;
    let reach_m = content.largest() * REACH_M;
    let corner_m = cell.as_vec2() * cell_m;
    let min = Vec3::new(corner_m.x - reach_m, lowest_m, corner_m.y - reach_m);
    let top_m = highest_m + content.largest() * HEIGHT_M;
    let max = Vec3::new(corner_m.x + cell_m + reach_m, top_m, corner_m.y + cell_m + reach_m);
    Some(Bounds::from_min_max(min, max))
}

/// The boxes about the trees of all cells where any stand.
fn boxes(store: &CellStore) -> Vec<Bounds> {
    store.iter().filter_map(|cell| box_of_trees(cell, store.cell_m())).collect()
}

fn random_unit(random: &mut Xoshiro256PlusPlus) -> Vec3 {
    let mut component = || random.random_range(-1.0..1.0_f32);
    Vec3::new(component(), component(), component()).normalize_or(Vec3::Z)
}

/// A camera somewhere in or over the forest that looks anywhere; also what it makes of a point of the world.
fn random_view(random: &mut Xoshiro256PlusPlus, sun: Option<SunShadows>) -> (CullingView, Mat4) {
    let mut place = |half_m: f32| random.random_range(-half_m..half_m);
    let eye_m = Vec3::new(place(1500.0), place(60.0) + 40.0, place(1500.0));
    let clip_from_view = perspective_infinite_reverse(
        random.random_range(0.2..2.0),
        random.random_range(0.3..3.0),
        random.random_range(0.01..2.0),
    );
    let looking = Transform::from_translation(eye_m).looking_to(random_unit(random), random_unit(random));
    let view_from_world = looking.to_matrix().inverse();
    let clip_from_world = clip_from_view * view_from_world;
    let planes = ViewFrustum::from_clip_from_world(&clip_from_world).half_spaces.map(|space| space.normal_d());
    let distance_m = random.random_range(50.0..3000.0);
    (CullingView { planes, eye_m, distance_m, sun }, clip_from_world)
}

/// Whether a point is in the picture, by projection.
fn is_pictured(point: Vec3, clip_from_world: &Mat4) -> bool {
    let clip = *clip_from_world * point.extend(1.0);
    clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z <= clip.w
}

/// A place in a box.
fn random_place(bounds: &Bounds, random: &mut Xoshiro256PlusPlus) -> Vec3 {
    let mut component = || random.random_range(-1.0..=1.0_f32);
    bounds.centre + Vec3::new(component(), component(), component()) * bounds.half
}

#[test]
fn no_box_in_view_is_culled() {
    let boxes = boxes(&forest(40, 2, 30.0, 1));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut pictured, mut kept) = (0, 0);
    for _ in 0..150 {
        let (view, clip_from_world) = random_view(&mut random, None);
        let culler = Culler::new(&view);
        for bounds in &boxes {
            let visibility = culler.visibility(bounds);
            kept += usize::from(visibility.is_some());
            let points: [Vec3; 6] = std::array::from_fn(|_| random_place(bounds, &mut random));
            let visible =
                |point: &Vec3| is_pictured(*point, &clip_from_world) && point.distance(view.eye_m) <= view.distance_m;
            if points.iter().any(visible) {
                pictured += 1;
                assert_eq!(visibility, Some(Visibility::InView), "{bounds:?} for {view:?}");
            }
        }
    }
    assert!(pictured > 10_000, "{pictured}");
    assert!(kept < 2 * pictured, "{kept} kept for {pictured}: hardly anything is culled");
}

#[test]
fn no_shadow_in_view_is_culled() {
    let boxes = boxes(&forest(25, 2, 30.0, 2));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut thrown = 0;
    for _ in 0..300 {
        let sun = SunShadows {
            direction: (random_unit(&mut random) - 0.5 * Vec3::Y) * random.random_range(0.1..3.0),
            shadow_distance_m: random.random_range(20.0..800.0),
            lowest_m: -30.0,
            longest_m: random.random_range(50.0..500.0),
        };
        let (view, clip_from_world) = random_view(&mut random, Some(sun));
        let culler = Culler::new(&view);
        for bounds in boxes.iter().filter(|bounds| bounds.distance(view.eye_m) <= view.distance_m) {
            for _ in 0..6 {
                let from = random_place(bounds, &mut random);
                // Somewhere on the way of the light, above the lowest ground.
                let shadow = from + sun.direction.normalize() * random.random_range(0.0..sun.longest_m);
                let falls = shadow.y >= sun.lowest_m && shadow.distance(view.eye_m) <= sun.shadow_distance_m;
                if falls && is_pictured(shadow, &clip_from_world) {
                    thrown += 1;
                    let (min, max) = (bounds.centre - bounds.half, bounds.centre + bounds.half);
                    assert!(culler.sees(min, max), "{bounds:?} for {view:?}");
                }
            }
        }
    }
    assert!(thrown > 1000, "{thrown}");
}

#[test]
fn shadows_keep_few_boxes() {
    let boxes = boxes(&forest(40, 2, 5.0, 3));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut of_shadows = 0;
    for _ in 0..100 {
        let direction = Vec3::new(1.0, -1.0, 0.3);
        let sun = SunShadows { direction, shadow_distance_m: 200.0, lowest_m: -5.0, longest_m: 1e3 };
        let (view, _) = random_view(&mut random, Some(sun));
        let culler = Culler::new(&view);
        let shadows = boxes.iter().filter(|bounds| culler.visibility(bounds) == Some(Visibility::ShadowOnly));
        of_shadows += shadows.count();
    }
    assert!((20..5000).contains(&of_shadows), "{of_shadows} in 100 pictures");
}

#[test]
fn values_that_are_no_number_are_harmless() {
    let boxes = boxes(&forest(5, 2, 5.0, 4));
    let (view, _) = random_view(&mut Xoshiro256PlusPlus::seed_from_u64(9), None);
    let count = |view: CullingView| {
        let culler = Culler::new(&view);
        boxes.iter().filter(|bounds| culler.visibility(bounds).is_some()).count()
    };
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(count(CullingView { eye_m: Vec3::new(0.0, wrong, 0.0), ..view }), 0);
        let open = CullingView { planes: [Vec4::splat(wrong); 6], eye_m: Vec3::ZERO, distance_m: 1e9, sun: None };
        assert_eq!(count(open), boxes.len());
        let sun = SunShadows { direction: Vec3::NEG_Y, shadow_distance_m: wrong, lowest_m: wrong, longest_m: wrong };
        count(CullingView { sun: Some(sun), ..view });
        count(CullingView { sun: Some(SunShadows { direction: Vec3::splat(wrong), ..sun }), ..view });
    }
    let everything = CullingView { planes: [Vec4::W; 6], eye_m: Vec3::ZERO, distance_m: f32::INFINITY, sun: None };
    assert_eq!(count(everything), boxes.len());
    assert_eq!(count(CullingView { distance_m: f32::NAN, ..everything }), 0);
}
