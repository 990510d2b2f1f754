//! What whole trees do in the wind beside what others have measured: frequencies, damping, how loads grow, how far trees lean.

use crate::report::Report;
use bevy::math::{Mat3, Vec3};
use bevy_windwood::{
    dynamics::{BeamPose, BeamSway, TreeInWind, TreePoser},
    sway::{SwaySettings, WindResponse},
    tree::{Species, TreeModel},
    wind::{FieldSettings, WindField},
};
use serde::Deserialize;
use std::sync::Arc;

const MEASURED_BY_OTHERS: &str = include_str!("measured_by_others.ron");
/// Speeds at which trees are shown, m/s.
const SPEEDS_M_S: [f32; 4] = [5.0, 10.0, 15.0, 25.0];
/// Between these load exponents are taken, m/s: trees were measured in such winds.
const EXPONENT_SPEEDS_M_S: [f32; 2] = [6.0, 14.0];
const DAMPING_SPEED_M_S: f32 = 10.0;
const SPECIES: [&str; 8] = ["oak", "beech", "birch", "maple", "fir", "norway_spruce", "scots_pine", "larch"];
const SEED: u64 = 1;

/// A figure of a tree.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
enum Quantity {
    FrequencyHz,
    FrequencyInLeafByBare,
    LoadExponentInLeaf,
    LoadExponentBare,
    /// Frontal area at 20 m/s over that in a calm.
    AreaKeptAt20,
    DampingInLeaf,
    DampingBare,
}

/// A published range.
#[derive(Deserialize)]
struct Published {
    what: Quantity,
    species: String,
    low: f64,
    high: f64,
    source: String,
    confirmed: bool,
}

/// A mature tree, and winds.
struct Tree<'a> {
    model: TreeModel,
    winds: &'a [(f32, WindResponse)],
}

/// Adds the figures to those of the topic `trees`.
pub fn run(report: &mut Report, shipped: impl Fn(&str) -> Result<Species, String>) {
    let (published, winds) = match (ron::from_str::<Vec<Published>>(MEASURED_BY_OTHERS), winds()) {
        (Ok(published), Ok(winds)) => (published, winds),
        (Err(error), _) => return failed(report, &error.to_string()),
        (_, Err(error)) => return failed(report, &error),
    };
    let (mut confirmed_outside, mut unconfirmed_outside) = (0, 0);
    println!(
        "  species          Hz leaf  bare   damping leaf  bare   lean of the tip at 5, 10, 15, 25 m/s, degrees, and top downwind, heights"
    );
    for name in SPECIES {
        let species = match shipped(name) {
            Ok(species) => species,
            Err(error) => return failed(report, &error),
        };
        let tree = Tree { model: TreeModel::bake(&species, species.age.mature_years, SEED), winds: &winds };
        tree.print(name);
        for range in published.iter().filter(|range| range.species == name) {
            let value = tree.figure(range.what);
            let inside = (range.low..=range.high).contains(&value);
            let standing = if range.confirmed { "measured by others" } else { "unconfirmed" };
            println!(
                "    {:<22} {value:.3} in {:.2} to {:.2}: {}  ({standing}: {})",
                format!("{:?}", range.what),
                range.low,
                range.high,
                if inside { "inside" } else { "OUTSIDE" },
                range.source
            );
            *(if range.confirmed { &mut confirmed_outside } else { &mut unconfirmed_outside }) += i32::from(!inside);
        }
    }
    let note = "figures of shipped trees outside of what others have measured";
    report.at_most("outside_published_ranges", f64::from(confirmed_outside), 0.0, note);
    report.record("outside_unconfirmed_ranges", f64::from(unconfirmed_outside), "the same for unconfirmed ranges");
}

fn failed(report: &mut Report, error: &str) {
    eprintln!("trees: {error}");
    report.at_most("outside_published_ranges", f64::NAN, 0.0, "could not be measured");
}

