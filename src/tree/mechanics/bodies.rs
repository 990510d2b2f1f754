//! A tree as articulated bodies: one for each branch that bears others. `resonance.rs` tells the theory.

use super::{
    articulated::{Articulated, Piece, Probe},
    branches::{Carrier, LoadedBranch},
    four::{Four, add, cross},
    hinges::Hinge,
    statics::{Beyond, PieceWeight, winds},
    twig::Twig,
};
use bevy::math::{DVec3, Vec3};

/// Where on a branch its motion is taken, as a share of its length.
const SENSOR: f64 = 2.0 / 3.0;

/// A branch's place where it grows, its pieces and its sensor.
struct Body {
    branch: usize,
    first: usize,
    end: usize,
    /// From the hinge before it; none of a stem.
    arm: Option<Vec3>,
    next_sibling: Option<u32>,
    sensor: usize,
    sensor_arm: Vec3,
    winds: [Vec3; 2],
}

/// All branches of a tree that bear others, and their pieces.
pub(super) struct Bodies {
    bodies: Vec<Body>,
    pieces: Vec<Piece>,
    twigs: Vec<Twig>,
}

impl Bodies {
    pub fn new(branches: &[LoadedBranch]) -> Self {
        let mut tree = Self { bodies: Vec::new(), pieces: Vec::new(), twigs: Vec::new() };
        let mut body_of = vec![0; branches.len()];
        for (index, branch) in branches.iter().enumerate() {
            let bearer = branch.carrier.map(|Carrier { branch, attach_m }| {
                tree.bodies[body_of[branch]].first + piece_at(&branches[branch].swaying_hinges, attach_m)
            });
            match bearer {
                Some(bearer) if !branch.bears => tree.bear_twig(bearer, branch),
                bearer => {
                    body_of[index] = tree.bodies.len();
                    tree.bear_branch(bearer, index, branch);
                }
            }
        }
        tree
    }

    /// Number of branches that bear others.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// The number among all branches of each of them.
    pub fn branches(&self) -> impl Iterator<Item = usize> {
        self.bodies.iter().map(|body| body.branch)
    }

    fn bear_twig(&mut self, bearer: usize, branch: &LoadedBranch) {
        let piece = &mut self.pieces[bearer];
        branch.lumps.iter().for_each(|lump| piece.bear(lump));
        let next = piece.first_twig.replace(self.twigs.len() as u32);
        self.twigs.push(Twig::new(branch, piece.at, next));
    }

    fn bear_branch(&mut self, bearer: Option<usize>, index: usize, branch: &LoadedBranch) {
        let first = self.pieces.len();
        self.pieces.extend(pieces_of(branch));
        let sensor_m = SENSOR * branch.length_m;
        let sensor = piece_at(&branch.swaying_hinges, sensor_m);
        let sensor_arm = branch
            .swaying_hinges
            .get(sensor)
            .map_or(Vec3::ZERO, |hinge| (hinge.direction * (sensor_m - hinge.along_m)).as_vec3());
        let mut ways = winds(branch).into_iter();
        let winds = std::array::from_fn(|_| ways.next().unwrap_or(DVec3::ZERO).as_vec3());
        self.bodies.push(Body {
            branch: index,
            first,
            end: self.pieces.len(),
            arm: bearer.map(|bearer| (branch.base - self.pieces[bearer].at).as_vec3()),
            next_sibling: bearer.and_then(|bearer| self.pieces[bearer].first_child.replace(self.bodies.len() as u32)),
            sensor: first + sensor,
            sensor_arm,
            winds,
        });
    }

    /// How the sensor of a branch moves along the wind while its root is held. Those that it bears must be among the articulated
    /// bodies; it joins them, as one body about the hinge that bears it, as the branch that carries it feels it.
    pub fn sway(&self, index: usize, z: Four, articulated: &mut [Articulated]) -> Four {
        let body = &self.bodies[index];
        let (mut held, mut carried) = (Articulated::default(), Articulated::default());
        let mut probes: Option<[Probe; 2]> = None;
        for at in (body.first..body.end).rev() {
            let piece = &self.pieces[at];
            let borne = self.borne(piece, z, articulated);
            held.add(&borne);
            if at == body.sensor {
                probes = Some(body.winds.map(|wind| Probe::new(wind, body.sensor_arm)));
            }
            held.weigh(piece);
            let coupled = held.coupled(piece);
            let compliance = held.compliance(piece);
            for probe in probes.iter_mut().flatten() {
                probe.release(&held, &compliance, &coupled);
            }
            held.release(&compliance, &coupled);
            held.move_back(piece.arm);
            for probe in probes.iter_mut().flatten() {
                add(&mut probe.moment, &cross(piece.arm, &probe.force));
            }
            if body.arm.is_some() {
                carried.add(&borne);
                carried.release_weightless(piece);
                carried.move_back(piece.arm);
            }
        }
        if let Some(arm) = body.arm {
            carried.move_back(arm);
            articulated[index] = carried;
        }
        probes.iter().flatten().fold(Four::ZERO, |sum, probe| sum + probe.moved)
    }

    /// A piece with all that it bears.
    fn borne(&self, piece: &Piece, z: Four, articulated: &[Articulated]) -> Articulated {
        let mut borne = Articulated::default();
        piece.add_to(&mut borne, z);
        let mut twig = piece.first_twig;
        while let Some(index) = twig {
            let borne_twig = &self.twigs[index as usize];
            borne_twig.add_to(&mut borne, z);
            twig = borne_twig.next_sibling;
        }
        let mut child = piece.first_child;
        while let Some(index) = child {
            borne.add(&articulated[index as usize]);
            child = self.bodies[index as usize].next_sibling;
        }
        borne
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
