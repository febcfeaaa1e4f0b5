//! The Beckmann distribution of microfacets with height-correlated Smith shadowing.
//!
//! D(m) = exp(−tan²θ/α²)/(π α² cos⁴θ) (Beckmann and Spizzichino 1963): slopes are normally distributed with variance α²/2. Λ = (exp(−a²)/(a√π) − erfc
//! a)/2 with a = 1/(α tan θ) (Walter et al. 2007), exact where that paper's rational form is not. Visible facets are sampled (Heitz and d'Eon 2014):
//! the slope towards the viewer by numerical inversion of [1 + erf x + tan θ exp(−x²)/√π], the slope across by the inverse error function (Giles
//! 2010). The error function is Hastings' (Abramowitz and Stegun 7.1.26, 1.5e-7).

use core::f32::consts::PI;

use etendue_core::maths::f32::{exp, ln};
use glam::{Vec2, Vec3};

const FRAC_1_SQRT_PI: f32 = 0.564_189_6;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Beckmann {
    pub(super) alpha: f32,
}

impl Beckmann {
    /// Density of facet normals by solid angle, over the projected area; 1/sr.
    fn density(self, m: Vec3) -> f32 {
        let (a2, z2) = (self.alpha * self.alpha, m.z * m.z);
        let steepness = (m.x * m.x + m.y * m.y) / (a2 * z2);
        // Beyond, exp is 0 in f32.
        if steepness < 100.0 { exp(-steepness) / (PI * a2 * z2 * z2) } else { 0.0 }
    }

    /// cos θ · Λ, finite at grazing.
    pub(super) fn shadow(self, w: Vec3) -> f32 {
        let slope = self.alpha * (w.x * w.x + w.y * w.y).sqrt();
        let a = w.z / slope.max(f32::MIN_POSITIVE);
        // Beyond, Λ is below 1e-12.
        if a > 5.0 {
            return 0.0;
        }
        let bell = exp(-a * a);
        (0.5 * (slope * FRAC_1_SQRT_PI * bell - w.z * erfc_over_bell(a) * bell)).max(0.0)
    }

    /// f · cos θᵢ without the Fresnel factor, 1/sr; `m` is the unit half vector.
    pub(super) fn reflect(self, wo: Vec3, wi: Vec3, m: Vec3) -> f32 {
        let below = wo.z * wi.z + wi.z * self.shadow(wo) + wo.z * self.shadow(wi);
        0.25 * self.density(m) * wi.z / below.max(f32::MIN_POSITIVE)
    }

    /// Density by solid angle of the direction reflected at a visible facet `m`, 1/sr.
    pub(super) fn reflect_pdf(self, wo: Vec3, m: Vec3) -> f32 {
        0.25 * self.density(m) / (wo.z + self.shadow(wo))
    }

    /// G₂/G₁ = f cos θᵢ / (F · pdf) of a direction reflected at a visible facet.
    pub(super) fn weight(self, wo: Vec3, wi: Vec3) -> f32 {
        let so = self.shadow(wo);
        wi.z * (wo.z + so) / (wo.z * wi.z + wi.z * so + wo.z * self.shadow(wi)).max(f32::MIN_POSITIVE)
    }

    /// Samples a facet normal visible from `wo`.
    pub(super) fn sample(self, wo: Vec3, u: Vec2) -> Vec3 {
        // Sampled for the stretched direction (roughness 1), and scaled back.
        let (x, y) = (self.alpha * wo.x, self.alpha * wo.y);
        let side = (x * x + y * y).sqrt();
        let (cos_phi, sin_phi) = if side > 0.0 { (x / side, y / side) } else { (1.0, 0.0) };
        let along = visible_slope(side / wo.z.max(1e-20), u.x);
        let across = erf_inverse((2.0 * u.y - 1.0).clamp(-0.999_999_9, 0.999_999_9));
        let slope = Vec2::new(cos_phi * along - sin_phi * across, sin_phi * along + cos_phi * across) * self.alpha;
        Vec3::new(-slope.x, -slope.y, 1.0).normalize()
    }
}

/// Maximum sampled slope: the fraction of steeper ones is exp(−25).
const MAX_SLOPE: f32 = 5.0;

/// The slope x < cot θ of density (1 − x tan θ) exp(−x²), sampled by `u`: the root of an increasing function, found by Newton's method
/// within a bracket.
fn visible_slope(tan: f32, u: f32) -> f32 {
    let rise = |x: f32| {
        let bell = exp(-x * x);
        (1.0 + erf(x) + tan * FRAC_1_SQRT_PI * bell, 2.0 * FRAC_1_SQRT_PI * bell * (1.0 - x * tan))
    };
    let (mut low, mut high) = (-MAX_SLOPE, (1.0 / tan.max(1e-20)).min(MAX_SLOPE));
    let goal = rise(high).0 * u;
    let mut x = 0.5 * (low + high.min(1.0));
    for _ in 0..24 {
        let (value, slope) = rise(x);
        let error = value - goal;
        if error.abs() < 3e-7 * (1.0 + tan) {
            break;
        }
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let step = x - error / slope.max(1e-20);
        x = if step > low && step < high { step } else { 0.5 * (low + high) };
    }
    x
}

