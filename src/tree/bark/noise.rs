//! Noise that tiles: gradient noise (Perlin 1985) and cells (Worley 1996) of whole periods over the tile.

use bevy::math::Vec2;

/// Mixes lattice point, salt and seed (the finaliser of `MurmurHash3`).
pub(super) fn hash(x: i32, y: i32, salt: u32) -> u32 {
    let mut hash = salt.wrapping_mul(0xc2b2_ae3d) ^ (x as u32).wrapping_mul(0x9e37_79b1);
    hash ^= (y as u32).wrapping_mul(0x85eb_ca77);
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 16)
}

/// The low bits as a share of one.
pub(super) fn unit(hash: u32) -> f32 {
    (hash & 0xffff) as f32 / 65_536.0
}

/// Gradient noise with its lattice drawn up beforehand: the last column and row repeat the first.
pub(super) struct Noise {
    size: Vec2,
    stride: usize,
    gradients: Vec<Vec2>,
}

impl Noise {
    pub(super) fn new(columns: u32, rows: u32, salt: u32) -> Self {
        let (columns, rows) = (columns.max(1) as i32, rows.max(1) as i32);
        let gradients = (0..(columns + 1) * (rows + 1))
            .map(|point| {
                let hash = hash(point % (columns + 1) % columns, point / (columns + 1) % rows, salt);
                Vec2::from_angle(std::f32::consts::TAU * unit(hash))
            })
            .collect();
        Self { size: Vec2::new(columns as f32, rows as f32), stride: columns as usize + 1, gradients }
    }

    /// About -1..1; `uv` from 0 up to but not including 1.
    pub(super) fn at(&self, uv: Vec2) -> f32 {
        let point = uv * self.size;
        // `uv` is not negative, so truncation is the floor (which is a call on plain x86-64).
        let (x, y) = (point.x as usize, point.y as usize);
        let within = point - Vec2::new(x as f32, y as f32);
        let fade = within * within * (Vec2::splat(3.0) - 2.0 * within);
        let corner = |dx: usize, dy: usize| {
            self.gradients[(y + dy) * self.stride + x + dx].dot(within - Vec2::new(dx as f32, dy as f32))
        };
        let top = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * fade.x;
        let bottom = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * fade.x;
        1.4 * (top + (bottom - top) * fade.y)
    }
}

/// What is known of the nearest cell.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// Difference of the distances to the second nearest and the nearest centre: 0 between two cells.
    pub edge: f32,
    /// From the nearest centre, in cells.
    pub from: Vec2,
    /// From the nearest centre to the second nearest, in cells.
    pub to_second: Vec2,
    /// Random bits of the nearest cell.
    pub hash: u32,
}

/// A jittered grid of cells, drawn up beforehand with a rim that repeats the far side.
pub(super) struct Cells {
    size: Vec2,
    stride: usize,
    /// Centre within its own square, and random bits.
    centres: Vec<(Vec2, u32)>,
}

impl Cells {
    /// `jitter` 0 sets the centres on a grid, 1 anywhere in their squares.
    pub(super) fn new(columns: u32, rows: u32, jitter: f32, salt: u32) -> Self {
        let (columns, rows) = (columns.max(1) as i32, rows.max(1) as i32);
        let centre = |x: i32, y: i32| {
            let hash = hash(x.rem_euclid(columns), y.rem_euclid(rows), salt);
            (Vec2::new(unit(hash), unit(hash >> 16)) * jitter + 0.5 * (1.0 - jitter), hash)
        };
        let centres = (-1..=rows).flat_map(|y| (-1..=columns).map(move |x| (x, y))).map(|(x, y)| centre(x, y));
        Self { size: Vec2::new(columns as f32, rows as f32), stride: columns as usize + 2, centres: centres.collect() }
    }

    /// The cell at `uv` (any value), displaced by `warp` in cells.
    pub(super) fn at(&self, uv: Vec2, warp: Vec2) -> Cell {
        let point = uv * self.size + warp;
        let home = point.floor();
        let within = point - home;
        // A remainder may round up to the divisor itself.
        let wrapped = home.rem_euclid(self.size).min(self.size - 1.0);
        let first = wrapped.y as usize * self.stride + wrapped.x as usize;
        let (mut nearest, mut second) = (f32::INFINITY, f32::INFINITY);
        let mut cell = Cell { edge: 0.0, from: Vec2::ZERO, to_second: Vec2::ZERO, hash: 0 };
        let mut from_second = Vec2::ZERO;
        for row in 0..3 {
            let start = first + row * self.stride;
            for (column, &(centre, hash)) in self.centres[start..start + 3].iter().enumerate() {
                let from = within - centre - Vec2::new(column as f32 - 1.0, row as f32 - 1.0);
                let distance = from.length_squared();
                if distance < nearest {
                    (second, nearest) = (nearest, distance);
                    from_second = cell.from;
                    (cell.from, cell.hash) = (from, hash);
                } else if distance < second {
                    second = distance;
                    from_second = from;
                }
            }
        }
        cell.edge = second.sqrt() - nearest.sqrt();
        cell.to_second = cell.from - from_second;
        cell
    }
}
