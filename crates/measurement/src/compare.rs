//! Comparison of two results: errors A − B with their uncertainty, and images of both.
//!
//! Channels that carry a variance (`variance.NAME` for `NAME`) are compared by a Z test with a family-wise significance over all
//! channels; identifiers and all channels without variance must be equal.

use std::path::Path;

use etendue_io::compare::{ChannelPair, ComparedFiles, PairContent, VarianceOrigin, read_pair};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{ExistingFiles, OutputFolder, inspect::Preview};
use etendue_stats::planes::{EstimatedPlane, PlaneTest, Verdict, compare as compare_planes};
use etendue_stats::{ErrorSummary, chi_square::sidak_level};

/// Comparison of one channel.
#[derive(Clone, Debug)]
pub struct ChannelComparison {
    /// Channel name.
    pub name: String,
    /// Errors A − B relative to the reference B; `None` for identifiers.
    pub errors: Option<ErrorSummary>,
    /// Samples that are not equal bit for bit.
    pub unequal: usize,
    /// Samples that are not finite (NaN or infinite) in A, in B or in both; excluded from the errors. In a channel with variance
    /// they include samples whose variance is not finite or below zero; the test then reports a difference if there is any. 0 for
    /// identifiers.
    pub not_finite: usize,
    /// The Z test, for channels with variance.
    pub test: Option<PlaneTest>,
}

impl ChannelComparison {
    /// True if the channels differ: by the test if there is one, otherwise if any sample differs.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.test.map_or(self.unequal > 0, |test| test.verdict == Verdict::Differ)
    }
}

/// Two results of the same size and channels.
pub struct Comparison {
    /// Channel by channel.
    pub channels: Vec<ChannelComparison>,
    pair: ComparedFiles,
}

impl Comparison {
    /// True if any channel differs.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.channels.iter().any(ChannelComparison::differs)
    }

    /// Writes `a.png`, `b.png` and `difference.png` (|a − b|) of the channel that differs most into a folder.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn save_pictures(&self, folder: &Path) -> Result<(), Error> {
        write(&self.pair, folder)
    }
}

/// Compares two EXR or PNG files. `significance` is the family-wise probability of calling equal images different, above 0 and
/// below 1.
///
/// # Errors
/// If a file cannot be read, or the files differ in size or channels.
pub fn compare(a: &Path, b: &Path, significance: f64) -> Result<Comparison, Error> {
    if !(significance > 0.0 && significance < 1.0) {
        let message = format!("`significance` {significance}: expected a probability between 0 and 1");
        return Err(Error::argument("significance", message));
    }
    let pair = read_pair(a, b).map_err(Error::input)?;
    Ok(Comparison { channels: findings(&pair, significance)?, pair })
}

fn findings(pair: &ComparedFiles, significance: f64) -> Result<Vec<ChannelComparison>, Error> {
    let tested = pair.channels.iter().filter(|c| c.has_variance()).count().max(1);
    let level = sidak_level(significance, tested);
    pair.channels.iter().map(|channel| finding(channel, pair, level)).collect()
}

fn finding(channel: &ChannelPair, pair: &ComparedFiles, level: f64) -> Result<ChannelComparison, Error> {
    let name = channel.name.clone();
    match &channel.content {
        PairContent::Identity { a, b } => {
            let unequal = a.iter().zip(b).filter(|(a, b)| a != b).count();
            Ok(ChannelComparison { name, errors: None, unequal, not_finite: 0, test: None })
        }
        PairContent::Number { a, b, variance } => {
            let unequal = a.iter().zip(b).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            let test =
                match variance {
                    None => None,
                    Some((error_a, error_b)) => {
                        let a = estimated(a, error_a, pair.origin.0);
                        let b = estimated(b, error_b, pair.origin.1);
                        let test = compare_planes(&a, &b, level);
                        Some(test.map_err(|error| {
                            Error::coded(ErrorCode::NotComparable, format!("channel {name}: {error}"))
                        })?)
                    }
                };
            let correlated_px = pair.origin.0.correlated_block_px.max(pair.origin.1.correlated_block_px);
            let errors = ErrorSummary::compare(a, b).map(|errors| errors.with_correlated_pixels(correlated_px));
            // No errors: no sample is finite in both.
            let without_errors = errors.map_or(a.len(), |errors| errors.not_finite);
            let not_finite = test.map_or(without_errors, |test| test.not_finite);
            Ok(ChannelComparison { name, errors, unequal, not_finite, test })
        }
    }
}

fn estimated<'a>(mean: &'a [f32], variance_of_mean: &'a [f32], origin: VarianceOrigin) -> EstimatedPlane<'a> {
    EstimatedPlane {
        mean,
        variance_of_mean,
        replicates: origin.replicates,
        correlated_pixels: origin.correlated_block_px,
    }
}

/// Writes `a.png`, `b.png` and `difference.png` (|a − b|) of the first channel that differs most.
pub(crate) fn write(pair: &ComparedFiles, folder: &Path) -> Result<(), Error> {
    let Some((a, b)) = worst(pair) else { return Ok(()) };
    let difference: Vec<f32> = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).collect();
    let mut output = OutputFolder::open(folder, ExistingFiles::Replace).map_err(Error::input)?;
    for (name, values) in [("a.png", &a), ("b.png", &b), ("difference.png", &difference)] {
        let bytes = Preview::from_grey(pair.width, pair.height, values).to_png();
        let bytes = bytes.map_err(|error| Error::Run(error.to_string()))?;
        output.write(name, &bytes).map_err(Error::input)?;
    }
    output.commit().map_err(|error| Error::Run(error.to_string())).map(|_| ())
}

/// The samples of the channel with the largest relative difference.
fn worst(pair: &ComparedFiles) -> Option<(Vec<f32>, Vec<f32>)> {
    let numbers = pair.channels.iter().map(|channel| match &channel.content {
        PairContent::Number { a, b, .. } => (a.clone(), b.clone()),
        PairContent::Identity { a, b } => {
            (a.iter().map(|v| *v as f32).collect(), b.iter().map(|v| *v as f32).collect())
        }
    });
    numbers.max_by(|x, y| distance(&x.0, &x.1).total_cmp(&distance(&y.0, &y.1)))
}

/// Sum of |a − b| over the sum of |a| + |b|, over finite samples.
fn distance(a: &[f32], b: &[f32]) -> f64 {
    let pairs = || a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
    let size: f64 = pairs().map(|(a, b)| f64::from(a.abs()) + f64::from(b.abs())).sum();
    let error: f64 = pairs().map(|(a, b)| f64::from((a - b).abs())).sum();
    if size > 0.0 { error / size } else { 0.0 }
}
