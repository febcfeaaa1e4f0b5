//! Spatial frequency response of slanted edges.
//!
//! After ISO 12233:2023 (edge-based SFR), with the steps that lose accuracy replaced:
//!
//! | step of the standard | here |
//! | --- | --- |
//! | row-by-row centroids, then a line or polynomial | the same quantity by least squares on all pixels: start from the gradients of a median-filtered picture, then Gauss–Newton on edge and profile at once (separable least squares, Golub & Pereyra 1973), pixels that are defects left out |
//! | distances across the edge into quarter-pixel bins | a spline through the distances themselves: no bins, so no bin response and no empty bins at near-rational slopes |
//! | finite differences, then a corrected window and transform | the spline's derivative and its Fourier transform in closed form: no derivative response, no window |
//!
//! The line spread is a sum of B-splines of degree 4, each of unit area; the edge profile their integral:
//!
//! ```text
//! L(d) = Σ_j s_j β⁴((d − t_j)/h)/h        E(d) = a + ∫ L
//! SFR(f) = |Σ_j s_j exp(−2πi f t_j)| sinc(f h)⁵ / |Σ_j s_j|
//! ```
//!
//! d is the distance from the edge along its normal, pixels; f in cycles a pixel along the normal. The step h is 1/4 pixel, or as wide as
//! 5/4 of the widest gap between the distances that the slope leaves (0.45 pixels at tan θ = 1/2), which least squares needs. Beyond 10
//! pixels, where only glare and the tails of diffraction change the profile, the step is 2 pixels: less noise. Beyond 0.65 of the picture's
//! nearer side the profile is constant; what a lens spreads farther is missing from the response at 0, as in the standard. What is measured includes the pixel's aperture, |sinc(f cos θ) sinc(f sin θ)|
//! for a full square pixel.
//!
//! Uncertainty: the covariance of the s_j with each pixel's own squared residual for its variance, and with the noise that neighbours share
//! (demosaiced pictures; file covariance), carried to SFR(f), MTF50 and MTF10 by the law of propagation, to the second order where the
//! response is as small as its noise. The edge's own place is taken as known: its part is of second order. Sides that are not even are in it:
//! what surfaces of one degree more change beyond noise is half the width of a rectangular distribution.
//!
//! Refused: edges within 2° of rows, columns or diagonals, or that cross too few rows to sample the profile, or rise within a gap of its
//! samples; clipped plateaus; anything that is not one straight edge. Of a star each edge is measured in a
//! strip between its neighbours. Shading of the sides is taken off on request. Left out: chromatic aberration between channels (measure each).

mod acutance;
mod covariance;
mod edge;
mod fit;
mod knots;
mod profile;
mod shading;
mod spline;
mod strip;
#[cfg(test)]
mod tests;

use crate::{Estimate, Image};
pub use acutance::acutance;
pub use edge::{Edge, Orientation};
use profile::Profile;
use shading::levelled;
pub use strip::{Strip, measure_strip};

/// How an edge is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SfrSettings {
    /// Degree of the polynomial that the edge follows: 1 straight, 2 and 3 for edges bent by distortion.
    pub edge_degree: usize,
    /// How far from the edge the profile has fine detail, pixels; `None`: 10, or as far as the picture reaches.
    pub reach_px: Option<f64>,
    /// Degree of the surfaces, one on either side of the edge beyond the reach, by which shading is taken off: 0 for none, 1 or 2.
    pub shading_degree: usize,
    /// The reading of a saturated pixel.
    pub full_scale: Option<f64>,
    /// The last frequency of the curve, cycles a pixel.
    pub last_frequency: f64,
}

impl Default for SfrSettings {
    fn default() -> Self {
        Self { edge_degree: 1, reach_px: None, shading_degree: 0, full_scale: None, last_frequency: 1.0 }
    }
}

/// A point of the response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SfrPoint {
    /// Cycles a pixel along the edge's normal.
    pub frequency: f64,
    /// Response, 1 at frequency 0.
    pub response: Estimate,
}

/// An edge's response.
#[derive(Clone, Debug, PartialEq)]
pub struct Sfr {
    /// Angle between the edge and the nearest of rows and columns, degrees, 0 to 45.
    pub angle_deg: f64,
    /// Which of the two that is.
    pub orientation: Orientation,
    /// Levels of the dark and the bright side, in the picture's readings.
    pub levels: [f64; 2],
    /// Standard deviation of the residuals, in the picture's readings.
    pub noise: f64,
    /// The step of the profile's splines, pixels.
    pub step_px: f64,
    /// The response at frequencies from 0 on.
    pub curve: Vec<SfrPoint>,
    /// Where the response first falls to a half, cycles a pixel; none where it does not within the curve.
    pub mtf50: Option<Estimate>,
    /// Where it first falls to a tenth.
    pub mtf10: Option<Estimate>,
    /// How much the response changes at most, beyond its noise, where shading is taken off by surfaces of one degree more.
    pub shading: f64,
    /// The edge profile: (distance, px; reading), at equal steps.
    pub profile: Vec<(f64, f64)>,
}

