//! An edge among others: only the pixels of a strip about it are looked at, as between the neighbouring edges of a star.

use super::edge::Edge;
use super::{Sfr, SfrError, SfrSettings, check, fit, told};
use crate::Image;

/// A strip about a straight edge whose place is known to a pixel or so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    /// The ends of the edge, raster coordinates, px.
    pub ends_px: [[f64; 2]; 2],
    /// How far the strip reaches to either side of each end, px, and linearly between them.
    pub half_widths_px: [f64; 2],
}

impl Strip {
    /// Whether a point lies in the strip.
    fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let [a, b] = self.ends_px;
        let (run, off) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
        let length = (run[0] * run[0] + run[1] * run[1]).sqrt();
        let along = (off[0] * run[0] + off[1] * run[1]) / (length * length);
        let across = (off[0] * run[1] - off[1] * run[0]) / length;
        let [p, q] = self.half_widths_px;
        (0.0..=1.0).contains(&along) && across.abs() <= p + along * (q - p)
    }

    /// The pixels about it: left column, top row, width, height, within a picture.
    fn bounds(&self, image: &Image) -> [usize; 4] {
        let most = self.half_widths_px[0].max(self.half_widths_px[1]) + 1.0;
        let along = |k: usize, length: usize| {
            let (a, b) = (self.ends_px[0][k], self.ends_px[1][k]);
            let low = ((a.min(b) - most).floor().max(0.0) as usize).min(length);
            let high = ((a.max(b) + most).ceil().max(0.0) as usize).min(length);
            (low, high - low)
        };
        let ((left, width), (top, height)) = (along(0, image.width()), along(1, image.height()));
        [left, top, width, height]
    }
}

/// The response of the slanted edge in a strip of a picture.
///
/// # Errors
/// As [`super::measure_edge`].
pub fn measure_strip(image: &Image, strip: &Strip, settings: &SfrSettings) -> Result<Sfr, SfrError> {
    let [left, top, width, height] = strip.bounds(image);
    if width < 16 || height < 16 {
        return Err(SfrError::TooSmall { width, height });
    }
    let part = image.part(left, top, width, height);
    check(&part, settings)?;
    let ends = strip.ends_px.map(|[x, y]| [x - left as f64, y - top as f64]);
    let start = Edge::through(ends, &part)?;
    let seen: Vec<f32> = (0..width * height)
        .map(|i| [left + i % width, top + i / width].map(|v| v as f64 + 0.5))
        .map(|at| if strip.holds(at) { 1.0 } else { 0.0 })
        .collect();
    let seen = start.upright(&Image::from_samples(width, height, seen).expect("as many pixels"));
    let seen: Vec<bool> = seen.samples().iter().map(|s| *s > 0.5).collect();
    let (edge, profile) = fit::fitted(&start.upright(&part), &seen, start, settings)?;
    Ok(told(&edge, &profile, settings))
}
