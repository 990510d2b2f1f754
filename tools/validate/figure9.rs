//! Figure 9 of Setas et al. on this machine: frame rate over number of trees, with the voxel grid, levels of detail, both or
//! neither.

use crate::{
    figure9_chart,
    report::Report,
    support::capture,
    walk::{self, PATH_S, Technique},
};
use bevy::prelude::*;
use bevy_windwood::prelude::*;
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// Size of the pictures. It is small because on software Vulkan a larger picture spends most of its time on pixels, of which
/// the paper's machine had few, and not on trees.
const SIZE: (u32, u32) = (320, 180);
/// Numbers of trees.
const TREES: [u32; 4] = [10, 100, 1000, 10_000];
/// The time of a frame at a place is the mean of this many frames, or of those in this time.
const FRAMES_PER_PLACE: u32 = 8;
const TIME_PER_PLACE: Duration = Duration::from_millis(600);
/// Longest measurement of a curve at one number of trees. Two places are always measured.
const LONGEST_MEASUREMENT: Duration = Duration::from_secs(25);

/// A curve of the figure.
pub struct Curve {
    pub name: &'static str,
    technique: Technique,
    /// Number of trees, and frames per second.
    pub points: Vec<(u32, f64)>,
}

/// Frame rates of the paper for 1,000 trees.
pub const PAPER_RATES: [(&str, f64); 4] =
    [("neither", 0.9), ("voxels only", 5.2), ("levels only", 3.7), ("both", 12.2)];

/// Measures each curve at up to `places` places, evenly along the path, and draws the chart to the file `chart`.
pub fn run(places: u32, most_trees: u32, chart: &Path) -> Report {
    let technique = |voxels, levels| Technique { voxels, levels, style: LevelStyle::Thinned };
    let curve = |name, technique| Curve { name, technique, points: Vec::new() };
    let mut curves = [
        curve("neither", technique(false, false)),
        curve("voxels only", technique(true, false)),
        curve("levels only", technique(false, true)),
        curve("both", technique(true, true)),
    ];
    println!(
        "{:>8} {:>12} {:>12} {:>12} {:>12}   frames/s at {}x{}",
        "trees", "neither", "voxels", "levels", "both", SIZE.0, SIZE.1
    );
    for trees in TREES.into_iter().filter(|trees| *trees <= most_trees) {
        let mut row = format!("{trees:>8}");
        for curve in &mut curves {
            match measure_rate(trees, curve.technique, places) {
                Ok(rate) => {
                    curve.points.push((trees, rate));
                    row += &format!(" {rate:>12.3}");
                }
                Err(error) => {
                    eprintln!("{} trees, {}: {error}", trees, curve.name);
                    row += &format!(" {:>12}", "-");
                }
            }
        }
        println!("{row}");
    }
    if let Err(error) = figure9_chart::draw(chart, &curves) {
        eprintln!("{}: {error}", chart.display());
    } else {
        println!("chart: {}", chart.display());
    }
    report(&curves)
}

fn report(curves: &[Curve; 4]) -> Report {
    let rate =
        |curve: &Curve, trees| curve.points.iter().find(|(at, _)| *at == trees).map_or(f64::NAN, |(_, rate)| *rate);
    let [neither, voxels, levels, both] = curves;
    let ratio = |curve, trees| rate(curve, trees) / rate(neither, trees);
    let mut report = Report::default();
    report.at_least("ratio_both_1000", ratio(both, 1000), 13.6, "frame rate over that with neither; the paper: 13.6");
    report.record("ratio_voxels_1000", ratio(voxels, 1000), "the same with the voxel grid alone; the paper: 5.8");
    report.record("ratio_levels_1000", ratio(levels, 1000), "the same with levels alone; the paper: 4.1");
    report.at_least("ratio_both_10000", ratio(both, 10_000), 100.0, "the same at 10,000 trees");
    for (key, curve, trees) in [
        ("rate_neither_1000", neither, 1000),
        ("rate_both_1000", both, 1000),
        ("rate_neither_10000", neither, 10_000),
        ("rate_both_10000", both, 10_000),
    ] {
        report.record(key, rate(curve, trees), "frames/s");
    }
    report
}

/// Frames per second along the path.
fn measure_rate(trees: u32, technique: Technique, places: u32) -> Result<f64, String> {
    let (mut app, camera, _) = walk::headless(trees, technique, SIZE)?;
    let start = Instant::now();
    let (mut measured, mut spent_s) = (0, 0.0);
    for place in 0..places {
        if let Some(mut at) = app.world_mut().get_mut::<Transform>(camera) {
            *at = walk::place(trees, PATH_S * place as f32 / places as f32);
        }
        // The camera jumps from place to place. What changes at once there changes gradually on a walk: it is not measured.
        walk::settle(&mut app, 100)?;
        capture::step(&mut app);
        let start_here = Instant::now();
        let mut frames = 0;
        while frames == 0 || (frames < FRAMES_PER_PLACE && start_here.elapsed() < TIME_PER_PLACE) {
            capture::step(&mut app);
            frames += 1;
        }
        (measured, spent_s) = (measured + 1, spent_s + start_here.elapsed().as_secs_f64() / f64::from(frames));
        if start.elapsed() > LONGEST_MEASUREMENT && measured >= 2 {
            break;
        }
    }
    Ok(f64::from(measured) / spent_s)
}
