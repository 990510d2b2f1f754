//! The ground: real elevations, smoothly interpolated, as one mesh that is fine near the forest and coarse far away.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use noise::{NoiseFn, OpenSimplex};
use std::path::Path;

/// The shipped elevations: Rocky Mountain National Park, see `assets/terrain/README.md`.
const SHIPPED: &[u8] = include_bytes!("../../assets/terrain/rmnp-dem-16bit.png");
/// Where in the shipped elevations the forest stands, as shares of the map's width and height: a slope by a valley.
const SHIPPED_PLACE: Vec2 = Vec2::new(0.675, 0.2366);

/// Elevations on a grid, interpolated so that the slope has no kinks.
pub struct Ground {
    elevations_m: Vec<f32>,
    columns: usize,
    rows: usize,
    cell_m: f32,
    /// Grid coordinates of the world's origin.
    origin: Vec2,
    /// Elevation of the world's origin.
    datum_m: f32,
    /// Ripples too small for the map: amplitude and length from hummock to hummock.
    hummocks: OpenSimplex,
}

/// Height of the hummocks, m.
const HUMMOCK_M: f32 = 0.35;
/// Length from one hummock to the next, m.
const HUMMOCK_LENGTH_M: f32 = 14.0;

impl Ground {
    /// Reads elevations from a 16-bit grey PNG, or takes the shipped ones.
    pub fn load(file: Option<&Path>, cell_m: f32) -> Result<Self, String> {
        let (name, bytes) = match file {
            Some(path) => {
                let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
                (path.display().to_string(), bytes)
            }
            None => ("the shipped elevations".to_owned(), SHIPPED.to_vec()),
        };
        let image = image::load_from_memory(&bytes).map_err(|error| format!("{name}: {error}"))?;
        let image::DynamicImage::ImageLuma16(map) = image else {
            return Err(format!("{name}: expected a 16-bit grey PNG, found {:?}", image.color()));
        };
        let (columns, rows) = (map.width() as usize, map.height() as usize);
        if columns < 4 || rows < 4 {
            return Err(format!("{name}: expected at least 4 x 4 elevations, found {columns} x {rows}"));
        }
        let elevations_m = map.pixels().map(|pixel| f32::from(pixel.0[0])).collect();
        let place = if file.is_some() { Vec2::splat(0.5) } else { SHIPPED_PLACE };
        let origin = place * Vec2::new(columns as f32 - 1.0, rows as f32 - 1.0);
        let mut ground =
            Self { elevations_m, columns, rows, cell_m, origin, datum_m: 0.0, hummocks: OpenSimplex::new(7) };
        ground.datum_m = ground.elevation_m(origin);
        Ok(ground)
    }

    /// Height of the ground at world (x, z), m; 0 at the origin, up to the hummocks.
    pub fn height_m(&self, x: f32, z: f32) -> f32 {
        let hummock = self.hummocks.get([x, z].map(|c| f64::from(c / HUMMOCK_LENGTH_M))) as f32;
        self.elevation_m(self.origin + Vec2::new(x, z) / self.cell_m) - self.datum_m + HUMMOCK_M * hummock
    }

    /// The horizontal direction in which the ground rises at the origin, as world (X, Z).
    pub fn uphill(&self) -> Dir2 {
        let step = 20.0;
        let slope = Vec2::new(
            self.height_m(step, 0.0) - self.height_m(-step, 0.0),
            self.height_m(0.0, step) - self.height_m(0.0, -step),
        );
        Dir2::new(slope).unwrap_or(Dir2::NEG_Y)
    }

    /// Normal at world (x, z).
    pub fn normal(&self, x: f32, z: f32, step: f32) -> Vec3 {
        let dx = self.height_m(x + step, z) - self.height_m(x - step, z);
        let dz = self.height_m(x, z + step) - self.height_m(x, z - step);
        Vec3::new(-dx, 2.0 * step, -dz).normalize()
    }

