//! From frames to numbers over time.

use crate::{Estimate, Image};

/// Mean of each row, less black.
pub(super) fn row_means(frame: &Image, black: f64) -> Vec<f64> {
    let mean = |row: &[f32]| row.iter().map(|v| f64::from(*v)).sum::<f64>() / row.len() as f64 - black;
    frame.samples().chunks_exact(frame.width()).map(mean).collect()
}

/// Mean of a frame, less black; its uncertainty from the scatter of its columns, which see the same bands.
pub(super) fn frame_mean(frame: &Image, black: f64) -> Estimate {
    let (columns, rows) = (frame.width(), frame.height());
    let column = |x: usize| (0..rows).map(|y| f64::from(frame.at(x, y))).sum::<f64>() / rows as f64 - black;
    let means: Vec<f64> = (0..columns).map(column).collect();
    let mean = means.iter().sum::<f64>() / columns as f64;
    let squares: f64 = means.iter().map(|m| (m - mean) * (m - mean)).sum();
    Estimate::new(mean, (squares / ((columns - 1) * columns) as f64).sqrt())
}

/// Mean of several.
pub(super) fn mean_of(all: &[Estimate]) -> Estimate {
    let count = all.len() as f64;
    let squares: f64 = all.iter().map(|e| e.standard_uncertainty * e.standard_uncertainty).sum();
    Estimate::new(all.iter().map(|e| e.value).sum::<f64>() / count, squares.sqrt() / count)
}

/// Mean of several of one quantity, by what each knows of it.
pub(super) fn weighted_mean(all: &[Estimate]) -> Option<Estimate> {
    let weight = |e: &Estimate| 1.0 / (e.standard_uncertainty * e.standard_uncertainty);
    let total: f64 = all.iter().map(weight).sum();
    let known = !all.is_empty() && total > 0.0 && total.is_finite();
    known.then(|| Estimate::new(all.iter().map(|e| e.value * weight(e)).sum::<f64>() / total, 1.0 / total.sqrt()))
}
