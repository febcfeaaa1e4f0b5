//! Path-space regularisation: micro-facets as wide as what a path has been scattered by.
//!
//! A path that a wide lobe has scattered meets the image of a lamp in a narrower one by luck alone, in a few samples as many times too bright as the
//! second lobe is narrower. Where a caller asks for it ([`super::PathSettings::regularize`]), each lobe of micro-facets (metals, coats, paint, glass) is
//! widened, until its density is at most [`SHARE`] of that of the widest scattering before it, or [`LEAST_PER_SR`] (Kaplanyan and Dachsbacher, "Path space
//! regularization for holistic and robust light transport", 2013; there of mirrors). What is seen straight or in mirrors is as it was; images of lamps in
//! what other surfaces mirror are blurred, and their light is kept but for what models lose at greater roughness. The mean is another one: the picture
//! is biased. Where caustics are left out, those behind matt surfaces still are: nothing is widened there; a mirror that a glossy surface shows is
//! widened, and counts. The density is that of reflection: what glass refracts straight on stays up to 36 times as dense (n = 1.5).

use core::f32::consts::PI;
use etendue_core::maths::f32::cbrt;

use super::effects::Effects;
use super::path::Path;
use crate::materials::ShadingFrame;

/// How dense a lobe may be beside the widest scattering before it. Of 4, 1, 1/2, 0.3 and 0.2, tried on car paint that sees a wet road at 64 samples, the
/// last two leave no speckle.
const SHARE: f32 = 0.25;

/// How dense any lobe may be, 1/sr: that of a GGX lobe of α = 0.28 along the normal.
const LEAST_PER_SR: f32 = 1.0;

// Behind matt surfaces all lobes are as wide, so that paths that share a tail agree on it.
const _: () = assert!(SHARE / PI < LEAST_PER_SR);

impl<const N: usize, E: Effects> Path<'_, N, E> {
    /// The least roughness α of micro-facets at a surface that the path has met: 0 where they are as they are.
    #[inline(always)]
    pub(super) fn least_alpha(&self, frame: &ShadingFrame) -> f32 {
        let settings = &self.tracer.settings;
        let left_out = self.history.is_matt() && !settings.caustics;
        if !settings.regularize || self.bounces == 0 || left_out {
            return 0.0;
        }
        alpha_of_density((SHARE * self.history.least_density()).max(LEAST_PER_SR), frame.wo.z)
    }
}

/// A roughness α at which a GGX lobe's density at its axis, seen at a cosine, is at most `density`, 1/sr. The density is
/// 1/(2π α² (cos + √(cos² + α² sin²))), and the root at least cos and, with the cosine, at least α: two bounds, of which the lower α does.
fn alpha_of_density(density: f32, cos: f32) -> f32 {
    let (steep, grazing) = (1.0 / (4.0 * PI * density * cos).sqrt(), cbrt(1.0 / (2.0 * PI * density)));
    steep.min(grazing).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Ggx;
    use glam::Vec3;

    #[test]
    fn lobes_are_no_denser_than_asked_and_not_much_wider_than_that_takes() {
        for density in [0.4_f32, 1.3, 4.0, 30.0, 1000.0, 1e6] {
            for cos in [1.0_f32, 0.7, 0.2, 0.03, 1e-3] {
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let peak = |alpha| Ggx::of(alpha).map_or(f32::INFINITY, |facets| facets.reflect_pdf(wo, Vec3::Z));
                let alpha = alpha_of_density(density, cos);
                assert!(alpha == 1.0 || peak(alpha) <= density * 1.001, "{density} {cos}: {}", peak(alpha));
                assert!(peak(0.6 * alpha) > density || alpha < 1e-4, "{density} {cos}: {alpha}");
            }
        }
        assert_eq!(alpha_of_density(f32::INFINITY, 0.5), 0.0);
    }
}