/// The wind of every speed that is looked at, over open country.
fn winds() -> Result<Vec<(f32, WindResponse)>, String> {
    let speeds = SPEEDS_M_S.into_iter().chain(EXPONENT_SPEEDS_M_S).chain([1.0, 20.0]);
    let wind = |speed: f32| {
        let field = WindField::synthesise(&FieldSettings { speed, ..Default::default() }).map_err(|e| e.to_string())?;
        Ok((speed, WindResponse::new(Arc::new(field), &SwaySettings::default())))
    };
    speeds.map(wind).collect()
}

impl Tree<'_> {
    fn wind(&self, speed_m_s: f32) -> &WindResponse {
        let found = self.winds.iter().find(|(speed, _)| *speed == speed_m_s);
        &found.expect("every speed has a wind").1
    }

    fn trunk(&self, is_in_leaf: bool) -> &BeamSway {
        let beam = &self.model.beams[0];
        if is_in_leaf { &beam.in_leaf } else { &beam.bare }
    }

    fn frequency_hz(&self, is_in_leaf: bool) -> f64 {
        let classes = self.winds[0].1.table.grid.classes;
        f64::from(classes.frequency_at_hz(self.trunk(is_in_leaf).class))
    }

    fn damping(&self, is_in_leaf: bool) -> f64 {
        f64::from(self.trunk(is_in_leaf).damping_ratio(&self.wind(DAMPING_SPEED_M_S).beam_wind(), 1.0))
    }

    /// Load of the mean wind on the trunk, up to a factor.
    fn load(&self, is_in_leaf: bool, speed_m_s: f32) -> f64 {
        let answer = self.trunk(is_in_leaf).answer(&self.wind(speed_m_s).beam_wind(), 1.0);
        f64::from(answer.mean_gain) * f64::from(speed_m_s).powi(2)
    }

    fn exponent(&self, is_in_leaf: bool) -> f64 {
        let [slow, fast] = EXPONENT_SPEEDS_M_S;
        (self.load(is_in_leaf, fast) / self.load(is_in_leaf, slow)).ln() / f64::from(fast / slow).ln()
    }

    fn figure(&self, what: Quantity) -> f64 {
        match what {
            Quantity::FrequencyHz => self.frequency_hz(true),
            Quantity::FrequencyInLeafByBare => self.frequency_hz(true) / self.frequency_hz(false),
            Quantity::LoadExponentInLeaf => self.exponent(true),
            Quantity::LoadExponentBare => self.exponent(false),
            Quantity::AreaKeptAt20 => self.load(true, 20.0) / self.load(true, 1.0) / 400.0,
            Quantity::DampingInLeaf => self.damping(true),
            Quantity::DampingBare => self.damping(false),
        }
    }

    /// In the mean wind: by how many degrees the tip of the main stem is turned, and how far it is downwind, in heights.
    fn lean(&self, speed_m_s: f32) -> [f64; 2] {
        let wind = self.wind(speed_m_s);
        let (map, wind) = (wind.basis.map(), wind.beam_wind());
        let tree = TreeInWind { map, wind, to_wind: Mat3::IDENTITY, scale: 1.0, leaf_share: 1.0 };
        let mut poses = vec![BeamPose::REST; self.model.beams.len()];
        TreePoser::new(&self.model.beams, &tree).pose(&[], Vec3::X, &mut poses);
        // The last beam of the stem.
        let continuations = self.model.skeleton.continuations();
        let last = std::iter::successors(Some(0), |&beam| continuations[beam].map(|next| next as usize)).last();
        let rest = &self.model.beams[last.unwrap_or_default()];
        let tip = rest.base + rest.direction * rest.length_m;
        let (place, rotation) = poses[last.unwrap_or_default()].carry(rest, 1.0, tip);
        let turned = (rotation * rest.direction).angle_between(rest.direction).to_degrees();
        [f64::from(turned), f64::from((place - tip).x / self.model.height_m())]
    }

    fn print(&self, name: &str) {
        let leans = SPEEDS_M_S.map(|speed| self.lean(speed)).map(|[deg, share]| format!("{deg:.1} ({share:.3})"));
        println!(
            "  {name:<16} {:>6.2} {:>6.2} {:>12.3} {:>6.3}    {}",
            self.frequency_hz(true),
            self.frequency_hz(false),
            self.damping(true),
            self.damping(false),
            leans.join("  ")
        );
    }
}