/// erfc(x) · exp(x²), x ≥ 0, to 1.5e-7 · exp(x²).
fn erfc_over_bell(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    t * (0.254_829_6 + t * (-0.284_496_74 + t * (1.421_413_8 + t * (-1.453_152 + t * 1.061_405_4))))
}

fn erf(x: f32) -> f32 {
    (1.0 - erfc_over_bell(x.abs()) * exp(-x * x)).copysign(x)
}

/// The inverse of the error function for |x| < 1, to a few units of f32.
fn erf_inverse(x: f32) -> f32 {
    const CENTRE: [f32; 9] = [
        2.810_226_4e-8,
        3.432_739_4e-7,
        -3.523_387_7e-6,
        -4.391_506_5e-6,
        2.185_808_7e-4,
        -1.253_725_e-3,
        -4.177_681_6e-3,
        0.246_640_73,
        1.501_409_4,
    ];
    const TAIL: [f32; 9] = [
        -2.002_142_6e-4,
        1.009_505_6e-4,
        1.349_343_2e-3,
        -3.673_428_4e-3,
        5.739_507_7e-3,
        -7.622_461_3e-3,
        9.438_870_5e-3,
        1.001_674,
        2.832_976_8,
    ];
    let w = -ln((1.0 - x) * (1.0 + x));
    let (w, series) = if w < 5.0 { (w - 2.5, CENTRE) } else { (w.sqrt() - 3.0, TAIL) };
    x * series.into_iter().fold(0.0, |sum, c| sum * w + c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::microfacet::mirrored;

    #[test]
    fn the_error_function_is_its_integral() {
        let mut integral = 0.0_f64;
        const STEP: f64 = 1e-4;
        for i in 0..30_000 {
            let x = (f64::from(i) + 0.5) * STEP;
            integral += 2.0 / core::f64::consts::PI.sqrt() * etendue_core::maths::f64::exp(-x * x) * STEP;
            if i % 1000 == 999 {
                let end = ((f64::from(i) + 1.0) * STEP) as f32;
                assert!((f64::from(erf(end)) - integral).abs() < 3e-7, "{end}");
                // Near 1 the accuracy of the inverse is that of erf in f32, divided by its slope.
                let slack = 1e-6 + 4e-7 / (1.13 * f64::from(exp(-end * end)));
                assert!((f64::from(erf_inverse(integral as f32) - end)).abs() < slack, "{end}");
            }
        }
    }

    #[test]
    fn what_is_seen_of_the_facets_is_the_plane() {
        // ∫ D(m) [wo·m]₊ G₁ dω = cos θₒ: the density of visible facets integrates to 1.
        for alpha in [0.05_f32, 0.4, 1.0] {
            for cos in [1.0_f32, 0.6, 0.1, 0.02] {
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let beckmann = Beckmann { alpha };
                let n = 400;
                let mut sum = 0.0_f64;
                for i in 0..n * n {
                    // Slopes (−5 α … 5 α)²; dω = cos³ d²slope.
                    let at = |k: usize| alpha * 10.0 * ((k as f32 + 0.5) / n as f32 - 0.5);
                    let m = Vec3::new(-at(i % n), -at(i / n), 1.0).normalize();
                    let area = (10.0 * alpha / n as f32) * (10.0 * alpha / n as f32) * m.z * m.z * m.z;
                    let actual = beckmann.density(m) * wo.dot(m).max(0.0) / (wo.z + beckmann.shadow(wo));
                    sum += f64::from(actual * area);
                }
                assert!((sum - 1.0).abs() < 1e-3, "{alpha} {cos}: {sum}");
            }
        }
    }

    #[test]
    fn weights_are_value_over_density() {
        let wo = Vec3::new(0.6, 0.0, 0.8);
        for alpha in [0.01, 0.2, 0.9] {
            let facets = Beckmann { alpha };
            for i in 0..64 {
                let m = facets.sample(wo, Vec2::new((i % 8) as f32 / 8.0 + 0.01, (i / 8) as f32 / 8.0 + 0.01));
                let wi = mirrored(wo, m);
                if wi.z > 1e-3 {
                    let ratio = facets.reflect(wo, wi, m) / facets.reflect_pdf(wo, m);
                    assert!((ratio - facets.weight(wo, wi)).abs() < 1e-4 * ratio, "{alpha} {wi}");
                    assert!(ratio <= 1.0 + 1e-5);
                }
            }
        }
    }

    #[test]
    fn extremes_of_the_square_give_unit_normals() {
        for wo in [Vec3::Z, Vec3::X, Vec3::new(1.0, 0.0, 1e-7).normalize(), Vec3::new(0.0, 0.8, 0.6)] {
            for alpha in [1e-4, 1e-2, 1.0] {
                for u in [Vec2::ZERO, Vec2::new(0.5, 0.999_999_94), Vec2::splat(0.999_999_94), Vec2::new(0.999, 0.0)] {
                    let m = Beckmann { alpha }.sample(wo, u);
                    assert!((m.length() - 1.0).abs() < 1e-5 && m.z > 0.0, "{wo} {alpha} {u}: {m}");
                }
            }
        }
    }
}