/// Why an edge cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SfrError {
    /// Too few pixels.
    #[error("a slanted edge needs at least 16 × 16 pixels, not {width} × {height}")]
    TooSmall {
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A reading is NaN or infinite.
    #[error("the picture holds readings that are no numbers: give finite values")]
    NotFinite,
    /// There is no edge.
    #[error(
        "no slanted edge is in this part of the picture: expected one straight edge between two even surfaces ({0})"
    )]
    NoEdge(&'static str),
    /// Its angle cannot be measured.
    #[error(
        "the edge is at {angle_deg:.2}° to the pixels' rows or columns: expected 2° to 43°, so that its profile is sampled between the pixels"
    )]
    Angle {
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// The rows do not sample the profile densely enough.
    #[error(
        "the edge's profile is sampled with gaps of {gap_px:.2} pixels only: at {angle_deg:.2}° take more rows, or another angle"
    )]
    Gaps {
        /// The widest gap.
        gap_px: f64,
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// The edge rises within a gap of its samples.
    #[error(
        "the edge rises within the {gap_px:.2} pixels between the samples of its profile at {angle_deg:.2}°, so that finer structure is \
         folded back: take another angle; is the picture sampled at points (nearest neighbour)?"
    )]
    Steep {
        /// The widest gap.
        gap_px: f64,
        /// Angle to the nearest of rows and columns.
        angle_deg: f64,
    },
    /// A side is clipped.
    #[error("{percent:.1} % of the pixels are saturated: expose less, so that both sides of the edge keep their noise")]
    Saturated {
        /// Share of pixels.
        percent: f64,
    },
    /// The dark side is cut.
    #[error(
        "{percent:.1} % of the pixels read 0, where darkness is cut: expose more, or raise the black level, so that both sides keep their noise"
    )]
    Dark {
        /// Share of pixels.
        percent: f64,
    },
    /// The edge's degree or reach makes no sense.
    #[error("{0}")]
    Settings(&'static str),
}

/// The response of the slanted edge that fills a picture.
///
/// # Errors
/// Where there is no such edge, its angle cannot be measured, or it is clipped.
pub fn measure_edge(image: &Image, settings: &SfrSettings) -> Result<Sfr, SfrError> {
    check(image, settings)?;
    let start = Edge::from_gradients(image)?;
    let upright = start.upright(image);
    let by_degree = |shading_degree: usize| {
        let settings = &SfrSettings { shading_degree, ..*settings };
        let image = &levelled(&upright, &start, settings)?;
        let (edge, profile) = fit::fitted(image, &vec![true; image.samples().len()], start.clone(), settings)?;
        Ok::<_, SfrError>(told(&edge, &profile, settings))
    };
    let found = by_degree(settings.shading_degree)?;
    let further = settings.shading_degree + 1;
    let other = (further <= shading::MAX_DEGREE).then(|| by_degree(further)).and_then(Result::ok);
    Ok(match other {
        Some(other) => found.with_choice_of_shading(&other),
        None => found,
    })
}

/// Points of a curve but the first.
const POINTS: usize = 100;

