//! Trees that a game touches: that they move as the table says where nothing but the wind drives them, and what they cost.

mod cost;
mod follows;

use crate::report::Report;

pub fn run() -> Report {
    let mut report = Report::default();
    follows::run(&mut report);
    if let Err(error) = cost::run(&mut report) {
        eprintln!("live: {error}");
        report.at_most("sleep_cost_ns", f64::NAN, 1.0, "could not be measured");
    }
    report
}
