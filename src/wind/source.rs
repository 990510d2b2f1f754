//! Winds that a game makes: what [`WindSource`](super::WindSource) blows, as plain formulas.
//!
//! Each kind is a published flow:
//!
//! | kind | flow | file |
//! |---|---|---|
//! | blast | a spherical shock wave in air (Kinney & Graham 1985) | `source/blast.rs` |
//! | downwash | the wake of a rotor, which turns into a jet along the ground | `source/downwash.rs` |
//! | cone | a round turbulent jet (Schlichting 1933) | `source/jet.rs` |
//! | vortex | a Lamb-Oseen vortex | `source/vortex.rs` |
//!
//! All but the blast, whose air is compressed, are free of divergence: as much air comes to any place as leaves it. Only at a nozzle, and
//! where a source ends, between 0.8 and 1 of its reach, that is not so.
//!
//! A [`SourceFlow`] is a source in one frame, in twelve numbers. Who asks for the velocity at a place needs nothing else:
//! `render/shaders/wind_sources.wesl` has the same formulas.

mod blast;
mod downwash;
mod jet;
mod smoothstep;
mod vortex;

use crate::setting::{SettingError, require};
use bevy::{
    math::{Quat, Vec3},
    reflect::Reflect,
};
use smoothstep::smoothstep;

/// What a source blows, and how strong.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub enum SourceKind {
    /// An explosion: a shock wave runs out from it, once. The air follows it, and comes back.
    Blast {
        /// Mass of TNT that has its energy, kg; 0.001 to 100,000. A hand grenade has 0.2, a large aerial bomb 400. Ten kilograms
        /// throw about twigs a few metres away. It takes hundreds to sway a tree, since the wind of a blast is short.
        charge_kg: f32,
    },
    /// A rotor that blows down, such as a helicopter's. Over the ground the air runs out to all sides. The tilt of the rotor is left out.
    Downwash {
        /// Radius of the rotor, m; 0.05 to 30.
        rotor_radius_m: f32,
        /// Thrust, N: of a hovering craft its weight. 0 to 1,000,000.
        thrust_n: f32,
        /// World height of the ground below, m.
        ground_m: f32,
    },
    /// A jet of air that widens to a cone about the entity's forward direction (-Z): a fan, a dragon's breath, an engine.
    Cone {
        /// Speed where it leaves the nozzle, m/s; 0 to 300.
        speed_m_s: f32,
        /// Radius of the nozzle, m; 0.01 to 20.
        nozzle_radius_m: f32,
        /// Half the angle of the cone in which it is faster than half as on its axis, degrees; 1 to 60. Free jets have 5.4.
        half_angle_deg: f32,
    },
    /// A vortex about the entity's +Y axis, which moves with the entity: a dust devil, the tip of a wing.
    Vortex {
        /// Greatest speed of the air around the axis, m/s; 0 to 150.
        speed_m_s: f32,
        /// Where that is at first, m from the axis; 0.05 to 100.
        core_radius_m: f32,
        /// How far it reaches along its axis, to both sides together, m; 0.1 to 1000.
        length_m: f32,
        /// Viscosity by which its core grows, m^2/s; 0 to 100. 0 keeps it as it is.
        spreading_m2_s: f32,
    },
}

/// A fan of 15 m/s.
impl Default for SourceKind {
    fn default() -> Self {
        Self::Cone { speed_m_s: 15.0, nozzle_radius_m: 0.5, half_angle_deg: 5.4 }
    }
}

impl SourceKind {
    /// Whether it is there at once and goes by itself.
    pub(super) fn is_sudden(&self) -> bool {
        matches!(self, Self::Blast { .. })
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        match *self {
            Self::Blast { charge_kg } => require("charge_kg", charge_kg, 0.001..=100_000.0),
            Self::Downwash { rotor_radius_m, thrust_n, ground_m } => {
                require("rotor_radius_m", rotor_radius_m, 0.05..=30.0)?;
                require("thrust_n", thrust_n, 0.0..=1e6)?;
                require("ground_m", ground_m, -1e6..=1e6)
            }
            Self::Cone { speed_m_s, nozzle_radius_m, half_angle_deg } => {
                require("speed_m_s", speed_m_s, 0.0..=300.0)?;
                require("nozzle_radius_m", nozzle_radius_m, 0.01..=20.0)?;
                require("half_angle_deg", half_angle_deg, 1.0..=60.0)
            }
            Self::Vortex { speed_m_s, core_radius_m, length_m, spreading_m2_s } => {
                require("speed_m_s", speed_m_s, 0.0..=150.0)?;
                require("core_radius_m", core_radius_m, 0.05..=100.0)?;
                require("length_m", length_m, 0.1..=1000.0)?;
                require("spreading_m2_s", spreading_m2_s, 0.0..=100.0)
            }
        }
    }
}

/// Which formula a flow follows. The shaders know them by these numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum FlowForm {
    Blast = 0,
    Downwash = 1,
    #[default]
    Jet = 2,
    Vortex = 3,
}

