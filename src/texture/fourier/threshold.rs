//! Thresholds of a texture's values.

/// The value above which `share` (0 to 1) of the samples lies; 0 without samples.
#[must_use]
pub fn threshold_above(mut samples: Vec<f32>, share: f32) -> f32 {
    let Some(last) = samples.len().checked_sub(1) else { return 0.0 };
    let below = ((1.0 - share.clamp(0.0, 1.0)) * last as f32).round() as usize;
    let (_, &mut threshold, _) = samples.select_nth_unstable_by(below, f32::total_cmp);
    threshold
}
