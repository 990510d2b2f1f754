//! The paper's figure 9 on this machine: frames a second over the number of trees, with neither, either and both of the
//! voxel grid and the levels of detail.

use crate::{figure9_chart, report::Report, walk, walk::Technique};
use bevy::prelude::*;
use bevy_windwood::prelude::*;
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// How long the paper's path was, s.
const PATH_S: f32 = 180.0;
/// Small: on software Vulkan most of a larger picture's time goes into its pixels, of which the paper's machine had few, and not
/// into the trees.
const SIZE: (u32, u32) = (320, 180);
/// Numbers of trees.
const TREES: [u32; 4] = [10, 100, 1000, 10_000];
/// A frame's time at a place is the mean of so many, or of as many as there are in so long: short ones are easily disturbed.
const FRAMES_AT_A_PLACE: u32 = 8;
const LONG_ENOUGH: Duration = Duration::from_millis(600);
/// No curve is measured longer than this at one number of trees, once everything stands; but two places always are.
const PATIENCE: Duration = Duration::from_secs(25);

/// A curve of the figure.
pub struct Curve {
    pub name: &'static str,
    technique: Technique,
    /// Number of trees, and frames a second.
    pub points: Vec<(u32, f64)>,
}

/// The frame rates that the paper states for 1,000 trees.
pub const PAPER: [(&str, f64); 4] = [("neither", 0.9), ("voxels only", 5.2), ("levels only", 3.7), ("both", 12.2)];

/// Measures each curve at `frames` places at most, evenly along the path, and draws the chart to `chart`.
pub fn run(frames: u32, most_trees: u32, chart: &Path) -> Report {
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
            match rate(trees, curve.technique, frames) {
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
    report.tell("ratio_voxels_1000", ratio(voxels, 1000), "the same with the voxel grid alone; the paper: 5.8");
    report.tell("ratio_levels_1000", ratio(levels, 1000), "the same with levels alone; the paper: 4.1");
    report.at_least("ratio_both_10000", ratio(both, 10_000), 100.0, "the same at 10,000 trees");
    for (key, curve, trees) in [
        ("rate_neither_1000", neither, 1000),
        ("rate_both_1000", both, 1000),
        ("rate_neither_10000", neither, 10_000),
        ("rate_both_10000", both, 10_000),
    ] {
        report.tell(key, rate(curve, trees), "frames/s");
    }
    report
}

/// Frames a second on the path.
fn rate(trees: u32, technique: Technique, frames: u32) -> Result<f64, String> {
    let (mut app, camera, _) = walk::headless(trees, technique, SIZE)?;
    let begun = Instant::now();
    let (mut places, mut spent_s) = (0, 0.0);
    for frame in 0..frames {
        if let Some(mut at) = app.world_mut().get_mut::<Transform>(camera) {
            *at = walk::place(trees, PATH_S * frame as f32 / frames as f32);
        }
        // From one place to the next much changes at once that on a walk changes little by little: that is not measured.
        walk::settle(&mut app, 100)?;
        crate::capture::step(&mut app);
        let at = Instant::now();
        let mut here = 0;
        while here == 0 || (here < FRAMES_AT_A_PLACE && at.elapsed() < LONG_ENOUGH) {
            crate::capture::step(&mut app);
            here += 1;
        }
        (places, spent_s) = (places + 1, spent_s + at.elapsed().as_secs_f64() / f64::from(here));
        if begun.elapsed() > PATIENCE && places >= 2 {
            break;
        }
    }
    Ok(f64::from(places) / spent_s)
}
