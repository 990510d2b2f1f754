//! Beams whose parents are posed before any of them: they are posed side by side.

use crate::dynamics::{
    beam::{BeamDynamics, NO_PARENT},
    beam_pose::BeamPose,
    bend::AxisPoint,
    lanes::{LANES, Lanes, Number, Rotation, Vector, lanes},
    oscillator_grid::RowWeights,
};
use bevy::math::{Quat, Vec3A, Vec4};
use std::array::from_fn;

/// The least limit of a tip's angle, in radians: a beam without one is as good as rigid.
const LEAST_ANGLE_LIMIT_RAD: f32 = 1e-6;
/// Free angles beyond this, in radians and by component, are cut off before their squares overflow. Nothing smaller is cut, for that would
/// turn the bend out of the plane across the beam.
const FREE_ANGLE_BOUND: f32 = 1e18;
/// Greatest square of the share of the way to the wind that a beam bends, so that its fourth power is finite.
const MOST_BEND: f32 = 1e8;
/// The least square of that way: that of beams which point into the wind.
const LEAST_WAY: f32 = 1e-20;
/// In a lane without a beam.
const NO_BEAM: u32 = u32::MAX;

/// What is known of a beam before the wind of the moment.
#[derive(Clone, Copy)]
pub(super) struct PreparedBeam {
    /// Free tip angle in the mean wind, and for a unit of each signal's response, in rad.
    pub mean: Vec3A,
    pub moving: [Vec3A; 4],
    pub direction: Vec3A,
    /// Where on the parent this beam is attached.
    pub attach: AxisPoint,
    /// Of the rows in `TreePoser::rows`.
    pub read: RowWeights,
    pub parent: u32,
    pub angle_limit_rad: f32,
}

impl PreparedBeam {
    /// Stands on the ground and does not move.
    const REST: Self = Self {
        mean: Vec3A::ZERO,
        moving: [Vec3A::ZERO; 4],
        direction: Vec3A::Y,
        attach: AxisPoint::ORIGIN,
        read: RowWeights { rows: [0; 4], weights: [0.0; 4] },
        parent: NO_PARENT,
        angle_limit_rad: 1.0,
    };

    /// Of one beam among those of its tree, without a load.
    pub fn unloaded(beams: &[BeamDynamics], index: usize) -> Self {
        let beam = &beams[index];
        let parent = parent_of(beams, index);
        Self {
            direction: Vec3A::from(beam.direction),
            attach: AxisPoint::new(parent.unwrap_or(beam), beam.attach),
            parent: if parent.is_some() { beam.parent } else { NO_PARENT },
            angle_limit_rad: beam.angle_limit_rad.max(LEAST_ANGLE_LIMIT_RAD),
            ..Self::REST
        }
    }
}

/// A beam with a parent that does not precede it stands on the ground.
pub(super) fn parent_of(beams: &[BeamDynamics], index: usize) -> Option<&BeamDynamics> {
    beams[..index].get(beams[index].parent as usize)
}

/// As many beams as there are lanes, or fewer.
#[derive(Clone, Debug)]
pub(super) struct BeamGroup {
    /// Free tip angle in the mean wind, and for a unit of each signal's response, in rad.
    mean: Vector<Lanes>,
    moving: [Vector<Lanes>; 4],
    direction: Vector<Lanes>,
    /// Where on their parents these beams are attached.
    attach: AxisPoint<Lanes>,
    angle_limit_rad: Lanes,
    read: [RowWeights; LANES],
    parents: [u32; LANES],
    beams: [u32; LANES],
}

impl BeamGroup {
    /// Of the beams of these indices, [`LANES`] at most, none of which is the parent of another.
    pub fn new(indices: &[u32], prepare: impl Fn(usize) -> PreparedBeam) -> Self {
        let mut of = [PreparedBeam::REST; LANES];
        let mut beams = [NO_BEAM; LANES];
        for ((lane, beam), &index) in of.iter_mut().zip(&mut beams).zip(indices) {
            (*lane, *beam) = (prepare(index as usize), index);
        }
        let [angle_limit_rad] = lanes(|lane| [of[lane].angle_limit_rad]);
        Self {
            mean: Vector(lanes(|lane| of[lane].mean.to_array())),
            moving: from_fn(|signal| Vector(lanes(|lane| of[lane].moving[signal].to_array()))),
            direction: Vector(lanes(|lane| of[lane].direction.to_array())),
            attach: AxisPoint::side_by_side(|lane| of[lane].attach),
            angle_limit_rad,
            read: of.map(|beam| beam.read),
            parents: of.map(|beam| beam.parent),
            beams,
        }
    }

    /// The rows of the table that its beams read.
    pub fn rows_mut(&mut self) -> impl Iterator<Item = &mut u32> {
        let used = self.beams.iter().filter(|beam| **beam != NO_BEAM).count();
        self.read[..used].iter_mut().flat_map(|read| &mut read.rows)
    }

