//! Light scattered among facets more than once: what single scattering loses, given back.
//!
//! f_ms = F_ms · (1 − E(θₒ))(1 − E(θᵢ)) / (π (1 − Ē)), E = the albedo of facets that reflect everything, Ē = 2 ∫ E μ dμ
//! (Kulla and Conty 2017, after Kelemen and Szirmay-Kalos 2001); F_ms = F̄² Ē/(1 − F̄ (1 − Ē)), F̄ = 2 ∫ F μ dμ, counts
//! light that met two facets or more (Hill 2018). Reciprocal; with F = 1 the whole sends back all light, with less it
//! sends back at most E + (1 − E) F_ms ≤ 1 at every wavelength.
//!
//! E is tabulated by a fixed quadrature over visible facets, on roughness α = t² and μ/(μ + α), the cosine measured
//! against the roughness: for small α the loss depends on their ratio alone. Ē is the mean of the same table, so that the
//! furnace's error is the table's own. Directions are drawn from the loss itself by the table's cells.
//!
//! Left out: the direction that light keeps after a few bounces; what leaves is taken independent of where it came from.

use core::f32::consts::{FRAC_1_PI, TAU};
use etendue_core::maths::f32::{exp, ln, sin_cos};
use glam::{Vec2, Vec3};
use std::sync::LazyLock;

use super::facets::Distribution;
use super::microfacet::mirrored;

/// Steps over the root of the roughness.
const ROUGHNESSES: usize = 32;
/// Steps over μ/(μ + α), from 0 to its value at μ = 1.
const SLANTS: usize = 32;

/// Loss by single scattering for every roughness and incidence.
pub(super) struct Loss {
    /// (1 − E) (1 + μ²/α²), row by row of roughness.
    loss: Vec<f32>,
    /// (1 − Ē)/α², row by row.
    mean: Vec<f32>,
    /// For each row, how much of ∫ (1 − E) μ dμ lies below each step of the slant; the last is 1.
    cumulative: Vec<f32>,
}

static GGX: LazyLock<Loss> = LazyLock::new(|| Loss::new(Distribution::Ggx));
static BECKMANN: LazyLock<Loss> = LazyLock::new(|| Loss::new(Distribution::Beckmann));

/// The table of a distribution, made when first asked for.
pub(super) fn table(distribution: Distribution) -> &'static Loss {
    match distribution {
        Distribution::Ggx => &GGX,
        Distribution::Beckmann => &BECKMANN,
    }
}

/// Roughness of a row; the first stands for the limit of small ones.
fn row_alpha(row: usize) -> f32 {
    let t = row as f32 / ROUGHNESSES as f32;
    (t * t).max(2e-4)
}

/// The cosine at a slant of 0 to 1.
fn cosine(slant: f32, alpha: f32) -> f32 {
    let s = slant / (1.0 + alpha);
    (alpha * s / (1.0 - s)).min(1.0)
}

fn slant(cos: f32, alpha: f32) -> f32 {
    cos / (cos + alpha) * (1.0 + alpha)
}

impl Loss {
    fn new(distribution: Distribution) -> Self {
        let (mut loss, mut mean, mut cumulative) = (vec![], vec![], vec![]);
        for row in 0..=ROUGHNESSES {
            let alpha = row_alpha(row);
            let at = |k: usize| {
                let cos = cell_edge(k, alpha);
                loss_at(distribution, alpha, cos) * fall(cos, alpha)
            };
            let row: Vec<f32> = (0..=SLANTS).map(at).collect();
            let cells: Vec<f64> = (0..SLANTS).map(|k| cell_flux(&row, k, alpha)).collect();
            let total: f64 = cells.iter().sum();
            mean.push((2.0 * total / (f64::from(alpha) * f64::from(alpha))) as f32);
            cumulative.push(0.0);
            let mut sum = 0.0;
            cumulative.extend(cells.iter().map(|cell| {
                sum += cell / total;
                sum.min(1.0) as f32
            }));
            loss.extend(row);
        }
        Self { loss, mean, cumulative }
    }

    /// The loss at a roughness.
    pub(super) fn of_alpha(&'static self, alpha: f32) -> LossOfAlpha {
        let x = alpha.clamp(0.0, 1.0).sqrt() * ROUGHNESSES as f32;
        let row = (x as usize).min(ROUGHNESSES - 1);
        let share = x - row as f32;
        let mean = self.mean[row] + (self.mean[row + 1] - self.mean[row]) * share;
        LossOfAlpha { table: self, alpha, row, share, mean: mean * alpha * alpha }
    }
}

/// 1 − E at a cosine, by the midpoint rule over the square that visible facets are drawn from (half of it in azimuth),
/// denser at the ends of the steepness: there lie the few facets that lose most.
fn loss_at(distribution: Distribution, alpha: f32, cos: f32) -> f32 {
    const CELLS: usize = 24;
    let facets = distribution.of_alpha(alpha);
    let cos = cos.max(1e-7);
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let cell = |i: usize| {
        let (a, b) = (((i % CELLS) as f32 + 0.5) / CELLS as f32, ((i / CELLS) as f32 + 0.5) / CELLS as f32);
        let (b, mut density) = to_the_ends(b);
        let u = match distribution {
            Distribution::Ggx => Vec2::new(0.5 * a, b),
            Distribution::Beckmann => {
                let (a, more) = to_the_ends(a);
                density *= more;
                Vec2::new(b, 0.5 * a)
            }
        };
        let wi = mirrored(wo, facets.sample(wo, u));
        let loss = if wi.z > 0.0 { 1.0 - facets.weight(wo, wi) } else { 1.0 };
        f64::from(loss * density)
    };
    (((0..CELLS * CELLS).map(cell).sum::<f64>() / (CELLS * CELLS) as f64) as f32).max(1e-12)
}

