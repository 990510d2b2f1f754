//! One square of drawn ground: a lattice of heights at the resolution of its level, with what closes the gaps to coarser
//! neighbours.
//!
//! Where two levels of the pyramid meet, the finer edge has vertices between those of the coarser. The triangle of such a
//! vertex and its two neighbours on the coarser edge is the gap itself: it stands upright, and since it has the normals of
//! the finer edge it is shaded like the ground about it (Setas et al., section 4.1.1). A neighbour may be coarser by
//! several levels while the viewer flies fast, so that each edge has these triangles for every level up to
//! [`COARSEST_NEIGHBOUR`]: together they fill whatever opens between the two edges. Which of them are shown depends on
//! the neighbours of the moment; [`Seams`] tells the vertex shader, and the mesh stays as it is.

use super::chunk_key::SIDE;
use crate::ground::{Cover, Ground};
use bevy::math::{DVec2, Vec3};

pub use super::chunk_key::{CHUNK_CELLS, COARSEST_NEIGHBOUR, ChunkKey, Edge, Seams};

/// The vertices of a chunk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChunkVertices {
    /// x and z from the square's least corner, y the elevation itself, so that equal places have equal bits in all
    /// chunks, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// The gap that a vertex belongs to, 0 for the ground itself: 8 times the edge's number, and how much coarser the
    /// neighbour must be for it to be drawn; then the share of the ground that is under trees, 0..1.
    pub marks: Vec<[f32; 2]>,
    /// Triangles.
    pub indices: Vec<u32>,
    /// Least elevation, m.
    pub lowest_m: f32,
    /// Greatest elevation, m.
    pub highest_m: f32,
}

/// The ground of a chunk. Where an elevation is not a finite number, 0 is drawn.
#[must_use]
pub fn chunk_vertices(
    ground: &impl Ground,
    cover: Option<&dyn Cover>,
    key: ChunkKey,
    finest_cell_m: f64,
) -> ChunkVertices {
    let lattice = Lattice::new(ground, key, finest_cell_m);
    let mut vertices = ChunkVertices { lowest_m: f32::MAX, highest_m: f32::MIN, ..ChunkVertices::default() };
    for row in 0..SIDE {
        for column in 0..SIDE {
            let covered = cover.map_or(0.0, |cover| cover.share(lattice.place(column, row)).clamp(0.0, 1.0));
            vertices.push(&lattice, column, row, 0.0, covered);
        }
    }
    vertices.indices = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).flat_map(move |column| cell(column, row))).collect();
    for edge in Edge::ALL {
        vertices.close_gaps(&lattice, edge);
    }
    vertices
}

/// The two triangles of a cell; their common side runs from its east to its south corner.
fn cell(column: usize, row: usize) -> [u32; 6] {
    let west = (row * SIDE + column) as u32;
    let south = west + SIDE as u32;
    [west, south, west + 1, west + 1, south, south + 1]
}

impl ChunkVertices {
    fn push(&mut self, lattice: &Lattice, column: usize, row: usize, gap_code: f32, covered: f32) {
        let height_m = lattice.height_m(column, row);
        let along = |index: usize| index as f32 * lattice.cell_m as f32;
        self.positions.push([along(column), height_m, along(row)]);
        self.normals.push(lattice.normal(column, row).to_array());
        self.marks.push([gap_code, covered]);
        self.lowest_m = self.lowest_m.min(height_m);
        self.highest_m = self.highest_m.max(height_m);
    }

    /// The upright triangles of an edge, for neighbours of every level.
    fn close_gaps(&mut self, lattice: &Lattice, edge: Edge) {
        for levels in 1..=COARSEST_NEIGHBOUR {
            let span = 1 << levels;
            for start in (0..CHUNK_CELLS as usize).step_by(span) {
                for along in [start, start + span / 2, start + span] {
                    let (column, row) = edge.vertex(along);
                    let covered = self.marks[row * SIDE + column][1];
                    self.indices.push(self.positions.len() as u32);
                    self.push(lattice, column, row, (8 * edge as u32 + levels) as f32, covered);
                }
            }
        }
    }
}

/// The heights of a chunk, and of one row of cells about it, from which normals come.
struct Lattice {
    heights_m: Vec<f32>,
    corner_m: DVec2,
    cell_m: f64,
}

impl Lattice {
    const SIDE: usize = SIDE + 2;

    fn new(ground: &impl Ground, key: ChunkKey, finest_cell_m: f64) -> Self {
        let cell_m = finest_cell_m * f64::from(1_u32 << key.level);
        let corner_m = key.corner_m(finest_cell_m);
        let place = |index: usize| {
            let step = DVec2::new((index % Self::SIDE) as f64, (index / Self::SIDE) as f64) - 1.0;
            corner_m + step * cell_m
        };
        let drawn_m = |height_m: f64| if height_m.is_finite() { height_m as f32 } else { 0.0 };
        let heights_m = (0..Self::SIDE * Self::SIDE).map(|index| drawn_m(ground.height_m(place(index)))).collect();
        Self { heights_m, corner_m, cell_m }
    }

    fn place(&self, column: usize, row: usize) -> DVec2 {
        self.corner_m + DVec2::new(column as f64, row as f64) * self.cell_m
    }

    fn height_m(&self, column: usize, row: usize) -> f32 {
        self.heights_m[(row + 1) * Self::SIDE + column + 1]
    }

