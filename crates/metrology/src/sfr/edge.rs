//! Position of an edge: a polynomial over the rows, initialised from the gradients.

use etendue_core::maths::f64::{atan, atan2, tan};

use super::SfrError;
use crate::Image;

/// Minimum angle to rows, columns and diagonals, degrees.
const MIN_ANGLE_DEG: f64 = 1.9;
/// The same for the first estimate, which is wrong by a third of a degree at most.
const MIN_FIRST_ANGLE_DEG: f64 = 0.8;
/// Minimum fraction of the gradients' power along an edge's normal, relative to isotropic noise.
const MIN_ANISOTROPY: f64 = 0.2;

/// Approximate direction of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// Along columns: the response is that across columns (horizontal).
    Vertical,
    /// Along rows: the response is that across rows (vertical).
    Horizontal,
}

/// An edge in an image oriented so that the edge runs from top to bottom: x = Σ c_k ((y − y₀)/y₀)^k.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    orientation: Orientation,
    /// Middle of the rows, px.
    middle: f64,
    coefficients: Vec<f64>,
}

impl Edge {
    /// The edge from the structure tensor of the image gradients (its principal direction is the edge's normal; isotropic noise
    /// does not rotate it) and the centre of the gradients along it.
    pub(super) fn from_gradients(image: &Image) -> Result<Self, SfrError> {
        let gradients: Vec<Gradient> = gradients(&smoothed(image)).collect();
        let sum = |f: fn(&Gradient) -> f64| gradients.iter().map(f).sum::<f64>();
        let (xx, yy, xy) = (sum(|g| g.x * g.x), sum(|g| g.y * g.y), sum(|g| g.x * g.y));
        // Readings near the largest number have invalid gradients.
        if (xx + yy).is_nan() || xx + yy <= 0.0 {
            return Err(SfrError::NoEdge("the image is uniform"));
        }
        let spread = ((xx - yy) * (xx - yy) + 4.0 * xy * xy).sqrt();
        if spread < MIN_ANISOTROPY * (xx + yy) {
            return Err(SfrError::NoEdge("the gradients have no common direction"));
        }
        let normal_rad = 0.5 * atan2(2.0 * xy, xx - yy);
        let vertical = xx >= yy;
        // The normal (cos α, sin α) of an edge x = c + s y is (1, −s); with x and y exchanged for a horizontal one.
        let slope = if vertical { -tan(normal_rad) } else { -1.0 / tan(normal_rad) };
        let angle_deg = atan(slope.abs()).to_degrees();
        if !(MIN_FIRST_ANGLE_DEG..=45.0 - MIN_FIRST_ANGLE_DEG).contains(&angle_deg) {
            return Err(SfrError::Angle { angle_deg });
        }
        let (height, middle) = if vertical { (image.height(), image.height()) } else { (image.width(), image.width()) };
        let middle = (0.5 * middle as f64).min(0.5 * height as f64);
        let place = |g: &Gradient| {
            let (across, along, weight) = if vertical { (g.at.0, g.at.1, g.x) } else { (g.at.1, g.at.0, g.y) };
            [weight * (across - slope * (along - middle)), weight]
        };
        let [moment, weight] = gradients.iter().map(place).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        let at = moment / weight;
        let width = if vertical { image.width() } else { image.height() } as f64;
        if !(at > 0.0 && at < width) {
            return Err(SfrError::NoEdge("the gradients cancel"));
        }
        let orientation = if vertical { Orientation::Vertical } else { Orientation::Horizontal };
        Ok(Self { orientation, middle, coefficients: vec![at, slope * middle] })
    }

    /// The edge through two points of an image.
    pub(super) fn fit_through([a, b]: [[f64; 2]; 2], image: &Image) -> Result<Self, SfrError> {
        let run = [b[0] - a[0], b[1] - a[1]];
        let vertical = run[1].abs() >= run[0].abs();
        let (across, along, length) = if vertical { (0, 1, image.height()) } else { (1, 0, image.width()) };
        if run[along] == 0.0 {
            return Err(SfrError::NoEdge("the two ends coincide"));
        }
        let (slope, middle) = (run[across] / run[along], 0.5 * length as f64);
        let orientation = if vertical { Orientation::Vertical } else { Orientation::Horizontal };
        let edge =
            Self { orientation, middle, coefficients: vec![a[across] + slope * (middle - a[along]), slope * middle] };
        edge.check().map(|()| edge)
    }

