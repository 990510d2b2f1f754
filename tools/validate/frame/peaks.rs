//! The resonances of a place that moves with many modes.

use super::modes::Mode;

/// Damping ratio under which modes run together to peaks: that of a branch in a moderate wind.
const DAMPING_RATIO: f64 = 0.09;
/// Frequencies that are looked at: from half of the slowest mode's on, each by the one before.
const RATIO: f64 = 1.005;
/// Modes slower than this, Hz, are those of what all but falls over.
const LEAST_HZ: f64 = 0.02;
/// Modes of a smaller share than this, of either sign, bring no peak that matters.
const LEAST_SHARE: f64 = 1e-3;

/// A peak of the lag behind the wind.
#[derive(Clone, Copy)]
pub struct Peak {
    pub frequency_hz: f64,
    /// Lag by the static deflection.
    pub lag: f64,
    /// Motion in gusts, by that of the strongest peak.
    pub motion: f64,
}

/// The peaks of all these modes together, the one that gusts move furthest first: their amplitude at a frequency `f` is as
/// `sqrt(f S(f)) ~ f^(-1/3)` (Kolmogorov's spectrum). Branches as fast as their trunk divide its mode in many, which damping makes one peak.
pub fn peaks(modes: &[Mode]) -> Vec<Peak> {
    let modes: Vec<&Mode> = modes.iter().filter(|mode| mode.share.abs() > LEAST_SHARE).collect();
    let slowest_hz = modes.iter().map(|mode| mode.frequency_hz).fold(f64::INFINITY, f64::min).max(LEAST_HZ);
    let fastest_hz = modes.iter().map(|mode| mode.frequency_hz).fold(0.0, f64::max);
    let count = ((4.0 * fastest_hz / slowest_hz).ln() / RATIO.ln()).ceil() as i32;
    let at = |step: i32| {
        let frequency_hz = 0.5 * slowest_hz * RATIO.powi(step);
        let lag: f64 = modes.iter().map(|mode| mode.share * lag(frequency_hz / mode.frequency_hz)).sum();
        Peak { frequency_hz, lag, motion: lag / frequency_hz.cbrt() }
    };
    let curve: Vec<Peak> = (0..count.max(0)).map(at).collect();
    let is_highest = |three: &&[Peak]| three[1].motion >= three[0].motion && three[1].motion > three[2].motion;
    let mut peaks: Vec<Peak> = curve.windows(3).filter(is_highest).map(|three| three[1]).collect();
    peaks.retain(|peak| peak.motion > 0.0);
    peaks.sort_by(|a, b| b.motion.total_cmp(&a.motion));
    let strongest = peaks.first().map_or(1.0, |peak| peak.motion);
    peaks.iter_mut().for_each(|peak| peak.motion /= strongest);
    peaks
}

/// Lag of a mode by its static deflection, for a frequency by its own.
fn lag(ratio: f64) -> f64 {
    let damping = 2.0 * DAMPING_RATIO * ratio;
    damping / ((1.0 - ratio * ratio).powi(2) + damping * damping)
}

/// What the second of two peaks has of the deflection by both, without what the flank of each adds to the other.
pub fn second_share(first: &Peak, second: &Peak) -> f64 {
    let ratio = second.frequency_hz / first.frequency_hz;
    let (own, to_first, to_second) = (lag(1.0), lag(1.0 / ratio), lag(ratio));
    let determinant = own * own - to_first * to_second;
    let shares = [own * first.lag - to_first * second.lag, own * second.lag - to_second * first.lag]
        .map(|share| share / determinant);
    shares[1] / (shares[0] + shares[1])
}
