//! Four signals that stand for the wind's load on a beam of any direction.
//!
//! The load on a beam depends on its direction `d` through the normal velocity `u_n = u - (u.d) d`; for quadratic drag
//! it is `q_d(t) = |u_n| u_n` (eq. 15 per unit length, without its constants). Solving each branch's own oscillator
//! would cost as much as there are branches, so the load is written in few signals `y_k`, shared by all:
//!
//! ```text
//! q_d(t) ~ mean(d) + sum_{k < 4} c_k(d) y_k(t)
//! ```
//!
//! The equation of motion (21) is linear, so the same sum holds for the responses. Two choices of the signals:
//!
//! - [`LoadBasisKind::OrthogonalBeams`], the paper's interpolation (25): the signals are the three components of
//!   `q_X + q_Y + q_Z`, the loads of three orthogonal beams, and the coefficients project them across `d`. As printed it
//!   counts each axis twice (an axis is normal to two of the three beams); `halved` divides by two, which is exact
//!   for a drag linear in the velocity, and leaves some 30% of error for the quadratic one.
//! - [`LoadBasisKind::Principal`]: the four principal components of the loads of a spread of directions. Over directions
//!   the loads' covariance has a rank of hardly more than four (some 3% are left at a turbulence intensity of 0.2), and
//!   four fill one vec4. Rejected: drag linearised about the mean wind (three signals, 16%).

use super::direction_map::{DirectionMap, LoadCoefficients};
use bevy::math::{Vec3, Vec4};
use bevy::reflect::Reflect;
use nalgebra::{DMatrix, SymmetricEigen};
use serde::{Deserialize, Serialize};

/// Number of basis signals: as many as fill one vec4 of the response table.
const BASIS_RANK: usize = 4;

/// Directions whose loads the principal components are taken from, spread evenly over a hemisphere: more
/// than ten times as many load components as there are signals to be found.
const TRAINING_DIRECTIONS: usize = 48;
/// Velocities at which the statistics are taken; these bound the time that building a basis takes.
const STATISTICS_SAMPLES: usize = 1024;
/// Texels a side of the map of regressed coefficients; the one looked up has twice as many.
const REGRESSED_MAP_SIZE: usize = 65;
/// A principal component this small beside the greatest is rounding, not load.
const NEGLIGIBLE_VARIANCE: f64 = 1e-10;

/// Which signals stand for the load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum LoadBasisKind {
    /// The loads of three orthogonal beams (eq. 25 of Setas et al.).
    OrthogonalBeams {
        /// Whether the sum is divided by two. The paper prints it undivided, which doubles every response.
        halved: bool,
    },
    /// The four principal components of the load over all directions.
    #[default]
    Principal,
}

/// The basis signals as a function of the wind's velocity, and each direction's coefficients.
pub struct LoadBasis {
    kind: LoadBasisKind,
    signals: Box<dyn Fn(Vec3) -> Vec4 + Send + Sync>,
    map: DirectionMap,
}

impl LoadBasis {
    /// Builds a basis for the wind of which `velocities` (m/s, wind coordinates) are a sample: all columns, one after
    /// the other, or one. The statistics use at most 1024 of them, evenly spread. `load(velocity, direction)` is
    /// the load on a beam in m^2/s^2, perpendicular to its direction, such as `|u_n| u_n`.
    ///
    /// Velocities and loads that are not finite count as calm. In a calm all signals and coefficients are zero.
    pub fn new(
        kind: LoadBasisKind,
        velocities: &[Vec3],
        load: impl Fn(Vec3, Vec3) -> Vec3 + Send + Sync + 'static,
    ) -> Self {
        let load = move |velocity, direction| finite_or_zero(load(finite_or_zero(velocity), direction));
        let sample = spread_sample(velocities, STATISTICS_SAMPLES);
        match kind {
            LoadBasisKind::OrthogonalBeams { halved } => Self::orthogonal_beams(halved, &sample, load),
            LoadBasisKind::Principal => Self::principal(&sample, load),
        }
    }

    /// The basis signals' moving part for one velocity, m/s in wind coordinates.
    pub fn signals(&self, velocity: Vec3) -> Vec4 {
        (self.signals)(velocity)
    }