    /// The image in the edge's own frame: rows and columns are exchanged for a horizontal edge.
    pub(super) fn upright(&self, image: &Image) -> Image {
        match self.orientation {
            Orientation::Vertical => image.clone(),
            Orientation::Horizontal => {
                let (width, height) = (image.width(), image.height());
                let samples = (0..width).flat_map(|x| (0..height).map(move |y| image.at(x, y))).collect();
                Image::from_samples(height, width, samples).expect("as many pixels")
            }
        }
    }

    /// Approximate direction.
    #[must_use]
    pub fn orientation(&self) -> Orientation {
        self.orientation
    }

    /// The angle to rows or columns at the image centre, degrees.
    #[must_use]
    pub fn angle_deg(&self) -> f64 {
        atan(self.slope(self.middle).abs()).to_degrees()
    }

    fn argument(&self, y: f64) -> f64 {
        (y - self.middle) / self.middle
    }

    fn x(&self, y: f64) -> f64 {
        let t = self.argument(y);
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
    }

    fn slope(&self, y: f64) -> f64 {
        let t = self.argument(y);
        let terms = self.coefficients.iter().enumerate().skip(1).rev();
        terms.fold(0.0, |sum, (k, c)| sum * t + k as f64 * c) / self.middle
    }

    /// Distance of a point from the edge along the normal, px, positive to the right.
    pub(super) fn distance(&self, x: f64, y: f64) -> f64 {
        let slope = self.slope(y);
        (x - self.x(y)) / (1.0 + slope * slope).sqrt()
    }

    /// Derivatives of a pixel's distance by the coefficients, to first order: −t^k cos θ.
    pub(super) fn sensitivities(&self, y: f64, degree: usize) -> Vec<f64> {
        let (t, slope) = (self.argument(y), self.slope(y));
        let cosine = 1.0 / (1.0 + slope * slope).sqrt();
        core::iter::successors(Some(-cosine), |s| Some(s * t)).take(degree + 1).collect()
    }

    /// The edge with changed coefficients.
    pub(super) fn moved(&self, by: &[f64]) -> Self {
        let coefficient = |k: usize| self.coefficients.get(k).copied().unwrap_or(0.0) + by[k];
        Self { coefficients: (0..by.len()).map(coefficient).collect(), ..self.clone() }
    }

    /// Checks that its angle can be measured.
    pub(super) fn check(&self) -> Result<(), SfrError> {
        let angle_deg = self.angle_deg();
        let is_valid = (MIN_ANGLE_DEG..=45.0 - MIN_ANGLE_DEG).contains(&angle_deg);
        if is_valid { Ok(()) } else { Err(SfrError::Angle { angle_deg }) }
    }
}

/// Border removed by smoothing, px.
const BORDER: f64 = 2.0;

/// 3 × 3 medians, which remove single hot or dead pixels, then 3 × 3 means, which leave a ninth of the noise power.
fn smoothed(image: &Image) -> Image {
    let median = |mut near: [f32; 9]| {
        near.sort_unstable_by(f32::total_cmp);
        near[4]
    };
    let mean = |near: [f32; 9]| near.iter().sum::<f32>() / 9.0;
    neighbourhoods(&neighbourhoods(image, median), mean)
}

/// A function of each pixel and its eight neighbours; without the image's border.
fn neighbourhoods(image: &Image, reduce: impl Fn([f32; 9]) -> f32) -> Image {
    let (width, height) = (image.width() - 2, image.height() - 2);
    let near = |x: usize, y: usize| core::array::from_fn(|i| image.at(x + i % 3, y + i / 3));
    let samples = (0..width * height).map(|i| reduce(near(i % width, i / width))).collect();
    Image::from_samples(width, height, samples).expect("as many pixels")
}

struct Gradient {
    at: (f64, f64),
    x: f64,
    y: f64,
}

/// Gradients between four pixels, averaged over each pair (Roberts' cross, axis-aligned).
fn gradients(image: &Image) -> impl Iterator<Item = Gradient> {
    let at = |x: usize, y: usize| f64::from(image.at(x, y));
    let places = (1..image.height()).flat_map(|y| (1..image.width()).map(move |x| (x, y)));
    places.map(move |(x, y)| {
        let [a, b, c, d] = [at(x - 1, y - 1), at(x, y - 1), at(x - 1, y), at(x, y)];
        Gradient { at: (x as f64 + BORDER, y as f64 + BORDER), x: 0.5 * (b + d - a - c), y: 0.5 * (c + d - a - b) }
    })
}
