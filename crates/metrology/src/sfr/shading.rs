//! Shading of an edge's region, taken off by the surfaces of its two sides.
//!
//! A lens's fall-off or uneven light makes the sides of an edge slope, and a slope is a response at low frequencies that the lens does not
//! have: 5 % across a region move the response by as much. A polynomial is fitted to each side beyond the profile's reach, and every
//! reading is taken as the share between the two surfaces, at the levels that they have in the region's middle:
//!
//! ```text
//! y′ = D₀ + (y − D(x, y)) (B₀ − D₀)/(B(x, y) − D(x, y))
//! ```
//!
//! Exact for y = b + S(x, y) E(d) where the surfaces can follow the shading S, whatever the black level b. Tails of the line spread beyond the
//! reach are taken for shading: leave it out where glare or diffraction is to be measured. The surfaces' own uncertainty is left out.

use super::knots::USUAL_REACH_PX;
use super::{Edge, SfrError, SfrSettings};
use crate::Image;
use crate::solve::Normal;

/// The largest degree of a surface.
pub(super) const MAX_DEGREE: usize = 2;

/// A surface over the picture.
struct Surface {
    coefficients: Vec<f64>,
    degree: usize,
}

/// The picture without shading.
pub(super) fn levelled(image: &Image, edge: &Edge, settings: &SfrSettings) -> Result<Image, SfrError> {
    let degree = settings.shading_degree;
    if degree == 0 {
        return Ok(image.clone());
    }
    let reach_px = settings.reach_px.unwrap_or(USUAL_REACH_PX);
    let (width, height) = (image.width(), image.height());
    let [left, right] =
        [-1.0, 1.0].map(|side| Surface::fitted(image, degree, |x, y| side * edge.distance(x, y) > reach_px));
    let few = SfrError::NoEdge("too few pixels beyond its reach tell the shading of its sides");
    let (left, right) = left.zip(right).ok_or(few)?;
    let middle = [0.5 * width as f64, 0.5 * height as f64];
    let [l0, r0] = [&left, &right].map(|s| s.at(image, middle));
    let level = |i: usize| {
        let at = [(i % width) as f64 + 0.5, (i / width) as f64 + 0.5];
        let (l, r) = (left.at(image, at), right.at(image, at));
        l0 + (f64::from(image.samples()[i]) - l) * (r0 - l0) / (r - l)
    };
    let samples: Vec<f32> = (0..width * height).map(|i| level(i) as f32).collect();
    if samples.iter().any(|s| !s.is_finite()) {
        return Err(SfrError::NoEdge("the shading of its sides crosses"));
    }
    Ok(Image::from_samples(width, height, samples).expect("as many as before"))
}

impl Surface {
    /// By least squares on the pixels of a side.
    fn fitted(image: &Image, degree: usize, within: impl Fn(f64, f64) -> bool) -> Option<Self> {
        let terms = (degree + 1) * (degree + 2) / 2;
        let mut normal = Normal::new(terms);
        for (i, reading) in image.samples().iter().enumerate() {
            let (x, y) = ((i % image.width()) as f64 + 0.5, (i / image.width()) as f64 + 0.5);
            if within(x, y) {
                normal.add(&powers(image, [x, y], degree), f64::from(*reading), 1.0);
            }
        }
        Some(Self { coefficients: normal.solve()?, degree })
    }

    fn at(&self, image: &Image, at: [f64; 2]) -> f64 {
        powers(image, at, self.degree).iter().zip(&self.coefficients).map(|(p, c)| p * c).sum()
    }
}

/// uⁱ vʲ, i + j up to the degree; u and v from −1 to 1 over the picture.
fn powers(image: &Image, [x, y]: [f64; 2], degree: usize) -> Vec<f64> {
    let (u, v) = (2.0 * x / image.width() as f64 - 1.0, 2.0 * y / image.height() as f64 - 1.0);
    let power = |base: f64, n: usize| (0..n).fold(1.0, |product, _| product * base);
    (0..=degree).flat_map(|n| (0..=n).map(move |j| power(u, n - j) * power(v, j))).collect()
}
