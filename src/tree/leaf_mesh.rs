//! The surface of the foliage: a card for each spray, or an ellipsoid for each leaf.
//!
//! A card is a kite, root, left, tip and right, folded along its axis: two triangles that show two brightnesses and no
//! edge-on line. A bent card has a fifth vertex in its middle, crossed cards are two kites ([`Card`]). The texture lies
//! along the diagonal of a square, so the kite wastes no texels.
//! Normals lean from the card's own towards the way out of its clump (the branch it belongs to) and of the crown:
//! light then models the crown's billows and not the single cards. They are meant to be drawn without flipping on
//! the back side, for a leaf seen from behind is lit by the same sky.

use bevy::math::{Mat3, Quat, Vec3};

use super::{
    crown::{gardner, impressionist},
    ellipsoid::Ellipsoid,
    foliage::{Card, Foliage},
    generator::Growth,
    leaf::{LeafEllipsoids, LeafKind},
    skeleton::{LeafCluster, Skeleton},
    species::Species,
    vertices::LeafVertices,
};

/// Where the kite is widest, as a share of its length: beyond its middle, for cards that end in a point are thorns on a crown's outline.
pub(super) const WIDEST_AT: f32 = 0.58;
/// Shares of the normal: the card's own, its clump's outside, the crown's outside.
const NORMAL_SHARES: [f32; 3] = [0.45, 0.75, 0.5];
/// The order of branches whose foliage makes a clump.
const CLUMP_ORDER: u8 = 2;
/// Ambient light on the lower, inner side of a clump.
const CLUMP_SHADE: f32 = 0.38;

/// The surface of the foliage: cards for sprays, or the polygons or ellipsoids of a crown.
#[must_use]
pub fn leaves(species: &Species, skeleton: &Skeleton) -> LeafVertices {
    match &species.growth {
        Growth::Impressionist(crown) => impressionist::leaves(crown, skeleton),
        Growth::Gardner(crown) => gardner::leaves(crown, skeleton),
        Growth::ReevesBlau(_) | Growth::Oak(_) | Growth::Fir(_) | Growth::AonoKunii(_) => match &species.foliage.kind {
            LeafKind::Sprays => cards(&species.foliage, skeleton),
            LeafKind::Ellipsoids(leaves) => ellipsoids(&species.foliage, leaves, skeleton),
        },
    }
}

/// Builds the ellipsoids of all leaves. Their normals are their own: the mask's edge follows from them.
fn ellipsoids(foliage: &Foliage, leaves: &LeafEllipsoids, skeleton: &Skeleton) -> LeafVertices {
    let facets = leaves.surface.facets;
    let mut out = LeafVertices::with_capacity(skeleton.clusters.len() * (2 * facets as usize + 1).pow(2));
    let clumps = Clumps::of(skeleton);
    for cluster in &skeleton.clusters {
        let outward = skeleton.envelope.outward(cluster.anchor);
        let light = clumps.light(foliage, cluster, outward);
        let semi_axes = leaves.semi_axes_of(cluster.phase);
        let [length, width, thickness] = (semi_axes * (0.5 * cluster.size_m / semi_axes.x)).to_array();
        // The corners of an octahedron are at the ends of the axes: it turns onto itself, in one of four ways.
        let turns = (4.0 * cluster.tint.fract()) as u32;
        let half_turns = [turns & 1, turns >> 1].map(|turn| std::f32::consts::PI * turn as f32);
        let ellipsoid = Ellipsoid {
            centre: cluster.anchor + cluster.axis * (0.5 * cluster.size_m),
            axes: Mat3::from_cols(cluster.axis, cluster.normal, cluster.axis.cross(cluster.normal)),
            semi_axes_m: Vec3::new(length, thickness, width),
            turn: Quat::from_rotation_y(half_turns[0]) * Quat::from_rotation_x(half_turns[1]),
            facets,
        };
        ellipsoid.write(cluster, |_, _| light, &mut out);
    }
    out
}

/// Builds the cards of all sprays.
fn cards(foliage: &Foliage, skeleton: &Skeleton) -> LeafVertices {
    let mut out = LeafVertices::with_capacity(skeleton.clusters.len() * foliage.card.vertices());
    let clumps = Clumps::of(skeleton);
    for cluster in &skeleton.clusters {
        let outward = skeleton.envelope.outward(cluster.anchor);
        let from_clump = clumps.outward(cluster);
        let light = clumps.light(foliage, cluster, outward);
        let [own, clump, crown] = NORMAL_SHARES;
        let bent = from_clump * clump + outward * crown;
        let kite = Kite::of(foliage, cluster);
        let corners: &mut dyn Iterator<Item = Corner> = match foliage.card {
            Card::Flat | Card::Folded => &mut kite.corners().into_iter(),
            Card::Bent => &mut kite.corners().into_iter().chain([kite.centre()]),
            Card::Crossed => &mut kite.corners().into_iter().chain(kite.crossing().corners()),
        };
        for corner in corners {
            let facing = if corner.normal.dot(bent) < 0.0 { -own } else { own };
            let normal = (corner.normal * facing + bent).try_normalize().unwrap_or(outward);
            out.push(cluster, corner.position, normal, corner.uv, light);
        }
        push_triangles(&mut out, foliage.card);
    }
    out
}

