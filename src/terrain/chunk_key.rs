//! Squares of drawn ground: their places in the levels of the pyramid, their edges, and how much coarser the ground beyond
//! each edge is.

use bevy::math::{DVec2, IVec2};

/// Cells along a side of a chunk.
pub const CHUNK_CELLS: u32 = 32;
/// By how many levels a neighbour may be coarser, so that every gap is closed: 2^5 cells are the whole edge.
pub const COARSEST_NEIGHBOUR: u32 = CHUNK_CELLS.ilog2();
/// Vertices along a side of a chunk.
pub(super) const SIDE: usize = CHUNK_CELLS as usize + 1;

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
    pub(super) fn vertex(self, along: usize) -> (usize, usize) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_shown_only_where_the_neighbour_is_coarser() {
        let seams = Seams::default().with(Edge::East, 2);
        let code = |edge: Edge, levels: u32| (8 * edge as u32 + levels) as f32;
        assert!(seams.shows(0.0) && seams.shows(code(Edge::East, 1)) && seams.shows(code(Edge::East, 2)));
        assert!(!seams.shows(code(Edge::East, 3)) && !seams.shows(code(Edge::South, 1)));
    }
}