/// A map of [0, 1] to itself that is dense at both ends, and its derivative.
fn to_the_ends(v: f32) -> (f32, f32) {
    (v * v * (3.0 - 2.0 * v), 6.0 * v * (1.0 - v))
}

/// By how much the loss falls beyond a cosine of α, about: what is interpolated is the loss times this.
fn fall(cos: f32, alpha: f32) -> f32 {
    1.0 + cos * cos / (alpha * alpha)
}

/// ∫ (1 − E) μ dμ over a cell of a row, by the midpoint rule over equal steps, or equal ratios where the cell does not
/// begin at zero.
fn cell_flux(row: &[f32], k: usize, alpha: f32) -> f64 {
    const STEPS: usize = 64;
    let (low, high) = (cell_edge(k, alpha), cell_edge(k + 1, alpha));
    let at = |x: f32| if k == 0 { high * x } else { low * exp(x * ln(high / low)) };
    (0..STEPS)
        .map(|i| {
            let (a, b) = (at(i as f32 / STEPS as f32), at((i + 1) as f32 / STEPS as f32));
            let mid = at((i as f32 + 0.5) / STEPS as f32);
            let x = slant(mid, alpha) * SLANTS as f32 - k as f32;
            let loss = (row[k] + (row[k + 1] - row[k]) * x) / fall(mid, alpha);
            f64::from(loss) * 0.5 * f64::from(b - a) * f64::from(b + a)
        })
        .sum()
}

fn cell_edge(k: usize, alpha: f32) -> f32 {
    if k == SLANTS { 1.0 } else { cosine(k as f32 / SLANTS as f32, alpha) }
}

/// What single scattering loses at one roughness.
#[derive(Clone, Copy)]
pub(super) struct LossOfAlpha {
    table: &'static Loss,
    alpha: f32,
    row: usize,
    share: f32,
    /// 1 − Ē.
    mean: f32,
}

impl core::fmt::Debug for LossOfAlpha {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("LossOfAlpha").field("alpha", &self.alpha).field("mean", &self.mean).finish_non_exhaustive()
    }
}

impl LossOfAlpha {
    /// 1 − E at a cosine.
    pub(super) fn at(&self, cos: f32) -> f32 {
        let x = (slant(cos, self.alpha) * SLANTS as f32).min(SLANTS as f32);
        let k = (x as usize).min(SLANTS - 1);
        let along = |row: usize| {
            let nodes = &self.table.loss[row * (SLANTS + 1) + k..];
            nodes[0] + (nodes[1] - nodes[0]) * (x - k as f32)
        };
        let (low, high) = (along(self.row), along(self.row + 1));
        (low + (high - low) * self.share) / fall(cos, self.alpha)
    }

    /// F_ms of a mean Fresnel reflectance F̄.
    pub(super) fn tint(&self, mean_fresnel: f32) -> f32 {
        mean_fresnel * mean_fresnel * (1.0 - self.mean) / (1.0 - mean_fresnel * self.mean)
    }

    /// f_ms cos θᵢ / F_ms, given 1 − E of both directions.
    pub(super) fn value_cos(&self, wo_loss: f32, wi: Vec3) -> f32 {
        wo_loss * self.at(wi.z) * wi.z * FRAC_1_PI / self.mean
    }

    /// The nearer row of the table: directions are drawn by its cells.
    fn cells(&self) -> &'static [f32] {
        let row = self.row + usize::from(self.share >= 0.5);
        &self.table.cumulative[row * (SLANTS + 1)..(row + 1) * (SLANTS + 1)]
    }

    /// A direction drawn by the loss.
    pub(super) fn sample(&self, u: Vec2) -> Vec3 {
        let cells = self.cells();
        let k = cells.partition_point(|c| *c <= u.x).clamp(1, SLANTS) - 1;
        let within = ((u.x - cells[k]) / (cells[k + 1] - cells[k]).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let cos = self.within(k, within);
        let (s, c) = sin_cos(TAU * u.y);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        Vec3::new(sin * c, sin * s, cos)
    }

    /// The cosine at a share of cell `k`: uniform by its square in the first, by its logarithm in the others.
    fn within(&self, k: usize, share: f32) -> f32 {
        let (low, high) = (cell_edge(k, self.alpha), cell_edge(k + 1, self.alpha));
        if k == 0 { high * share.sqrt() } else { low * exp(share * ln(high / low)) }
    }

    /// Density of [`Self::sample`] at a cosine, 1/sr.
    pub(super) fn pdf(&self, cos: f32) -> f32 {
        let k = ((slant(cos, self.alpha) * SLANTS as f32) as usize).min(SLANTS - 1);
        let cells = self.cells();
        let (low, high) = (cell_edge(k, self.alpha), cell_edge(k + 1, self.alpha));
        let density = if k == 0 { 2.0 * cos / (high * high) } else { 1.0 / (cos * ln(high / low)) };
        (cells[k + 1] - cells[k]) * density / TAU
    }
}
