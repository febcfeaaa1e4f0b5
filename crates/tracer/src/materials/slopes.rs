//! Light that facets reflect after one reflection, by quadrature over their slopes (Gauss–Legendre rule).
//!
//! A facet's normal is (−α x, −α y, 1) normalised; slopes have the density P(x, y), exp(−x² − y²)/π for Beckmann and 1/(π (1 + x² + y²)²) for GGX. A
//! viewer at the cosine μ, in the plane of x, sees each by (μ − α x s)₊/(μ (1 + Λₒ)), s = √(1 − μ²); these weights integrate to 1 (Heitz 2014). Of
//! the visible light, (1 + Λₒ)/(1 + Λₒ + Λᵢ) leaves at once. The rest hits other facets, and so does all light that a facet reflects downwards. Light
//! goes up for x between the roots of μ − 2 α x s − μ α² (x² + y²) = 0, so that the Gauss–Legendre rule integrates smooth pieces only.
//!
//! The error is below 2e-5 at all cosines and α ≥ 1e-4, found by comparison with the same rule of 64 nodes.

use core::f64::consts::{FRAC_1_PI, FRAC_PI_2};
use std::sync::LazyLock;

use etendue_core::maths::f64::{atan, exp, sin_cos};
use glam::Vec3;

use super::{beckmann::Beckmann, microfacet::Distribution};

/// Slopes of Beckmann's facets beyond are left out: their fraction is exp(−30).
const MAX_SLOPE: f64 = 5.5;

const FRAC_1_SQRT_PI: f64 = 0.564_189_583_547_756_3;

/// Facets of one roughness as a viewer at one cosine sees them.
#[derive(Clone, Copy, Debug)]
pub(super) struct VisibleFacets {
    distribution: Distribution,
    alpha: f64,
    cos: f64,
    sin: f64,
    /// μ Λₒ.
    shadow: f64,
}

/// Interval of coordinates of a strip.
#[derive(Clone, Copy)]
struct StripInterval {
    low: f64,
    high: f64,
}

/// Facets of one slope y.
struct SlopeStrip {
    y: f64,
    /// Stretch of the coordinate along x, see [`VisibleFacets::slope`].
    stretch: f64,
    weight: f64,
}

impl VisibleFacets {
    /// Facets of roughness `alpha` seen at the cosine `cos`.
    pub(super) fn new(distribution: Distribution, alpha: f32, cos: f32) -> Self {
        let (alpha, cos) = (f64::from(alpha), f64::from(cos).clamp(1e-7, 1.0));
        let sin = (1.0 - cos * cos).sqrt();
        Self { distribution, alpha, cos, sin, shadow: shadow(distribution, alpha, cos, sin) }
    }

    /// Fraction of light that does not leave after one reflection, for facets that reflect everything: 1 − E.
    pub(super) fn energy_loss(&self) -> f64 {
        let (above, below) = self.strips();
        let all = |strip: &SlopeStrip| strip.weight * self.along(strip, self.ends(strip), |_, _| 1.0);
        let below: f64 = below.iter().map(all).sum();
        let above = above.iter().map(|strip| {
            let (visible, up) = (self.ends(strip), self.upward(strip));
            let (left, right) =
                (StripInterval { low: visible.low, high: up.low }, StripInterval { low: up.high, high: visible.high });
            let down = self.along(strip, left, |_, _| 1.0) + self.along(strip, right, |_, _| 1.0);
            strip.weight * (down + self.along(strip, up, |_, up| 1.0 - self.free(up)))
        });
        above.sum::<f64>() + below
    }

    /// Fraction of light that leaves after one reflection, for facets whose reflectance `of` depends on the cosine at the facet and on the
    /// cosine at which the light leaves.
    pub(super) fn reflected(&self, of: impl Fn(f64, f64) -> f64) -> f64 {
        let light = |strip: &SlopeStrip| {
            strip.weight * self.along(strip, self.upward(strip), |cos_facet, up| self.free(up) * of(cos_facet, up))
        };
        self.strips().0.iter().map(light).sum()
    }

