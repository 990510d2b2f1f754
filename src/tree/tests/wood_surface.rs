//! The surface of the wood has no holes that show.

use super::{fir, oak};
use crate::tree::{
    individual::grow,
    skeleton::Skeleton,
    vertices::WoodVertices,
    wood_mesh::{coarse_wood, wood},
};
use bevy::math::Vec3;
use std::collections::HashMap;

/// Edges with a triangle on one side only, after vertices at one place are taken as one.
fn open_edges(wood: &WoodVertices) -> Vec<[usize; 2]> {
    let mut welded: HashMap<([u32; 3], u32), usize> = HashMap::new();
    let first_at: Vec<usize> = (0..wood.positions.len())
        .map(|index| {
            let place = wood.positions[index].map(f32::to_bits);
            *welded.entry((place, wood.sway[index][0] as u32)).or_insert(index)
        })
        .collect();
    let mut sides: HashMap<[usize; 2], i32> = HashMap::new();
    for triangle in wood.indices.chunks_exact(3) {
        for corner in 0..3 {
            let edge = [triangle[corner], triangle[(corner + 1) % 3]].map(|index| first_at[index as usize]);
            let (key, direction) = if edge[0] < edge[1] { (edge, 1) } else { ([edge[1], edge[0]], -1) };
            *sides.entry(key).or_insert(0) += direction;
        }
    }
    sides.into_iter().filter(|&(_, balance)| balance != 0).map(|(edge, _)| edge).collect()
}

#[test]
fn open_edges_of_bark_lie_inside_the_parent_or_below_the_ground() {
    for species in [oak(), fir()] {
        let skeleton = grow(&species, species.age.mature_years, 3);
        let wood = wood(&species, &skeleton);
        let edges = open_edges(&wood);
        assert!(edges.len() >= 3 * skeleton.beams.iter().filter(|beam| beam.attach < 1.0).count() / 2);
        let branches = branches(&skeleton);
        let (mut shown, mut tried) = (0, 0);
        for index in edges.into_iter().flatten() {
            let point = Vec3::from(wood.positions[index]);
            let [beam, at, ..] = wood.sway[index];
            let bound = &skeleton.beams[beam as usize];
            if bound.parent.is_none() && point.y < 0.0 {
                continue; // The trunk is open below the ground.
            }
            // A foot moves with the parent that it stands on, a thin root with its own beam's root inside the parent.
            let (carrier, at) = match bound.parent {
                Some(parent) if at == 0.0 && is_inside(&wood, &skeleton, &branches, parent, bound.attach, point) => {
                    (parent, bound.attach)
                }
                _ => (beam as u32, at),
            };
            let inside = is_inside(&wood, &skeleton, &branches, carrier, at, point);
            shown += u32::from(!inside);
            tried += 1;
        }
        // At a kink of a thin limb the drawn surface is narrower than its cross-sections: a few feet stand out there.
        assert!(100 * shown < tried, "{}: {shown} of {tried} vertices at open edges show", species.name);
    }
}

/// Area of all triangles, m^2: four times what is seen of a convex surface from all sides in the mean (Cauchy).
fn area_m2(wood: &WoodVertices) -> f32 {
    let corner = |index: u32| Vec3::from(wood.positions[index as usize]);
    let of = |triple: &[u32]| {
        let [a, b, c] = [triple[0], triple[1], triple[2]].map(corner);
        0.5 * (b - a).cross(c - a).length()
    };
    wood.indices.chunks_exact(3).map(of).sum()
}

#[test]
fn coarse_wood_has_few_vertices_and_is_as_wide() {
    let species = oak();
    let skeleton = grow(&species, 90.0, 2);
    let (full, coarse) = (wood(&species, &skeleton), coarse_wood(&species, &skeleton, |_| true));
    let share = coarse.positions.len() as f32 / full.positions.len() as f32;
    let area = area_m2(&coarse) / area_m2(&full);
    println!("{share} of the vertices, {area} of the area");
    assert!(share < 0.75, "{share} of the vertices");
    assert!((area - 1.0).abs() < 0.1, "{area} of the area");
    let trunk = coarse_wood(&species, &skeleton, |beam| beam == 0);
    assert!(!trunk.indices.is_empty() && trunk.positions.len() < coarse.positions.len());
}

/// The branch of each beam, as the index of its first beam.
fn branches(skeleton: &Skeleton) -> Vec<usize> {
    let mut branches: Vec<usize> = (0..skeleton.beams.len()).collect();
    for (beam, next) in skeleton.continuations().into_iter().enumerate() {
        if let Some(next) = next {
            branches[next as usize] = branches[beam];
        }
    }
    branches
}

/// Whether a point lies inside the drawn surface of `beam`'s branch beside the place `at`: met from within to both sides.
fn is_inside(wood: &WoodVertices, skeleton: &Skeleton, branches: &[usize], beam: u32, at: f32, point: Vec3) -> bool {
    let carrier = &skeleton.beams[beam as usize];
    let across = carrier.tangent(at).any_orthonormal_vector();
    [across, -across]
        .into_iter()
        .all(|out| leaves_through(wood, branches, beam, point, out, 2.5 * carrier.base_radius_m))
}

/// Whether a ray meets the surface of `beam`'s branch from within, not farther than `limit_m`.
fn leaves_through(wood: &WoodVertices, branches: &[usize], beam: u32, point: Vec3, out: Vec3, limit_m: f32) -> bool {
    wood.indices.chunks_exact(3).any(|triangle| {
        let own = |&index: &u32| branches[wood.sway[index as usize][0] as usize] == branches[beam as usize];
        if !triangle.iter().all(own) {
            return false;
        }
        // Moeller and Trumbore, 1997.
        let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from(wood.positions[triangle[corner] as usize]));
        let (ab, ac, from) = (b - a, c - a, point - a);
        let across = out.cross(ac);
        let volume = ab.dot(across);
        let u = from.dot(across) / volume;
        let v = out.dot(from.cross(ab)) / volume;
        let far_m = ac.dot(from.cross(ab)) / volume;
        // A negative volume is a triangle seen from behind, which is from within.
        volume < 0.0 && u >= -1e-4 && v >= -1e-4 && u + v <= 1.0001 && (0.0..=limit_m).contains(&far_m)
    })
}
