//! Shading of a flat field: fall-off over the radial field position and as a map.
//!
//! After ISO 17957:2015 (map of blocks relative to the centre) and figure 12 of Gruyer, Grapinet & De Souza (relative illumination
//! against the radial field position in % of the half diagonal). With readings y less the black level b:
//!
//! ```text
//! profile: mean of y − b over rings of equal width, at √⟨r²⟩, less what the fitted fall-off's mean over the ring is more than its value there,
//!          over the centre's value
//! centre:  I₀ of I₀ (1 + a₂ r² + a₄ r⁴ + a₆ r⁶ + a₈ r⁸), fitted to the rings by weighted least squares; r = 1 in the corner
//! map:     means of blocks over the mean of the block in the centre (odd numbers of blocks)
//! ```
//!
//! Uncertainty: from each ring's and block's own noise (from the second differences of neighbours, PRNU among it, over the number of
//! pixels), and for the profile that of I₀, which all rings share, and of what whole rows and columns of the sensor have in common
//! (`lines.rs`). The unevenness of the light itself is not in it, nor is that of rows and columns in the map's.
//!
//! Refused: saturated fields, fields no brighter than black, pictures that no smooth fall-off describes.

mod colour;
mod lines;
#[cfg(test)]
mod tests;

use crate::flat::{SATURATED_SHARE, neighbour_variances, saturated_fraction};
use crate::linear::Matrix;
use crate::linear::matrix::dot;
use crate::solve::Normal;
use crate::{Estimate, Image};

pub use colour::{ColourShading, colour_shading};

/// How a flat field is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingSettings {
    /// Reading of no light.
    pub black: f64,
    /// Reading of a saturated pixel.
    pub full_scale: Option<f64>,
    /// Centre of the fall-off, raster coordinates; `None`: the picture's.
    pub centre_px: Option<(f64, f64)>,
    /// Rings of the profile.
    pub rings: usize,
    /// Blocks of the map along each side, an odd number.
    pub blocks: usize,
}

impl Default for ShadingSettings {
    fn default() -> Self {
        Self { black: 0.0, full_scale: None, centre_px: None, rings: 20, blocks: 11 }
    }
}

/// A ring of the profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Radial field position, share of the distance from the centre to the farthest corner.
    pub position: f64,
    /// Illumination relative to the centre.
    pub relative: Estimate,
}

/// A flat field's shading.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {
    /// From the centre outwards.
    pub profile: Vec<Ring>,
    /// The centre's reading less black.
    pub centre: Estimate,
    /// a₂, a₄, a₆, a₈ of the fitted fall-off, positions as shares.
    pub coefficients: [Estimate; 4],
    /// Fitted illumination at the farthest corner relative to the centre.
    pub corner: Estimate,
    /// Block means relative to the central one, rows from the top.
    pub map: Vec<Vec<Estimate>>,
}

impl Shading {
    /// The fitted fall-off at a radial field position (1 at the farthest corner).
    #[must_use]
    pub fn falloff(&self, position: f64) -> f64 {
        let square = position * position;
        self.coefficients.iter().rev().fold(0.0, |sum, a| (sum + a.value) * square) + 1.0
    }
}

/// Why a flat field cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShadingError {
    /// Saturated.
    #[error("{percent:.1} % of the flat field's pixels are saturated: expose less")]
    Saturated {
        /// Share of pixels.
        percent: f64,
    },
    /// No light.
    #[error(
        "the flat field's centre reads {reading}, no more than black ({black}): expose more, or check the black level"
    )]
    Dark {
        /// Reading of the centre.
        reading: f64,
        /// The black level.
        black: f64,
    },
    /// Not a flat field.
    #[error(
        "this is no picture of an evenly lit surface: it differs from a smooth fall-off by {percent:.0} % (root mean square of {blocks} × {blocks} blocks)"
    )]
    NotFlat {
        /// Relative deviation.
        percent: f64,
        /// Blocks along a side.
        blocks: usize,
    },
    /// A reading is NaN or infinite.
    #[error("the picture holds readings that are no numbers: give finite values")]
    NotFinite,
    /// Too few pixels for the rings and blocks.
    #[error(
        "a picture of {width} × {height} pixels is too small for {rings} rings and {blocks} × {blocks} blocks (an odd number of blocks, four pixels or more each)"
    )]
    TooSmall {
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Rings asked for.
        rings: usize,
        /// Blocks asked for.
        blocks: usize,
    },
    /// Channels of different sizes.
    #[error("the channels differ in size: give pictures of one size")]
    Sizes,
}

