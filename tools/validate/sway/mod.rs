//! How much trees sway, against direct integration in a wind that blows at every part of the crown.
//!
//! `wind` synthesises turbulence at up to 96 cells of a crown, each known by eight places, apart from the crate's own field. `crown`
//! has what each cell does to the trunk's tip, by finite elements. `oracle` sums the quadratic drag of all cells and steps
//! the trunk's oscillator, or both where it has two. `product` poses the same trunk from the product's tables.
//!
//! Both sides have the trunk's natural frequencies and damping in common, and the tip's deflection in a steady wind: how far trees
//! bend is the matter of the topic `skeleton`. What is compared is the motion before the poses saturate, along and across
//! the wind together, in the band from one cycle in the wind's period to 4 Hz.

mod bands;
mod crown;
mod oracle;
mod product;
mod wind;

use crate::{report::Report, trees::shipped};
use bands::{Bands, OCTAVES};
use bevy_windwood::{
    dynamics::{BeamWind, FrequencyClasses, MeanWind, OscillatorGrid, StandWind},
    sway::SwaySettings,
    wind::{FieldSettings, LogProfile},
};
use crown::Crown;
use oracle::{Oscillator, Trunk, linear_variances, simulate};
use rustfft::num_complex::Complex;
use std::{ops::Range, thread};
use wind::mean_speed_m_s;

const SPECIES: [&str; 4] = ["oak", "birch", "norway_spruce", "scots_pine"];
/// Ages as shares of the mature age.
const AGES: [f32; 3] = [0.25, 0.5, 1.0];
const SPEEDS_M_S: [f32; 4] = [4.0, 8.0, 12.0, 16.0];
/// Realisations of each side.
const SEEDS: u64 = 24;
/// Individual of each species.
const SWAY_SEED: u64 = 1;
/// Octaves with less of the variance than this are left out.
const LEAST_SHARE: f64 = 0.02;
/// Factor on the turbulence under which the linear theory is exact.
const WEAK: f32 = 0.05;
/// Speed of the steady wind in which both sides bend alike, m/s.
const STEADY_SPEED_M_S: f32 = 8.0;

pub fn run() -> Report {
    let mut report = Report::default();
    let crowns = match crowns() {
        Ok(crowns) => crowns,
        Err(error) => {
            eprintln!("{error}");
            report.at_most("tip_rms_error_worst", f64::NAN, 0.2, "could not be measured");
            return report;
        }
    };
    let trunks = trunks(&crowns);
    let speeds = SPEEDS_M_S.map(|speed| compare(&crowns, &trunks, &FieldSettings { speed, ..Default::default() }));
    let all: Vec<&Comparison> = speeds.iter().flatten().collect();
    println!("  tree                   m      Hz    m/s  tip cm  product   ratio  octaves  mean  one wind  static");
    for (index, crown) in crowns.iter().enumerate() {
        for (speed, comparisons) in SPEEDS_M_S.iter().zip(&speeds) {
            comparisons[index].print(crown, *speed);
        }
    }
    let mut errors: Vec<f64> = all.iter().map(|found| (found.rms_ratio() - 1.0).abs()).collect();
    errors.sort_by(f64::total_cmp);
    report.at_most(
        "tip_rms_error_median",
        errors[errors.len() / 2],
        0.1,
        "product over oracle, 12 trees at four speeds",
    );
    report.at_most("tip_rms_error_worst", errors[errors.len() - 1], 0.2, "the same");
    let octaves: Vec<f64> = all.iter().flat_map(|found| found.octave_errors()).collect();
    let rms = (octaves.iter().map(|error| error * error).sum::<f64>() / octaves.len() as f64).sqrt();
    report.at_most(
        "tip_spectrum_octave_error",
        rms,
        0.25,
        "ln of the ratio of rms in octaves above 2% of the power, rms",
    );
    let worst = octaves.iter().fold(0.0_f64, |worst, error| worst.max(error.abs()));
    report.record("tip_spectrum_octave_worst", worst, "the same, worst");
    let mean = all.iter().map(|found| (found.mean_ratio - 1.0).abs()).fold(0.0, f64::max);
    report.record("tip_mean_error_worst", mean, "mean deflection, product over oracle");
    report.record(
        "mature_oak_8_m_s_ratio",
        speeds[1][AGES.len() - 1].rms_ratio(),
        "rms of its tip, product over oracle",
    );
    linear_theory(&mut report, &crowns[AGES.len() - 1], &trunks[AGES.len() - 1]);
    report
}

