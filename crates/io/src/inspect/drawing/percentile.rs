//! Percentiles of what is finite.

/// The value of which `percent` of the finite values are not greater; `None` where no value is finite.
pub(super) fn percentile(values: impl Iterator<Item = f32>, percent: usize) -> Option<f32> {
    let mut finite: Vec<f32> = values.filter(|v| v.is_finite()).collect();
    let rank = finite.len().checked_sub(1)? * percent / 100;
    Some(*finite.select_nth_unstable_by(rank, f32::total_cmp).1)
}
