//! The first trunk on a ray.
//!
//! The ray is walked cell by cell along the axis on which it makes more way: a slab of cells at a time, of which it crosses
//! one or two, three where a trunk may reach over the border. Each cell is tested once, and the walk ends when the best
//! hit lies before the next slab.

use super::trunk::Trunk;
use crate::{
    cells::{cell::Cell, store::CellStore},
    scatter::{GREATEST_SIZE, Stem},
};
use bevy::math::{DVec2, DVec3, IVec2, Vec3, Vec3Swizzles};

/// No ray is followed farther, m: the greatest plan across.
const LONGEST_M: f64 = 1e6;

/// Places within a cell are known so well in single precision, m.
const ROUNDING_M: f32 = 1e-3;
/// Rays that make less way on the map than this, m/m, are as good as vertical.
const STEEP: f32 = 1e-3;

/// The trunk that a ray hits first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The tree's cell.
    pub cell: IVec2,
    /// Its number among the cell's [`records`](super::super::Cell::records).
    pub index: usize,
    /// The tree.
    pub stem: Stem,
    /// From the ray's origin, m; 0 where it begins within a trunk.
    pub distance_m: f32,
    /// Where the trunk is hit, m.
    pub position: Vec3,
}

/// A ray, made ready to be walked.
struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// The part that is asked about.
    part: Part,
    /// How far a trunk may reach from its stem, m.
    reach_m: f64,
}

/// Part of the ray: from, to, m.
type Part = [f64; 2];

/// The best hit so far.
#[derive(Clone, Copy)]
struct Best {
    cell: IVec2,
    index: usize,
    distance_m: f64,
}

impl CellStore {
    /// The trunk that a ray hits first, within a length, m. `trunks` are those of full-grown trees, by the number of their
    /// species; a species beyond the table has none. `direction` may have any length but zero.
    pub fn cast(&self, origin: Vec3, direction: Vec3, longest_m: f32, trunks: &[Trunk]) -> Option<RayHit> {
        let direction = direction.as_dvec3().try_normalize()?;
        if !origin.is_finite() || longest_m.is_nan() || longest_m < 0.0 {
            return None;
        }
        let widest_m = trunks.iter().map(|trunk| trunk.of_size(GREATEST_SIZE).radius_m).fold(0.0, f32::max);
        let highest_m = trunks.iter().map(|trunk| trunk.of_size(1.0).height_m).fold(0.0, f32::max);
        let part = [0.0, f64::from(longest_m)];
        let ray = Ray { origin: origin.as_dvec3(), direction, part, reach_m: f64::from(widest_m) };
        let ray = ray.within(self.corners_m()?)?;

        let mut best: Option<Best> = None;
        ray.walk(f64::from(self.cell_m()), |cell, part| {
            if best.is_some_and(|best| best.distance_m < part[0]) {
                return false;
            }
            if let Some(content) = self.get(cell)
                && ray.is_low_enough(part, content, highest_m)
            {
                self.cast_in_cell(&ray, part, cell, content, trunks, &mut best);
            }
            true
        });
        let Best { cell, index, distance_m } = best?;
        let position = (ray.origin + distance_m * ray.direction).as_vec3();
        Some(RayHit { cell, index, stem: self.stem(cell, index)?, distance_m: distance_m as f32, position })
    }