fn crowns() -> Result<Vec<Crown>, String> {
    let mut crowns = Vec::new();
    for name in SPECIES {
        let species = shipped(name)?;
        crowns.extend(AGES.map(|age| Crown::of(name, &species, age * species.age.mature_years)));
    }
    Ok(crowns)
}

/// A trunk's oscillators, with the damping ratios that the product gives them in a wind.
fn oscillators(crown: &Crown, settings: &FieldSettings) -> [Oscillator; 2] {
    let profile = LogProfile::from_reference(settings.speed, settings.roughness_m, settings.displacement_m);
    let mean = MeanWind::new(&profile, 10.0);
    let structure = SwaySettings::default().damping_ratio;
    let grid = OscillatorGrid::new(FrequencyClasses::default(), structure, mean.speed_m_s, 10.0);
    let ratios = crown.trunk[0].in_leaf.damping_ratios(&BeamWind { stand: StandWind::open(mean), grid }, 1.0);
    let oscillator = |mode: usize| Oscillator {
        frequency_hz: crown.frequencies_hz[mode],
        damping_ratio: f64::from(ratios[mode]),
        share: crown.shares[mode],
    };
    [oscillator(0), oscillator(1)]
}

/// Brings the oracle's deflection, which is that of the trunk at two thirds of its length, to the product's at the tip, in a
/// steady wind.
fn trunks(crowns: &[Crown]) -> Vec<Trunk> {
    let steady = FieldSettings { speed: STEADY_SPEED_M_S, gustiness: 0.0, ..Default::default() };
    let tips = product::tips(crowns, &product::response(&steady));
    let trunk = |(crown, tips): (&Crown, &Vec<Vec<_>>)| {
        let ours: Complex<f64> = tips[0][0];
        let theirs: f64 = crown.cells.iter().map(|cell| cell.weight * mean_speed_m_s(&steady, cell.at.y).powi(2)).sum();
        let static_factor = ours.re / theirs;
        Trunk { oscillators: oscillators(crown, &steady), static_factor }
    };
    crowns.iter().zip(&tips).map(trunk).collect()
}

/// One tree in one wind, by both.
struct Comparison {
    ours: Bands,
    theirs: Bands,
    /// Mean deflection, product over oracle.
    mean_ratio: f64,
    /// Rms in a wind that is one over the crown, over that in the true one, by the linear theory.
    point_wind_ratio: f64,
    static_factor: f64,
}

fn compare(crowns: &[Crown], trunks: &[Trunk], settings: &FieldSettings) -> Vec<Comparison> {
    let (ours, means) = product_bands(crowns, settings);
    let in_wind = |(crown, trunk): (&Crown, &Trunk)| Trunk { oscillators: oscillators(crown, settings), ..*trunk };
    let in_wind: Vec<Trunk> = crowns.iter().zip(trunks).map(in_wind).collect();
    let trees: Vec<usize> = (0..crowns.len()).collect();
    let of_tree = |&tree: &usize| {
        let (theirs, mean_m) = simulate(&crowns[tree], &in_wind[tree], settings, 0..SEEDS);
        let [crown, point] = linear_variances(&crowns[tree], &in_wind[tree], settings);
        Comparison {
            ours: ours[tree],
            theirs,
            mean_ratio: means[tree] / mean_m,
            point_wind_ratio: (point / crown).sqrt(),
            static_factor: in_wind[tree].static_factor,
        }
    };
    in_parallel(&trees, of_tree)
}

