//! The natural frequencies of a beam against the resonances of the finite elements.
//!
//! The product has one or two. The elements have many modes, which are some peaks together in a moderate wind ([`peaks`]). Both are held to
//! account:
//!
//! - each peak that matters must be one of the product's frequencies: those by which gusts move the beam at least [`SIGNIFICANT`] times as
//!   far as by the strongest, however many there are, and the greatest group of modes in each wind,
//! - each of the product's frequencies must be a peak: one by which gusts move it at least [`REAL`] times as far as by the strongest.
//!
//! The error is the greatest of all these. A stem has the same frequencies in winds along x and z: its peaks are those of both together.

use super::elements::strongest;
use crate::frame::{
    modes::Mode,
    peaks::{Peak, peaks, second_share},
};

const SIGNIFICANT: f64 = 0.5;
const REAL: f64 = 0.25;

/// A beam's frequencies, over those of the finite elements.
#[derive(Clone, Copy)]
pub struct Resonances {
    /// The greatest error, with its sign: product over elements, less one.
    pub error: f64,
    /// Of the group of modes that moves furthest in gusts, in the wind where it is worst, by the nearest of its frequencies.
    pub in_gusts: f64,
    /// Peaks that matter.
    pub peaks: usize,
    /// Share of the second frequency in the deflection by both, less that of the peaks that are nearest; where there are two.
    pub share_error: Option<f64>,
}

impl Resonances {
    /// `modes` are those of the elements, for each wind.
    pub fn compare(ours: &[Mode], modes: &[Vec<Mode>]) -> Self {
        let peaks = peaks(&modes.concat());
        let [significant, real] =
            [SIGNIFICANT, REAL].map(|least| peaks.iter().filter(move |peak| peak.motion >= least));
        let of_winds = modes.iter().map(|modes| strongest(modes)[0].frequency_hz);
        let theirs_hz = significant.clone().map(|peak| peak.frequency_hz).chain(of_winds);
        let matched = theirs_hz.map(|hz| least(ours.iter().map(|mode| mode.frequency_hz / hz - 1.0)));
        let real_hz: Vec<f64> = real.map(|peak| peak.frequency_hz).collect();
        let are_peaks = ours.iter().map(|mode| least(real_hz.iter().map(|hz| mode.frequency_hz / hz - 1.0)));
        let in_gusts = modes.iter().map(|modes| {
            let theirs_hz = strongest(modes)[1].frequency_hz;
            least(ours.iter().map(|mode| mode.frequency_hz / theirs_hz - 1.0))
        });
        Self {
            error: worst(matched.chain(are_peaks)),
            in_gusts: worst(in_gusts),
            peaks: significant.count(),
            share_error: share_error(ours, &peaks),
        }
    }
}

fn share_error(ours: &[Mode], peaks: &[Peak]) -> Option<f64> {
    let [first, second] = ours else { return None };
    let nearest = |mode: &Mode| {
        let distance = |peak: &&Peak| (peak.frequency_hz / mode.frequency_hz).ln().abs();
        peaks.iter().filter(|peak| peak.motion >= REAL).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let (a, b) = nearest(first).zip(nearest(second))?;
    (a.frequency_hz != b.frequency_hz).then(|| second.share - second_share(a, b))
}

fn least(errors: impl Iterator<Item = f64>) -> f64 {
    errors.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN)
}

fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    errors.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN)
}
