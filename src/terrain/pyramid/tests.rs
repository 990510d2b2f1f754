use super::*;
use crate::terrain::{
    TurningBands, TurningBandsSettings,
    chunk::{CHUNK_CELLS, ChunkVertices, chunk_vertices},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

const SHAPE: PyramidShape = PyramidShape { finest_cell_m: 2.0, coarsest_level: 6, detail: 1.6, reach_m: 6000.0 };

fn eye(x: f64, z: f64, above_ground_m: f64) -> Eye {
    Eye { place: DVec2::new(x, z), above_ground_m }
}

fn build_all(pyramid: &mut Pyramid) {
    while let Some(key) = pyramid.next_to_build() {
        pyramid.receive(key);
    }
    pyramid.select_drawn();
}

/// The squares that are drawn cover each of these places exactly once.
fn assert_covered_once(pyramid: &Pyramid, about: DVec2, radius_m: f64, random: &mut Xoshiro256PlusPlus) {
    for _ in 0..300 {
        let place = about + radius_m * DVec2::new(random.random_range(-0.7..0.7), random.random_range(-0.7..0.7));
        let covers = |(key, _): &&(ChunkKey, Seams)| {
            let corner = key.corner_m(SHAPE.finest_cell_m);
            place.cmpge(corner).all() && place.cmplt(corner + key.side_m(SHAPE.finest_cell_m)).all()
        };
        assert_eq!(pyramid.drawn().iter().filter(covers).count(), 1, "{place}");
    }
}

#[test]
fn the_ground_is_covered_once_wherever_viewers_jump() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut pyramid = Pyramid::new(SHAPE);
    let mut place = DVec2::ZERO;
    pyramid.select(&[eye(0.0, 0.0, 2.0)]);
    build_all(&mut pyramid);
    for _ in 0..60 {
        place += DVec2::new(random.random_range(-400.0..400.0), random.random_range(-400.0..400.0));
        pyramid.select(&[Eye { place, above_ground_m: random.random_range(0.0..300.0) }]);
        // Only a part of what is wanted is ready in time.
        for _ in 0..random.random_range(0..40) {
            let Some(key) = pyramid.next_to_build() else { break };
            pyramid.receive(key);
        }
        pyramid.select_drawn();
        assert_covered_once(&pyramid, place, 3000.0, &mut random);
        pyramid.dropped().for_each(drop);
    }
}

#[test]
fn neighbours_differ_by_one_level_once_all_is_built() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    for _ in 0..30 {
        let mut pyramid = Pyramid::new(SHAPE);
        let at = eye(random.random_range(-1e4..1e4), random.random_range(-1e4..1e4), random.random_range(0.0..500.0));
        pyramid.select(&[at]);
        build_all(&mut pyramid);
        assert!(pyramid.is_complete());
        for (key, _) in pyramid.drawn() {
            assert!(Edge::ALL.into_iter().all(|edge| pyramid.step(*key, edge) <= 1), "{key:?}");
        }
    }
}

#[test]
fn work_and_memory_stay_bounded() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut pyramid = Pyramid::new(SHAPE);
    let mut most = 0;
    for flight in 0..200 {
        let at = 1e5 * DVec2::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
        pyramid.select(&[Eye { place: at, above_ground_m: 2.0 }]);
        build_all(&mut pyramid);
        pyramid.dropped().for_each(drop);
        most = most.max(pyramid.nodes.len());
        assert!(flight == 0 || pyramid.nodes.len() < 1200, "{} squares", pyramid.nodes.len());
    }
    assert!(most > 200, "{most}");
}

#[test]
fn a_viewer_on_a_border_makes_nothing_flicker() {
    let mut pyramid = Pyramid::new(SHAPE);
    let mut drawn = Vec::new();
    for step in 0..20 {
        // The side of level 0 is 64 m; level 1 is split at 204.8 m.
        pyramid.select(&[eye(-204.8 + f64::from(step % 2), 64.0, 0.0)]);
        build_all(&mut pyramid);
        drawn.push(pyramid.drawn().len());
    }
    assert!(drawn[1..].iter().all(|count| *count == drawn[1]), "{drawn:?}");
}

