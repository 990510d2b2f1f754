//! The synthesised wind against the formulas of the literature, measured from its samples as an anemometer would.
//!
//! The formulas are written again here and the spectra are estimated from velocities, so that the check shares nothing but the
//! samples with the synthesis.

mod ensemble;
mod offgrid;
mod pairs;
mod sampling;
mod target;

use crate::report::Report;
use bevy_windwood::wind::{FieldSettings, WindField};
use ensemble::{Ensemble, PAIRS, SEEDS};
use sampling::{Seam, log_law_error};
use std::{ops::Range, time::Instant};
use target::{Target, bins_of_band};

pub fn run() -> Report {
    let settings = FieldSettings::default();
    let mut report = Report::default();
    let start = Instant::now();
    let field = WindField::synthesise(&settings).expect("the default settings are valid");
    report.record("synthesis_s", start.elapsed().as_secs_f64(), "one field of 2048 x 16 x 16 on one thread");
    let target = Target::new(&field);
    let ensemble = Ensemble::measure(&settings, &target);

    let (psd, psd_slowest) = psd_errors(&ensemble, &target);
    report.at_most("psd_worst_octave_error", psd, 0.05, "relative, octaves of 8 and more bins, all levels, u v w");
    report.record("psd_slowest_bins_error", psd_slowest, "relative, the 7 slowest bins");
    let coherence = root_coherence_error(&ensemble, &target);
    report.at_most("root_coherence_worst_error", coherence, 0.02, "absolute, octaves, lateral, vertical and oblique");
    report.at_most("variance_worst_error", variance_error(&ensemble, &target), 0.02, "relative to the resolved band");
    let [u, v, w] = field.resolved_fraction();
    report.record("resolved_fraction_u", f64::from(u), "of the whole variance, mean over levels");
    report.record("resolved_fraction_v", f64::from(v), "");
    report.record("resolved_fraction_w", f64::from(w), "");
    report.at_most("log_law_worst_error", log_law_error(&field, &target), 1e-3, "relative, means of sample()");
    let seam = Seam::measure(&field);
    report.at_most(
        "period_seam",
        seam.jump,
        1e-5,
        "sample() a period later, and a column a width across, relative to U(10)",
    );
    report.at_most("period_seam_step", seam.step_ratio, 1.1, "rms step over the seam to rms step elsewhere");
    offgrid::add_figures(&mut report);
    pairs::add_figures(&mut report, &target);
    report.record("seeds", SEEDS as f64, "realisations");
    report
}

/// The worst relative error of the power in octaves of 8 and more bins, and in the slowest bins.
fn psd_errors(ensemble: &Ensemble, target: &Target) -> (f64, f64) {
    let worst_of = |bands: Range<usize>| {
        let error = |component, level| {
            let of_band = |band| (ensemble.power(component, level, band) - 1.0).abs();
            bands.clone().map(of_band).fold(0.0, f64::max)
        };
        worst(3, target.heights_m.len(), error)
    };
    (worst_of(1..ensemble.bands), worst_of(0..1))
}

fn root_coherence_error(ensemble: &Ensemble, target: &Target) -> f64 {
    worst(3, PAIRS.len(), |component, pair| {
        let error = |band: usize| {
            let bins = bins_of_band(band);
            let count = bins.len() as f64;
            let expected: f64 =
                bins.map(|bin| target.root_coherence(component, target.frequency_hz(bin), PAIRS[pair])).sum();
            (ensemble.root_coherence(component, pair, band) - expected / count).abs()
        };
        (0..ensemble.bands).map(error).fold(0.0, f64::max)
    })
}

fn variance_error(ensemble: &Ensemble, target: &Target) -> f64 {
    worst(3, ensemble.levels, |component, level| {
        let measured = ensemble.variance[component * ensemble.levels + level] / ensemble.series;
        (measured / target.resolved_variance(component, level) - 1.0).abs()
    })
}

/// The greatest error of a table.
fn worst(rows: usize, columns: usize, error: impl Fn(usize, usize) -> f64) -> f64 {
    let of_row = |row| (0..columns).map(|column| error(row, column)).fold(0.0, f64::max);
    (0..rows).map(of_row).fold(0.0, f64::max)
}
