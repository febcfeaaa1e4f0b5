//! Approximate depth of field: a blend with one blurred copy by distance.
//!
//! L' = (1 − t) L + t B(L), with B a normalised bell of three running means, as wide as a disc of the diameter `blur_px` (standard deviation: a
//! quarter of it), and t a function of the distance d along the ray: 0 from `sharp_near_m` to `sharp_far_m`, rising linearly to 1 at `blurred_near_m`
//! in front and `blurred_far_m` behind, 1 beyond. This is the method of D. Gruyer, M. Grapinet and P. De Souza (2012), "Modeling and validation of a
//! new generic virtual optical sensor for ADAS prototyping".
//!
//! Running means have fractional ends so that any width is met exactly (P. Gwosdek et al., 2011). The cost does not depend on the width. Near objects
//! bleed onto far ones and vice versa, and the blur has a single size: it fits a lens at one distance at most.

use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::Radiance;

use super::PinholeView;
use crate::{error::OpticsError, overlap::positive};

/// Running means in each direction.
const PASSES: usize = 3;

/// Parameters of a blend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FastParameters {
    /// Start of the sharp range, m; 0: nothing near is blurred.
    pub sharp_near_m: f64,
    /// End of the sharp range, m; infinity: nothing far is blurred.
    pub sharp_far_m: f64,
    /// Fully blurred from this distance to the camera, m.
    pub blurred_near_m: f64,
    /// Fully blurred from this distance on, m.
    pub blurred_far_m: f64,
    /// Diameter of the largest blur, px.
    pub blur_px: f64,
}

/// A blend by distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FastBlend {
    parameters: FastParameters,
}

impl FastBlend {
    /// Creates a blend.
    ///
    /// # Errors
    /// If the distances are not in the order blurred, sharp, sharp, blurred, or the blur is not positive.
    pub fn new(parameters: FastParameters) -> Result<Self, OpticsError> {
        let FastParameters { sharp_near_m, sharp_far_m, blurred_near_m, blurred_far_m, blur_px } = parameters;
        positive("blur_px", blur_px)?;
        let near =
            (0.0 <= blurred_near_m && blurred_near_m < sharp_near_m) || (sharp_near_m == 0.0 && blurred_near_m == 0.0);
        let far = (sharp_far_m < blurred_far_m && blurred_far_m.is_finite()) || sharp_far_m == f64::INFINITY;
        if near && far && sharp_near_m <= sharp_far_m {
            return Ok(Self { parameters });
        }
        Err(OpticsError::SharpRange { blurred_near_m, sharp_near_m, sharp_far_m, blurred_far_m })
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &FastParameters {
        &self.parameters
    }

    /// Reach of the blur, px.
    pub(super) fn reach_px(&self) -> usize {
        PASSES * (RunningMean::new(self.parameters.blur_px).radius + 1)
    }

    /// The fraction of the blurred copy at a distance.
    fn blurred_fraction(&self, distance_m: f64) -> f64 {
        let p = &self.parameters;
        if distance_m < p.sharp_near_m {
            ((p.sharp_near_m - distance_m) / (p.sharp_near_m - p.blurred_near_m)).min(1.0)
        } else if distance_m > p.sharp_far_m {
            ((distance_m - p.sharp_far_m) / (p.blurred_far_m - p.sharp_far_m)).min(1.0)
        } else {
            0.0
        }
    }

    pub(super) fn image(&self, view: &PinholeView<'_>) -> SpectralCube<Radiance> {
        let mean = RunningMean::new(self.parameters.blur_px);
        let size = [view.width(), view.height()];
        let visible: Vec<f64> =
            (0..size[0] * size[1]).map(|i| f64::from(u8::from(view.inverse_per_m(i).is_some()))).collect();
        let coverage = mean.blurred(visible.clone(), size);
        let mut image = view.cropped();
        for (from, to) in view.radiance.planes().iter().zip(image.planes_mut()) {
            let light = from.samples().iter().zip(&visible);
            let light = light.map(|(l, s)| if *s > 0.0 { f64::from(*l) } else { 0.0 }).collect();
            self.blend(view, &mean.blurred(light, size), &coverage, to);
        }
        image
    }

    fn blend(&self, view: &PinholeView<'_>, blurred: &[f64], coverage: &[f64], to: &mut Plane<Radiance>) {
        let width = to.width();
        for (i, light) in to.samples_mut().iter_mut().enumerate() {
            let pixel = (i / width + view.margin_px) * view.width() + i % width + view.margin_px;
            let distance = f64::from(view.distance.samples()[pixel]);
            let fraction = if distance > 0.0 { self.blurred_fraction(distance) } else { 0.0 };
            if fraction > 0.0 {
                *light = ((1.0 - fraction) * f64::from(*light) + fraction * blurred[pixel] / coverage[pixel]) as f32;
            }
        }
    }
}

/// A running mean with fractional ends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RunningMean {
    /// Whole pixels on each side.
    radius: usize,
    /// Weight of the next pixel.
    end: f64,
}

