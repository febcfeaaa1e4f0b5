//! What is found of one edge.

use super::curve::SfrPoint;
use super::edge::Orientation;
use crate::Estimate;

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

impl Sfr {
    /// With what taking off shading by surfaces of one degree more changes: where that is more than noise explains, the sides are not as even as
    /// was assumed, and the difference is half the width of a rectangular distribution (GUM 4.3.7).
    pub(super) fn with_choice_of_shading(self, other: &Self) -> Self {
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
pub(super) fn widened(a: Estimate, b: Estimate) -> Estimate {
    let own = a.standard_uncertainty * a.standard_uncertainty;
    let beyond = ((a.value - b.value) * (a.value - b.value) - own).max(0.0);
    Estimate::new(a.value, (own + beyond / 3.0).sqrt())
}