/// The shading of a flat field.
///
/// # Errors
/// Where it is saturated, dark, not flat, or too small.
pub fn measure_shading(image: &Image, settings: &ShadingSettings) -> Result<Shading, ShadingError> {
    check(image, settings)?;
    let rings = Sums::rings(image, settings);
    let first = Falloff::fitted(&rings, &Matrix::zeros(rings.len(), rings.len()))?;
    let shared = lines::shared(image, settings, &rings, |square| first.at(square));
    let fit = Falloff::fitted(&rings, &shared)?;
    let centre = fit.centre(settings)?;
    let blocks = block_sums(image, settings);
    let map = relative_map(&blocks, settings)?;
    flatness(&blocks, &fit, settings)?;
    Ok(Shading {
        profile: rings.iter().map(|ring| fit.ring(ring)).collect(),
        centre,
        coefficients: [1, 2, 3, 4].map(|k| fit.ratio(k)),
        corner: fit.corner(),
        map,
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
    let share = saturated_fraction(image.samples(), settings.full_scale);
    if share > SATURATED_SHARE { Err(ShadingError::Saturated { percent: 100.0 * share }) } else { Ok(()) }
}

/// Sums over the pixels of a ring or block.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    reading: f64,
    /// Of the positions: Σ 1, Σ r², … Σ r⁸.
    powers: [f64; TERMS],
    variance: f64,
    pairs: f64,
    /// Which ring it is of those asked for.
    number: usize,
}

impl Sums {
    fn add(&mut self, reading: f64, square_position: f64) {
        self.count += 1.0;
        self.reading += reading;
        self.powers.iter_mut().zip(powers(square_position)).for_each(|(sum, power)| *sum += power);
    }

    fn mean(&self) -> f64 {
        self.reading / self.count
    }

    fn square_position(&self) -> f64 {
        self.powers[1] / self.count
    }

    /// Means of 1, r², … r⁸.
    fn mean_powers(&self) -> [f64; TERMS] {
        self.powers.map(|sum| sum / self.count)
    }

    /// Of the mean.
    fn standard_uncertainty(&self) -> f64 {
        if self.pairs > 0.0 { (self.variance / self.pairs / self.count).sqrt() } else { f64::INFINITY }
    }

    /// Rings that hold pixels.
    fn rings(image: &Image, settings: &ShadingSettings) -> Vec<Self> {
        let mut rings: Vec<Self> = (0..settings.rings).map(|number| Self { number, ..Self::default() }).collect();
        let square = square_position(image, settings);
        let ring = |square: f64| ring_at(square, settings);
        for (x, y, reading) in readings(image, settings) {
            let square = square(x, y);
            rings[ring(square)].add(reading, square);
        }
        for (x, y, variance) in neighbour_variances(image) {
            let ring = &mut rings[ring(square(x, y))];
            ring.variance += variance;
            ring.pairs += 1.0;
        }
        rings.retain(|ring| ring.count >= 4.0 && ring.pairs >= 2.0);
        rings
    }
}

/// The ring of a squared position.
fn ring_at(square: f64, settings: &ShadingSettings) -> usize {
    ((square.sqrt() * settings.rings as f64) as usize).min(settings.rings - 1)
}

fn readings(image: &Image, settings: &ShadingSettings) -> impl Iterator<Item = (usize, usize, f64)> {
    let width = image.width();
    image.samples().iter().enumerate().map(move |(i, s)| (i % width, i / width, f64::from(*s) - settings.black))
}

/// Squared distance of a pixel from the centre over that of the farthest corner.
fn square_position(image: &Image, settings: &ShadingSettings) -> impl Fn(usize, usize) -> f64 + use<> {
    let (width, height) = (image.width() as f64, image.height() as f64);
    let (cx, cy) = settings.centre_px.unwrap_or((0.5 * width, 0.5 * height));
    let farthest = |c: f64, size: f64| c.max(size - c) * c.max(size - c);
    let whole = farthest(cx, width) + farthest(cy, height);
    move |x, y| {
        let (x, y) = (x as f64 + 0.5 - cx, y as f64 + 0.5 - cy);
        (x * x + y * y) / whole
    }
}

/// Coefficients of the fall-off: of 1, r², … r⁸.
const TERMS: usize = 5;

/// I₀ (1 + a₂ r² + …) as b₀ + b₁ r² + ….
struct Falloff {
    b: Vec<f64>,
    covariance: Matrix,
    /// The covariance of b₀ with each coefficient by the rings' own noise.
    own_of_centre: Vec<f64>,
    /// Of each ring, by its number: the covariance of b₀ with what lines share in its mean, and the variance of that.
    with_lines: Vec<[f64; 2]>,
}

fn powers(square: f64) -> [f64; TERMS] {
    let mut powers = [1.0; TERMS];
    (1..TERMS).for_each(|k| powers[k] = powers[k - 1] * square);
    powers
}

/// The noise of a pixel that the fit assumes at least, of its reading, so that no ring rules alone.
const MIN_NOISE: f64 = 1e-3;

/// A ring's weight in the fit.
fn weight(ring: &Sums) -> f64 {
    let (u, least) = (ring.standard_uncertainty(), MIN_NOISE * ring.mean().abs() / ring.count.sqrt());
    1.0 / (u * u + least * least).max(f64::MIN_POSITIVE)
}

impl Falloff {
    /// By the rings, whose means have a covariance by lines beside their own noise.
    fn fitted(rings: &[Sums], shared: &Matrix) -> Result<Self, ShadingError> {
        let mut normal = Normal::new(TERMS);
        for ring in rings {
            normal.add(&ring.mean_powers(), ring.mean(), weight(ring));
        }
        let none = ShadingError::NotFlat { percent: f64::NAN, blocks: 0 };
        let (b, own) = normal.solve().zip(normal.inverse()).ok_or(none)?;
        // How each coefficient depends on the means of the rings.
        let lever = |ring: &Sums| own.times(&ring.mean_powers().map(|p| p * weight(ring)));
        let levers = Matrix::from_rows(TERMS, rings.iter().map(lever));
        let column = |k: usize| (0..rings.len()).map(|i| levers.at(i, k)).collect::<Vec<f64>>();
        let pulled: Vec<Vec<f64>> = (0..TERMS).map(|k| shared.times(&column(k))).collect();
        let own_of_centre = own.row(0).to_vec();
        let mut covariance = own;
        for (i, pulled) in pulled.iter().enumerate() {
            (0..TERMS).for_each(|j| *covariance.at_mut(i, j) += dot(pulled, &column(j)));
        }
        let mut with_lines = vec![[0.0; 2]; rings.iter().map(|ring| ring.number + 1).max().unwrap_or(0)];
        rings.iter().enumerate().for_each(|(i, ring)| with_lines[ring.number] = [pulled[0][i], shared.at(i, i)]);
        Ok(Self { b, covariance, own_of_centre, with_lines })
    }

    fn centre(&self, settings: &ShadingSettings) -> Result<Estimate, ShadingError> {
        let centre = Estimate::new(self.b[0], self.covariance.at(0, 0).sqrt());
        let dark = ShadingError::Dark { reading: centre.value + settings.black, black: settings.black };
        if centre.value > 3.0 * centre.standard_uncertainty && centre.value > 0.0 { Ok(centre) } else { Err(dark) }
    }

    /// The reading at a squared position.
    fn at(&self, square: f64) -> f64 {
        powers(square).iter().zip(&self.b).map(|(p, b)| p * b).sum()
    }

    /// The fall-off's mean over a ring or block.
    fn mean(&self, pixels: &Sums) -> f64 {
        pixels.mean_powers().iter().zip(&self.b).map(|(p, b)| p * b).sum()
    }

    /// A ring over the centre, which depends on the ring itself by its share in the fit.
    fn ring(&self, ring: &Sums) -> Ring {
        let there = self.at(ring.square_position());
        let curved = self.mean(ring) - there;
        let (value, u) = ((ring.mean() - curved) / self.b[0], ring.standard_uncertainty());
        let along: f64 = self.own_of_centre.iter().zip(ring.mean_powers()).map(|(c, p)| c * p).sum();
        let [with_centre, of_lines] = self.with_lines[ring.number];
        let common = u * u * along * weight(ring) + with_centre;
        let variance = u * u + of_lines + value * value * self.covariance.at(0, 0) - 2.0 * value * common;
        let u = variance.max(0.0).sqrt() / self.b[0];
        Ring { position: ring.square_position().sqrt(), relative: Estimate::new(value, u) }
    }

    /// A linear form of the coefficients over b₀.
    fn over_centre(&self, form: [f64; TERMS]) -> Estimate {
        let value = form.iter().zip(&self.b).map(|(f, b)| f * b).sum::<f64>() / self.b[0];
        let mut slopes = form.map(|f| f / self.b[0]);
        slopes[0] -= value / self.b[0];
        Estimate::new(value, self.covariance.form(&slopes).max(0.0).sqrt())
    }

    fn ratio(&self, k: usize) -> Estimate {
        self.over_centre(core::array::from_fn(|i| f64::from(u8::from(i == k))))
    }

    fn corner(&self) -> Estimate {
        self.over_centre([1.0; TERMS])
    }
}

/// Sums of the map's blocks, row by row.
fn block_sums(image: &Image, settings: &ShadingSettings) -> Vec<Sums> {
    let (n, width, height) = (settings.blocks, image.width(), image.height());
    let block = |x: usize, y: usize| (y * n / height) * n + x * n / width;
    let square = square_position(image, settings);
    let mut blocks = vec![Sums::default(); n * n];
    readings(image, settings).for_each(|(x, y, reading)| blocks[block(x, y)].add(reading, square(x, y)));
    for (x, y, variance) in neighbour_variances(image) {
        let block = &mut blocks[block(x, y)];
        block.variance += variance;
        block.pairs += 1.0;
    }
    blocks
}

fn relative_map(blocks: &[Sums], settings: &ShadingSettings) -> Result<Vec<Vec<Estimate>>, ShadingError> {
    let middle = blocks[blocks.len() / 2];
    let (centre, u_centre) = (middle.mean(), middle.standard_uncertainty());
    if centre <= 0.0 {
        return Err(ShadingError::Dark { reading: centre + settings.black, black: settings.black });
    }
    let relative = |(i, block): (usize, &Sums)| {
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

/// The largest deviation of blocks from the fall-off that still is a flat field: lamps and lenses that are not centred.
const MAX_DEVIATION: f64 = 0.15;

fn flatness(blocks: &[Sums], fit: &Falloff, settings: &ShadingSettings) -> Result<(), ShadingError> {
    let deviation = |block: &Sums| {
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
