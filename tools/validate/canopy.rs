//! The wind in stands of trees beside what others have measured: its profile, and how edges shelter what is behind them.

use crate::report::Report;
use bevy_windwood::{
    dynamics::Speeds,
    sway::{SwaySettings, WindResponse},
    wind::{Canopy, FieldSettings, WindField},
};
use serde::Deserialize;
use std::sync::Arc;

const MEASURED_BY_OTHERS: &str = include_str!("canopies.ron");
/// Height and frontal area indices of the stands that are looked at. The indices are half of the leaf area of stands that
/// were measured: 2 of a pine forest, 4 of an aspen forest (Amiro 1990), 6 of a spruce forest.
const HEIGHT_M: f32 = 15.0;
const INDICES: [f32; 3] = [1.0, 2.0, 3.0];
/// Trees' loads are compared at this share of their height: where wind presses as on the whole crown.
const LOAD_AT: f32 = 0.75;
/// Spacing of trees by their height, and the frontal area index of spruces at that spacing: half as high a crown, as wide as the
/// spacing, a triangle.
const SPACINGS: [f64; 3] = [0.15, 0.25, 0.35];

#[derive(Deserialize)]
struct Measured {
    speed: Vec<Band>,
    gusts: Vec<Band>,
    source: String,
    confirmed: bool,
}

#[derive(Deserialize)]
struct Band {
    height: f32,
    low: f32,
    high: f32,
}

pub fn run() -> Report {
    let mut report = Report::default();
    match (ron::from_str::<Measured>(MEASURED_BY_OTHERS), wind()) {
        (Ok(measured), Ok(wind)) => {
            profiles(&mut report, &measured, &wind);
            shelter(&mut report, &wind);
        }
        (Err(error), _) => failed(&mut report, &error.to_string()),
        (_, Err(error)) => failed(&mut report, &error),
    }
    report
}

fn failed(report: &mut Report, error: &str) {
    eprintln!("canopy: {error}");
    report.at_most("outside_published_bands", f64::NAN, 0.0, "could not be measured");
}

fn wind() -> Result<WindResponse, String> {
    let field = WindField::synthesise(&FieldSettings::default()).map_err(|error| error.to_string())?;
    Ok(WindResponse::new(Arc::new(field), &SwaySettings::default()))
}

fn profiles(report: &mut Report, measured: &Measured, wind: &WindResponse) {
    let standing = if measured.confirmed { "measured by others" } else { "unconfirmed" };
    println!("  U/U_h and sigma_u/u* in stands, beside bands of {} ({standing})", measured.source);
    let mut outside = 0;
    for index in INDICES {
        let stand = wind.stand_wind(&Canopy { height_m: HEIGHT_M, frontal_area_index: index, exposure: [0.0; 8] });
        let top = stand.inside(HEIGHT_M);
        let friction = stand.friction();
        let mut row = format!("    index {index}:");
        let mut look = |bands: &[Band], value: &dyn Fn(Speeds) -> f32| {
            for Band { height, low, high } in bands {
                let value = value(stand.inside(height * HEIGHT_M));
                let is_inside = (*low..=*high).contains(&value);
                outside += i32::from(!is_inside);
                row += &format!("  {height}: {value:.2}{}", if is_inside { "" } else { " OUTSIDE" });
            }
            row += "  |";
        };
        look(&measured.speed, &|speeds| speeds.mean / top.mean);
        look(&measured.gusts, &|speeds| speeds.gusts / friction);
        println!("{row}");
    }
    report.at_most(
        "outside_published_bands",
        f64::from(outside),
        0.0,
        "profiles in stands outside of what was measured",
    );
}

/// Loads far inside a stand by those at its edge, against the wind tunnel of Stacey et al. 1994 as Gardiner et al. 2000 fitted it (the
/// bending moment as a function of spacing over height).
fn shelter(report: &mut Report, wind: &WindResponse) {
    println!("  mean and greatest load inside a stand by that at its edge, and in the wind tunnel");
    let (mut means, mut greatest) = (Vec::new(), Vec::new());
    for spacing in SPACINGS {
        // Trees a square metre, by triangles of half the height.
        let index = 0.25 / spacing;
        let canopy = Canopy { height_m: HEIGHT_M, frontal_area_index: index as f32, exposure: [0.0; 8] };
        let inside = wind.stand_wind(&canopy).speeds(LOAD_AT * HEIGHT_M);
        let edge = wind.stand_wind(&Canopy::default()).speeds(LOAD_AT * HEIGHT_M);
        let tunnel_mean = (0.68 * spacing - 0.0385) / (0.68 * spacing - 0.0385 + 0.4785 - 0.68 * spacing);
        let tunnel_most = (2.7193 * spacing - 0.061) / (2.7193 * spacing - 0.061 + 0.9701 - 1.273 * spacing);
        let (mean, most) = (load(inside, 0.0) / load(edge, 0.0), load(inside, PEAK) / load(edge, PEAK));
        println!("    spacing {spacing}: {mean:.3} ({tunnel_mean:.3})   {most:.3} ({tunnel_most:.3})");
        means.push(mean / tunnel_mean);
        greatest.push(most / tunnel_most);
    }
    let mean_of = |ratios: &[f64]| ratios.iter().sum::<f64>() / ratios.len() as f64;
    report.record("shelter_mean_by_tunnel", mean_of(&means), "mean load inside by that at the edge, over the tunnel's");
    report.record("shelter_peak_by_tunnel", mean_of(&greatest), "the same of the greatest load");
}

/// Deviations of the greatest gust of an hour.
const PEAK: f64 = 3.5;

/// The load of a wind with a gust of so many deviations; with none the mean load of a normal wind.
fn load(Speeds { mean, gusts }: Speeds, deviations: f64) -> f64 {
    let (mean, gusts) = (f64::from(mean), f64::from(gusts));
    if deviations > 0.0 { (mean + deviations * gusts).powi(2) } else { mean * mean + gusts * gusts }
}
