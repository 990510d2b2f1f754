//! What is beyond a hinge of a tree that sways, as one body. `resonance.rs` tells the theory.

use super::{
    branches::Lump,
    four::{
        Four, Matrix, Vector, add, cross, dot, inverse, subtract, subtracted, symmetric_times_transposed, times,
        times_transposed, transposed,
    },
    hinges::Hinge,
    statics::PieceWeight,
};
use bevy::math::{DVec3, Mat3, Vec3};

/// What is beyond a place, as one body. Forces, moments and turns are about that place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Articulated {
    force: Matrix,
    coupling: Matrix,
    turn: Matrix,
    /// Forces and moments of the wind along x and along z.
    loads: [[Vector; 2]; 2],
}

/// The rigid piece beyond a hinge, with the lumps that it bears itself.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    /// The hinge, and from there to the hinge or to the root before.
    pub at: DVec3,
    pub arm: Vec3,
    direction: Vec3,
    bend: f32,
    twist: f32,
    /// What weight adds to its stiffness, and half the moment of the weight.
    weight: Mat3,
    half_moment: Vec3,
    mass: f32,
    moment: Vec3,
    /// xx, yy, zz, xy, xz, yz.
    inertia: [f32; 6],
    drag: f32,
    drag_moment: Vec3,
    /// The first of the branches that it bears and that bear others, and the first of those that do not.
    pub first_child: Option<u32>,
    pub first_twig: Option<u32>,
}

impl Piece {
    pub fn new(hinge: &Hinge, before: DVec3, weight: PieceWeight) -> Self {
        Self {
            at: hinge.at,
            arm: (hinge.at - before).as_vec3(),
            direction: hinge.direction.as_vec3(),
            bend: hinge.bend_compliance.recip() as f32,
            twist: hinge.twist_compliance.recip() as f32,
            weight: weight.stiffness.as_mat3(),
            half_moment: (weight.moment_nm * 0.5).as_vec3(),
            mass: 0.0,
            moment: Vec3::ZERO,
            inertia: [0.0; 6],
            drag: 0.0,
            drag_moment: Vec3::ZERO,
            first_child: None,
            first_twig: None,
        }
    }

    pub fn bear(&mut self, lump: &Lump) {
        let (mass, drag) = (lump.mass_kg as f32, lump.drag_kg_m as f32);
        let r = (lump.at.as_dvec3() - self.at).as_vec3();
        self.mass += mass;
        self.moment += r * mass;
        self.drag += drag;
        self.drag_moment += r * drag;
        let products =
            [r.y * r.y + r.z * r.z, r.x * r.x + r.z * r.z, r.x * r.x + r.y * r.y, -r.x * r.y, -r.x * r.z, -r.y * r.z];
        self.inertia.iter_mut().zip(products).for_each(|(inertia, product)| *inertia += mass * product);
    }
}

impl Articulated {
    #[inline]
    pub fn add(&mut self, other: &Self) {
        for row in 0..3 {
            add(&mut self.force[row], &other.force[row]);
            add(&mut self.coupling[row], &other.coupling[row]);
            add(&mut self.turn[row], &other.turn[row]);
        }
        for (load, other) in self.loads.iter_mut().zip(&other.loads) {
            add(&mut load[0], &other[0]);
            add(&mut load[1], &other[1]);
        }
    }

    /// Adds what bend adds to a rigid body, by its motion and by the wind, times a factor each (`twig.rs`).
    #[inline]
    pub fn add_bend(&mut self, by_motion: &[[f32; 6]; 6], by_wind: &[[f32; 6]; 2], motion: Four, wind: Four) {
        for row in 0..3 {
            for column in 0..3 {
                self.force[row][column] -= motion * by_motion[row][column];
                self.coupling[row][column] -= motion * by_motion[row][3 + column];
                self.turn[row][column] -= motion * by_motion[3 + row][3 + column];
            }
        }
        for ([force, moment], by_wind) in self.loads.iter_mut().zip(by_wind) {
            for n in 0..3 {
                force[n] += wind * by_wind[n];
                moment[n] += wind * by_wind[3 + n];
            }
        }
    }

    /// Tells the same about a place from which this one's is an `arm` away.
    #[inline]
    pub fn move_back(&mut self, arm: Vec3) {
        // Columns of the old coupling and of the new one, both crossed with the arm.
        let before = transposed(&self.coupling).map(|column| cross(arm, &column));
        for (coupling, force) in self.coupling.iter_mut().zip(&self.force) {
            add(coupling, &cross(arm, force));
        }
        let after = transposed(&self.coupling).map(|column| cross(arm, &column));
        for row in 0..3 {
            for column in 0..3 {
                self.turn[row][column] += after[column][row] + before[row][column];
            }
        }
        for [force, moment] in &mut self.loads {
            add(moment, &cross(arm, force));
        }
    }

    /// What weight adds to the stiffness.
    #[inline]
    pub fn weigh(&mut self, piece: &Piece) {
        for row in 0..3 {
            for column in 0..3 {
                self.turn[row][column].re += piece.weight.col(column)[row];
            }
        }
    }