    /// Free tip angles for the responses of the table's rows.
    #[inline]
    pub fn free_angles(&self, responses: &[Vec4]) -> Vector<Lanes> {
        let response = lanes(|lane| response(&self.read[lane], responses).to_array());
        self.moving.iter().zip(response).fold(self.mean, |sum, (moving, response)| sum + *moving * response)
    }

    /// The lanes of values of which there is one a beam; what is beyond their end counts as nothing.
    pub fn take(&self, of_beams: &[Vec3A]) -> Vector<Lanes> {
        let of_beam = |lane: usize| of_beams.get(self.beams[lane] as usize);
        Vector(lanes(|lane| of_beam(lane).copied().unwrap_or_default().to_array()))
    }

    /// Each lane with the index of its beam.
    pub fn by_beam(&self, lanes: &Vector<Lanes>) -> impl Iterator<Item = (usize, Vec3A)> {
        let components = lanes.0.map(Lanes::to_array);
        let beams = self.beams.into_iter().enumerate().filter(|(_, beam)| *beam != NO_BEAM);
        beams.map(move |(lane, beam)| (beam as usize, Vec3A::from_array(components.map(|of| of[lane]))))
    }

    /// Poses these beams, given the poses of their parents in `out`.
    #[inline]
    pub fn pose(&self, free_angles: Vector<Lanes>, downwind: Option<Vector<Lanes>>, out: &mut [BeamPose]) {
        let mut tip_angle = saturate(free_angles, self.angle_limit_rad);
        let (rotation, translation) = self.motion_of_parents(out);
        if let Some(downwind) = downwind {
            tip_angle = held_to_wind(tip_angle, rotation.rotate(self.direction), downwind);
        }
        let [x, y, z] = rotation.vector.0.map(Lanes::to_array);
        let w = rotation.scalar.to_array();
        let tips = tip_angle.0.map(Lanes::to_array);
        let translations = translation.0.map(Lanes::to_array);
        for (lane, beam) in self.beams.into_iter().enumerate() {
            if let Some(pose) = out.get_mut(beam as usize) {
                *pose = BeamPose {
                    tip_angle: Vec3A::from_array(tips.map(|of| of[lane])),
                    rotation: Quat::from_xyzw(x[lane], y[lane], z[lane], w[lane]),
                    translation: Vec3A::from_array(translations.map(|of| of[lane])),
                };
            }
        }
    }

    /// The rigid motion of each beam's rest frame: its parent's own, after the parent's bend where this one is attached.
    #[inline]
    fn motion_of_parents(&self, posed: &[BeamPose]) -> (Rotation<Lanes>, Vector<Lanes>) {
        let parents: [&BeamPose; LANES] =
            from_fn(|lane| posed.get(self.parents[lane] as usize).unwrap_or(&BeamPose::REST));
        let [x, y, z, scalar] = lanes(|lane| parents[lane].rotation.to_array());
        let rotation = Rotation { vector: Vector([x, y, z]), scalar };
        let translation = Vector(lanes(|lane| parents[lane].translation.to_array()));
        let bend = self.attach.bend(&Vector(lanes(|lane| parents[lane].tip_angle.to_array())));
        let moved = rotation.rotate(bend.displacement - bend.rotation.displacement(&self.attach.rest));
        (rotation.after(&bend.rotation), translation + moved)
    }
}

#[inline]
fn response(read: &RowWeights, responses: &[Vec4]) -> Vec4 {
    let of_row =
        |index: usize| responses.get(read.rows[index] as usize).copied().unwrap_or(Vec4::ZERO) * read.weights[index];
    (of_row(0) + of_row(1)) + (of_row(2) + of_row(3))
}

/// `Theta` from `Theta_free`: the same direction, but never beyond the limit.
#[inline(always)]
fn saturate<T: Number>(free: Vector<T>, limit_rad: T) -> Vector<T> {
    let bounded = Vector(free.0.map(|angle| angle.at_most(FREE_ANGLE_BOUND).at_least(-FREE_ANGLE_BOUND)));
    bounded * (limit_rad / (limit_rad * limit_rad + bounded.length_squared()).sqrt())
}

/// The bend of a beam that points to `carried` before it, held to that which points it into the wind.
#[inline(always)]
pub(super) fn held_to_wind<T: Number>(tip_angle: Vector<T>, carried: Vector<T>, downwind: Vector<T>) -> Vector<T> {
    let way = (carried - downwind).length_squared().at_least(LEAST_WAY);
    let share = (tip_angle.length_squared() / way).at_most(MOST_BEND);
    let fourth = share * share * (share * share);
    tip_angle * (T::from(1.0) / (T::from(1.0) + fourth).sqrt().sqrt().sqrt())
}
