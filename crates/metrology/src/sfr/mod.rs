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

mod blur;
mod covariance;
mod edge;
mod error;
mod fit;
mod knots;
mod measure;
mod profile;
mod response;
#[cfg(test)]
mod tests;

pub use blur::{Blur, blur};
pub use edge::{Edge, Orientation};
pub use error::{SfrError, SfrSettings};
pub use measure::{Strip, measure_edge, measure_strip};
pub use response::{Sfr, SfrPoint, acutance, crossing, mean_curve};
