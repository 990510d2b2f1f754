//! What the finite elements say of a tree.

use super::GRAVITY_M_S2;
use crate::frame::{
    modes::{self, Mode},
    of_tree::{Place, TreeFrame},
};
use nalgebra::{Vector3, Vector6};

/// Roughness length for which the product weights loads by height, m, and the height at which the weight is 1.
pub const ROUGHNESS_M: f64 = 0.3;
pub const REFERENCE_HEIGHT_M: f64 = 10.0;

/// The modes of a node in a uniform wind.
pub fn modes(tree: &TreeFrame, node: usize, wind: Vector3<f64>) -> Vec<Mode> {
    modes::modes(&tree.frame, GRAVITY_M_S2, &wind_load(tree, wind), (node, wind))
}

/// The resonance of a node in a uniform wind: that of the greatest share, and that which moves it furthest in gusts.
pub fn strongest(modes: &[Mode]) -> [Mode; 2] {
    [modes::peak(modes), modes::gust_peak(modes)]
}

/// The frequency at which the node begins to resonate in a uniform wind, Hz.
pub fn onset_hz(tree: &TreeFrame, node: usize, wind: Vector3<f64>) -> f64 {
    modes::onset_hz(&tree.frame, GRAVITY_M_S2, &wind_load(tree, wind), (node, wind))
}

/// The load of a uniform wind pressure of 1 m^2/s^2 at the reference height.
fn wind_load(tree: &TreeFrame, wind: Vector3<f64>) -> Vec<Vector6<f64>> {
    tree.frame.load(|lump| wind * (lump.drag_kg_m * pressure_ratio(lump.at.y)))
}

/// The logarithmic law, squared.
fn pressure_ratio(height_m: f64) -> f64 {
    let log = |height_m: f64| (height_m / ROUGHNESS_M).max(1.0).ln();
    (log(height_m) / log(REFERENCE_HEIGHT_M)).powi(2)
}

/// How a frame moves under a uniform wind.
pub struct Motion(Vec<Vector6<f64>>);

impl Motion {
    pub fn of(tree: &TreeFrame, wind: Vector3<f64>, gravity_m_s2: f64) -> Self {
        Self(tree.frame.factor(gravity_m_s2).solve(&wind_load(tree, wind)))
    }

    /// The motion under a level wind from that under winds along x and z.
    pub fn combined([along_x, along_z]: &[Self; 2], wind: Vector3<f64>) -> Self {
        Self(along_x.0.iter().zip(&along_z.0).map(|(x, z)| x * wind.x + z * wind.z).collect())
    }

    pub fn deflection(&self, tree: &TreeFrame, place: Place) -> Vector3<f64> {
        tree.frame.displacement(&self.0, place.node, &tree.frame.place(place.node))
    }

    /// Deflection as seen from the root of the beam `first`.
    pub fn bend(&self, tree: &TreeFrame, first: usize, place: Place) -> Vector3<f64> {
        let root = tree.nodes[first][0].1;
        self.deflection(tree, place) - tree.frame.displacement(&self.0, root, &tree.frame.place(place.node))
    }
}