/// A source in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SourceFlow {
    pub form: FlowForm,
    /// Where it is, m; of a downwash on the ground.
    pub place: Vec3,
    /// Nothing blows farther from its place, m.
    pub reach_m: f32,
    /// Unit vector along a jet, or along the axis of a vortex.
    pub axis: Vec3,
    /// Its numbers: see the file of each form.
    pub numbers: [f32; 4],
    /// Time since the last frame, s.
    pub frame_s: f32,
}

/// From this share of its reach on a source fades out.
const FADES_FROM: f32 = 0.8;

/// When a source is looked at: its age now and one frame ago, s, and a factor on its speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SourceMoment {
    pub age_s: f32,
    pub before_s: f32,
    pub strength: f32,
}

impl SourceFlow {
    /// A source at a place; none where nothing of it blows any more.
    pub fn new(kind: &SourceKind, place: Vec3, rotation: Quat, reach_m: f32, at: SourceMoment) -> Option<Self> {
        if !(place.is_finite() && rotation.is_finite()) {
            return None;
        }
        let SourceMoment { age_s, before_s, strength } = at;
        let flow = |form, numbers| Self { form, place, reach_m, axis: Vec3::Y, numbers, frame_s: age_s - before_s };
        match *kind {
            SourceKind::Blast { charge_kg } => {
                let numbers = blast::numbers(charge_kg, [age_s, before_s], strength);
                let reach_m = reach_m.min(blast::most_reach_m(&numbers));
                let blast = Self { reach_m, ..flow(FlowForm::Blast, numbers) };
                (!blast::has_passed(&numbers, reach_m)).then_some(blast)
            }
            SourceKind::Downwash { rotor_radius_m, thrust_n, ground_m } => {
                let numbers = downwash::numbers(rotor_radius_m, thrust_n, place.y - ground_m, strength);
                Some(Self { place: place.with_y(ground_m), ..flow(FlowForm::Downwash, numbers) })
            }
            SourceKind::Cone { speed_m_s, nozzle_radius_m, half_angle_deg } => {
                let numbers = jet::numbers(speed_m_s * strength, nozzle_radius_m, half_angle_deg);
                let axis = (rotation * Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
                Some(Self { axis, ..flow(FlowForm::Jet, numbers) })
            }
            SourceKind::Vortex { speed_m_s, core_radius_m, length_m, spreading_m2_s } => {
                let numbers = vortex::numbers(speed_m_s * strength, core_radius_m, length_m, spreading_m2_s, age_s);
                let axis = (rotation * Vec3::Y).normalize_or(Vec3::Y);
                Some(Self { axis, ..flow(FlowForm::Vortex, numbers) })
            }
        }
    }

    /// As the shaders read it: place and reach, axis and form, numbers.
    #[cfg(feature = "render")]
    pub(crate) fn to_rows(self) -> [[f32; 4]; 3] {
        let form = self.form as u32 as f32;
        [self.place.extend(self.reach_m).to_array(), self.axis.extend(form).to_array(), self.numbers]
    }

    /// Velocity of its air at a place, m/s in world axes.
    pub fn velocity(&self, at: Vec3) -> Vec3 {
        let (numbers, axis, from) = (&self.numbers, self.axis, at - self.place);
        let share = from.length() / self.reach_m;
        let is_within = share < 1.0;
        if !is_within {
            return Vec3::ZERO;
        }
        let velocity = match self.form {
            FlowForm::Blast => blast::velocity(numbers, from),
            FlowForm::Downwash => downwash::velocity(numbers, from),
            FlowForm::Jet => jet::velocity(numbers, axis, from),
            FlowForm::Vortex => vortex::velocity(numbers, axis, from),
        };
        let velocity = velocity * (1.0 - smoothstep(FADES_FROM, 1.0, share));
        if velocity.is_finite() { velocity } else { Vec3::ZERO }
    }

    /// Whether it passes within milliseconds, and has to be looked at more than once a frame.
    pub fn is_pulse(&self) -> bool {
        self.form == FlowForm::Blast
    }

    /// The velocities of a pulse at a place since the last frame, each with the share of the frame for which it stands; none where it was
    /// not there.
    pub fn pulse(&self, at: Vec3) -> impl Iterator<Item = (Vec3, f32)> + use<> {
        let flow = *self;
        blast::fronts(&self.numbers, (at - self.place).length(), self.frame_s).map(move |(front_m, share)| {
            let then = Self { numbers: blast::with_front(&flow.numbers, front_m), ..flow };
            (then.velocity(at), share)
        })
    }

    /// Whether it blows at least so fast, m/s, somewhere in a ball.
    pub fn touches(&self, centre: Vec3, radius_m: f32, least_m_s: f32) -> bool {
        let from = centre - self.place;
        if from.length() - radius_m >= self.reach_m {
            return false;
        }
        let nearest = match self.form {
            FlowForm::Blast => return blast::touches(&self.numbers, from.length(), radius_m, least_m_s),
            FlowForm::Downwash => downwash::strongest_near(&self.numbers, from),
            FlowForm::Jet => self.axis * from.dot(self.axis).max(0.0),
            FlowForm::Vortex => vortex::strongest_near(&self.numbers, self.axis, from),
        };
        let there = centre + (nearest - from).clamp_length_max(radius_m);
        self.velocity(there).length() >= least_m_s || self.velocity(centre).length() >= least_m_s
    }
}

#[cfg(test)]
mod tests;
