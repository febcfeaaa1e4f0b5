//! Shading of a flat field: fall-off over the radial field position and as a map.
//!
//! After ISO 17957:2015 (map of blocks relative to the centre) and figure 12 of Gruyer, Grapinet & De Souza (relative illumination
//! against the radial field position in % of the half diagonal). With readings y less the black level b:
//!
//! ```text
//! profile: mean of y − b over rings of equal width, at √⟨r²⟩, less the difference of the fitted fall-off's mean over the ring
//! from its value there,
//!          over the centre's value
//! centre:  I₀ of I₀ (1 + b₁ r² + b₂ r⁴ + b₃ r⁶ + b₄ r⁸)/(1 + c r²)², fitted to the rings by weighted least squares; r = 1 in the corner; c that of a first fit
//!          without it (`report.rs`)
//! a₂ … a₈: of the polynomial 1 + a₂ r² + … + a₈ r⁸ that is nearest to the fit over the circle
//! map:     means of blocks over the mean of the block in the centre (odd numbers of blocks)
//! ```
//!
//! Uncertainty: from each ring's and block's own noise (second differences of neighbours, which include PRNU, over the number of
//! pixels, and the noise shared by neighbours: `correlation.rs`). For the profile also that of I₀, which all rings share, and of
//! row and column noise of the sensor (`sums.rs`). If the rings differ from the fit by more than that, the fit's covariance is
//! scaled accordingly (Birge 1932). It excludes the non-uniformity of the light itself; for the map also row and column noise.
//!
//! Refused: saturated fields, fields no brighter than black, images that no smooth fall-off describes.

mod colour;
mod correlation;
mod falloff;
mod report;
mod sums;
#[cfg(test)]
mod tests;

use crate::patch_statistics::{MAX_SATURATED_FRACTION, neighbour_variances, saturated_fraction};
use crate::{Estimate, Image, linear::Matrix};
use correlation::Correlation;
use falloff::Falloff;
use report::Basis;
use sums::{RegionSums, readings, square_position};

pub use colour::{ColourShading, colour_shading};
pub use report::{Ring, Shading, ShadingError, ShadingSettings};

/// Measures the shading of a flat field.
///
/// # Errors
/// If it is saturated, dark, not flat, or too small.
pub fn measure_shading(image: &Image, settings: &ShadingSettings) -> Result<Shading, ShadingError> {
    check(image, settings)?;
    let none = |rings: &[RegionSums]| Matrix::zeros(rings.len(), rings.len());
    let rings = RegionSums::rings(image, settings, Basis::default());
    let polynomial = Falloff::fitted(&rings, Basis::default(), &none(&rings))?;
    let basis = Basis::from_corner(polynomial.corner().value);
    let mut rings = RegionSums::rings(image, settings, basis);
    let first = Falloff::fitted(&rings, basis, &none(&rings))?;
    let relative = sums::relative(image, settings, |square| first.at(square));
    let correlation = Correlation::from_relative(&relative, image.width());
    let spread = correlation.as_ref().map_or(1.0, Correlation::mean_over_differences);
    rings.iter_mut().for_each(|ring| ring.variance *= spread);
    let shared = sums::shared(image, settings, &rings, &relative, correlation.as_ref());
    let fit = Falloff::fitted(&rings, basis, &shared)?;
    let centre = fit.centre(settings)?;
    let mut blocks = block_sums(image, settings, basis);
    blocks.iter_mut().for_each(|block| block.variance *= spread);
    let map = relative_map(&blocks, settings)?;
    flatness(&blocks, &fit, settings)?;
    Ok(Shading {
        profile: rings.iter().map(|ring| fit.ring(ring)).collect(),
        centre,
        coefficients: fit.polynomial(),
        corner: fit.corner(),
        map,
        fitted: (basis, fit.shape()),
    })
}

fn check(image: &Image, settings: &ShadingSettings) -> Result<(), ShadingError> {
    let (width, height, rings, blocks) = (image.width(), image.height(), settings.rings, settings.blocks);
    let enough = blocks % 2 == 1 && width.min(height) >= 4 * blocks && rings >= 4 && width.min(height) >= 2 * rings;
    if !enough {
        return Err(ShadingError::TooSmall { width, height, rings, blocks });
    }
    if image.samples().iter().any(|s| !s.is_finite()) {
        return Err(ShadingError::NotFinite);
    }
    let fraction = saturated_fraction(image.samples(), settings.full_scale);
    if fraction > MAX_SATURATED_FRACTION {
        return Err(ShadingError::Saturated { percent: 100.0 * fraction });
    }
    let reading = image.samples().iter().map(|s| f64::from(*s)).sum::<f64>() / image.samples().len() as f64;
    if reading > settings.black { Ok(()) } else { Err(ShadingError::Dark { reading, black: settings.black }) }
}

/// Sums of the map's blocks, row by row.
fn block_sums(image: &Image, settings: &ShadingSettings, basis: Basis) -> Vec<RegionSums> {
    let (n, width, height) = (settings.blocks, image.width(), image.height());
    let block = |x: usize, y: usize| (y * n / height) * n + x * n / width;
    let square = square_position(image, settings);
    let mut blocks = vec![RegionSums::default(); n * n];
    readings(image, settings).for_each(|(x, y, reading)| blocks[block(x, y)].add(reading, square(x, y), basis));
    for (x, y, variance) in neighbour_variances(image) {
        let block = &mut blocks[block(x, y)];
        block.variance += variance;
        block.pairs += 1.0;
    }
    blocks
}

fn relative_map(blocks: &[RegionSums], settings: &ShadingSettings) -> Result<Vec<Vec<Estimate>>, ShadingError> {
    let middle = blocks[blocks.len() / 2];
    let (centre, u_centre) = (middle.mean(), middle.standard_uncertainty());
    if centre <= 0.0 {
        return Err(ShadingError::Dark { reading: centre + settings.black, black: settings.black });
    }
    let relative = |(i, block): (usize, &RegionSums)| {
        let value = block.mean() / centre;
        let own = block.standard_uncertainty() / centre;
        let shared = value * u_centre / centre;
        // The central block is 1 by definition.
        let u = if i == blocks.len() / 2 { 0.0 } else { (own * own + shared * shared).sqrt() };
        Estimate::new(value, u)
    };
    let all: Vec<Estimate> = blocks.iter().enumerate().map(relative).collect();
    Ok(all.chunks_exact(settings.blocks).map(<[Estimate]>::to_vec).collect())
}

/// Maximum deviation of blocks from the fall-off in a flat field: lights and lenses that are not centred.
const MAX_DEVIATION: f64 = 0.15;

fn flatness(blocks: &[RegionSums], fit: &Falloff, settings: &ShadingSettings) -> Result<(), ShadingError> {
    let deviation = |block: &RegionSums| {
        let noise = block.standard_uncertainty();
        let difference = block.mean() - fit.mean(block);
        (difference * difference - noise * noise).max(0.0) / (fit.b[0] * fit.b[0])
    };
    let rms = (blocks.iter().map(deviation).sum::<f64>() / blocks.len() as f64).sqrt();
    if rms <= MAX_DEVIATION {
        return Ok(());
    }
    Err(ShadingError::NotFlat { percent: 100.0 * rms, blocks: settings.blocks })
}