/// The triangles of the card whose vertices were pushed last.
fn push_triangles(out: &mut LeafVertices, card: Card) {
    let root = (out.positions.len() - card.vertices()) as u32;
    let triangles: &[u32] = match card {
        Card::Flat | Card::Folded => &[0, 2, 1, 0, 3, 2],
        Card::Bent => &[0, 4, 1, 4, 2, 1, 0, 3, 4, 4, 3, 2],
        Card::Crossed => &[0, 2, 1, 0, 3, 2, 4, 6, 5, 4, 7, 6],
    };
    out.indices.extend(triangles.iter().map(|corner| root + corner));
}

/// A vertex of a card, before the crown bends its normal.
struct Corner {
    position: Vec3,
    normal: Vec3,
    uv: [f32; 2],
}

/// A spray's kite: all that its corners are found from.
struct Kite {
    anchor: Vec3,
    axis: Vec3,
    side: Vec3,
    normal: Vec3,
    /// From root to tip in a straight line, m.
    length_m: f32,
    /// From its root to where it is widest, along that line.
    widest_m: f32,
    half_width_m: f32,
    /// Height of its widest place above that line, m, and how far normals lean to root and tip for it.
    rise_m: f32,
    leans: [f32; 2],
    fold_rad: f32,
}

impl Kite {
    fn of(foliage: &Foliage, cluster: &LeafCluster) -> Self {
        // Both parts keep their lengths when they bend.
        let bend_rad = if foliage.card == Card::Bent { foliage.bend_deg.to_radians() } else { 0.0 };
        let [inner, outer] = [WIDEST_AT, 1.0 - WIDEST_AT];
        let up_rad = (outer * bend_rad.sin()).atan2(inner + outer * bend_rad.cos());
        let down_rad = bend_rad - up_rad;
        let fold_deg = if foliage.card == Card::Flat { 0.0 } else { foliage.fold_deg };
        Self {
            anchor: cluster.anchor,
            axis: cluster.axis,
            side: cluster.axis.cross(cluster.normal),
            normal: cluster.normal,
            length_m: cluster.size_m * (inner * up_rad.cos() + outer * down_rad.cos()),
            widest_m: inner * cluster.size_m * up_rad.cos(),
            half_width_m: 0.5 * foliage.aspect * cluster.size_m,
            rise_m: inner * cluster.size_m * up_rad.sin(),
            leans: [up_rad.sin(), down_rad.sin()],
            fold_rad: fold_deg.to_radians(),
        }
    }

    fn widest(&self) -> Vec3 {
        self.anchor + self.axis * self.widest_m + self.normal * self.rise_m
    }

    /// Root, left, tip, right.
    fn corners(&self) -> [Corner; 4] {
        let (fold_sin, fold_cos) = self.fold_rad.sin_cos();
        let out = self.side * (fold_cos * self.half_width_m);
        let low = self.widest() - self.normal * (fold_sin * self.half_width_m);
        let (normal, fold) = (self.normal, self.side * fold_sin);
        let [to_root, to_tip] = self.leans.map(|lean| self.axis * lean);
        [
            Corner { position: self.anchor, normal: normal - to_root, uv: [0.0, 1.0] },
            Corner { position: low - out, normal: normal - fold, uv: [0.0, 0.0] },
            Corner { position: self.anchor + self.axis * self.length_m, normal: normal + to_tip, uv: [1.0, 0.0] },
            Corner { position: low + out, normal: normal + fold, uv: [1.0, 1.0] },
        ]
    }

    fn centre(&self) -> Corner {
        Corner { position: self.widest(), normal: self.normal, uv: [0.5, 0.5] }
    }

    /// The kite through the same axis at right angles.
    fn crossing(&self) -> Self {
        Self { side: self.normal, normal: -self.side, ..*self }
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

    /// Ambient light at a cluster, 0 to 1: less in the crown's depth, and on the lower, inner side of its clump.
    fn light(&self, foliage: &Foliage, cluster: &LeafCluster, outward: Vec3) -> f32 {
        let lit = 0.5 + 0.5 * self.outward(cluster).dot((outward + Vec3::Y).normalize_or(Vec3::Y));
        foliage.light(cluster.depth) * (CLUMP_SHADE + (1.0 - CLUMP_SHADE) * lit.clamp(0.0, 1.0))
    }

    fn outward(&self, cluster: &LeafCluster) -> Vec3 {
        let spray = cluster.anchor + 0.5 * cluster.axis * cluster.size_m;
        let from = spray - self.middle[self.of_beam[cluster.beam as usize]];
        // Near the middle of a clump there is no outside: the direction fades in over the size of a spray.
        from / (from.length() + 0.3 * cluster.size_m)
    }
}
