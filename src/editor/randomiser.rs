//! Another individual of a species that is edited.

use super::{fields::all_fields, file_session::Message, randomise::randomised, session::Session, steps::Steps};
use crate::tree::Species;

/// Trees of one stand differ by about this share in each measure.
pub const NATURAL_SPREAD: f64 = 0.1;

/// How a species is randomised.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Randomiser {
    /// Whether it leaves the seed of the individuals.
    pub is_seed_locked: bool,
    /// How often it was done: each time with another seed.
    times: u64,
}

impl Default for Randomiser {
    fn default() -> Self {
        Self { is_seed_locked: true, times: 0 }
    }
}

impl Randomiser {
    /// Another individual of the kind: see [`randomised`].
    pub fn randomise(&mut self, session: &mut Session<Species>) {
        self.times += 1;
        let fields = all_fields(session.table());
        let species = randomised(session.document(), &fields, NATURAL_SPREAD, self.times, Species::validate);
        let Some(mut species) = species else {
            session.message = Some(Message::Failed("No other individual passes the checks".into()));
            return;
        };
        if !self.is_seed_locked {
            species.seed = species.seed.wrapping_add(self.times);
        }
        session.change(species, "Randomise");
        session.end_gesture();
    }
}
