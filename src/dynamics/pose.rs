//! The pose of a tree in the wind: each beam bends along its first mode, keeps its length, and moves its children.
//!
//! Beam: base `b`, unit direction `d`, length `L`, all at rest and in the tree's own coordinates; `s` runs from 0 at its
//! root to 1 at its tip. The load `q`, a vector across `d`, moves the tip by `a = g q` lengths (`g` the beam's gain), and
//! turns it by `Theta = phi_1'(1) a`; along a stiff axis, that of crooked branches, it does so less
//! ([`BeamDynamics::stiff_axis`]). In a storm a linear law would roll the beam up, so the angle saturates:
//!
//! ```text
//! Theta = Theta_free / sqrt(1 + |Theta_free|^2 / limit^2)
//! ```
//!
//! The limit is that of a whole branch, of which each of its beams has its share: so no stem is bent past the wind. What its ancestors
//! carry along may already point that way, and a beam that points into the wind feels nothing of it. So the angle is also held to
//! that between the beam, as it is carried, and the wind of the moment, by the chord `c` of that angle:
//!
//! ```text
//! Theta' = Theta / (1 + (|Theta| / c)^8)^(1/8)
//! ```
//!
//! It leaves a bend of half of that angle as it is, to 5e-4.
//!
//! `bend.rs` has the place and the turn of each point of its axis.
//!
//! A point bound at `s` turns about the axis with it: `p -> R(s) (p - (b + L s d)) + bent(s)`, with `R(s)` the rotation
//! about `d x Theta` by `h(s) |Theta|`. A child moves with its parent in the same way, from the point where it is
//! attached. So the pose of a vertex is the product of its ancestors' motions, all in rest coordinates.
//!
//! Each beam's pose is a long chain of operations after its parent's. Beams with equally many ancestors do not wait for one
//! another, and are posed eight at a time (`beam_group.rs`), in half of the time.

use super::beam::{BeamDynamics, BeamWind};
use super::beam_pose::BeamPose;
use super::bend::SLOPE_TIP;
use super::direction_map::DirectionMap;
use super::lanes::{LANES, Lanes, Vector};
use beam_group::{BeamGroup, PreparedBeam, parent_of};
use bevy::math::{Mat3, Vec3, Vec3A, Vec4};

/// The angle in radians that the tip of a branch approaches in an ever stronger wind (63 degrees).
pub const TIP_ANGLE_LIMIT: f32 = 1.1;

/// Below this speed, m/s, no wind holds beams back.
const LEAST_WIND_M_S: f32 = 1e-3;

/// One tree's beams, prepared for one wind: what does not change from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct TreePoser {
    /// Parents before their children.
    groups: Vec<BeamGroup>,
    /// How many ancestors each beam has, and the beams' indices by that.
    ancestors: Vec<u32>,
    order: Vec<u32>,
    /// The rows of the table that the beams read, in order, and the place of each row of the table among these.
    rows: Vec<u32>,
    places: Vec<u32>,
}

/// What the poses of a tree in one wind depend on beside its beams.
#[derive(Clone, Copy)]
pub struct TreeInWind<'a> {
    /// The load coefficients of all directions.
    pub map: &'a DirectionMap,
    /// The mean wind, and the oscillators of the table.
    pub wind: BeamWind,
    /// Turns the tree's coordinates into the wind's: a rotation, or one with a mirror image before it.
    pub to_wind: Mat3,
    /// Size of the instance.
    pub scale: f32,
    /// How much of its leaves the tree has, 0 to 1.
    pub leaf_share: f32,
}

impl TreePoser {
    /// See [`prepare`](Self::prepare).
    pub fn new(beams: &[BeamDynamics], tree: &TreeInWind) -> Self {
        let mut poser = Self::default();
        poser.prepare(beams, tree);
        poser
    }

    /// Prepares the beams of a tree, in place of the former ones. To be repeated when the wind's basis, the tree's
    /// orientation or the season changes. A beam with a parent that does not precede it stands on the ground.
    pub fn prepare(&mut self, beams: &[BeamDynamics], tree: &TreeInWind) {
        self.group(beams, |index| {
            let beam = &beams[index];
            let coefficients = tree.map.coefficients(tree.to_wind * beam.direction);
            let answer = beam.sway(tree.leaf_share).answer(&tree.wind, tree.scale);
            let free_angle = |load: Vec3, gain: f32| {
                let angle = SLOPE_TIP * gain * beam.effective_load(tree.to_wind.transpose() * load);
                Vec3A::from(if angle.is_finite() { angle } else { Vec3::ZERO })
            };
            PreparedBeam {
                mean: free_angle(coefficients.mean, answer.mean_gain),
                moving: coefficients.moving.map(|moving| free_angle(moving, answer.gust_gain)),
                read: answer.read,
                ..PreparedBeam::unloaded(beams, index)
            }
        });
        self.find_rows(tree.wind.grid.rows());
    }