    /// Strips that reflect part of the light up, and strips that reflect all of it down.
    fn strips(&self) -> ([SlopeStrip; 20], [SlopeStrip; 20]) {
        let end = match self.distribution {
            Distribution::Ggx => FRAC_PI_2,
            Distribution::Beckmann => MAX_SLOPE,
        };
        let steep = 1.0 / (self.alpha * self.cos);
        let split = self.coordinate(steep, 1.0).min(end);
        // Dense at the split, where the upward part shrinks like a root.
        let above = |(g, w): (f64, f64)| (split * (2.0 - g) * g, 2.0 * w * split * (1.0 - g));
        let below = |(g, w): (f64, f64)| (split + (end - split) * g, w * (end - split));
        let strip = |(t, weight)| self.strip(t, weight);
        (GAUSS.map(|node| strip(above(node))), GAUSS.map(|node| strip(below(node))))
    }

    /// Both signs of y.
    fn strip(&self, t: f64, weight: f64) -> SlopeStrip {
        match self.distribution {
            Distribution::Ggx => {
                let (sin, cos) = sin_cos(t);
                let cos = cos.max(1e-15);
                SlopeStrip { y: sin / cos, stretch: 1.0 / cos, weight: 2.0 * weight * cos }
            }
            Distribution::Beckmann => {
                SlopeStrip { y: t, stretch: 1.0, weight: 2.0 * weight * FRAC_1_SQRT_PI * exp(-t * t) }
            }
        }
    }

    /// The coordinate of a slope: the arc tangent for GGX, the slope itself for Beckmann.
    fn coordinate(&self, x: f64, stretch: f64) -> f64 {
        match self.distribution {
            Distribution::Ggx => atan(x / stretch),
            Distribution::Beckmann => x.clamp(-MAX_SLOPE, MAX_SLOPE),
        }
    }

    /// The slope at a coordinate, and the density there.
    fn slope(&self, t: f64, stretch: f64) -> (f64, f64) {
        match self.distribution {
            Distribution::Ggx => {
                let (sin, cos) = sin_cos(t);
                let cos = cos.max(1e-15);
                (stretch * sin / cos, cos * cos * FRAC_1_PI)
            }
            Distribution::Beckmann => (t, FRAC_1_SQRT_PI * exp(-t * t)),
        }
    }

    /// Coordinates between which facets of a strip are visible.
    fn ends(&self, strip: &SlopeStrip) -> StripInterval {
        let at = |x| self.coordinate(x, strip.stretch);
        StripInterval { low: at(f64::NEG_INFINITY), high: at(self.cos / (self.alpha * self.sin)) }
    }

    /// Coordinates between which facets of a strip reflect light up.
    fn upward(&self, strip: &SlopeStrip) -> StripInterval {
        let (steep, s) = (self.alpha * strip.y, self.sin);
        let root = (s * s + self.cos * self.cos * (1.0 - steep * steep)).max(0.0).sqrt();
        let left = -(s + root) / (self.cos * self.alpha);
        let right = self.cos * (1.0 - steep * steep) / (self.alpha * (s + root).max(1e-300));
        let at = |x| self.coordinate(x, strip.stretch);
        StripInterval { low: at(left), high: at(right.max(left)) }
    }

    /// ∫ over the visible part of a strip, times a function of the cosine at the facet and of the reflected light's.
    fn along(&self, strip: &SlopeStrip, coordinates: StripInterval, of: impl Fn(f64, f64) -> f64) -> f64 {
        let StripInterval { low, high } = coordinates;
        let at = |(g, w): &(f64, f64)| {
            let (x, density) = self.slope(low + (high - low) * g, strip.stretch);
            let towards = (self.cos - self.alpha * x * self.sin).max(0.0);
            let square = 1.0 + self.alpha * self.alpha * (x * x + strip.y * strip.y);
            let up = (2.0 * towards / square - self.cos).clamp(0.0, 1.0);
            w * density * towards * of((towards / square.sqrt()).min(1.0), up)
        };
        GAUSS.iter().map(at).sum::<f64>() * (high - low) / (self.cos + self.shadow)
    }

