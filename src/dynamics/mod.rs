//! How a beam responds to a load: pure functions of plain data, without the engine's entities.
//!
//! The path from the wind to a moving branch, after section 3.2 of Setas, Gomes & Rebordão, "Dynamic Simulation of
//! Natural Environments in Virtual Reality" (equation numbers in this room are that paper's):
//!
//! 1. `load_basis`: four signals stand for the wind's load on a beam of *any* direction, in place of the three orthogonal
//!    beams of (25). `direction_map` holds the coefficients of each direction.
//! 2. `oscillator_grid`: some hundred oscillators that stand for those of all beams: `frequency_classes`, rounded to some
//!    thirty, sizes of what a beam carries, which average gusts (`admittance`), and damping ratios.
//! 3. `response`: the responses of these oscillators (21) to the signals, as one table, by `periodic_filter`. Beams above 3.6 Hz
//!    follow slow gusts, and ring in fast ones, which all places share. `table_place` reads it.
//! 4. `beam`: how a beam answers a wind: by how much at its height (`mean_wind`) and in its stand (`stand_wind`), and as which
//!    oscillators.
//! 5. `pose`: a tree's bent beams, each attached to its parent, from the table. `bend` is the shape of one of them, `lanes` has the
//!    numbers of several side by side.
//! 6. `leaf`: leaves that turn into the wind and flutter (26).
//! 7. `exact_step`: one oscillator, step by step, for motion that is not periodic. `live`: trees that a game touches move by it, beside
//!    the table.
//!
//! Steps 1 to 3 happen once for a wind, step 4 once for a tree in a wind, steps 5 and 6 in every frame. Since (21) is linear, a branch costs a few
//! multiplications, whatever its frequency and its place in the tree. The closed forms that all this is checked against
//! (18 to 24) are in `oracle`, for tests alone.
//!
//! Lengths are in metres, times in seconds. *Wind coordinates* are (along, up, across): along the mean wind, the world's
//! up, and along x up.

pub(crate) mod admittance;
pub(crate) mod beam;
pub(crate) mod beam_pose;
pub(crate) mod bend;
pub(crate) mod direction_map;
mod exact_step;
pub(crate) mod frequency_classes;
mod lanes;
pub(crate) mod leaf;
pub(crate) mod live;
pub(crate) mod load_basis;
pub(crate) mod mean_wind;
#[cfg(test)]
mod oracle;
pub(crate) mod oscillator_grid;
mod periodic_filter;
pub(crate) mod pose;
pub(crate) mod response;
pub(crate) mod second_mode;
pub(crate) mod stand_wind;
pub(crate) mod table_place;
#[cfg(test)]
pub(crate) mod test_beams;

pub use admittance::{admittance, equivalent_size_m};
pub use beam::{BeamAnswer, BeamDynamics, BeamSway, BeamWind, DRAG_SPEED_M_S, NO_PARENT};
pub use beam_pose::BeamPose;
pub use bend::{MODE_SHAPE, SLOPE_TIP};
pub use direction_map::{DirectionMap, LoadCoefficients};
pub use exact_step::{ExactStep, OscillatorState};
pub use frequency_classes::FrequencyClasses;
pub use leaf::{LeafResponse, RestingLeaf};
pub use live::{BeamLoad, Capsule, Contacts, LiveBeam, LiveSteps, LiveTree, SweptCapsule, strike};
pub use load_basis::{LoadBasis, LoadBasisKind};
pub use mean_wind::MeanWind;
pub use oscillator_grid::{OscillatorGrid, RowWeights};
pub use pose::{TIP_ANGLE_LIMIT, TreeInWind, TreePoser};
pub use response::ResponseTable;
pub use second_mode::SecondMode;
pub use stand_wind::{Speeds, StandWind};
pub use table_place::TablePlace;