    /// The coefficients of a beam's direction, a unit vector in wind coordinates, from the nearest texel: exactly what
    /// the GPU reads.
    pub fn coefficients(&self, direction: Vec3) -> LoadCoefficients {
        self.map.coefficients(direction)
    }

    /// The coefficients of all directions.
    pub fn map(&self) -> &DirectionMap {
        &self.map
    }

    fn orthogonal_beams(
        halved: bool,
        sample: &[Vec3],
        load: impl Fn(Vec3, Vec3) -> Vec3 + Send + Sync + 'static,
    ) -> Self {
        let sum = move |velocity| Vec3::AXES.map(|axis| load(velocity, axis)).into_iter().sum::<Vec3>();
        let mean = mean(sample.iter().map(|&velocity| sum(velocity)));
        let factor = if halved { 0.5 } else { 1.0 };
        let across = LoadCoefficients {
            mean: factor * mean,
            moving: [factor * Vec3::X, factor * Vec3::Y, factor * Vec3::Z, Vec3::ZERO],
        };
        Self {
            kind: LoadBasisKind::OrthogonalBeams { halved },
            signals: Box::new(move |velocity| (sum(velocity) - mean).extend(0.0)),
            map: DirectionMap::new(REGRESSED_MAP_SIZE, |direction| across.perpendicular_to(direction)).refined(),
        }
    }

    fn principal(sample: &[Vec3], load: impl Fn(Vec3, Vec3) -> Vec3 + Send + Sync + 'static) -> Self {
        let projection = PrincipalProjection::new(sample, &load);
        let signals: Vec<Vec4> = sample.iter().map(|&velocity| projection.signals(velocity, &load)).collect();
        let map = DirectionMap::new(REGRESSED_MAP_SIZE, |direction| {
            regress(&signals, sample.iter().map(|&velocity| load(velocity, direction)))
        });
        Self {
            kind: LoadBasisKind::Principal,
            signals: Box::new(move |velocity| projection.signals(velocity, &load)),
            map: map.refined(),
        }
    }
}

impl std::fmt::Debug for LoadBasis {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("LoadBasis").field("kind", &self.kind).finish_non_exhaustive()
    }
}

/// The linear functionals that turn the loads of the training directions into four uncorrelated signals of variance 1.
struct PrincipalProjection {
    directions: Vec<Vec3>,
    /// Weights of the x, y and z components of each direction's load.
    weights: Vec<[Vec4; 3]>,
    /// The signals of the mean load.
    offset: Vec4,
}

impl PrincipalProjection {
    fn new(sample: &[Vec3], load: &impl Fn(Vec3, Vec3) -> Vec3) -> Self {
        let directions = hemisphere(TRAINING_DIRECTIONS);
        let loads = weighted_loads(sample, &directions, load);
        let covariance = loads.matrix.tr_mul(&loads.matrix) / sample.len().max(1) as f64;
        let functionals = leading_functionals(covariance);
        let weights: Vec<[Vec4; 3]> = loads
            .scales
            .iter()
            .enumerate()
            .map(|(d, &scale)| [0, 1, 2].map(|axis| weight(&functionals, 3 * d + axis, scale)))
            .collect();
        let offset = project(&weights, loads.means.iter().copied());
        Self { directions, weights, offset }
    }

    fn signals(&self, velocity: Vec3, load: &impl Fn(Vec3, Vec3) -> Vec3) -> Vec4 {
        project(&self.weights, self.directions.iter().map(|&direction| load(velocity, direction))) - self.offset
    }
}

fn weight(functionals: &[Vec<f64>; BASIS_RANK], row: usize, scale: f64) -> Vec4 {
    Vec4::from_array(std::array::from_fn(|k| (functionals[k][row] * scale) as f32))
}

fn project(weights: &[[Vec4; 3]], loads: impl Iterator<Item = Vec3>) -> Vec4 {
    weights.iter().zip(loads).map(|(w, load)| w[0] * load.x + w[1] * load.y + w[2] * load.z).sum()
}

/// The moving loads of the training directions, one row a sample, three columns a direction.
struct WeightedLoads {
    matrix: DMatrix<f64>,
    /// What each direction's load was multiplied by.
    scales: Vec<f64>,
    means: Vec<Vec3>,
}

