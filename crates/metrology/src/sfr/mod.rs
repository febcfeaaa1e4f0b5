//! Spatial frequency response of slanted edges.
//!
//! After ISO 12233:2023 (edge-based SFR), with the inaccurate steps replaced:
//!
//! | step of the standard | here |
//! | --- | --- |
//! | row-by-row centroids, then a line or polynomial | the same quantity by least squares on all pixels: start from the gradients of a median-filtered image, then Gauss–Newton on edge and profile together (separable least squares, Golub & Pereyra 1973), without defective pixels |
//! | distances across the edge into quarter-pixel bins | a spline over the distances themselves: no bins, so no bin response and no empty bins at near-rational slopes |
//! | finite differences, then a corrected window and transform | the spline's derivative and its Fourier transform in closed form: no derivative response, no window |
//!
//! The line spread is a sum of B-splines of degree 4, each of unit area; the edge profile is their integral:
//!
//! ```text
//! L(d) = Σ_j s_j β⁴((d − t_j)/h)/h        E(d) = a + ∫ L
//! SFR(f) = |Σ_j s_j exp(−2πi f t_j)| sinc(f h)⁵ / |Σ_j s_j|
//! ```
//!
//! d is the distance from the edge along its normal, pixels; f in cycles per pixel along the normal. The step h is 1/4 pixel, or
//! 5/4 of the widest gap between the distances at this slope (0.45 pixels at tan θ = 1/2), as least squares requires. Beyond 10
//! pixels, where only glare and the tails of diffraction change the profile, the step is 2 pixels, for less noise. Beyond 0.65 of
//! the image's nearer side the profile is constant; light that the lens spreads farther is missing from the response at 0, as in
//! the standard. The result includes the pixel aperture, |sinc(f cos θ) sinc(f sin θ)| for a full square pixel.
//!
//! Uncertainty: the covariance of the s_j, with each pixel's own squared residual as its variance, and with noise shared by
//! neighbours (demosaiced images; file covariance), is propagated to SFR(f), MTF50 and MTF10 by the law of propagation, to second
//! order if the response is as small as its noise. The position of the edge is treated as known: its contribution is of second
//! order. Non-uniform sides are included: the change by surfaces of one degree more, beyond noise, is half the width of a
//! rectangular distribution.
//!
//! Refused: edges within 2° of rows, columns or diagonals, edges that cross too few rows to sample the profile, or rise within a
//! gap between its samples; clipped plateaus; anything that is not one straight edge. Each edge of a star is measured in a strip
//! between its neighbours. Shading of the sides is removed on request. Limitations: chromatic aberration between channels
//! (measure each channel).

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
