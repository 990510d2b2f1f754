//! Parsers that check values of the command line.

// Each program that includes this file uses a part of it.
#![allow(dead_code)]

use std::{fmt::Display, str::FromStr};

/// A wind speed, m/s.
pub fn wind_speed(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 75.0, "m/s")
}

/// A time, s.
pub fn seconds(text: &str) -> Result<f64, String> {
    in_range(text, 0.0, 1e6, "s")
}

/// A time of the year.
pub fn year(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 1.0, "of the year")
}

/// A number in a range.
pub fn in_range<T: FromStr + PartialOrd + Display>(text: &str, low: T, high: T, unit: &str) -> Result<T, String> {
    match text.parse::<T>() {
        Ok(value) if (&low..=&high).contains(&&value) => Ok(value),
        _ => Err(format!("expected a number from {low} to {high} {unit}")),
    }
}

/// A size in pixels, such as `960x540`.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    match parts {
        Some((width, height)) if (1..=4096).contains(&width) && (1..=4096).contains(&height) => Ok((width, height)),
        _ => Err("expected WIDTHxHEIGHT, each from 1 to 4096".to_owned()),
    }
}
