//! Multiple scattering among facets: adds the energy lost by single scattering.
//!
//! f_ms = F_ms · (1 − E(θₒ))(1 − E(θᵢ)) / (π (1 − Ē)), E = the albedo of facets that reflect everything, Ē = 2 ∫ E μ dμ (Kulla and Conty 2017, after
//! Kelemen and Szirmay-Kalos 2001); F_ms = F̄² Ē/(1 − F̄ (1 − Ē)), F̄ = 2 ∫ F μ dμ, includes light reflected by two facets or more (Hill 2018).
//! Reciprocal. With F = 1 all light is reflected, with less at most E + (1 − E) F_ms ≤ 1 at every wavelength.
//!
//! 1 − E is tabulated by quadrature over slopes, on the root of the roughness and the slant μ/(μ + α), the cosine relative to the roughness: for
//! small α the loss depends on their ratio alone. 1 − Ē is the integral of the interpolated table itself, tabulated finely over α, so that the
//! furnace test's error is the table's own: 3e-4 at most. Directions are sampled from the loss by the table's cells.
//!
//! Left out: the dependence of the direction on that of incidence after a few bounces; the two are treated as independent.

use core::f32::consts::{FRAC_1_PI, TAU};
use std::sync::LazyLock;

use etendue_core::maths::f32::{exp, ln, sin_cos};
use glam::{Vec2, Vec3};

use super::slopes::{GAUSS, VisibleFacets};
use super::{MIRROR_ALPHA, microfacet::Distribution};

/// Steps over the root of the roughness.
const ROUGHNESSES: usize = 64;
/// Steps over the slant, from 0 to its value at μ = 1.
const SLANTS: usize = 128;
/// Steps of the mean over the logarithm of the roughness, from [`MIRROR_ALPHA`] to 1.
const MEANS: usize = 256;

/// Loss by single scattering for every roughness and incidence.
pub(super) struct LossTable {
    /// 1 − E, row by row of roughness.
    loss: Vec<f32>,
    /// (1 − Ē)/α².
    mean: Vec<f32>,
    /// For each row, the fraction of ∫ (1 − E) μ dμ below each step of the slant; the last is 1.
    cumulative: Vec<f32>,
}

static GGX: LazyLock<LossTable> = LazyLock::new(|| LossTable::new(Distribution::Ggx));
static BECKMANN: LazyLock<LossTable> = LazyLock::new(|| LossTable::new(Distribution::Beckmann));

/// The table of a distribution, computed at first use.
pub(super) fn table(distribution: Distribution) -> &'static LossTable {
    match distribution {
        Distribution::Ggx => &GGX,
        Distribution::Beckmann => &BECKMANN,
    }
}

/// Roughness of a row; the first represents the limit of small ones.
fn row_alpha(row: usize) -> f32 {
    let t = row as f32 / ROUGHNESSES as f32;
    (t * t).max(2e-4)
}

/// Parameter c of the spacing of steps: step k is at the fraction (q² + c q)/(1 + c) of the maximum slant, q = k/[`SLANTS`]. Near slant 0 (grazing
/// incidence), where the loss varies as μ ln μ, steps are c/(1 + c) = 1/5 as wide as uniform ones.
const GRAZING: f32 = 0.25;

/// The cosine at a step of the slant.
fn cosine(step: f32, alpha: f32) -> f32 {
    let q = step / SLANTS as f32;
    let s = q * (q + GRAZING) / ((1.0 + GRAZING) * (1.0 + alpha));
    (alpha * s / (1.0 - s)).min(1.0)
}

/// The step of the slant at a cosine, 0 to [`SLANTS`].
fn step(cos: f32, alpha: f32) -> f32 {
    let slant = cos / (cos + alpha) * (1.0 + alpha);
    let root = (GRAZING * GRAZING + 4.0 * (1.0 + GRAZING) * slant).sqrt();
    (0.5 * (root - GRAZING) * SLANTS as f32).min(SLANTS as f32)
}

/// Position of a roughness among the rows.
fn row_of(alpha: f32) -> (usize, f32) {
    let x = alpha.clamp(0.0, 1.0).sqrt() * ROUGHNESSES as f32;
    let row = (x as usize).min(ROUGHNESSES - 1);
    (row, x - row as f32)
}

/// Position of a roughness among the means.
fn mean_of(alpha: f32) -> (usize, f32) {
    let x = (1.0 - ln(alpha.max(MIRROR_ALPHA)) / ln(MIRROR_ALPHA)).clamp(0.0, 1.0) * MEANS as f32;
    let node = (x as usize).min(MEANS - 1);
    (node, x - node as f32)
}

impl LossTable {
    fn new(distribution: Distribution) -> Self {
        let mut table = Self { loss: vec![], mean: vec![0.0; MEANS + 1], cumulative: vec![] };
        for row in 0..=ROUGHNESSES {
            let alpha = row_alpha(row);
            table.loss.extend((0..=SLANTS).map(|k| {
                let lost = VisibleFacets::new(distribution, alpha, cell_edge(k, alpha)).energy_loss();
                lost.max(1e-12) as f32
            }));
        }
        for row in 0..=ROUGHNESSES {
            table.cumulative.extend(table.cumulative_sums(row_alpha(row)));
        }
        table.mean = (0..=MEANS).map(|node| table.mean_at(node)).collect();
        table
    }

