//! Trees as space frames: rods with six freedoms a node, by finite elements. An oracle for `tree::mechanics`, which it shares
//! no formula with.
//!
//! `element` has the stiffness of a rod, `tree_matrix` solves, `modes` finds natural frequencies and `peaks` what they are together,
//! `of_tree` makes a frame of a skeleton, `closed_forms` checks all of it.

pub mod closed_forms;
pub mod element;
pub mod modes;
pub mod of_tree;
pub mod peaks;
pub mod tree_matrix;

use element::{Matrix12, Rod, elastic, geometric, geometric_arm, rigid};
use nalgebra::{Matrix6, SMatrix, Vector3, Vector6};
use tree_matrix::{TreeFactor, TreeMatrix};

/// Stiffness of what does not give, N/m and N m/rad.
const RIGID: f64 = 1e14;

/// Rods that branch but never meet again, with lumps of mass and drag on rigid arms.
#[derive(Default)]
pub struct Frame {
    nodes: Vec<Node>,
    pub lumps: Vec<Lump>,
}

struct Node {
    at: Vector3<f64>,
    /// What holds it to the ground.
    ground: Matrix6<f64>,
    /// The rod that it ends.
    link: Option<Link>,
}

struct Link {
    parent: usize,
    start: Vector3<f64>,
    rod: Rod,
    /// Whether weight pulls it over.
    is_weighed: bool,
}

/// A mass with drag, held by a node.
pub struct Lump {
    pub node: usize,
    pub at: Vector3<f64>,
    pub mass_kg: f64,
    /// Force for a wind pressure |u|u of 1 m^2/s^2, kg/m.
    pub drag_kg_m: f64,
}

impl Frame {
    /// A node on the ground that gives nothing but a turn about the horizontal axes, for the moment `rocking_nm_rad`; by
    /// `None` not even that.
    pub fn stand(&mut self, at: Vector3<f64>, rocking_nm_rad: Option<f64>) -> usize {
        let rocking = rocking_nm_rad.unwrap_or(RIGID);
        let ground = Matrix6::from_diagonal(&Vector6::new(RIGID, RIGID, RIGID, rocking, RIGID, rocking));
        self.push(Node { at, ground, link: None })
    }

    /// A rod from `start`, fixed to the node `from`, to a new node at `end`. Weight pulls it over.
    pub fn extend(&mut self, from: usize, start: Vector3<f64>, end: Vector3<f64>, rod: Rod) -> usize {
        let link = Link { parent: from, start, rod, is_weighed: true };
        self.push(Node { at: end, ground: Matrix6::zeros(), link: Some(link) })
    }

    /// Lets the weight of all beyond a rod's start act where the rod begins, as if it did not bend by it: for twigs, which
    /// would be too thin to stand as they are drawn.
    pub fn unweigh(&mut self, node: usize) {
        if let Some(link) = &mut self.nodes[node].link {
            link.is_weighed = false;
        }
    }

    fn push(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Stiffness, with what weight adds to it under a gravity of `gravity_m_s2`.
    pub fn stiffness(&self, gravity_m_s2: f64) -> TreeMatrix {
        let mut stiffness = self.matrix();
        let (masses, moments) = self.borne();
        // For each node the nearest below it, or itself, that weight moves.
        let mut bearers: Vec<usize> = Vec::with_capacity(self.nodes.len());
        for (index, node) in self.nodes.iter().enumerate() {
            stiffness.add(index, &node.ground);
            bearers.push(match &node.link {
                Some(link) if !link.is_weighed => bearers[link.parent],
                _ => index,
            });
            let Some(Link { parent, start, rod, is_weighed }) = &node.link else { continue };
            let (axis, middle) = (node.at - start, (node.at + start) / 2.0);
            let gravity_m_s2 = if *is_weighed { gravity_m_s2 } else { 0.0 };
            let weight_n = gravity_m_s2 * masses[index];
            let moment_nm = (moments[index] - masses[index] * middle).cross(&(-gravity_m_s2 * Vector3::y()));
            let element = elastic(&axis, rod) + geometric(&axis, weight_n, &moment_nm);
            add_element(&mut stiffness, index, *parent, &(start - self.nodes[*parent].at), &element);
        }
        for lump in &self.lumps {
            let bearer = bearers[lump.node];
            let mut block = Matrix6::zeros();
            let turn = geometric_arm(&(lump.at - self.nodes[bearer].at), gravity_m_s2 * lump.mass_kg);
            block.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
            stiffness.add(bearer, &block);
        }
        stiffness
    }

    pub fn factor(&self, gravity_m_s2: f64) -> TreeFactor {
        self.stiffness(gravity_m_s2).factorise()
    }

    pub fn mass(&self) -> TreeMatrix {
        let mut mass = self.matrix();
        for lump in &self.lumps {
            let motion = self.motion_at(lump.node, &lump.at);
            mass.add(lump.node, &(lump.mass_kg * motion.transpose() * motion));
        }
        mass
    }

    /// Forces on the lumps as forces and moments on the nodes.
    pub fn load(&self, force_n: impl Fn(&Lump) -> Vector3<f64>) -> Vec<Vector6<f64>> {
        let mut load = vec![Vector6::zeros(); self.nodes.len()];
        for lump in &self.lumps {
            load[lump.node] += self.motion_at(lump.node, &lump.at).tr_mul(&force_n(lump));
        }
        load
    }

    /// A force at a node.
    pub fn load_at(&self, node: usize, force_n: Vector3<f64>) -> Vec<Vector6<f64>> {
        let mut load = vec![Vector6::zeros(); self.nodes.len()];
        load[node].fixed_rows_mut::<3>(0).copy_from(&force_n);
        load
    }

    /// Displacement of a place that is fixed to a node, m.
    pub fn displacement(&self, motions: &[Vector6<f64>], node: usize, at: &Vector3<f64>) -> Vector3<f64> {
        self.motion_at(node, at) * motions[node]
    }

    pub fn place(&self, node: usize) -> Vector3<f64> {
        self.nodes[node].at
    }

    /// Mass that is held by each node and all beyond it, kg, and its first moment, kg m.
    pub fn borne(&self) -> (Vec<f64>, Vec<Vector3<f64>>) {
        let (mut masses, mut moments) = (vec![0.0; self.node_count()], vec![Vector3::zeros(); self.node_count()]);
        for lump in &self.lumps {
            masses[lump.node] += lump.mass_kg;
            moments[lump.node] += lump.mass_kg * lump.at;
        }
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let Some(link) = &node.link else { continue };
            let (mass, moment) = (masses[index], moments[index]);
            masses[link.parent] += mass;
            moments[link.parent] += moment;
        }
        (masses, moments)
    }

    fn matrix(&self) -> TreeMatrix {
        TreeMatrix::zeros(self.nodes.iter().map(|node| node.link.as_ref().map(|link| link.parent)).collect())
    }

    fn motion_at(&self, node: usize, at: &Vector3<f64>) -> SMatrix<f64, 3, 6> {
        rigid(&(at - self.nodes[node].at)).fixed_rows::<3>(0).into_owned()
    }
}

/// Adds a rod's stiffness. Its start is `arm` away from its parent node.
fn add_element(matrix: &mut TreeMatrix, node: usize, parent: usize, arm: &Vector3<f64>, element: &Matrix12) {
    let arm = rigid(arm);
    let block = |row, column| element.fixed_view::<6, 6>(row, column).into_owned();
    matrix.add(node, &block(6, 6));
    matrix.add_to_parent(node, &(block(6, 0) * arm));
    matrix.add(parent, &(arm.transpose() * block(0, 0) * arm));
}
