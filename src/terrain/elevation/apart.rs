//! Samples that look like no data: one value at an end that stands apart from all others.
//!
//! Voids of 65535 make mountains of 65 km, and voids of -32768 that were read as unsigned some of 33 km. No land does that: from its highest
//! place to the next is less than from there to the lowest. Voids of 0 in mountains are not as far away; but many cells hold that value, and
//! the heights of land have no other gap like the one above them.

use super::samples::is_number;

/// The gap that is wide, as a share of the spread of all other samples.
const WIDE_GAP: f32 = 0.1;
/// How many times as wide it is as the widest of all others.
const USUAL_GAPS: f32 = 5.0;
/// Classes of the histogram of samples.
const CLASSES: usize = 1000;

/// A value at an end that stands apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Apart {
    pub value: f32,
    pub cells: usize,
    /// The nearest value of another cell.
    pub nearest: f32,
}

/// The least and the greatest sample, where they stand apart: farther from the next than all others, without the opposite end, from each
/// other; or where several cells hold the value, by more than [`WIDE_GAP`] of that and by more than [`USUAL_GAPS`] times their own widest
/// gap. With fewer than four different samples nothing is told.
pub(super) fn standing_apart(samples: &[f32]) -> Vec<Apart> {
    let numbers = || samples.iter().copied().filter(|&sample| is_number(sample));
    let bottom = End::of(numbers(), |a, b| a < b);
    let top = End::of(numbers(), |a, b| a > b);
    let (Some(bottom), Some(top)) = (bottom, top) else { return Vec::new() };
    let spread = top.nearest - bottom.nearest;
    if spread <= 0.0 {
        return Vec::new();
    }
    let usual = widest_gap(numbers(), bottom.nearest, spread);
    let is_apart = |end: &Apart| {
        let gap = (end.value - end.nearest).abs();
        gap > spread || (end.cells > 1 && gap > WIDE_GAP * spread && gap > USUAL_GAPS * usual)
    };
    [bottom, top].into_iter().filter(is_apart).collect()
}

/// The widest gap between samples from `least` to `least` + `spread`, as far as a histogram shows it.
fn widest_gap(samples: impl Iterator<Item = f32>, least: f32, spread: f32) -> f32 {
    let mut is_filled = [false; CLASSES + 1];
    for share in samples.map(|sample| (sample - least) / spread).filter(|share| (0.0..=1.0).contains(share)) {
        is_filled[(share * CLASSES as f32) as usize] = true;
    }
    let filled = (0..=CLASSES).filter(|&class| is_filled[class]);
    let (mut widest, mut last) = (0, 0);
    for class in filled {
        widest = widest.max(class - last);
        last = class;
    }
    widest as f32 / CLASSES as f32 * spread
}

struct End;

impl End {
    /// The first of all samples in an order, how many there are of it, and the second: `None` where all are equal.
    fn of(samples: impl Iterator<Item = f32>, is_before: impl Fn(f32, f32) -> bool) -> Option<Apart> {
        let (mut first, mut cells, mut second) = (None, 0, None);
        for sample in samples {
            match first {
                Some(value) if sample == value => cells += 1,
                Some(value) if !is_before(sample, value) => {
                    if second.is_none_or(|second| is_before(sample, second)) {
                        second = Some(sample);
                    }
                }
                _ => {
                    second = first;
                    (first, cells) = (Some(sample), 1);
                }
            }
        }
        Some(Apart { value: first?, cells, nearest: second? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voids_stand_apart_and_peaks_do_not() {
        let land: Vec<f32> = (0..1000).map(|index| 2281.0 + (index * 7919 % 1981) as f32).collect();
        assert_eq!(standing_apart(&land), []);
        let with = |voids: &[f32]| {
            let all: Vec<f32> = voids.iter().chain(&land).chain(voids).copied().collect();
            standing_apart(&all).into_iter().map(|apart| (apart.value, apart.cells)).collect::<Vec<_>>()
        };
        assert_eq!(with(&[65535.0]), [(65535.0, 2)]);
        assert_eq!(with(&[32768.0]), [(32768.0, 2)]);
        assert_eq!(with(&[-9999.0]), [(-9999.0, 2)]);
        assert_eq!(with(&[0.0, 65535.0]), [(0.0, 2), (65535.0, 2)]);
        assert_eq!(with(&[f32::NAN, f32::MIN]), []);
        // Voids of 0 below mountains that are as high as they are wide.
        let wide: Vec<f32> = [0.0; 3].into_iter().chain((0..1000).map(|index| 400.0 + 3.0 * index as f32)).collect();
        assert_eq!(standing_apart(&wide).iter().map(|apart| apart.cells).collect::<Vec<_>>(), [3]);
        // A low plain in whole metres, and one peak above a range.
        let plain: Vec<f32> = (0..1000).map(|index| (index % 6) as f32).collect();
        assert_eq!(standing_apart(&plain), []);
        let peak: Vec<f32> = [3800.0].into_iter().chain((0..1000).map(|index| 400.0 + 3.0 * index as f32)).collect();
        assert_eq!(standing_apart(&peak), []);
        // The sea about an island.
        let island: Vec<f32> = (0..1000).map(|index| (index % 700) as f32).collect();
        assert_eq!(standing_apart(&island), []);
    }

    #[test]
    fn a_few_different_values_tell_nothing() {
        for samples in [&[][..], &[1.0], &[1.0, 1.0], &[1.0, 500.0], &[1.0, 2.0, 500.0], &[f32::NAN]] {
            assert_eq!(standing_apart(samples), [], "{samples:?}");
        }
    }
}