    /// (1 + Λₒ)/(1 + Λₒ + Λᵢ).
    fn free(&self, up: f64) -> f64 {
        let shadow = shadow(self.distribution, self.alpha, up, (1.0 - up * up).max(0.0).sqrt());
        let reached = up * (self.cos + self.shadow);
        if reached > 0.0 { reached / (reached + shadow * self.cos) } else { 0.0 }
    }
}

/// cos θ · Λ.
fn shadow(distribution: Distribution, alpha: f64, cos: f64, sin: f64) -> f64 {
    match distribution {
        Distribution::Ggx => {
            let square = alpha * alpha * sin * sin;
            0.5 * square / ((cos * cos + square).sqrt() + cos).max(1e-300)
        }
        Distribution::Beckmann => {
            let direction = Vec3::new(sin as f32, 0.0, cos as f32);
            f64::from(Beckmann { alpha: alpha as f32 }.shadow(direction))
        }
    }
}

/// Nodes of the rule.
const NODES: usize = 20;

/// Nodes on [0, 1] and their weights, which sum to 1: exact for polynomials up to degree 39.
pub(super) static GAUSS: LazyLock<[(f64, f64); NODES]> = LazyLock::new(|| core::array::from_fn(node));

/// Newton's method from Tricomi's estimate of a root of the Legendre polynomial.
fn node(i: usize) -> (f64, f64) {
    let n = NODES as f64;
    let mut x = etendue_core::maths::f64::cos(core::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
    for _ in 0..8 {
        let (value, slope) = legendre(x);
        x -= value / slope;
    }
    let slope = legendre(x).1;
    (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
}

/// The Legendre polynomial and its derivative, by recurrence.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=NODES {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, NODES as f64 * (x * value - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn energy_loss(distribution: Distribution, alpha: f32, cos: f32) -> f64 {
        VisibleFacets::new(distribution, alpha, cos).energy_loss()
    }

    #[test]
    fn losses_have_their_known_values() {
        // GGX of α = 1 along the normal: ln 2 in closed form. The others by the same rule with 64 nodes, in f64.
        let known = [
            (Distribution::Ggx, 1.0, 1.0, core::f64::consts::LN_2),
            (Distribution::Ggx, 0.25, 1.0, 0.084_187_57),
            (Distribution::Ggx, 0.1, 0.3, 0.063_748_24),
            (Distribution::Ggx, 1e-3, 1e-3, 0.107_925_4),
            (Distribution::Beckmann, 1.0, 1.0, 0.538_385_5),
            (Distribution::Beckmann, 0.5, 0.05, 0.024_014_54),
        ];
        for (distribution, alpha, cos, expected) in known {
            let lost = energy_loss(distribution, alpha, cos);
            assert!((lost - expected).abs() < 3e-5, "{distribution:?} {alpha} {cos}: {lost} {expected}");
        }
    }

    #[test]
    fn what_leaves_and_what_is_lost_are_all() {
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for alpha in [1e-4, 1e-2, 0.1, 0.4, 1.0] {
                for cos in [0.0, 1e-5, 1e-2, 0.1, 0.5, 0.9, 1.0] {
                    let actual = VisibleFacets::new(distribution, alpha, cos);
                    let sum = actual.energy_loss() + actual.reflected(|_, _| 1.0);
                    assert!((sum - 1.0).abs() < 3e-5, "{distribution:?} {alpha} {cos}: {sum}");
                }
            }
        }
    }

    #[test]
    fn powers_are_integrated_exactly() {
        for power in [0, 1, 2, 11, 39] {
            let sum: f64 = GAUSS.iter().map(|(x, w)| w * (0..power).map(|_| x).product::<f64>()).sum();
            assert!((sum * f64::from(power + 1) - 1.0).abs() < 1e-13, "{power}: {sum}");
        }
    }
}
