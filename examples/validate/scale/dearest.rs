//! What the systems take, one by one.

use bevy_windwood::SystemTimes;

/// What each system took in each frame.
#[derive(Default)]
pub struct Dearest {
    systems_ms: Vec<(&'static str, Vec<f64>)>,
}

impl Dearest {
    pub fn note(&mut self, times: &SystemTimes) {
        if self.systems_ms.is_empty() {
            self.systems_ms = times.iter().map(|(name, _)| (name, Vec::new())).collect();
        }
        for ((_, times_ms), (_, time)) in self.systems_ms.iter_mut().zip(times.iter()) {
            times_ms.push(time.as_secs_f64() * 1e3);
        }
    }

    /// The five systems that take most in most frames, and those that take most in the slowest.
    pub fn print(&self) {
        let of = |(name, ms): &(&'static str, Vec<f64>)| (median_and_p99(ms), *name);
        let mut systems: Vec<_> = self.systems_ms.iter().map(of).collect();
        for (which, title) in ["most frames", "the slowest"].into_iter().enumerate() {
            systems.sort_unstable_by(|(one, _), (other, _)| other[which].total_cmp(&one[which]));
            println!("  {title}");
            for ([median_ms, p99_ms], name) in systems.iter().take(5) {
                println!("    {name:<20} {median_ms:>9.4} {p99_ms:>11.4}");
            }
        }
    }
}

/// The values that a half, and 99 of 100, do not exceed; NaN of none.
pub fn median_and_p99(values: &[f64]) -> [f64; 2] {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1) as f64;
    [0.5, 0.99].map(|share| sorted.get((share * last).round() as usize).copied().unwrap_or(f64::NAN))
}