    /// The loss at a roughness.
    pub(super) fn at_alpha(&self, alpha: f32) -> RoughnessLoss<'_> {
        let ((row, fraction), (node, beyond)) = (row_of(alpha), mean_of(alpha));
        let mean = self.mean[node] + (self.mean[node + 1] - self.mean[node]) * beyond;
        RoughnessLoss { table: self, alpha, row, row_fraction: fraction, mean: mean * alpha * alpha }
    }

    /// ∫ (1 − E) μ dμ over each cell of the slant.
    fn cells(&self, alpha: f32) -> Vec<f64> {
        let loss = self.at_alpha(alpha);
        (0..SLANTS).map(|k| loss.cell_flux(k)).collect()
    }

    /// Cumulative sums of the cells up to each step, normalised.
    fn cumulative_sums(&self, alpha: f32) -> Vec<f32> {
        let cells = self.cells(alpha);
        let total: f64 = cells.iter().sum();
        let mut sum = 0.0;
        let sums = cells.iter().map(|cell| {
            sum += cell / total;
            sum.min(1.0) as f32
        });
        core::iter::once(0.0).chain(sums).collect()
    }

    /// (1 − Ē)/α² of a node of the means.
    fn mean_at(&self, node: usize) -> f32 {
        let alpha = exp(ln(MIRROR_ALPHA) * (1.0 - node as f32 / MEANS as f32));
        (2.0 * self.cells(alpha).iter().sum::<f64>() / (f64::from(alpha) * f64::from(alpha))) as f32
    }
}

fn cell_edge(k: usize, alpha: f32) -> f32 {
    if k == SLANTS { 1.0 } else { cosine(k as f32, alpha) }
}

/// Loss by single scattering at one roughness.
#[derive(Clone, Copy)]
pub(super) struct RoughnessLoss<'a> {
    table: &'a LossTable,
    alpha: f32,
    row: usize,
    row_fraction: f32,
    /// 1 − Ē.
    mean: f32,
}

impl core::fmt::Debug for RoughnessLoss<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("LossOfAlpha").field("alpha", &self.alpha).field("mean", &self.mean).finish_non_exhaustive()
    }
}

impl RoughnessLoss<'_> {
    /// 1 − E at a cosine.
    pub(super) fn at(&self, cos: f32) -> f32 {
        let x = step(cos, self.alpha);
        let k = (x as usize).min(SLANTS - 1);
        let along = |row: usize| {
            let nodes = &self.table.loss[row * (SLANTS + 1) + k..];
            nodes[0] + (nodes[1] - nodes[0]) * (x - k as f32)
        };
        let (low, high) = (along(self.row), along(self.row + 1));
        low + (high - low) * self.row_fraction
    }

    /// ∫ (1 − E) μ dμ over a cell of the slant: over the cosine in the first, over its logarithm in the others.
    fn cell_flux(&self, k: usize) -> f64 {
        let (low, high) = (cell_edge(k, self.alpha), cell_edge(k + 1, self.alpha));
        let ratio = if k == 0 { 0.0 } else { ln(high / low) };
        let at = |(x, weight): &(f64, f64)| {
            let x = *x as f32;
            let (cos, change) =
                if k == 0 { (high * x, high) } else { (low * exp(x * ratio), low * exp(x * ratio) * ratio) };
            weight * f64::from(self.at(cos) * cos * change)
        };
        GAUSS.iter().map(at).sum()
    }

    /// F_ms of a mean Fresnel reflectance F̄.
    pub(super) fn tint(&self, mean_fresnel: f32) -> f32 {
        mean_fresnel * mean_fresnel * (1.0 - self.mean) / (1.0 - mean_fresnel * self.mean)
    }

    /// f_ms cos θᵢ / F_ms, given 1 − E of both directions.
    pub(super) fn value_cos(&self, wo_loss: f32, wi: Vec3) -> f32 {
        wo_loss * self.at(wi.z) * wi.z * FRAC_1_PI / self.mean
    }

    /// The nearer row of the table: directions are sampled by its cells.
    fn cells(&self) -> &[f32] {
        let row = self.row + usize::from(self.row_fraction >= 0.5);
        &self.table.cumulative[row * (SLANTS + 1)..(row + 1) * (SLANTS + 1)]
    }

    /// Samples a direction by the loss.
    pub(super) fn sample(&self, u: Vec2) -> Vec3 {
        let cells = self.cells();
        let k = cells.partition_point(|c| *c <= u.x).clamp(1, SLANTS) - 1;
        let within = ((u.x - cells[k]) / (cells[k + 1] - cells[k]).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let cos = self.cosine_in_cell(k, within);
        let (s, c) = sin_cos(TAU * u.y);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        Vec3::new(sin * c, sin * s, cos)
    }

    /// The cosine at a fraction of cell `k`: uniform by its square in the first, by its logarithm in the others.
    fn cosine_in_cell(&self, k: usize, fraction: f32) -> f32 {
        let (low, high) = (cell_edge(k, self.alpha), cell_edge(k + 1, self.alpha));
        if k == 0 { high * fraction.sqrt() } else { low * exp(fraction * ln(high / low)) }
    }

    /// Density of [`Self::sample`] at a cosine, 1/sr.
    pub(super) fn pdf(&self, cos: f32) -> f32 {
        let k = (step(cos, self.alpha) as usize).min(SLANTS - 1);
        let cells = self.cells();
        let (low, high) = (cell_edge(k, self.alpha), cell_edge(k + 1, self.alpha));
        let density = if k == 0 { 2.0 * cos / (high * high) } else { 1.0 / (cos * ln(high / low)) };
        (cells[k + 1] - cells[k]) * density / TAU
    }
}
