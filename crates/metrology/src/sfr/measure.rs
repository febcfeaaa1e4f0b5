//! Response of an edge from its image: of a single edge, or in a strip among others.
//!
//! Shading of an edge's region is removed with surfaces fitted to its two sides.
//!
//! A lens's fall-off or non-uniform light makes the sides of an edge slope, which adds a response at low frequencies that the
//! lens does not have: 5 % across a region change the response by as much. A polynomial is fitted to each side beyond the
//! profile's reach. Every reading is converted to its relative position between the two surfaces, at their levels in the region's
//! centre:
//!
//! ```text
//! y′ = D₀ + (y − D(x, y)) (B₀ − D₀)/(B(x, y) − D(x, y))
//! ```
//!
//! This is exact for y = b + S(x, y) E(d) if the surfaces can follow the shading S, whatever the black level b. Limitations:
//! tails of the line spread beyond the reach are mistaken for shading, so it should be off for measurements of glare or
//! diffraction; the surfaces' own uncertainty is ignored.

use super::response::{Sfr, SfrPoint, crossing};
use super::{Edge, SfrError, SfrSettings, fit, knots::DEFAULT_REACH_PX, profile::Profile};
use crate::{Image, linear::Normal};

/// Maximum degree of a surface.
const MAX_DEGREE: usize = 2;

/// A surface over the image.
struct Surface {
    coefficients: Vec<f64>,
    degree: usize,
}

/// The image without shading.
fn levelled(image: &Image, edge: &Edge, settings: &SfrSettings) -> Result<Image, SfrError> {
    let degree = settings.shading_degree;
    if degree == 0 {
        return Ok(image.clone());
    }
    let reach_px = settings.reach_px.unwrap_or(DEFAULT_REACH_PX);
    let (width, height) = (image.width(), image.height());
    let [left, right] =
        [-1.0, 1.0].map(|side| Surface::fitted(image, degree, |x, y| side * edge.distance(x, y) > reach_px));
    let few = SfrError::NoEdge("too few pixels outside the profile to determine the shading of the two sides");
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
        return Err(SfrError::NoEdge("the shading surfaces of the two sides intersect"));
    }
    Ok(Image::from_samples(width, height, samples).expect("as many as before"))
}

