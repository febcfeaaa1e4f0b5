//! Colour shading: ratios of channels over the field.
//!
//! ```text
//! ratio of a block = (red/green of the block)/(red/green of the central block), and blue likewise
//! ```
//!
//! (ISO 17957:2015 defines colour shading as chroma differences of an encoded image; ratios of linear channels need no encoding.)

use super::{Shading, ShadingError, ShadingSettings, measure_shading};
use crate::{Estimate, Image};

/// Colour shading of a flat field.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourShading {
    /// Red over green, relative to the centre, rows from the top.
    pub red: Vec<Vec<Estimate>>,
    /// Blue over green, relative to the centre.
    pub blue: Vec<Vec<Estimate>>,
    /// The channels' own shading: red, green, blue.
    pub channels: [Shading; 3],
}

impl ColourShading {
    /// The value farthest from 1 of each map: red, blue.
    #[must_use]
    pub fn extremes(&self) -> [Estimate; 2] {
        let farther = |a: Estimate, b: Estimate| if (b.value - 1.0).abs() > (a.value - 1.0).abs() { b } else { a };
        [&self.red, &self.blue].map(|map| map.iter().flatten().copied().fold(Estimate::new(1.0, 0.0), farther))
    }
}

/// Measures colour shading from the red, green and blue of a flat field.
///
/// # Errors
/// As [`measure_shading`], for each channel, or if they differ in size.
pub fn colour_shading(channels: [&Image; 3], settings: &ShadingSettings) -> Result<ColourShading, ShadingError> {
    let size = |image: &Image| (image.width(), image.height());
    if channels.iter().any(|c| size(c) != size(channels[0])) {
        return Err(ShadingError::Sizes);
    }
    let [red, green, blue] = channels.map(|c| measure_shading(c, settings));
    let channels = [red?, green?, blue?];
    let ratio = |c: usize| {
        let rows = channels[c].map.iter().zip(&channels[1].map);
        rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| over(*a, *b)).collect()).collect()
    };
    Ok(ColourShading { red: ratio(0), blue: ratio(2), channels })
}

fn over(a: Estimate, b: Estimate) -> Estimate {
    let value = a.value / b.value;
    let (own, other) = (a.standard_uncertainty / b.value, value * b.standard_uncertainty / b.value);
    Estimate::new(value, (own * own + other * other).sqrt())
}