    /// Bicubic Catmull-Rom; beyond the map's edge its last row goes on.
    fn elevation_m(&self, at: Vec2) -> f32 {
        let (column, row) = (at.x.floor(), at.y.floor());
        let (wx, wy) = (spline_weights(at.x - column), spline_weights(at.y - row));
        let mut sum = 0.0;
        for (j, wy) in wy.into_iter().enumerate() {
            for (i, wx) in wx.into_iter().enumerate() {
                let x = (column as i64 + i as i64 - 1).clamp(0, self.columns as i64 - 1) as usize;
                let y = (row as i64 + j as i64 - 1).clamp(0, self.rows as i64 - 1) as usize;
                sum += wx * wy * self.elevations_m[y * self.columns + x];
            }
        }
        sum
    }

    /// One mesh to the horizon: lines 3 m apart in the middle and ever wider outwards, so that there is no seam.
    pub fn mesh(&self) -> Mesh {
        const LINES: usize = 321;
        let lines: Vec<f32> = (0..LINES).map(|line| line_m(line as f32 / (LINES - 1) as f32 * 2.0 - 1.0)).collect();
        let paint = Paint::new();
        let mut positions = Vec::with_capacity(LINES * LINES);
        let (mut normals, mut uvs, mut colours) = (Vec::new(), Vec::new(), Vec::new());
        for (row, &z) in lines.iter().enumerate() {
            for (column, &x) in lines.iter().enumerate() {
                let spacing = |index: usize| (lines[(index + 1).min(LINES - 1)] - lines[index.max(1) - 1]) * 0.5;
                let normal = self.normal(x, z, spacing(row).max(spacing(column)).clamp(1.0, 120.0));
                positions.push([x, self.height_m(x, z), z]);
                normals.push(normal.to_array());
                uvs.push([x / TEXTURE_M, z / TEXTURE_M]);
                colours.push(paint.colour(x, z, normal));
            }
        }
        let quads = (0..LINES - 1).flat_map(|row| (0..LINES - 1).map(move |column| (row * LINES + column) as u32));
        let lines = LINES as u32;
        let indices = quads.flat_map(|a| [a, a + lines, a + 1, a + 1, a + lines, a + lines + 1]).collect();
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
            .with_inserted_indices(Indices::U32(indices))
    }
}

/// Side of one repeat of the ground's texture, m.
const TEXTURE_M: f32 = 6.0;
/// How far the ground reaches, m.
const REACH_M: f32 = 14_000.0;

/// Place of a grid line: -1..=1 to metres, even within some 150 m and then growing with the cube and the ninth power.
fn line_m(t: f32) -> f32 {
    let linear = 330.0;
    linear * t + (1800.0 - linear) * t.powi(3) + (REACH_M - 1800.0) * t.powi(9)
}

fn spline_weights(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-0.5 * t + t2 - 0.5 * t3, 1.0 - 2.5 * t2 + 1.5 * t3, 0.5 * t + 2.0 * t2 - 1.5 * t3, -0.5 * t2 + 0.5 * t3]
}

/// Colours of meadow, dry grass, earth and rock.
struct Paint {
    patches: OpenSimplex,
}

impl Paint {
    fn new() -> Self {
        Self { patches: OpenSimplex::new(11) }
    }

    fn colour(&self, x: f32, z: f32, normal: Vec3) -> [f32; 4] {
        let octave = |length_m: f32| self.patches.get([x, z].map(|c| f64::from(c / length_m))) as f32;
        let near = 0.5 * octave(31.0) + 0.3 * octave(9.0) + 0.2 * octave(3.7);
        let far = 0.6 * octave(900.0) + 0.4 * octave(240.0);
        let meadow = Vec3::new(0.115, 0.165, 0.045);
        let dry = Vec3::new(0.24, 0.21, 0.09);
        let woods = Vec3::new(0.035, 0.065, 0.028);
        let rock = Vec3::new(0.17, 0.155, 0.14);
        let distance = Vec2::new(x, z).length();
        let grass = meadow.lerp(dry, smooth(-0.25, 0.55, near));
        let wooded = smooth(400.0, 1200.0, distance) * smooth(-0.35, 0.1, far + 0.3 * octave(60.0));
        let slope = 1.0 - normal.y;
        let colour = grass.lerp(woods, wooded).lerp(rock, smooth(0.15, 0.32, slope + 0.08 * far + 0.05 * octave(70.0)));
        [colour.x, colour.y, colour.z, 1.0]
    }
}

fn smooth(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
