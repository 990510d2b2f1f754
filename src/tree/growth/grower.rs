//! Grows buds into branches, chains of beams: shared by all generators.

use std::ops::Range;

use bevy::math::Vec3;
use rand::{Rng, RngExt};

use super::{envelope::Envelope, habit::Habit};
use crate::tree::skeleton::SkeletonBeam;

/// Most beams of one tree: growth ends there, lower orders first.
pub const BEAMS_LIMIT: usize = 4096;
/// A shorter piece of wood is no beam.
pub(super) const SHORTEST_BEAM_M: f32 = 0.08;
/// A branch that would keep less than this share of a segment before it meets the envelope ends where it is.
const SHORTEST_SEGMENT_SHARE: f32 = 0.3;
/// How much a beam's middle wanders off its chord, as a share of the turns between beams.
const BOW_SHARE: f32 = 0.15;

/// The branches of an individual, still without leaves; radii are found with the leaves.
pub(in crate::tree) struct GrownBranches {
    pub beams: Vec<SkeletonBeam>,
    /// The envelope at this individual's size.
    pub envelope: Envelope,
    /// Radius of the trunk at the ground, m: what the pipe model starts from.
    pub trunk_radius_m: f32,
}

/// A grown branch: a run of beams, each continuing the one before.
pub(super) struct Branch {
    pub beams: Range<usize>,
    pub length_m: f32,
}

/// Where a branch starts.
pub(super) struct Bud {
    pub parent: Option<u32>,
    pub attach: f32,
    pub base: Vec3,
    pub direction: Vec3,
    pub order: u8,
}

/// A tree while it grows.
pub(super) struct Grower<'a, R> {
    /// What branches may not leave, if anything.
    pub envelope: Option<Envelope>,
    pub beams: Vec<SkeletonBeam>,
    pub random: &'a mut R,
}

impl<'a, R: Rng> Grower<'a, R> {
    pub fn new(envelope: Option<Envelope>, random: &'a mut R) -> Self {
        Self { envelope, beams: Vec::new(), random }
    }

    /// Whether the tree may have more beams.
    pub fn has_room(&self) -> bool {
        self.beams.len() < BEAMS_LIMIT
    }

    /// Beam and place on it at a distance along a branch.
    pub fn find(&self, branch: &Branch, along_m: f32) -> (usize, f32) {
        let mut left_m = along_m;
        for index in branch.beams.clone() {
            let length_m = self.beams[index].length_m;
            if left_m < length_m {
                return (index, left_m / length_m);
            }
            left_m -= length_m;
        }
        (branch.beams.end - 1, 1.0)
    }

    /// The bud of a branch of `order` at a distance along its parent, `angle_rad` from its direction.
    pub fn bud(&self, parent: &Branch, along_m: f32, angle_rad: f32, roll_rad: f32, order: u8) -> Bud {
        let (carrier, attach) = self.find(parent, along_m);
        let beam = &self.beams[carrier];
        let direction = leave(beam.tangent(attach), angle_rad, roll_rad);
        Bud { parent: Some(carrier as u32), attach, base: beam.path(attach), direction, order }
    }

    /// Grows the beams of a branch, one after the other, until its length is used up or the envelope is met.
    pub fn run(&mut self, mut bud: Bud, length_m: f32, habit: &Habit) -> Branch {
        let first = self.beams.len();
        let mut grown_m = 0.0;
        let segment_m = length_m / habit.segments as f32;
        let turns = habit.segments.saturating_sub(1).max(1) as f32;
        for segment in 0..habit.segments {
            let room_m = if bud.order == 0 { segment_m } else { self.room_m(bud.base, bud.direction) };
            if segment > 0 && room_m < SHORTEST_SEGMENT_SHARE * segment_m {
                break;
            }
            let beam = self.beam(&bud, segment_m.min(room_m), habit);
            grown_m += beam.length_m;
            let turned = self.wander(beam.direction, habit.crook_rad) + Vec3::Y * (habit.rise / turns);
            bud = Bud {
                parent: Some(self.beams.len() as u32),
                attach: 1.0,
                base: beam.path(1.0),
                direction: turned.try_normalize().unwrap_or(beam.direction),
                order: bud.order,
            };
            self.beams.push(beam);
        }
        Branch { beams: first..self.beams.len(), length_m: grown_m }
    }

    /// How far the envelope lets a branch grow, m.
    pub fn room_m(&self, from: Vec3, direction: Vec3) -> f32 {
        self.envelope.map_or(f32::INFINITY, |envelope| envelope.exit_distance_m(from, direction))
    }

    fn beam(&mut self, bud: &Bud, length_m: f32, habit: &Habit) -> SkeletonBeam {
        let length_m = length_m.max(SHORTEST_BEAM_M);
        let sideways = self.wander(bud.direction, BOW_SHARE * habit.crook_rad) - bud.direction;
        let down = bud.direction * bud.direction.y - Vec3::Y;
        let mut bow = (down * habit.sag + sideways.reject_from(bud.direction)) * length_m;
        let tip = bud.base + bud.direction * length_m;
        if let Some(envelope) = self.envelope {
            bow.y = bow.y.min((envelope.top_m - bud.base.y.max(tip.y)).max(0.0));
        }
        SkeletonBeam {
            parent: bud.parent,
            attach: bud.attach,
            base: bud.base,
            direction: bud.direction,
            length_m,
            base_radius_m: 0.0,
            tip_radius_m: 0.0,
            bow,
            order: bud.order,
        }
    }

    /// A unit vector up to `angle_rad` away.
    pub fn wander(&mut self, direction: Vec3, angle_rad: f32) -> Vec3 {
        let roll = self.turn();
        let angle = angle_rad * self.random.random::<f32>().sqrt();
        leave(direction, angle, roll)
    }

    /// Any angle around, rad.
    pub fn turn(&mut self) -> f32 {
        self.random.random_range(0.0..std::f32::consts::TAU)
    }

    /// Uniform in -1..1.
    pub fn signed(&mut self) -> f32 {
        self.random.random_range(-1.0..1.0)
    }
}

/// The unit vector at `angle_rad` from `direction`, turned about it by `roll_rad`: 0 is level, a quarter turn is up.
pub(in crate::tree) fn leave(direction: Vec3, angle_rad: f32, roll_rad: f32) -> Vec3 {
    let side = direction.cross(Vec3::Y).try_normalize().unwrap_or(Vec3::X);
    let up = side.cross(direction);
    let across = side * roll_rad.cos() + up * roll_rad.sin();
    direction * angle_rad.cos() + across * angle_rad.sin()
}

pub(super) fn lerp(from: f32, to: f32, share: f32) -> f32 {
    from + (to - from) * share
}
