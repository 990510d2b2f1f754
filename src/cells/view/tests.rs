use super::*;
use crate::cells::store::tests::forest;
use bevy::{
    math::{Mat4, proj::perspective_infinite_reverse},
    prelude::Transform,
    shape::ViewFrustum,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

const EXTENT: TreeExtent = TreeExtent { height_m: 25.0, reach_m: 6.0 };

fn random_unit(random: &mut Xoshiro256PlusPlus) -> Vec3 {
    let mut component = || random.random_range(-1.0..1.0_f32);
    Vec3::new(component(), component(), component()).normalize_or(Vec3::Z)
}

/// A camera somewhere in or over the forest that looks anywhere; also what it makes of a point of the world.
fn random_view(random: &mut Xoshiro256PlusPlus, sun: Option<Sun>) -> (View, Mat4) {
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
    (View { planes, eye_m, distance_m, sun }, clip_from_world)
}

/// Whether a point is in the picture, by projection.
fn is_pictured(point: Vec3, clip_from_world: &Mat4) -> bool {
    let clip = *clip_from_world * point.extend(1.0);
    clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z <= clip.w
}

/// A place in or above a cell that a plant of it may fill.
fn random_place(bounds: &Bounds, random: &mut Xoshiro256PlusPlus) -> Vec3 {
    let mut component = || random.random_range(-1.0..=1.0_f32);
    bounds.centre + Vec3::new(component(), component(), component()) * bounds.half
}

#[test]
fn no_cell_in_view_is_dropped() {
    let store = forest(40, 2, 30.0, 1);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut seen, mut pictured, mut kept) = (Vec::new(), 0, 0);
    for _ in 0..150 {
        let (view, clip_from_world) = random_view(&mut random, None);
        store.see(&view, EXTENT, &mut seen);
        kept += seen.len();
        for (cell, content) in store.iter().filter(|(_, content)| !content.is_empty()) {
            let bounds = Bounds::of_cell(cell, store.cell_m(), content.spread(), EXTENT);
            let points: [Vec3; 6] = std::array::from_fn(|_| random_place(&bounds, &mut random));
            let visible =
                |point: &Vec3| is_pictured(*point, &clip_from_world) && point.distance(view.eye_m) <= view.distance_m;
            if points.iter().any(visible) {
                pictured += 1;
                assert!(seen.iter().any(|seen| seen.cell == cell && seen.in_view), "{cell} for {view:?}");
            }
        }
    }
    assert!(pictured > 10_000, "{pictured}");
    assert!(kept < 2 * pictured, "{kept} kept for {pictured}: hardly anything is culled");
}

#[test]
fn no_shadow_in_view_is_dropped() {
    let store = forest(25, 2, 30.0, 2);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let (mut seen, mut thrown) = (Vec::new(), 0);
    for _ in 0..300 {
        let sun = Sun {
            direction: (random_unit(&mut random) - 0.5 * Vec3::Y) * random.random_range(0.1..3.0),
            shadow_distance_m: random.random_range(20.0..800.0),
            lowest_m: -30.0,
            longest_m: random.random_range(50.0..500.0),
        };
        let (view, clip_from_world) = random_view(&mut random, Some(sun));
        store.see(&view, EXTENT, &mut seen);
        for (cell, content) in store.iter().filter(|(_, content)| !content.is_empty()) {
            let bounds = Bounds::of_cell(cell, store.cell_m(), content.spread(), EXTENT);
            if bounds.distance(view.eye_m) > view.distance_m {
                continue;
            }
            for _ in 0..6 {
                let from = random_place(&bounds, &mut random);
                // Somewhere on the way of the light, above the lowest ground.
                let shadow = from + sun.direction.normalize() * random.random_range(0.0..sun.longest_m);
                let falls = shadow.y >= sun.lowest_m && shadow.distance(view.eye_m) <= sun.shadow_distance_m;
                if falls && is_pictured(shadow, &clip_from_world) {
                    thrown += 1;
                    assert!(seen.iter().any(|seen| seen.cell == cell), "{cell} for {view:?}");
                }
            }
        }
    }
    assert!(thrown > 1000, "{thrown}");
}

#[test]
fn shadows_add_few_cells_and_blocks_decide_as_their_cells_do() {
    let store = forest(40, 2, 5.0, 3);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let (mut seen, mut of_shadows) = (Vec::new(), 0);
    for _ in 0..100 {
        let sun =
            Sun { direction: Vec3::new(1.0, -1.0, 0.3), shadow_distance_m: 200.0, lowest_m: -5.0, longest_m: 1e3 };
        let (view, _) = random_view(&mut random, Some(sun));
        store.see(&view, EXTENT, &mut seen);
        let watch = Watch::new(&view);
        let one_by_one: Vec<Seen> = store
            .iter()
            .filter(|(_, content)| !content.is_empty())
            .filter_map(|(cell, content)| {
                let bounds = Bounds::of_cell(cell, store.cell_m(), content.spread(), EXTENT);
                let sight = watch.sight(&bounds, ALL_PLANES)?;
                Some(Seen { cell, distance_m: sight.distance_m, in_view: sight.in_view })
            })
            .collect();
        assert_eq!(seen, one_by_one);
        of_shadows += seen.iter().filter(|seen| !seen.in_view).count();
    }
    assert!((20..5000).contains(&of_shadows), "{of_shadows} in 100 pictures");
}

#[test]
fn what_is_no_number_is_harmless() {
    let store = forest(5, 2, 5.0, 4);
    let (view, _) = random_view(&mut Xoshiro256PlusPlus::seed_from_u64(9), None);
    let stocked = store.iter().filter(|(_, content)| !content.is_empty()).count();
    let count = |view: View, extent| {
        let mut seen = vec![Seen { cell: IVec2::ZERO, distance_m: 0.0, in_view: true }];
        store.see(&view, extent, &mut seen);
        seen.len()
    };
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(count(View { eye_m: Vec3::new(0.0, wrong, 0.0), ..view }, EXTENT), 0);
        let open = View { planes: [Vec4::splat(wrong); 6], eye_m: Vec3::ZERO, distance_m: 1e9, sun: None };
        assert_eq!(count(open, EXTENT), stocked);
        assert_eq!(count(open, TreeExtent { height_m: wrong, reach_m: wrong }), stocked);
        let sun = Sun { direction: Vec3::NEG_Y, shadow_distance_m: wrong, lowest_m: wrong, longest_m: wrong };
        count(View { sun: Some(sun), ..view }, EXTENT);
        count(View { sun: Some(Sun { direction: Vec3::splat(wrong), ..sun }), ..view }, EXTENT);
    }
    let everything = View { planes: [Vec4::W; 6], eye_m: Vec3::ZERO, distance_m: f32::INFINITY, sun: None };
    assert_eq!(count(everything, EXTENT), stocked);
    assert_eq!(count(View { distance_m: f32::NAN, ..everything }, EXTENT), 0);
}