fn told(edge: &Edge, profile: &Profile, settings: &SfrSettings) -> Sfr {
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

impl Sfr {
    /// With what taking off shading by surfaces of one degree more changes: where that is more than noise explains, the sides are not as even as
    /// was assumed, and the difference is half the width of a rectangular distribution (GUM 4.3.7).
    fn with_choice_of_shading(self, other: &Self) -> Self {
        let differ = |(a, b): (&SfrPoint, &SfrPoint)| {
            let by = (a.response.value - b.response.value).abs();
            if by > 2.0 * a.response.standard_uncertainty { by } else { 0.0 }
        };
        let shading = self.curve.iter().zip(&other.curve).map(differ).fold(0.0, f64::max);
        let point = |(a, b): (&SfrPoint, &SfrPoint)| SfrPoint { response: widened(a.response, b.response), ..*a };
        let crossed = |a: Option<Estimate>, b: Option<Estimate>| a.map(|a| b.map_or(a, |b| widened(a, b)));
        Self {
            curve: self.curve.iter().zip(&other.curve).map(point).collect(),
            mtf50: crossed(self.mtf50, other.mtf50),
            mtf10: crossed(self.mtf10, other.mtf10),
            shading,
            ..self
        }
    }

    /// The same where the picture's readings lie `pitch_px` pixels apart: lengths in pixels, frequencies in cycles a pixel.
    #[must_use]
    pub fn sampled_every(self, pitch_px: f64) -> Self {
        let slower = |e: Estimate| e.scaled(1.0 / pitch_px);
        let point = |p: SfrPoint| SfrPoint { frequency: p.frequency / pitch_px, ..p };
        Self {
            step_px: self.step_px * pitch_px,
            mtf50: self.mtf50.map(slower),
            mtf10: self.mtf10.map(slower),
            curve: self.curve.into_iter().map(point).collect(),
            profile: self.profile.into_iter().map(|(d, reading)| (d * pitch_px, reading)).collect(),
            ..self
        }
    }
}

/// u² = u_a² + max((a − b)² − u_a², 0)/3: of what differs by no more than its own uncertainty nothing is added.
fn widened(a: Estimate, b: Estimate) -> Estimate {
    let own = a.standard_uncertainty * a.standard_uncertainty;
    let beyond = ((a.value - b.value) * (a.value - b.value) - own).max(0.0);
    Estimate::new(a.value, (own + beyond / 3.0).sqrt())
}

/// The mean of responses at the same frequencies.
#[must_use]
pub fn mean_curve(curves: &[&[SfrPoint]]) -> Vec<SfrPoint> {
    let count = curves.len() as f64;
    let at = |i: usize| {
        let points = || curves.iter().map(|curve| curve[i].response);
        let squares: f64 = points().map(|e| e.standard_uncertainty * e.standard_uncertainty).sum();
        let response = Estimate::new(points().map(|e| e.value).sum::<f64>() / count, squares.sqrt() / count);
        SfrPoint { frequency: curves[0][i].frequency, response }
    };
    let least = curves.iter().map(|curve| curve.len()).min().unwrap_or(0);
    (0..least).map(at).collect()
}

fn check(image: &Image, settings: &SfrSettings) -> Result<(), SfrError> {
    let (width, height) = (image.width(), image.height());
    if width < 16 || height < 16 {
        return Err(SfrError::TooSmall { width, height });
    }
    if image.samples().iter().any(|s| !s.is_finite()) {
        return Err(SfrError::NotFinite);
    }
    if !(1..=5).contains(&settings.edge_degree) {
        return Err(SfrError::Settings("the edge's degree must be 1 to 5"));
    }
    if settings.reach_px.is_some_and(|reach| reach.is_nan() || reach < 2.0) {
        return Err(SfrError::Settings("the profile's reach must be 2 pixels or more"));
    }
    if settings.shading_degree > shading::MAX_DEGREE {
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
    // Whole numbers and what is decoded from them end at 0, too.
    let dark = image.samples().iter().filter(|s| **s <= 0.0).count();
    let percent = 100.0 * dark as f64 / image.samples().len() as f64;
    if percent > 1.0 { Err(SfrError::Dark { percent }) } else { Ok(()) }
}

/// Where the curve falls to a level: midway between where the curve less its standard uncertainty does and where the curve with it does, so
/// that a noisy curve is not taken at its first dip. Half of what lies between is the uncertainty, or the uncertainty over the slope of a line
/// through the points about the place, where that is more (neighbours share their noise, a pair's slope would be mostly noise).
#[must_use]
pub fn crossing(curve: &[SfrPoint], level: f64) -> Option<Estimate> {
    const ABOUT: f64 = 0.05;
    let first = |sigmas: f64| {
        let value = |p: &SfrPoint| p.response.value + sigmas * p.response.standard_uncertainty;
        let pair = curve.windows(2).find(|pair| value(&pair[0]) > level && value(&pair[1]) <= level)?;
        let share = (value(&pair[0]) - level) / (value(&pair[0]) - value(&pair[1]));
        Some(pair[0].frequency + share * (pair[1].frequency - pair[0].frequency))
    };
    let plain = first(0.0)?;
    let (low, high) = (first(-1.0).unwrap_or(plain), first(1.0).unwrap_or(plain));
    let at = 0.5 * (low + high);
    let near: Vec<&SfrPoint> = curve.iter().filter(|p| (p.frequency - at).abs() <= ABOUT).collect();
    let mean = |f: fn(&SfrPoint) -> f64| near.iter().map(|p| f(p)).sum::<f64>() / near.len() as f64;
    let (x, y) = (mean(|p| p.frequency), mean(|p| p.response.value));
    let products = near.iter().map(|p| (p.frequency - x) * (p.response.value - y)).sum::<f64>();
    let slope = products / near.iter().map(|p| (p.frequency - x) * (p.frequency - x)).sum::<f64>();
    let u = near.iter().map(|p| p.response.standard_uncertainty).fold(0.0, f64::max);
    Some(Estimate::new(at, (u / slope.abs()).max(0.5 * (high - low))))
}