impl RunningMean {
    /// The mean for which three passes have the variance of a disc, a sixteenth of its diameter squared.
    fn new(diameter_px: f64) -> Self {
        let variance = diameter_px * diameter_px / 16.0 / PASSES as f64;
        let radius = (((12.0 * variance + 1.0).sqrt() - 1.0) / 2.0).floor();
        let next = radius + 1.0;
        let end = (2.0 * radius + 1.0) * (radius * next / 3.0 - variance) / (2.0 * (variance - next * next));
        Self { radius: radius as usize, end }
    }

    /// An image after all passes along rows and columns; zero beyond its edges.
    fn blurred(&self, mut image: Vec<f64>, [width, height]: [usize; 2]) -> Vec<f64> {
        let mut line = Vec::new();
        for _ in 0..PASSES {
            for row in image.chunks_exact_mut(width) {
                line.clear();
                line.extend_from_slice(row);
                self.line(&line, |x, value| row[x] = value);
            }
            for x in 0..width {
                line.clear();
                line.extend((0..height).map(|y| image[y * width + x]));
                self.line(&line, |y, value| image[y * width + x] = value);
            }
        }
        image
    }

    fn line(&self, line: &[f64], mut set: impl FnMut(usize, f64)) {
        let at = |i: i64| usize::try_from(i).ok().and_then(|i| line.get(i)).copied().unwrap_or(0.0);
        let radius = self.radius as i64;
        let area = 2.0 * (self.radius as f64 + self.end) + 1.0;
        let mut sum: f64 = (0..radius).map(at).sum();
        for i in 0..line.len() as i64 {
            sum += at(i + radius) - at(i - radius - 1);
            set(i as usize, (sum + self.end * (at(i - radius - 1) + at(i + radius + 1))) / area);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters() -> FastParameters {
        FastParameters { sharp_near_m: 4.0, sharp_far_m: 10.0, blurred_near_m: 2.0, blurred_far_m: 30.0, blur_px: 8.0 }
    }

    #[test]
    fn three_means_have_the_variance_that_is_asked_for() {
        for diameter in [0.5, 1.0, 3.7, 8.0, 21.0] {
            let mut line = vec![0.0; 101];
            line[50] = 1.0;
            let blurred = RunningMean::new(diameter).blurred(line, [101, 1]);
            // One row high: columns lose light beyond the edges, equally for all.
            let sum: f64 = blurred.iter().sum();
            let variance: f64 =
                blurred.iter().enumerate().map(|(x, v)| (x as f64 - 50.0) * (x as f64 - 50.0) * v / sum).sum();
            assert!((variance - diameter * diameter / 16.0).abs() < 1e-9, "{diameter}: {variance}");
        }
    }

    #[test]
    fn the_share_rises_linearly_on_both_sides_of_the_sharp_range() {
        let blend = FastBlend::new(parameters()).expect("legal");
        let fractions = [1.0, 2.0, 3.0, 4.0, 7.0, 10.0, 20.0, 30.0, f64::INFINITY].map(|d| blend.blurred_fraction(d));
        assert_eq!(fractions, [1.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0]);
        let far = FastParameters { sharp_far_m: f64::INFINITY, ..parameters() };
        assert_eq!(FastBlend::new(far).expect("legal").blurred_fraction(f64::INFINITY), 0.0);
    }

    #[test]
    fn distances_out_of_order_are_refused() {
        let wrong = [
            FastParameters { sharp_near_m: 11.0, ..parameters() },
            FastParameters { blurred_near_m: 4.0, ..parameters() },
            FastParameters { blurred_far_m: 10.0, ..parameters() },
            FastParameters { blurred_far_m: f64::INFINITY, ..parameters() },
            FastParameters { sharp_far_m: f64::NAN, ..parameters() },
        ];
        for wrong in wrong {
            assert!(matches!(FastBlend::new(wrong), Err(OpticsError::SharpRange { .. })), "{wrong:?}");
        }
        assert!(FastBlend::new(FastParameters { blur_px: 0.0, ..parameters() }).is_err());
    }
}