    /// How the turn of the piece before the hinge is coupled with that of the hinge, by weight as well.
    #[inline]
    pub fn coupled(&self, piece: &Piece) -> Matrix {
        let half = piece.half_moment;
        let halves = [[0.0, -half.z, half.y], [half.z, 0.0, -half.x], [-half.y, half.x, 0.0]];
        let mut coupled = self.turn;
        for row in 0..3 {
            for column in 0..3 {
                coupled[row][column].re += halves[row][column];
            }
        }
        coupled
    }

    /// Turn of the hinge under a moment.
    #[inline]
    pub fn compliance(&self, piece: &Piece) -> Matrix {
        let (along, bend, twist) = (piece.direction.to_array(), piece.bend, piece.twist - piece.bend);
        let mut stiff = self.turn;
        for row in 0..3 {
            stiff[row][row].re += bend;
            for column in 0..3 {
                stiff[row][column].re += twist * along[row] * along[column];
            }
        }
        inverse(&stiff)
    }

    /// Lets the body turn about the hinge that bears it, given the hinge's compliance and what couples it.
    #[inline]
    pub fn release(&mut self, compliance: &Matrix, coupled: &Matrix) {
        let by_force = times_transposed(&self.coupling, compliance);
        let by_turn = times_transposed(coupled, compliance);
        for [force, moment] in &mut self.loads {
            subtract(force, &times(&by_force, moment));
            *moment = subtracted(moment, &times(&by_turn, moment));
        }
        let forces = symmetric_times_transposed(&by_force, &self.coupling);
        let couplings = times_transposed(&by_force, coupled);
        let turns = symmetric_times_transposed(&by_turn, coupled);
        for row in 0..3 {
            subtract(&mut self.force[row], &forces[row]);
            subtract(&mut self.coupling[row], &couplings[row]);
            subtract(&mut self.turn[row], &turns[row]);
        }
    }

    /// The same for a piece without weight, for which `1 - R S = K S`.
    #[inline]
    pub fn release_weightless(&mut self, piece: &Piece) {
        let compliance = self.compliance(piece);
        let (along, bend, twist) = (piece.direction.to_array(), piece.bend, piece.twist - piece.bend);
        let along_compliance: Vector = std::array::from_fn(|column| {
            let [x, y, z] = compliance[column];
            x * along[0] + y * along[1] + z * along[2]
        });
        let kept: Matrix = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                compliance[row][column] * bend + along_compliance[column] * (twist * along[row])
            })
        });
        let by_force = times_transposed(&self.coupling, &compliance);
        for [force, moment] in &mut self.loads {
            subtract(force, &times(&by_force, moment));
            *moment = times(&kept, moment);
        }
        let forces = symmetric_times_transposed(&by_force, &self.coupling);
        for (own, taken) in self.force.iter_mut().zip(&forces) {
            subtract(own, taken);
        }
        self.coupling = times_transposed(&self.coupling, &kept);
        self.turn = symmetric_times_transposed(&self.turn, &kept);
    }
}

impl Piece {
    /// Adds the inertia and the drag of what it bears itself.
    #[inline]
    pub fn add_to(&self, body: &mut Articulated, z: Four) {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let m = self.moment;
        let inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let moment = [[0.0, m.z, -m.y], [-m.z, 0.0, m.x], [m.y, -m.x, 0.0]];
        for row in 0..3 {
            body.force[row][row] -= z * self.mass;
            for column in 0..3 {
                body.coupling[row][column] -= z * moment[row][column];
                body.turn[row][column] -= z * inertia[row][column];
            }
        }
        for (load, wind) in body.loads.iter_mut().zip([Vec3::X, Vec3::Z]) {
            let turning = self.drag_moment.cross(wind).to_array();
            for n in 0..3 {
                load[0][n].re += self.drag * wind[n];
                load[1][n].re += turning[n];
            }
        }
    }
}

/// How far a place on a branch moves along a wind: by what the hinges beyond the one that is reached do, and by the motion of the
/// piece there.
#[derive(Clone, Copy)]
pub(super) struct Probe {
    wind: Vec3,
    pub moved: Four,
    pub force: Vector,
    pub moment: Vector,
}

impl Probe {
    pub fn new(wind: Vec3, arm: Vec3) -> Self {
        let constant = |vector: Vec3| vector.to_array().map(Four::real);
        Self { wind, moved: Four::ZERO, force: constant(wind), moment: constant(arm.cross(wind)) }
    }

    #[inline]
    pub fn release(&mut self, body: &Articulated, compliance: &Matrix, coupled: &Matrix) {
        let load: Vector =
            std::array::from_fn(|n| body.loads[0][1][n] * self.wind.x + body.loads[1][1][n] * self.wind.z);
        let turned = times(compliance, &self.moment);
        self.moved += dot(&turned, &load);
        subtract(&mut self.force, &times(&body.coupling, &turned));
        subtract(&mut self.moment, &times(coupled, &turned));
    }
}