    /// By differences across two cells of this level: the ground's own gradient would show waves that are finer than the
    /// cells as noise.
    fn normal(&self, column: usize, row: usize) -> Vec3 {
        let at = |column: usize, row: usize| self.heights_m[row * Self::SIDE + column];
        let rise_x = at(column + 2, row + 1) - at(column, row + 1);
        let rise_z = at(column + 1, row + 2) - at(column + 1, row);
        Vec3::new(-rise_x, 2.0 * self.cell_m as f32, -rise_z).normalize_or(Vec3::Y)
    }
}

/// Elevation of the ground as it is drawn at the finest level, m: on the triangles of its lattice. Stems that stand on it
/// neither float nor sink.
#[must_use]
pub fn drawn_height_m(ground: &impl Ground, finest_cell_m: f64, place: DVec2) -> f32 {
    let cells = place / finest_cell_m;
    let first = cells.floor();
    let [u, v] = (cells - first).as_vec2().to_array();
    let height_m = |x: f64, z: f64| ground.height_m((first + DVec2::new(x, z)) * finest_cell_m) as f32;
    let (east, south) = (height_m(1.0, 0.0), height_m(0.0, 1.0));
    if u + v <= 1.0 {
        let corner = height_m(0.0, 0.0);
        corner + u * (east - corner) + v * (south - corner)
    } else {
        let corner = height_m(1.0, 1.0);
        corner + (1.0 - u) * (south - corner) + (1.0 - v) * (east - corner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::{TurningBands, TurningBandsSettings};

    const CELL_M: f64 = 2.0;

    fn ground() -> TurningBands {
        TurningBands::new(&TurningBandsSettings { finest_wavelength_m: 6.0, seed: 3, ..Default::default() }).unwrap()
    }

    #[test]
    fn equal_places_have_equal_bits_in_all_chunks() {
        let ground = ground();
        let key = ChunkKey { level: 2, column: -3, row: 7 };
        let coarse = chunk_vertices(&ground, None, key, CELL_M);
        for (child, [x, z]) in key.children().into_iter().zip([[0, 0], [1, 0], [0, 1], [1, 1]]) {
            let fine = chunk_vertices(&ground, None, child, CELL_M);
            for (row, column) in (0..=16).flat_map(|row| (0..=16).map(move |column| (row, column))) {
                let here = coarse.positions[(16 * z + row) * SIDE + 16 * x + column];
                assert_eq!(here[1].to_bits(), fine.positions[2 * row * SIDE + 2 * column][1].to_bits());
            }
        }
    }

    #[test]
    fn drawn_heights_lie_on_the_triangles_of_the_finest_level() {
        let ground = ground();
        let key = ChunkKey { level: 0, column: 4, row: -2 };
        let chunk = chunk_vertices(&ground, None, key, CELL_M);
        let corner = key.corner_m(CELL_M);
        for step in 0..2000_u32 {
            let within = DVec2::new(f64::from(step * 37 % 6400) / 100.0, f64::from(step * 91 % 6400) / 100.0);
            let drawn = height_on(&chunk, within.as_vec2().to_array()).unwrap();
            let stands = drawn_height_m(&ground, CELL_M, corner + within);
            assert!((drawn - stands).abs() < 1e-3, "{drawn} is drawn, {stands} is said");
        }
    }

    /// The height of the drawn triangles at a place, found among all of them.
    fn height_on(chunk: &ChunkVertices, [x, z]: [f32; 2]) -> Option<f32> {
        let ground = &chunk.indices[..6 * (SIDE - 1) * (SIDE - 1)];
        ground.chunks_exact(3).find_map(|triangle| {
            let [a, b, c] = [0, 1, 2].map(|corner| chunk.positions[triangle[corner] as usize]);
            let area =
                |p: [f32; 3], q: [f32; 3], x: f32, z: f32| (q[0] - p[0]) * (z - p[2]) - (q[2] - p[2]) * (x - p[0]);
            let whole = area(a, b, c[0], c[2]);
            let shares = [area(b, c, x, z), area(c, a, x, z), area(a, b, x, z)].map(|share| share / whole);
            let inside = shares.iter().all(|share| *share >= -1e-5);
            inside.then(|| shares[0] * a[1] + shares[1] * b[1] + shares[2] * c[1])
        })
    }

    #[test]
    fn normals_follow_the_slope() {
        let ramp = |place: DVec2| 0.5 * place.x;
        let chunk = chunk_vertices(&ramp, None, ChunkKey { level: 3, column: 0, row: 0 }, CELL_M);
        let expected = Vec3::new(-0.5, 1.0, 0.0).normalize();
        assert!(chunk.normals.iter().all(|normal| Vec3::from_array(*normal).distance(expected) < 1e-5));
        assert_eq!((chunk.lowest_m, chunk.highest_m), (0.0, 256.0));
    }

    #[test]
    fn holes_in_the_ground_are_drawn_at_zero() {
        let pond = |place: DVec2| if place.length() < 20.0 { f64::NAN } else { 7.0 };
        let chunk = chunk_vertices(&pond, None, ChunkKey { level: 0, column: 0, row: 0 }, CELL_M);
        assert_eq!((chunk.lowest_m, chunk.highest_m), (0.0, 7.0));
        assert!(chunk.positions.iter().chain(&chunk.normals).flatten().all(|value| value.is_finite()));
    }
}