/// Beams nearly along the mean wind carry little load, and if all loads counted in proportion to their variance, the
/// relative error of theirs would be great. Each direction's load is divided by the root of its standard deviation:
/// at a turbulence intensity of 0.2 that leaves a median error of 2.9% and a 95th percentile of 18.5%; the loads as they
/// are leave 2.7% and 19.5%, and those of unit deviation 3.5% and 18.2%.
fn weighted_loads(sample: &[Vec3], directions: &[Vec3], load: &impl Fn(Vec3, Vec3) -> Vec3) -> WeightedLoads {
    let mut matrix = DMatrix::zeros(sample.len(), 3 * directions.len());
    let mut scales = Vec::with_capacity(directions.len());
    let mut means = Vec::with_capacity(directions.len());
    for (d, &direction) in directions.iter().enumerate() {
        let loads: Vec<Vec3> = sample.iter().map(|&velocity| load(velocity, direction)).collect();
        let mean = mean(loads.iter().copied());
        let variance =
            loads.iter().map(|&q| f64::from((q - mean).length_squared())).sum::<f64>() / sample.len().max(1) as f64;
        let scale = if variance > 0.0 { variance.powf(-0.25) } else { 0.0 };
        for (row, &q) in loads.iter().enumerate() {
            for axis in 0..3 {
                matrix[(row, 3 * d + axis)] = f64::from(q[axis] - mean[axis]) * scale;
            }
        }
        scales.push(scale);
        means.push(mean);
    }
    WeightedLoads { matrix, scales, means }
}

/// The four eigenvectors of greatest variance, divided by their standard deviation; zero where there is no variance.
fn leading_functionals(covariance: DMatrix<f64>) -> [Vec<f64>; BASIS_RANK] {
    let eigen = SymmetricEigen::new(covariance);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let negligible = NEGLIGIBLE_VARIANCE * eigen.eigenvalues[order[0]].max(f64::MIN_POSITIVE);
    std::array::from_fn(|k| {
        let variance = eigen.eigenvalues[order[k]];
        let scale = if variance > negligible { variance.sqrt().recip() } else { 0.0 };
        eigen.eigenvectors.column(order[k]).iter().map(|weight| weight * scale).collect()
    })
}

/// Least squares of the loads on the signals. The signals being uncorrelated and of variance 1 (or zero), the normal
/// equations are solved already.
fn regress(signals: &[Vec4], loads: impl Iterator<Item = Vec3>) -> LoadCoefficients {
    let mut sum = LoadCoefficients::default();
    for (signal, load) in signals.iter().zip(loads) {
        sum.mean += load;
        for (moving, k) in sum.moving.iter_mut().zip(0..BASIS_RANK) {
            *moving += load * signal[k];
        }
    }
    let share = 1.0 / signals.len().max(1) as f32;
    LoadCoefficients { mean: sum.mean * share, moving: sum.moving.map(|moving| moving * share) }
}

/// At most `count` of the velocities, evenly spread by the golden section, whose steps never line up with the length of a column.
fn spread_sample(velocities: &[Vec3], count: usize) -> Vec<Vec3> {
    if velocities.len() <= count {
        return velocities.to_vec();
    }
    let place = |index: usize| (index as f64 * GOLDEN_SECTION).fract() * velocities.len() as f64;
    (0..count).map(|index| velocities[place(index) as usize]).collect()
}

/// `count` directions evenly spread over the upper hemisphere (a Fibonacci lattice).
fn hemisphere(count: usize) -> Vec<Vec3> {
    let direction = |index: usize| {
        let height = (index as f32 + 0.5) / count as f32;
        let azimuth = (std::f64::consts::TAU * (index as f64 * GOLDEN_SECTION).fract()) as f32;
        let radius = (1.0 - height * height).sqrt();
        Vec3::new(radius * azimuth.cos(), height, radius * azimuth.sin())
    };
    (0..count).map(direction).collect()
}

/// 2 / (1 + sqrt 5): multiples of it fill a circle most evenly.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_895;

fn mean(values: impl ExactSizeIterator<Item = Vec3>) -> Vec3 {
    let count = values.len().max(1) as f64;
    let sum = values.map(Vec3::as_dvec3).sum::<bevy::math::DVec3>();
    (sum / count).as_vec3()
}

fn finite_or_zero(value: Vec3) -> Vec3 {
    if value.is_finite() { value } else { Vec3::ZERO }
}

#[cfg(test)]
mod tests;
