//! Statistics of a channel.

use serde::Serialize;

/// A channel and its statistics over finite values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelReport {
    /// Name.
    pub name: String,
    /// How samples are stored.
    pub stored_as: String,
    /// Least value; `None` without any finite value, as for the next two.
    pub min: Option<f64>,
    /// Mean.
    pub mean: Option<f64>,
    /// Greatest value.
    pub max: Option<f64>,
    /// Samples that are not a number.
    pub nan_count: usize,
    /// Samples that are infinite.
    pub infinite_count: usize,
}

impl ChannelReport {
    /// The statistics of `samples`, summed in order.
    pub fn of(name: &str, stored_as: &str, samples: impl IntoIterator<Item = f64>) -> Self {
        let (mut min, mut max, mut sum, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0_usize);
        let (mut nan_count, mut infinite_count) = (0, 0);
        for v in samples {
            if v.is_finite() {
                (min, max, sum, count) = (min.min(v), max.max(v), sum + v, count + 1);
            } else if v.is_nan() {
                nan_count += 1;
            } else {
                infinite_count += 1;
            }
        }
        let some = |v: f64| (count > 0).then_some(v);
        Self {
            name: name.to_owned(),
            stored_as: stored_as.to_owned(),
            min: some(min),
            mean: some(sum / count as f64),
            max: some(max),
            nan_count,
            infinite_count,
        }
    }

    /// One line of the table.
    pub(super) fn line(&self, name_width: usize) -> String {
        let cell = |v: Option<f64>| v.map_or_else(|| "-".to_owned(), |v| format!("{v:.6e}"));
        let (min, mean, max) = (cell(self.min), cell(self.mean), cell(self.max));
        let (name, stored, nan, infinite) = (&self.name, &self.stored_as, self.nan_count, self.infinite_count);
        format!("  {name:name_width$}  {stored:6}  {min:>14}  {mean:>14}  {max:>14}  {nan:>7}  {infinite:>8}")
    }
}

/// The head of the table.
pub(super) fn heading(channels: &[ChannelReport]) -> String {
    let width = widest(channels);
    format!(
        "  {:width$}  {:6}  {:>14}  {:>14}  {:>14}  {:>7}  {:>8}",
        "channel", "type", "min", "mean", "max", "NaN", "infinite"
    )
}

/// The widest name.
pub(super) fn widest(channels: &[ChannelReport]) -> usize {
    channels.iter().map(|c| c.name.len()).max().unwrap_or(0).max("channel".len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_not_finite_are_counted_and_left_out() {
        let report = ChannelReport::of("Z", "float", [1.0, f64::NAN, 3.0, f64::INFINITY, f64::NEG_INFINITY]);
        assert_eq!((report.min, report.mean, report.max), (Some(1.0), Some(2.0), Some(3.0)));
        assert_eq!((report.nan_count, report.infinite_count), (1, 2));
        assert_eq!(ChannelReport::of("Z", "float", [f64::INFINITY]).mean, None);
    }
}