    /// Puts beams with equally many ancestors side by side.
    fn group(&mut self, beams: &[BeamDynamics], prepare: impl Fn(usize) -> PreparedBeam) {
        let Self { groups, ancestors, order, .. } = self;
        ancestors.clear();
        for index in 0..beams.len() {
            let of_parent = parent_of(beams, index).map(|_| ancestors[beams[index].parent as usize]);
            ancestors.push(of_parent.map_or(0, |ancestors| ancestors + 1));
        }
        order.clear();
        order.extend(0..beams.len() as u32);
        order.sort_unstable_by_key(|&index| (ancestors[index as usize], index));
        let generations = order.chunk_by(|&a, &b| ancestors[a as usize] == ancestors[b as usize]);
        groups.clear();
        groups.extend(generations.flat_map(|of| of.chunks(LANES)).map(|of| BeamGroup::new(of, &prepare)));
    }

    /// Notes which of the table's rows are read, and has the beams point at these.
    fn find_rows(&mut self, table_rows: usize) {
        const UNUSED: u32 = u32::MAX;
        self.places.clear();
        self.places.resize(table_rows, UNUSED);
        self.groups.iter_mut().flat_map(BeamGroup::rows_mut).for_each(|row| self.places[*row as usize] = 0);
        self.rows.clear();
        for (row, place) in (0..).zip(&mut self.places).filter(|(_, place)| **place != UNUSED) {
            *place = self.rows.len() as u32;
            self.rows.push(row);
        }
        for row in self.groups.iter_mut().flat_map(BeamGroup::rows_mut) {
            *row = self.places[*row as usize];
        }
    }

    /// The rows of the table whose responses [`pose`](Self::pose) asks for.
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Beams with a constant bend, by a free tip angle in rad across each beam, in any wind.
    pub(crate) fn bent(beams: &[BeamDynamics], free_angle: impl Fn(&BeamDynamics) -> Vec3) -> Self {
        let mut poser = Self::default();
        poser.group(beams, |index| PreparedBeam {
            mean: Vec3A::from(free_angle(&beams[index])),
            ..PreparedBeam::unloaded(beams, index)
        });
        poser
    }

    /// Number of beams.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is no beam.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Adds `weight` times each beam's free tip angle, for [`pose_free`](Self::pose_free): while one wind fades into another,
    /// their loads add up before the beams saturate.
    pub(crate) fn add_free_angles(&self, responses: &[Vec4], weight: f32, free: &mut [Vec3A]) {
        for group in &self.groups {
            for (beam, angle) in group.by_beam(&group.free_angles(responses)) {
                if let Some(free) = free.get_mut(beam) {
                    *free += weight * angle;
                }
            }
        }
    }

    /// Poses all beams for given free tip angles, one a beam, and as [`pose`](Self::pose) for the wind at the tree.
    pub(crate) fn pose_free(&self, free: &[Vec3A], wind: Vec3, out: &mut [BeamPose]) {
        let posed = out.len().min(free.len());
        self.pose_by(|group| group.take(free), wind, &mut out[..posed]);
    }

    /// Poses all beams, for the responses of its [`rows`](Self::rows) at the tree's place and time
    /// ([`ResponseTable::responses`](super::response::ResponseTable::responses)). A row without a response is at rest in the mean
    /// wind. No beam bends past the wind at the tree at that time: `wind` is its velocity in the tree's coordinates, m/s; where it is 0, beams
    /// bend as far as their own limits let them. Beams beyond the length of `out` are left out.
    pub fn pose(&self, responses: &[Vec4], wind: Vec3, out: &mut [BeamPose]) {
        self.pose_by(|group| group.free_angles(responses), wind, out);
    }

    #[inline]
    fn pose_by(&self, free_angles: impl Fn(&BeamGroup) -> Vector<Lanes>, wind: Vec3, out: &mut [BeamPose]) {
        let downwind = direction_of(wind).map(|downwind| Vector(downwind.to_array().map(Lanes::splat)));
        for group in &self.groups {
            group.pose(free_angles(group), downwind, out);
        }
    }
}

/// Where a wind blows to; none in a calm.
fn direction_of(wind: Vec3) -> Option<Vec3A> {
    let speed_m_s = wind.length();
    (speed_m_s > LEAST_WIND_M_S && speed_m_s.is_finite()).then(|| Vec3A::from(wind / speed_m_s))
}

mod beam_group;
#[cfg(test)]
mod tests;
