//! The frequency at which a branch resonates with all that it carries, which bends and twists as well.
//!
//! In a wind that swings with the angular frequency `w` every piece of a tree is held by its hinge and by the inertia of what is beyond.
//! Seen from a point, all of that is one body with the symmetric dynamic stiffness
//!
//! ```text
//! (f, m) = D (u, phi) - b,    D = [F C; C^T R],    of a rigid body: D = -z [M, -M r x; M r x, -M (r x)^2]
//! ```
//!
//! for forces and moments that move and turn it, with `z = w^2 / (1 + 2 i zeta)` for a damping ratio `zeta` of all hinges. A hinge of
//! the stiffness `K` (a matrix) frees the body beyond it from turning with the one before (the articulated bodies of
//! Featherstone 1983, for frequencies in place of time):
//!
//! ```text
//! S = (K + R)^-1,  N = R + [M x]/2,   F - C S C^T,  C - C S N^T,  R - N S N^T,   b_f - C S b_m,  b_m - N S b_m
//! ```
//!
//! `M` is the moment of the weight at the hinge, and `R` has the stiffness that weight gives each piece (`statics.rs`).
//!
//! So one pass from the twigs to the ground tells how all branches of a tree answer at a frequency, each of them held fast where it
//! grows: the deflection of a place at two thirds of its length is a linear function of the motion of the piece that bears it,
//! and goes down the branch by the same rules as the loads. Work grows with the number of beams.
//!
//! Resonance is where the deflection lags behind the wind most, in the sense of its imaginary part: every mode adds its share of the static
//! deflection there, over the width of a damped resonance. Branches as fast as the one that carries them divide its mode in many;
//! that is one peak again.

use super::{
    branches::{LoadedBranch, Lump},
    four::{
        Four, Matrix, Vector, add, cross, dot, inverse, subtract, subtracted, symmetric_times_transposed, times,
        times_transposed, transposed,
    },
    hinges::Hinge,
    response::BranchResponse,
    statics::{Beyond, PieceWeight, winds},
};
use bevy::math::{DVec3, Mat3, Vec3, Vec4};
use std::f64::consts::TAU;

/// Damping ratio of the peaks, that of branches in a moderate wind: what is nearer together than some 15% is one peak.
const DAMPING_RATIO: f32 = 0.12;
/// The frequencies that are tried: the lowest by that of the slowest branch, the natural logarithm of the ratio of neighbours, and
/// how many fours of them.
const LOWEST_SHARE: f64 = 0.6;
const STEP: f64 = 0.17;
const FOURS: usize = 4;
/// Where on a branch its motion is taken, as a share of its length.
const SENSOR: f64 = 2.0 / 3.0;

/// The natural frequency of each branch, Hz; none where no peak is within the frequencies that are tried.
pub(super) fn resonances_hz(branches: &[LoadedBranch], responses: &[BranchResponse]) -> Vec<Option<f64>> {
    let bodies = Bodies::new(branches);
    let lowest_hz = lowest_hz(branches, responses);
    let mut lags: Vec<[f32; 4 * FOURS]> = vec![[0.0; 4 * FOURS]; branches.len()];
    let mut articulated = vec![Articulated::default(); branches.len()];
    for four in 0..FOURS {
        let z = stiffness_ratio(lowest_hz, four);
        for (index, branch) in branches.iter().enumerate().rev() {
            if branch.bears {
                let answer = bodies.answer(index, z, &articulated);
                // Hinges of the stiffness K (1 + 2 i zeta) in place of K.
                let lag = answer.re * (2.0 * DAMPING_RATIO) - answer.im;
                lags[index][4 * four..4 * four + 4].copy_from_slice(&lag.to_array());
            }
            if branch.carrier.is_some() {
                articulated[index] = bodies.carried(index, z, &articulated);
            }
        }
    }
    lags.iter().map(|lags| Some(lowest_hz * peak(lags)?)).collect()
}

/// `z` at four frequencies.
fn stiffness_ratio(lowest_hz: f64, four: usize) -> Four {
    let square = Vec4::from_array(std::array::from_fn(|lane| {
        (TAU * lowest_hz * ratio((4 * four + lane) as f64)).powi(2) as f32
    }));
    let norm = 1.0 + 4.0 * DAMPING_RATIO * DAMPING_RATIO;
    Four { re: square / norm, im: square * (-2.0 * DAMPING_RATIO / norm) }
}

fn ratio(index: f64) -> f64 {
    (STEP * index).exp()
}