impl Surface {
    /// Fits a surface to the pixels of a side by least squares.
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

/// uⁱ vʲ, i + j up to the degree; u and v from −1 to 1 over the image.
fn powers(image: &Image, [x, y]: [f64; 2], degree: usize) -> Vec<f64> {
    let (u, v) = (2.0 * x / image.width() as f64 - 1.0, 2.0 * y / image.height() as f64 - 1.0);
    let power = |base: f64, n: usize| (0..n).fold(1.0, |product, _| product * base);
    (0..=degree).flat_map(|n| (0..=n).map(move |j| power(u, n - j) * power(v, j))).collect()
}

/// Measures the response of the slanted edge that fills an image.
///
/// # Errors
/// If there is no such edge, its angle cannot be measured, or it is clipped.
pub fn measure_edge(image: &Image, settings: &SfrSettings) -> Result<Sfr, SfrError> {
    check(image, settings)?;
    let start = Edge::from_gradients(image)?;
    let upright = start.upright(image);
    let by_degree = |shading_degree: usize| {
        let settings = &SfrSettings { shading_degree, ..*settings };
        let image = &levelled(&upright, &start, settings)?;
        let (edge, profile) = fit::fit_edge(image, &vec![true; image.samples().len()], start.clone(), settings)?;
        Ok::<_, SfrError>(edge_response(&edge, &profile, settings))
    };
    let result = by_degree(settings.shading_degree)?;
    let further = settings.shading_degree + 1;
    let other = (further <= MAX_DEGREE).then(|| by_degree(further)).and_then(Result::ok);
    Ok(match other {
        Some(other) => result.with_choice_of_shading(&other),
        None => result,
    })
}

/// Points of a curve without the first.
const POINTS: usize = 100;

pub(super) fn edge_response(edge: &Edge, profile: &Profile, settings: &SfrSettings) -> Sfr {
    let frequency = |i: usize| settings.last_frequency * i as f64 / POINTS as f64;
    let curve: Vec<SfrPoint> = (0..=POINTS).map(frequency).map(|f| profile.response(f)).collect();
    Sfr {
        angle_deg: edge.angle_deg(),
        orientation: edge.orientation(),
        levels: profile.levels(),
        noise: profile.noise(),
        step_px: profile.step_px(),
        mtf50: crossing(&curve, 0.5),
        mtf10: crossing(&curve, 0.1),
        curve,
        shading: 0.0,
        profile: profile.samples(),
    }
}

pub(super) fn check(image: &Image, settings: &SfrSettings) -> Result<(), SfrError> {
    let (width, height) = (image.width(), image.height());
    if width < 16 || height < 16 {
        return Err(SfrError::TooSmall { width, height });
    }
    if image.samples().iter().any(|s| !s.is_finite()) {
        return Err(SfrError::NotFinite);
    }
    if !(1..=5).contains(&settings.edge_degree) {
        return Err(SfrError::Settings("the degree of the edge must be 1 to 5"));
    }
    if settings.reach_px.is_some_and(|reach| reach.is_nan() || reach < 2.0) {
        return Err(SfrError::Settings("the reach of the profile must be 2 pixels or more"));
    }
    if settings.shading_degree > MAX_DEGREE {
        return Err(SfrError::Settings("the degree of the shading must be 0 to 2"));
    }
    if settings.last_frequency.is_nan() || settings.last_frequency <= 0.0 {
        return Err(SfrError::Settings("the last frequency must be above zero"));
    }
    let Some(full) = settings.full_scale else { return Ok(()) };
    let clipped = image.samples().iter().filter(|s| f64::from(**s) >= full).count();
    let percent = 100.0 * clipped as f64 / image.samples().len() as f64;
    if percent > 1.0 {
        return Err(SfrError::Saturated { percent });
    }
    // Integers, and values decoded from them, are clipped at 0, too.
    let dark = image.samples().iter().filter(|s| **s <= 0.0).count();
    let percent = 100.0 * dark as f64 / image.samples().len() as f64;
    if percent > 1.0 { Err(SfrError::Dark { percent }) } else { Ok(()) }
}

/// A strip around a straight edge whose position is known to about a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    /// The ends of the edge, raster coordinates, px.
    pub ends_px: [[f64; 2]; 2],
    /// Extent of the strip to either side of each end, px, linear between them.
    pub half_widths_px: [f64; 2],
}

impl Strip {
    /// True if a point is inside the strip.
    fn contains_strip(&self, [x, y]: [f64; 2]) -> bool {
        let [a, b] = self.ends_px;
        let (run, off) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
        let length = (run[0] * run[0] + run[1] * run[1]).sqrt();
        let along = (off[0] * run[0] + off[1] * run[1]) / (length * length);
        let across = (off[0] * run[1] - off[1] * run[0]) / length;
        let [p, q] = self.half_widths_px;
        (0.0..=1.0).contains(&along) && across.abs() <= p + along * (q - p)
    }

    /// The pixels around it: left column, top row, width, height, clipped to an image.
    fn bounds(&self, image: &Image) -> [usize; 4] {
        let max_half_width = self.half_widths_px[0].max(self.half_widths_px[1]) + 1.0;
        let along = |k: usize, length: usize| {
            let (a, b) = (self.ends_px[0][k], self.ends_px[1][k]);
            let low = ((a.min(b) - max_half_width).floor().max(0.0) as usize).min(length);
            let high = ((a.max(b) + max_half_width).ceil().max(0.0) as usize).min(length);
            (low, high - low)
        };
        let ((left, width), (top, height)) = (along(0, image.width()), along(1, image.height()));
        [left, top, width, height]
    }
}

/// Measures the response of the slanted edge in a strip of an image.
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
    let start = Edge::fit_through(ends, &part)?;
    let visible: Vec<f32> = (0..width * height)
        .map(|i| [left + i % width, top + i / width].map(|v| v as f64 + 0.5))
        .map(|at| if strip.contains_strip(at) { 1.0 } else { 0.0 })
        .collect();
    let visible = start.upright(&Image::from_samples(width, height, visible).expect("as many pixels"));
    let visible: Vec<bool> = visible.samples().iter().map(|s| *s > 0.5).collect();
    let (edge, profile) = fit::fit_edge(&start.upright(&part), &visible, start, settings)?;
    Ok(edge_response(&edge, &profile, settings))
}
