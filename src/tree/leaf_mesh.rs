//! The surface of the foliage: one folded card per spray.
//!
//! A card is a kite of four vertices, root, left, tip and right, folded along its axis: two triangles that show two
//! brightnesses and no edge-on line. Its texture lies along the diagonal of a square, so the kite wastes no texels.
//! Normals lean from the card's own towards the way out of its clump (the branch it belongs to) and of the crown:
//! light then models the crown's billows and not the single cards. They are meant to be drawn without flipping on
//! the back side, for a leaf seen from behind is lit by the same sky.

use bevy::math::Vec3;

use super::{
    skeleton::{LeafCluster, Skeleton},
    species::Species,
};

/// Vertices of the leaf cards.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafVertices {
    /// Rest positions, local to the tree, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, bent towards the crown's outside.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates: the spray runs from (0, 1) to (1, 0).
    pub uvs: Vec<[f32; 2]>,
    /// Beam index (whole), place on that beam 0..1, flutter phase 0..1, ambient light 0..1.
    pub sway: Vec<[f32; 4]>,
    /// Main axis of the spray at rest (unit), and its tint 0..1.
    pub axis: Vec<[f32; 4]>,
    /// Where the spray holds on, m; the fourth is 0.
    pub anchor: Vec<[f32; 4]>,
    /// Triangles.
    pub indices: Vec<u32>,
}

/// Where the kite is widest, as a share of its length.
const WIDEST_AT: f32 = 0.5;
/// Shares of the normal: the card's own, its clump's outside, the crown's outside.
const NORMAL_SHARES: [f32; 3] = [0.45, 0.75, 0.5];
/// The order of branches whose foliage makes a clump.
const CLUMP_ORDER: u8 = 2;
/// Ambient light on the lower, inner side of a clump.
const CLUMP_SHADE: f32 = 0.38;

/// Cuts the cards of all sprays.
#[must_use]
pub fn leaves(species: &Species, skeleton: &Skeleton) -> LeafVertices {
    let foliage = &species.foliage;
    let count = skeleton.clusters.len();
    let mut out = LeafVertices::with_capacity(count);
    let clumps = Clumps::of(skeleton);
    let (fold_sin, fold_cos) = foliage.fold_deg.to_radians().sin_cos();
    for cluster in &skeleton.clusters {
        let outward = skeleton.envelope.outward(cluster.anchor);
        let from_clump = clumps.outward(cluster);
        let side = cluster.axis.cross(cluster.normal);
        let half_width_m = 0.5 * foliage.aspect * cluster.size_m;
        let middle = cluster.anchor + cluster.axis * (WIDEST_AT * cluster.size_m);
        let lowered = cluster.normal * (-fold_sin * half_width_m);
        let kite = [
            (cluster.anchor, cluster.normal, [0.0, 1.0]),
            (middle - side * (fold_cos * half_width_m) + lowered, cluster.normal - side * fold_sin, [0.0, 0.0]),
            (cluster.anchor + cluster.axis * cluster.size_m, cluster.normal, [1.0, 0.0]),
            (middle + side * (fold_cos * half_width_m) + lowered, cluster.normal + side * fold_sin, [1.0, 1.0]),
        ];
        let lit = 0.5 + 0.5 * from_clump.dot((outward + Vec3::Y).normalize_or(Vec3::Y));
        let light = foliage.light(cluster.depth) * (CLUMP_SHADE + (1.0 - CLUMP_SHADE) * lit.clamp(0.0, 1.0));
        let [own, clump, crown] = NORMAL_SHARES;
        let bent = from_clump * clump + outward * crown;
        for (position, normal, uv) in kite {
            let facing = if normal.dot(bent) < 0.0 { -own } else { own };
            let normal = (normal * facing + bent).try_normalize().unwrap_or(outward);
            out.push(cluster, position, normal, uv, light);
        }
        out.close_kite();
    }
    out
}

impl LeafVertices {
    fn with_capacity(cards: usize) -> Self {
        let vertices = 4 * cards;
        Self {
            positions: Vec::with_capacity(vertices),
            normals: Vec::with_capacity(vertices),
            uvs: Vec::with_capacity(vertices),
            sway: Vec::with_capacity(vertices),
            axis: Vec::with_capacity(vertices),
            anchor: Vec::with_capacity(vertices),
            indices: Vec::with_capacity(6 * cards),
        }
    }

    fn push(&mut self, cluster: &LeafCluster, position: Vec3, normal: Vec3, uv: [f32; 2], light: f32) {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.uvs.push(uv);
        self.sway.push([cluster.beam as f32, cluster.at, cluster.phase, light]);
        self.axis.push(cluster.axis.extend(cluster.tint).to_array());
        self.anchor.push(cluster.anchor.extend(0.0).to_array());
    }

    /// The two halves of the kite of the last four vertices.
    fn close_kite(&mut self) {
        let root = self.positions.len() as u32 - 4;
        self.indices.extend([root, root + 2, root + 1, root, root + 3, root + 2]);
    }
}

/// The clumps of foliage: for each beam, the middle of all sprays on its branch of [`CLUMP_ORDER`] and beyond.
struct Clumps {
    of_beam: Vec<usize>,
    middle: Vec<Vec3>,
}

impl Clumps {
    fn of(skeleton: &Skeleton) -> Self {
        let mut of_beam: Vec<usize> = Vec::with_capacity(skeleton.beams.len());
        for (index, beam) in skeleton.beams.iter().enumerate() {
            let parent = beam.parent.map(|parent| parent as usize);
            let own = parent.is_none_or(|parent| {
                let branches = skeleton.beams[parent].order < beam.order;
                branches && beam.order <= CLUMP_ORDER
            });
            of_beam.push(if own { index } else { of_beam[parent.unwrap_or(0)] });
        }
        let mut sums = vec![(Vec3::ZERO, 0.0_f32); skeleton.beams.len()];
        for cluster in &skeleton.clusters {
            let (sum, count) = &mut sums[of_beam[cluster.beam as usize]];
            *sum += cluster.anchor + 0.5 * cluster.axis * cluster.size_m;
            *count += 1.0;
        }
        let middle = sums.into_iter().map(|(sum, count)| sum / count.max(1.0)).collect();
        Self { of_beam, middle }
    }

    fn outward(&self, cluster: &LeafCluster) -> Vec3 {
        let spray = cluster.anchor + 0.5 * cluster.axis * cluster.size_m;
        let from = spray - self.middle[self.of_beam[cluster.beam as usize]];
        // Near the middle of a clump there is no outside: the direction fades in over the size of a spray.
        from / (from.length() + 0.3 * cluster.size_m)
    }
}