/// Where to begin: well below the slowest branch that bears others, were these rigid.
fn lowest_hz(branches: &[LoadedBranch], responses: &[BranchResponse]) -> f64 {
    let bearing = branches.iter().zip(responses).filter(|(branch, _)| branch.bears);
    let slowest_hz = bearing.map(|(branch, response)| response.sway.rigid_hz(branch)).fold(f64::INFINITY, f64::min);
    if slowest_hz.is_finite() { LOWEST_SHARE * slowest_hz } else { 1.0 }
}

/// The greatest value and its neighbours tell where between them the peak is.
fn peak(lags: &[f32]) -> Option<f64> {
    let highest = (0..lags.len()).max_by(|&a, &b| lags[a].total_cmp(&lags[b]))?;
    let (before, after) = (*lags.get(highest.checked_sub(1)?)?, *lags.get(highest + 1)?);
    let curvature = before - 2.0 * lags[highest] + after;
    let off = 0.5 * (before - after) / curvature;
    (off.is_finite() && lags[highest] > 0.0).then(|| ratio(highest as f64 + f64::from(off)))
}

/// What is beyond a place, as one body. Forces, moments and turns are about that place.
#[derive(Clone, Copy, Debug, Default)]
struct Articulated {
    force: Matrix,
    coupling: Matrix,
    turn: Matrix,
    /// Forces and moments of the wind along x and along z.
    loads: [[Vector; 2]; 2],
}

/// The rigid piece beyond a hinge, with the lumps that it bears itself.
#[derive(Clone, Copy)]
struct Piece {
    /// The hinge, and from there to the hinge or to the root before.
    at: DVec3,
    arm: Vec3,
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
    /// The first of the branches that it bears.
    first_child: Option<u32>,
}

/// A branch's place where it grows, its pieces and its sensor.
struct Body {
    first: usize,
    end: usize,
    /// From the hinge before it, if another branch bears it.
    arm: Vec3,
    next_sibling: Option<u32>,
    sensor: usize,
    sensor_arm: Vec3,
    winds: [Vec3; 2],
}

struct Bodies {
    bodies: Vec<Body>,
    pieces: Vec<Piece>,
}

impl Bodies {
    fn new(branches: &[LoadedBranch]) -> Self {
        let mut bodies: Vec<Body> = Vec::with_capacity(branches.len());
        let mut pieces: Vec<Piece> = Vec::new();
        for branch in branches {
            let first = pieces.len();
            pieces.extend(pieces_of(branch));
            let sensor_m = SENSOR * branch.length_m;
            let sensor = piece_at(&branch.swaying_hinges, sensor_m);
            let sensor_arm = branch
                .swaying_hinges
                .get(sensor)
                .map_or(Vec3::ZERO, |hinge| (hinge.direction * (sensor_m - hinge.along_m)).as_vec3());
            let mut ways = winds(branch).into_iter();
            let winds = std::array::from_fn(|_| ways.next().unwrap_or(DVec3::ZERO).as_vec3());
            let mut body = Body {
                first,
                end: pieces.len(),
                arm: Vec3::ZERO,
                next_sibling: None,
                sensor: first + sensor,
                sensor_arm,
                winds,
            };
            if let Some(carrier) = branch.carrier {
                let bearer =
                    bodies[carrier.branch].first + piece_at(&branches[carrier.branch].swaying_hinges, carrier.attach_m);
                body.arm = (branch.base - pieces[bearer].at).as_vec3();
                body.next_sibling = pieces[bearer].first_child.replace(bodies.len() as u32);
            }
            bodies.push(body);
        }
        Self { bodies, pieces }
    }

    /// A branch as one body about the hinge that bears it, as the branch that carries it feels it.
    fn carried(&self, index: usize, z: Four, articulated: &[Articulated]) -> Articulated {
        let body = &self.bodies[index];
        let mut beyond = Articulated::default();
        for piece in self.pieces[body.first..body.end].iter().rev() {
            self.load(&mut beyond, piece, z, articulated);
            beyond.release_weightless(piece);
            beyond.move_back(piece.arm);
        }
        beyond.move_back(body.arm);
        beyond
    }