    fn cast_in_cell(
        &self,
        ray: &Ray,
        part: Part,
        cell: IVec2,
        content: &Cell,
        trunks: &[Trunk],
        best: &mut Option<Best>,
    ) {
        let corner_m = self.corner_m(cell);
        let start = ray.origin + part[0] * ray.direction - DVec3::new(corner_m.x, 0.0, corner_m.y);
        // Most stems are ruled out on the map, in single precision.
        let (place_of_start, way) = (start.as_vec3().xz(), ray.direction.as_vec3().xz());
        let level = way.length();
        for (index, &record) in content.records().iter().enumerate() {
            let [.., rest] = record;
            let Some(trunk) = trunks.get((rest & 0xff) as usize) else { continue };
            let place = Stem::place_in_cell(record, self.cell_m());
            let trunk = trunk.of_size(Stem::packed_size(record));
            let passes = (place - place_of_start).perp_dot(way).abs() > (trunk.radius_m + ROUNDING_M) * level;
            if passes && level > STEEP {
                continue;
            }
            let foot = Vec3::new(place.x, f32::from_bits(record[1]), place.y).as_dvec3();
            let Some(hit_m) = trunk.hit(start - foot, ray.direction) else { continue };
            let distance_m = part[0] + hit_m;
            if distance_m <= ray.part[1] && best.is_none_or(|best| distance_m < best.distance_m) {
                *best = Some(Best { cell, index, distance_m });
            }
        }
    }
}

impl Ray {
    /// The same ray, only as far as it is over a rectangle; `None` where it misses it.
    fn within(self, [min, max]: [DVec2; 2]) -> Option<Self> {
        let part = [self.part[0], self.part[1].min(LONGEST_M + min.abs().max(max.abs()).length())];
        let ray = Self { part, ..self };
        let ray = Self { part: ray.part_between(ray.origin.x, ray.direction.x, min.x, max.x)?, ..ray };
        Some(Self { part: ray.part_between(ray.origin.z, ray.direction.z, min.y, max.y)?, ..ray })
    }

    /// The part of the ray on which one coordinate lies between two values, as far as trunks reach over.
    fn part_between(&self, origin: f64, way: f64, least: f64, greatest: f64) -> Option<Part> {
        let (least, greatest) = (least - self.reach_m - origin, greatest + self.reach_m - origin);
        if way == 0.0 {
            return (least <= 0.0 && greatest >= 0.0).then_some(self.part);
        }
        let (one, other) = (least / way, greatest / way);
        let part = [one.min(other).max(self.part[0]), one.max(other).min(self.part[1])];
        (part[0] <= part[1]).then_some(part)
    }

    /// Visits the cells on the way, nearest slabs first, until `visit` answers no; with the part of the ray on their slab.
    fn walk(&self, cell_m: f64, mut visit: impl FnMut(IVec2, Part) -> bool) {
        let along_x = self.direction.x.abs() >= self.direction.z.abs();
        let turned = |place: DVec3| if along_x { (place.x, place.z) } else { (place.z, place.x) };
        let ((origin, origin_across), (way, way_across)) = (turned(self.origin), turned(self.direction));
        let number = |place_m: f64| (place_m / cell_m).floor() as i32;
        // The cells of a part of the ray along one axis, and as far as trunks reach over.
        let range = |origin: f64, way: f64, part: Part| {
            let [from_m, to_m] = part.map(|t| origin + way * t);
            number(from_m.min(to_m) - self.reach_m)..=number(from_m.max(to_m) + self.reach_m)
        };
        let slabs = range(origin, way, self.part);
        let (mut forth, mut back) = (slabs.clone(), slabs.rev());
        let next = || if way >= 0.0 { forth.next() } else { back.next() };
        for slab in std::iter::from_fn(next) {
            let edge_m = f64::from(slab) * cell_m;
            let Some(part) = self.part_between(origin, way, edge_m, edge_m + cell_m) else { continue };
            for across in range(origin_across, way_across, part) {
                let cell = if along_x { IVec2::new(slab, across) } else { IVec2::new(across, slab) };
                if !visit(cell, part) {
                    return;
                }
            }
        }
    }

    /// Whether a part of the ray comes as low as a cell's trunks, and not below them all.
    fn is_low_enough(&self, part: Part, content: &Cell, highest_m: f32) -> bool {
        let Some([lowest_m, top_m]) = content.ground_m() else { return false };
        let [one, other] = part.map(|t| self.origin.y + t * self.direction.y);
        let top_m = f64::from(top_m) + f64::from(content.largest() * highest_m);
        one.min(other) <= top_m && one.max(other) >= f64::from(lowest_m)
    }
}
