//! Times of our systems, one by one.

use bevy_windwood::SystemTimes;

/// The time of each system in each frame.
#[derive(Default)]
pub struct SystemCosts {
    systems_ms: Vec<(&'static str, Vec<f64>)>,
}

impl SystemCosts {
    pub fn add(&mut self, times: &SystemTimes) {
        if self.systems_ms.is_empty() {
            self.systems_ms = times.iter().map(|(name, _)| (name, Vec::new())).collect();
        }
        for ((_, times_ms), (_, time)) in self.systems_ms.iter_mut().zip(times.iter()) {
            times_ms.push(time.as_secs_f64() * 1e3);
        }
    }

    /// Prints the five systems with the greatest medians, and the five with the greatest 99th percentiles.
    pub fn print(&self) {
        let of = |(name, ms): &(&'static str, Vec<f64>)| (median_and_p99(ms), *name);
        let mut systems: Vec<_> = self.systems_ms.iter().map(of).collect();
        for (which, title) in ["median", "99th percentile"].into_iter().enumerate() {
            systems.sort_unstable_by(|(one, _), (other, _)| other[which].total_cmp(&one[which]));
            println!("  {title}");
            for ([median_ms, p99_ms], name) in systems.iter().take(5) {
                println!("    {name:<20} {median_ms:>9.4} {p99_ms:>11.4}");
            }
        }
    }
}

/// Median and 99th percentile. NaN if there are no values.
pub fn median_and_p99(values: &[f64]) -> [f64; 2] {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1) as f64;
    [0.5, 0.99].map(|share| sorted.get((share * last).round() as usize).copied().unwrap_or(f64::NAN))
}