    /// How the sensor of a branch moves along the wind while its root is held.
    fn answer(&self, index: usize, z: Four, articulated: &[Articulated]) -> Four {
        let body = &self.bodies[index];
        let mut beyond = Articulated::default();
        let mut probes: Option<[Probe; 2]> = None;
        for index in (body.first..body.end).rev() {
            let piece = &self.pieces[index];
            self.load(&mut beyond, piece, z, articulated);
            if index == body.sensor {
                probes = Some(body.winds.map(|wind| Probe::new(wind, body.sensor_arm)));
            }
            beyond.weigh(piece);
            let coupled = beyond.coupled(piece);
            let compliance = beyond.compliance(piece);
            for probe in probes.iter_mut().flatten() {
                probe.release(&beyond, &compliance, &coupled);
            }
            beyond.release(&compliance, &coupled);
            beyond.move_back(piece.arm);
            for probe in probes.iter_mut().flatten() {
                add(&mut probe.moment, &cross(piece.arm, &probe.force));
            }
        }
        probes.iter().flatten().fold(Four::ZERO, |sum, probe| sum + probe.moved)
    }

    /// Adds what a piece bears.
    fn load(&self, beyond: &mut Articulated, piece: &Piece, z: Four, articulated: &[Articulated]) {
        piece.add_to(beyond, z);
        let mut child = piece.first_child;
        while let Some(branch) = child {
            beyond.add(&articulated[branch as usize]);
            child = self.bodies[branch as usize].next_sibling;
        }
    }
}

/// How far a place on a branch moves along a wind: by what the hinges beyond the one that is reached do, and by the motion of the
/// piece there.
#[derive(Clone, Copy)]
struct Probe {
    wind: Vec3,
    moved: Four,
    force: Vector,
    moment: Vector,
}

impl Probe {
    fn new(wind: Vec3, arm: Vec3) -> Self {
        let constant = |vector: Vec3| vector.to_array().map(Four::real);
        Self { wind, moved: Four::ZERO, force: constant(wind), moment: constant(arm.cross(wind)) }
    }

    fn release(&mut self, body: &Articulated, compliance: &Matrix, coupled: &Matrix) {
        let load: Vector =
            std::array::from_fn(|n| body.loads[0][1][n] * self.wind.x + body.loads[1][1][n] * self.wind.z);
        let turned = times(compliance, &self.moment);
        self.moved += dot(&turned, &load);
        subtract(&mut self.force, &times(&body.coupling, &turned));
        subtract(&mut self.moment, &times(coupled, &turned));
    }
}

impl Articulated {
    fn add(&mut self, other: &Self) {
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

    /// Tells the same about a place from which this one's is an `arm` away.
    fn move_back(&mut self, arm: Vec3) {
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
    fn weigh(&mut self, piece: &Piece) {
        for row in 0..3 {
            for column in 0..3 {
                self.turn[row][column].re += piece.weight.col(column)[row];
            }
        }
    }

    /// How the turn of the piece before the hinge is coupled with that of the hinge, by weight as well.
    fn coupled(&self, piece: &Piece) -> Matrix {
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
    fn compliance(&self, piece: &Piece) -> Matrix {
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
    fn release(&mut self, compliance: &Matrix, coupled: &Matrix) {
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
    fn release_weightless(&mut self, piece: &Piece) {
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
        for row in 0..3 {
            subtract(&mut self.force[row], &forces[row]);
        }
        self.coupling = times_transposed(&self.coupling, &kept);
        self.turn = symmetric_times_transposed(&self.turn, &kept);
    }
}

impl Piece {
    /// Adds the inertia and the drag of what it bears itself.
    fn add_to(&self, body: &mut Articulated, z: Four) {
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

/// The piece at a place: the last hinge before it. What is before the first hinge counts as beyond it.
fn piece_at(hinges: &[Hinge], along_m: f64) -> usize {
    hinges.partition_point(|hinge| hinge.along_m < along_m).saturating_sub(1)
}

fn pieces_of(branch: &LoadedBranch) -> Vec<Piece> {
    let hinges = &branch.swaying_hinges;
    let weights = PieceWeight::of(hinges, &Beyond::sums(branch, hinges, |lump| [lump.mass_kg]));
    let mut before = branch.base;
    let mut pieces: Vec<Piece> = hinges
        .iter()
        .zip(weights)
        .map(|(hinge, weight)| {
            let piece = Piece::new(hinge, before, weight);
            before = hinge.at;
            piece
        })
        .collect();
    for lump in branch.lumps.iter().filter(|lump| lump.is_own) {
        pieces[piece_at(&branch.swaying_hinges, lump.attach_m)].bear(lump);
    }
    pieces
}

impl Piece {
    fn new(hinge: &Hinge, before: DVec3, weight: PieceWeight) -> Self {
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
        }
    }

    fn bear(&mut self, lump: &Lump) {
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
