//! Pictures of two results that differ, and of their difference.

use etendue_io::compare::{Content, Pair};
use etendue_io::failure::Error;
use etendue_io::inspect::Preview;
use etendue_io::{Existing, OutputFolder};
use std::path::Path;

/// Writes `a.png`, `b.png` and `difference.png` (|a − b|) of the first channel that differs most.
pub(crate) fn write(pair: &Pair, folder: &Path) -> Result<(), Error> {
    let Some((a, b)) = worst(pair) else { return Ok(()) };
    let difference: Vec<f32> = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).collect();
    let mut output = OutputFolder::open(folder, Existing::Replace).map_err(Error::input)?;
    for (name, values) in [("a.png", &a), ("b.png", &b), ("difference.png", &difference)] {
        let bytes = Preview::of_grey(pair.width, pair.height, values).to_png();
        let bytes = bytes.map_err(|error| Error::Run(error.to_string()))?;
        output.write(name, &bytes).map_err(Error::input)?;
    }
    output.commit().map_err(|error| Error::Run(error.to_string())).map(|_| ())
}

/// The samples of the channel with the largest relative difference.
fn worst(pair: &Pair) -> Option<(Vec<f32>, Vec<f32>)> {
    let numbers = pair.channels.iter().map(|channel| match &channel.content {
        Content::Number { a, b, .. } => (a.clone(), b.clone()),
        Content::Identity { a, b } => (a.iter().map(|v| *v as f32).collect(), b.iter().map(|v| *v as f32).collect()),
    });
    numbers.max_by(|x, y| distance(&x.0, &x.1).total_cmp(&distance(&y.0, &y.1)))
}

/// Sum of |a − b| over the sum of |a| + |b|, of what is finite.
fn distance(a: &[f32], b: &[f32]) -> f64 {
    let pairs = || a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
    let size: f64 = pairs().map(|(a, b)| f64::from(a.abs()) + f64::from(b.abs())).sum();
    let error: f64 = pairs().map(|(a, b)| f64::from((a - b).abs())).sum();
    if size > 0.0 { error / size } else { 0.0 }
}