/// Power of the product's tips over all seeds, and their mean along the wind, m.
fn product_bands(crowns: &[Crown], settings: &FieldSettings) -> (Vec<Bands>, Vec<f64>) {
    let seeds: Vec<u64> = (0..SEEDS).collect();
    let of_seed = |&seed: &u64| {
        let tips = product::tips(crowns, &product::response(&FieldSettings { seed, ..settings.clone() }));
        let of_tree = |columns: Vec<Vec<_>>| {
            let mut bands = Bands::default();
            let samples = (columns.len() * columns[0].len()) as f64;
            let mean_m = columns.iter().flatten().map(|tip: &Complex<f64>| tip.re).sum::<f64>() / samples;
            columns.into_iter().for_each(|column| bands.add(column));
            (bands, mean_m)
        };
        tips.into_iter().map(of_tree).collect::<Vec<_>>()
    };
    let (mut bands, mut means) = (vec![Bands::default(); crowns.len()], vec![0.0; crowns.len()]);
    for of_seed in in_parallel(&seeds, of_seed) {
        for (tree, (part, mean_m)) in of_seed.iter().enumerate() {
            bands[tree].merge(part);
            means[tree] += mean_m / SEEDS as f64;
        }
    }
    (bands, means)
}

impl Comparison {
    fn rms_ratio(&self) -> f64 {
        (self.ours.variance() / self.theirs.variance()).sqrt()
    }

    /// ln of the ratio of rms in the octaves that matter to either.
    fn octave_errors(&self) -> Vec<f64> {
        let [ours, theirs] = [&self.ours, &self.theirs].map(|bands| (bands.powers(), LEAST_SHARE * bands.variance()));
        let matters = |octave: &usize| ours.0[*octave] > ours.1 || theirs.0[*octave] > theirs.1;
        (0..OCTAVES).filter(matters).map(|octave| 0.5 * (ours.0[octave] / theirs.0[octave]).ln()).collect()
    }

    fn print(&self, crown: &Crown, speed: f32) {
        let errors = self.octave_errors();
        let octaves = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
        let [ours, theirs] = [&self.ours, &self.theirs].map(|bands| 100.0 * bands.variance().sqrt());
        println!(
            "  {:<18} {:>5.1} {:>7.2} {speed:>6.0} {theirs:>7.2} {ours:>9.2} {:>7.2} {octaves:>8.2} {:>5.2} {:>8.2} {:>6.2}",
            crown.name,
            crown.height_m,
            crown.frequencies_hz[0],
            self.rms_ratio(),
            self.mean_ratio,
            self.point_wind_ratio,
            self.static_factor,
        );
    }
}

/// The oracle against the linear theory of buffeting, in weak turbulence.
fn linear_theory(report: &mut Report, crown: &Crown, trunk: &Trunk) {
    let weak = FieldSettings { gustiness: WEAK, ..Default::default() };
    let simulated = simulate(crown, trunk, &weak, 0..2 * SEEDS).0.variance();
    let [linear, _] = linear_variances(crown, trunk, &weak);
    report.at_most(
        "linear_theory_error",
        ((simulated / linear).sqrt() - 1.0).abs(),
        0.05,
        "the oracle in weak turbulence",
    );
}

/// Does `work` for each item, on all cores.
fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let part = |range: Range<usize>| items[range].iter().map(&work).collect::<Vec<R>>();
    let share = items.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let starts = (0..items.len()).step_by(share);
        let part = &part;
        let parts: Vec<_> =
            starts.map(|start| scope.spawn(move || part(start..(start + share).min(items.len())))).collect();
        parts.into_iter().flat_map(|part| part.join().expect("a measuring thread failed")).collect()
    })
}
