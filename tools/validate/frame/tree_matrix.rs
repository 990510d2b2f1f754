//! Symmetric matrices that couple each node of a tree with its parent alone, and their exact factors.
//!
//! Eliminated from the tips to the root, such a matrix `K = L D L^T` fills no new block: the work grows with the number of
//! nodes.

use nalgebra::{Matrix6, Vector6};

/// A matrix in blocks of six freedoms a node. Parents come before their children.
pub struct TreeMatrix {
    parents: Vec<Option<usize>>,
    diagonal: Vec<Matrix6<f64>>,
    /// The block of a node's row and its parent's column.
    to_parent: Vec<Matrix6<f64>>,
}

/// The factors of a [`TreeMatrix`].
pub struct TreeFactor {
    parents: Vec<Option<usize>>,
    /// Inverses of the pivots, blocks of `D`.
    inverses: Vec<Matrix6<f64>>,
    /// Pivot's inverse times the block to the parent: the part of `L^T`.
    to_parent: Vec<Matrix6<f64>>,
}

impl TreeMatrix {
    pub fn zeros(parents: Vec<Option<usize>>) -> Self {
        let blocks = vec![Matrix6::zeros(); parents.len()];
        Self { parents, diagonal: blocks.clone(), to_parent: blocks }
    }

    pub fn add(&mut self, node: usize, block: &Matrix6<f64>) {
        self.diagonal[node] += block;
    }

    pub fn add_to_parent(&mut self, node: usize, block: &Matrix6<f64>) {
        self.to_parent[node] += block;
    }

    pub fn times(&self, vector: &[Vector6<f64>]) -> Vec<Vector6<f64>> {
        let mut product: Vec<_> = self.diagonal.iter().zip(vector).map(|(block, value)| block * value).collect();
        for (node, parent) in self.parents.iter().enumerate() {
            let Some(parent) = *parent else { continue };
            product[node] += self.to_parent[node] * vector[parent];
            product[parent] += self.to_parent[node].tr_mul(&vector[node]);
        }
        product
    }

    pub fn factorise(mut self) -> TreeFactor {
        let mut inverses = vec![Matrix6::zeros(); self.parents.len()];
        for node in (0..self.parents.len()).rev() {
            inverses[node] = self.diagonal[node].try_inverse().expect("every node is held by something");
            let Some(parent) = self.parents[node] else { continue };
            let eliminated = inverses[node] * self.to_parent[node];
            self.diagonal[parent] -= self.to_parent[node].tr_mul(&eliminated);
            self.to_parent[node] = eliminated;
        }
        TreeFactor { parents: self.parents, inverses, to_parent: self.to_parent }
    }
}

impl TreeFactor {
    pub fn solve(&self, load: &[Vector6<f64>]) -> Vec<Vector6<f64>> {
        let mut solution = load.to_vec();
        for node in (0..solution.len()).rev() {
            let carried = self.to_parent[node].tr_mul(&solution[node]);
            if let Some(parent) = self.parents[node] {
                solution[parent] -= carried;
            }
        }
        for node in 0..solution.len() {
            let alone = self.inverses[node] * solution[node];
            solution[node] = match self.parents[node] {
                Some(parent) => alone - self.to_parent[node] * solution[parent],
                None => alone,
            };
        }
        solution
    }

    /// Number of negative eigenvalues of the matrix, which is that of its pivots (Sylvester's law of inertia).
    pub fn negative_eigenvalues(&self) -> usize {
        let negative = |inverse: &Matrix6<f64>| {
            let symmetric = (inverse + inverse.transpose()) / 2.0;
            symmetric.symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count()
        };
        self.inverses.iter().map(negative).sum()
    }
}

pub fn dot(a: &[Vector6<f64>], b: &[Vector6<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
