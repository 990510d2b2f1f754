//! Another individual of the same kind: every measure changed a little at random, as trees of one species differ.

use bevy::reflect::{GetPath, Reflect};
use rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use rand_distr::{Distribution, StandardNormal};

use super::fields::{Field, Kind, number, set_number};
use crate::setting::SettingError;

/// Variates beyond so many standard deviations are drawn again.
const FARTHEST: f64 = 2.0;
/// A value near 0 varies by this share of its range.
const SHARE_OF_RANGE: f64 = 0.02;
/// Channels of colours vary by this share of what measures do: more looks like another species.
const COLOUR_SHARE: f64 = 0.4;
/// How often the spread is halved until the result passes the check.
const MOST_TRIES: u32 = 8;

/// A value with all measures of `fields` changed by a normal variate with the standard deviation `spread`, as a share of the measure
/// (10% is what trees of one stand differ by), within their ranges. Counts, seeds, variants and words stay. None
/// where no such change passes the check.
pub fn randomised<T: Reflect + Clone>(
    value: &T,
    fields: &[&Field],
    spread: f64,
    seed: u64,
    check: impl Fn(&T) -> Result<(), SettingError>,
) -> Option<T> {
    let spreads = (0..MOST_TRIES).map(|halvings| spread * 0.5_f64.powi(halvings as i32));
    spreads.map(|spread| varied(value, fields, spread, seed)).find(|varied| check(varied).is_ok())
}

fn varied<T: Reflect + Clone>(value: &T, fields: &[&Field], spread: f64, seed: u64) -> T {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut varied = value.clone();
    for field in fields {
        let Ok(value) = varied.reflect_path_mut(field.path.as_str()) else { continue };
        match field.kind {
            Kind::Number => {
                let Some((now, range)) = number(value).zip(field.range.clone()) else { continue };
                let scale = now.abs().max(SHARE_OF_RANGE * (range.end() - range.start()).min(now.abs().max(1.0)));
                let wanted = now + spread * scale * variate(&mut random);
                set_number(value, wanted.clamp(*range.start(), *range.end()));
            }
            Kind::Colour => {
                let Some(channels) = value.try_downcast_mut::<[f32; 3]>() else { continue };
                let tone = spread * COLOUR_SHARE * variate(&mut random);
                for channel in channels {
                    let own = 0.5 * spread * COLOUR_SHARE * variate(&mut random);
                    *channel = (f64::from(*channel) * (1.0 + tone + own)).clamp(0.0, 1.0) as f32;
                }
            }
            Kind::Whole | Kind::Seed | Kind::Switch | Kind::Choice(_) | Kind::Direction | Kind::Text => {}
        }
    }
    varied
}

/// A standard normal variate that is not far out.
fn variate(random: &mut impl Rng) -> f64 {
    loop {
        let variate: f64 = StandardNormal.sample(random);
        if variate.abs() <= FARTHEST {
            return variate;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        editor::{field_table::fields_of, fields::all_fields},
        tree::Species,
    };

    const OAK: &str = include_str!("../../assets/species/oak.species.ron");

    fn oaks(spread: f64) -> (Species, Vec<Species>) {
        let oak = Species::from_ron(OAK).unwrap();
        let table = fields_of(&oak, Species::validate);
        let fields = all_fields(&table);
        let oaks = (0..200).map(|seed| randomised(&oak, &fields, spread, seed, Species::validate).unwrap());
        (oak.clone(), oaks.collect())
    }

    #[test]
    fn individuals_pass_the_check_and_have_the_spread() {
        let (oak, oaks) = oaks(0.1);
        let density = |oak: &Species| f64::from(oak.wood.density_kg_m3 / 1000.0);
        let mean = oaks.iter().map(density).sum::<f64>() / oaks.len() as f64;
        let deviation = (oaks.iter().map(|oak| (density(oak) - mean).powi(2)).sum::<f64>() / oaks.len() as f64).sqrt();
        // A normal variate cut off at 2 standard deviations has 0.88 of its own; some are of half the spread or less.
        assert!((mean - 1.0).abs() < 0.03 && (0.03..0.1).contains(&deviation), "{mean} +- {deviation}");
        for other in &oaks {
            assert!(other.validate().is_ok() && other != &oak);
            assert_eq!((other.variants, other.seed, &other.name), (oak.variants, oak.seed, &oak.name));
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_individual() {
        let (_, first) = oaks(0.1);
        assert_eq!(first, oaks(0.1).1);
        assert_ne!(first[0], first[1]);
    }

    #[test]
    fn no_spread_changes_nothing() {
        let (oak, oaks) = oaks(0.0);
        assert!(oaks.iter().all(|other| *other == oak));
    }
}
