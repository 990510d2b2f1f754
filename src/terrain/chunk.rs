//! One square of drawn ground: a lattice of heights at the resolution of its level, with what closes the gaps to coarser
//! neighbours.
//!
//! Where two levels of the pyramid meet, the finer edge has vertices between those of the coarser. The triangle of such a
//! vertex and its two neighbours on the coarser edge is the gap itself: it stands upright, and since it has the normals of
//! the finer edge it is shaded like the ground about it (Setas et al., section 4.1.1). A neighbour may be coarser by
//! several levels while the viewer flies fast, so that each edge has these triangles for every level up to
//! [`COARSEST_NEIGHBOUR`]: together they fill whatever opens between the two edges. Which of them are shown depends on
//! the neighbours of the moment; [`Seams`] tells the vertex shader, and the mesh stays as it is.

use super::{Cover, Heightfield};
use bevy::math::{DVec2, IVec2, Vec3};

/// Cells along a side of a chunk.
pub const CHUNK_CELLS: u32 = 32;
/// By how many levels a neighbour may be coarser, so that every gap is closed: 2^5 cells are the whole edge.
pub const COARSEST_NEIGHBOUR: u32 = CHUNK_CELLS.ilog2();

const SIDE: usize = CHUNK_CELLS as usize + 1;

/// Which square of which level of the pyramid; level 0 is the finest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ChunkKey {
    /// From 0, whose cells are the finest, each level has cells twice as wide.
    pub level: u32,
    /// Number of the square along x.
    pub column: i32,
    /// Number of the square along z.
    pub row: i32,
}

impl ChunkKey {
    /// Side of its square, m.
    #[must_use]
    pub fn side_m(self, finest_cell_m: f64) -> f64 {
        finest_cell_m * f64::from(CHUNK_CELLS) * f64::from(1_u32 << self.level)
    }

    /// Least corner (x, z) of its square, m.
    #[must_use]
    pub fn corner_m(self, finest_cell_m: f64) -> DVec2 {
        DVec2::new(f64::from(self.column), f64::from(self.row)) * self.side_m(finest_cell_m)
    }

    /// The square of the next coarser level that holds it.
    #[must_use]
    pub fn parent(self) -> Self {
        Self { level: self.level + 1, column: self.column >> 1, row: self.row >> 1 }
    }

    /// The four squares of the next finer level that it holds.
    #[must_use]
    pub fn children(self) -> [Self; 4] {
        let child = |x, z| Self { level: self.level - 1, column: 2 * self.column + x, row: 2 * self.row + z };
        [child(0, 0), child(1, 0), child(0, 1), child(1, 1)]
    }

    /// The square of the same level beyond one of its edges.
    #[must_use]
    pub fn beyond(self, edge: Edge) -> Self {
        let step = edge.outwards();
        Self { column: self.column + step.x, row: self.row + step.y, ..self }
    }
}

/// An edge of a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// Least x.
    West,
    /// Greatest x.
    East,
    /// Least z.
    North,
    /// Greatest z.
    South,
}

impl Edge {
    /// All of them, in the order of their numbers in [`Seams`].
    pub const ALL: [Self; 4] = [Self::West, Self::East, Self::North, Self::South];

    /// The step to the square beyond it, in columns and rows.
    #[must_use]
    pub fn outwards(self) -> IVec2 {
        match self {
            Self::West => IVec2::NEG_X,
            Self::East => IVec2::X,
            Self::North => IVec2::NEG_Y,
            Self::South => IVec2::Y,
        }
    }

    /// Column and row of its vertex number `along`.
    fn vertex(self, along: usize) -> (usize, usize) {
        match self {
            Self::West => (0, along),
            Self::East => (SIDE - 1, along),
            Self::North => (along, 0),
            Self::South => (along, SIDE - 1),
        }
    }
}

/// By how many levels the ground beyond each edge of a chunk is coarser: four bits an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seams(pub u32);

impl Seams {
    /// Notes how much coarser the ground beyond an edge is.
    #[must_use]
    pub fn with(self, edge: Edge, levels: u32) -> Self {
        Self(self.0 | levels.min(COARSEST_NEIGHBOUR) << (4 * edge as u32))
    }

    /// Whether a vertex with that code is drawn: the rule of the vertex shader, `ground.wesl`.
    #[must_use]
    pub fn shows(self, gap_code: f32) -> bool {
        let code = gap_code as u32;
        (self.0 >> (4 * (code >> 3)) & 15) >= code & 7
    }
}

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

/// The ground of a chunk.
#[must_use]
pub fn chunk_vertices(
    ground: &impl Heightfield,
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

    fn new(ground: &impl Heightfield, key: ChunkKey, finest_cell_m: f64) -> Self {
        let cell_m = finest_cell_m * f64::from(1_u32 << key.level);
        let corner_m = key.corner_m(finest_cell_m);
        let place = |index: usize| {
            let step = DVec2::new((index % Self::SIDE) as f64, (index / Self::SIDE) as f64) - 1.0;
            corner_m + step * cell_m
        };
        let heights_m = (0..Self::SIDE * Self::SIDE).map(|index| ground.height_m(place(index)) as f32).collect();
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
pub fn drawn_height_m(ground: &impl Heightfield, finest_cell_m: f64, place: DVec2) -> f32 {
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
    fn what_stands_on_the_finest_level_stands_on_its_triangles() {
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
    fn gaps_are_shown_only_where_the_neighbour_is_coarser() {
        let seams = Seams::default().with(Edge::East, 2);
        let code = |edge: Edge, levels: u32| (8 * edge as u32 + levels) as f32;
        assert!(seams.shows(0.0) && seams.shows(code(Edge::East, 1)) && seams.shows(code(Edge::East, 2)));
        assert!(!seams.shows(code(Edge::East, 3)) && !seams.shows(code(Edge::South, 1)));
    }

    #[test]
    fn normals_are_those_of_the_slope() {
        struct Ramp;
        impl Heightfield for Ramp {
            fn height_m(&self, place: DVec2) -> f64 {
                0.5 * place.x
            }
            fn gradient(&self, _: DVec2) -> DVec2 {
                DVec2::new(0.5, 0.0)
            }
        }
        let chunk = chunk_vertices(&Ramp, None, ChunkKey { level: 3, column: 0, row: 0 }, CELL_M);
        let expected = Ramp.normal(DVec2::ZERO);
        assert!(chunk.normals.iter().all(|normal| Vec3::from_array(*normal).distance(expected) < 1e-5));
        assert_eq!((chunk.lowest_m, chunk.highest_m), (0.0, 256.0));
    }
}