/// Walks along every seam of random views, finished and half built, and finds the upright gap between the two edges
/// covered by triangles that are shown.
#[test]
fn all_gaps_between_levels_are_closed() {
    let settings = TurningBandsSettings { finest_wavelength_m: 8.0, seed: 5, ..TurningBandsSettings::default() };
    let ground = TurningBands::new(&settings).unwrap();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let (mut seams, mut open_without) = (0, 0);
    for _ in 0..4 {
        let mut pyramid = Pyramid::new(PyramidShape { coarsest_level: 5, reach_m: 900.0, ..SHAPE });
        for _ in 0..3 {
            let at = 400.0 * DVec2::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
            pyramid.select(&[Eye { place: at, above_ground_m: 2.0 }]);
            for _ in 0..random.random_range(5..120) {
                let Some(key) = pyramid.next_to_build() else { break };
                pyramid.receive(key);
            }
            pyramid.select_drawn();
            pyramid.dropped().for_each(drop);
            let mut built = HashMap::new();
            for (key, seam) in pyramid.drawn() {
                for edge in Edge::ALL {
                    let step = pyramid.step(*key, edge);
                    if step == 0 {
                        continue;
                    }
                    let mut other = key.beyond(edge);
                    (0..step).for_each(|_| other = other.parent());
                    let mut vertices = |key: ChunkKey| -> ChunkVertices {
                        built.entry(key).or_insert_with(|| chunk_vertices(&ground, None, key, 2.0)).clone()
                    };
                    let (fine, coarse) = (vertices(*key), vertices(other));
                    seams += 1;
                    open_without += walk_seam(&fine, *key, *seam, edge, &coarse, other);
                }
            }
        }
    }
    assert!(seams > 100 && open_without > 1000, "{seams} seams, {open_without} gaps");
}

/// Checks that at places along the seam the triangles that are shown reach from the finer edge to the coarser. Returns the
/// number of places where there would be a gap without them.
fn walk_seam(
    fine: &ChunkVertices,
    key: ChunkKey,
    seams: Seams,
    edge: Edge,
    coarse: &ChunkVertices,
    other: ChunkKey,
) -> u32 {
    // Across the seam, and along it.
    let (across, along) = if matches!(edge, Edge::West | Edge::East) { (0, 2) } else { (2, 0) };
    let line = |vertices: &ChunkVertices, key: ChunkKey, index: usize| {
        let corner = key.corner_m(2.0).to_array();
        let [x, y, z] = vertices.positions[index];
        let at = [f64::from(x) + corner[0], f64::from(y), f64::from(z) + corner[1]];
        (at[across], at[along], at[1])
    };
    let side_m = key.side_m(2.0);
    let corner = key.corner_m(2.0).to_array();
    let border = corner[across / 2] + if matches!(edge, Edge::East | Edge::South) { side_m } else { 0.0 };
    let edge_height = |vertices: &ChunkVertices, key: ChunkKey, at: f64| {
        let ground = (CHUNK_CELLS as usize + 1).pow(2);
        let mut points: Vec<(f64, f64)> = (0..ground)
            .map(|index| line(vertices, key, index))
            .filter(|(a, ..)| *a == border)
            .map(|(_, l, h)| (l, h))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let pair = points.windows(2).find(|pair| (pair[0].0..=pair[1].0).contains(&at)).expect("on the edge");
        let share = (at - pair[0].0) / (pair[1].0 - pair[0].0);
        pair[0].1 + share * (pair[1].1 - pair[0].1)
    };
    let mut open = 0;
    for step in 0..96 {
        let at = corner[along / 2] + side_m * (f64::from(step) + 0.5) / 96.0;
        let (a, b) = (edge_height(fine, key, at), edge_height(coarse, other, at));
        if (a - b).abs() < 1e-4 {
            continue;
        }
        open += 1;
        let mut spans: Vec<(f64, f64)> = fine
            .indices
            .chunks_exact(3)
            .filter(|triangle| triangle.iter().all(|index| fine.marks[*index as usize][0] > 0.0))
            .filter(|triangle| triangle.iter().all(|index| seams.shows(fine.marks[*index as usize][0])))
            .map(|triangle| [0, 1, 2].map(|corner| line(fine, key, triangle[corner] as usize)))
            .filter(|corners| corners.iter().all(|(a, ..)| *a == border))
            .filter_map(|corners| span_at(&corners, at))
            .collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut reached, highest) = (a.min(b), a.max(b));
        for (low, high) in spans {
            if low <= reached + 1e-3 {
                reached = reached.max(high);
            }
        }
        assert!(reached >= highest - 1e-3, "open from {reached} to {highest} m at {at} of {key:?}, {edge:?}");
    }
    open
}

/// Least and greatest height of an upright triangle at a place along it.
fn span_at(corners: &[(f64, f64, f64); 3], at: f64) -> Option<(f64, f64)> {
    let mut heights = Vec::new();
    for (from, to) in [(0, 1), (1, 2), (0, 2)] {
        let ((_, x0, h0), (_, x1, h1)) = (corners[from], corners[to]);
        if (x0.min(x1)..=x0.max(x1)).contains(&at) && x0 != x1 {
            heights.push(h0 + (at - x0) / (x1 - x0) * (h1 - h0));
        }
    }
    let low = heights.iter().copied().reduce(f64::min)?;
    Some((low, heights.iter().copied().reduce(f64::max)?))
}
