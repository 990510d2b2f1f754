//! Directions on a square: where a view lies in the grid of an impostor atlas.
//!
//! The square is half an octahedron, unfolded (Meyer et al., "On floating-point normal vectors", 2010). With
//! `d / (|x| + |y| + |z|) = (x, y, z)`, the place is `(x + z, x - z)`, brought from -1..1 to 0..1: the horizon is the rim.
//! The impostor's shader does the same; the way from a direction to its views is therefore needed by tests only.

#[cfg(test)]
use bevy::math::UVec2;
use bevy::math::{Vec2, Vec3};

/// The unit vector to the eye that a place on the square, 0 to 1 each way, stands for.
pub(in crate::lod) fn view_direction(place: Vec2) -> Vec3 {
    let p = 2.0 * place - 1.0;
    let (x, z) = (0.5 * (p.x + p.y), 0.5 * (p.x - p.y));
    Vec3::new(x, 1.0 - x.abs() - z.abs(), z).normalize_or(Vec3::Y)
}

/// The place on the square, 0 to 1 each way, of a direction from the tree to the eye (of any length but 0). Below the
/// horizon the tree is seen as from the horizon.
#[cfg(test)]
pub(in crate::lod) fn view_place(to_eye: Vec3) -> Vec2 {
    let d = Vec3::new(to_eye.x, to_eye.y.max(0.0), to_eye.z);
    let d = d / (d.x.abs() + d.y + d.z.abs()).max(1e-12);
    0.5 + 0.5 * Vec2::new(d.x + d.z, d.x - d.z)
}

/// A view of the atlas, and its share in a mix.
#[cfg(test)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::lod) struct ViewWeight {
    /// Column and row of the view.
    pub view: UVec2,
    /// Its share, 0 to 1; the three add up to 1.
    pub weight: f32,
}

/// The three views, of a grid with so many along a side, around the direction from the tree to the eye: the corners of the
/// triangle of the grid that holds it. Where the eye looks along a view, that view weighs 1.
#[cfg(test)]
pub(in crate::lod) fn views_towards(to_eye: Vec3, views_per_side: u32) -> [ViewWeight; 3] {
    let place = view_place(to_eye) * (views_per_side - 1) as f32;
    let low = place.floor().min(Vec2::splat(views_per_side as f32 - 2.0)).max(Vec2::ZERO);
    let within = (place - low).clamp(Vec2::ZERO, Vec2::ONE);
    let beside = if within.x > within.y { UVec2::X } else { UVec2::Y };
    let (more, less) = (within.max_element(), within.min_element());
    let low = low.as_uvec2();
    [
        ViewWeight { view: low, weight: 1.0 - more },
        ViewWeight { view: low + beside, weight: more - less },
        ViewWeight { view: low + 1, weight: less },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn direction(azimuth_rad: f32, climb: f32) -> Vec3 {
        let level = (1.0 - climb * climb).max(0.0).sqrt();
        Vec3::new(level * azimuth_rad.cos(), climb, level * azimuth_rad.sin())
    }

    proptest! {
        #[test]
        fn a_place_leads_back_to_its_direction(azimuth in -3.2_f32..3.2, climb in 0.0_f32..1.0) {
            let up = direction(azimuth, climb);
            prop_assert!(view_direction(view_place(up)).distance(up) < 1e-5);
        }

        #[test]
        fn weights_add_up_to_one_and_interpolate_the_place(
            azimuth in -3.2_f32..3.2, climb in -1.0_f32..1.0, views_per_side in 2_u32..17,
        ) {
            let to_eye = direction(azimuth, climb) * 40.0;
            let views = views_towards(to_eye, views_per_side);
            let sum: f32 = views.iter().map(|view| view.weight).sum();
            prop_assert!((sum - 1.0).abs() < 1e-5);
            prop_assert!(views.iter().all(|view| (0.0..=1.0).contains(&view.weight)));
            prop_assert!(views.iter().all(|view| view.view.max_element() < views_per_side));
            let place: Vec2 = views.iter().map(|view| view.weight * view.view.as_vec2()).sum();
            prop_assert!(place.distance(view_place(to_eye) * (views_per_side - 1) as f32) < 1e-4);
        }

        #[test]
        fn small_turns_change_weights_little(azimuth in -3.2_f32..3.2, climb in 0.0_f32..0.99) {
            let weights = |to_eye: Vec3| {
                let mut grid = [[0.0_f32; 8]; 8];
                views_towards(to_eye, 8).iter().for_each(|one| grid[one.view.y as usize][one.view.x as usize] += one.weight);
                grid
            };
            let (one, other) = (weights(direction(azimuth, climb)), weights(direction(azimuth + 1e-3, climb + 1e-3)));
            let jump: f32 = one.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| (a - b).abs()).sum();
            prop_assert!(jump < 0.2, "{jump}");
        }
    }

    #[test]
    fn an_eye_that_looks_along_a_view_gets_that_view_alone() {
        for views_per_side in [2, 5, 8] {
            let all = (0..views_per_side).flat_map(|row| (0..views_per_side).map(move |column| (column, row)));
            for (column, row) in all {
                let place = UVec2::new(column, row);
                let to_eye = view_direction(place.as_vec2() / (views_per_side - 1) as f32);
                let views = views_towards(to_eye, views_per_side);
                let weight: f32 = views.iter().filter(|one| one.view == place).map(|one| one.weight).sum();
                assert!((weight - 1.0).abs() < 1e-5, "{place}: {weight}");
            }
        }
    }

    #[test]
    fn degenerate_directions_have_finite_weights() {
        for to_eye in [Vec3::ZERO, Vec3::NEG_Y, Vec3::Y] {
            assert!(views_towards(to_eye, 8).iter().all(|view| view.weight.is_finite()));
        }
    }
}
