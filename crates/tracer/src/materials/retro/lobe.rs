//! The lobe of a sheeting: its value, its albedo and its sampling.

use core::f32::consts::{PI, TAU};

use etendue_core::Basis;
use etendue_core::maths::f32::{acos, asin, cos, exp, ln, sin, sin_cos};
use glam::{Vec2, Vec3};

use super::RetroTable;
use crate::materials::energy::AlbedoTable;

/// The widest cut-off, degrees.
pub(super) const MAX_CUT_OFF_DEG: f64 = 10.0;

/// The largest entrance angle that ASTM E810 measures: beyond, the BSDF is constant and R_A falls.
pub(super) const GRAZING_DEG: f64 = 60.0;

/// Steps between the first and the last observation angle, and from there to the widest cut-off.
const STEPS: usize = 24;

/// f_r = R_A(α, β)/(cos β cos ν) minus the base's BSDF, at least 0, cut off at some α.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RetroLobe {
    table: RetroTable,
    /// The base's BSDF (luminous, under illuminant A), included in measured R_A, 1/sr.
    beneath: f32,
    /// Minimum cosine of β and ν.
    least_cos: f32,
    /// Edges of cells of the observation angle, as 1 − cos α; the last is the cut-off.
    edges: Vec<f32>,
    /// For each entrance angle of the table, the fraction of reflected light below each edge.
    cumulative: Vec<Vec<f32>>,
    /// ∫ f cos θᵢ dωᵢ at colour 1.
    pub(super) albedo: AlbedoTable,
}

/// 1 − cos of the angle between two unit vectors, exact for close ones.
fn one_minus_cos(a: Vec3, b: Vec3) -> f32 {
    0.5 * (a - b).length_squared()
}

/// The angle of a 1 − cos.
fn angle(one_minus_cos: f32) -> f32 {
    2.0 * asin((0.5 * one_minus_cos).sqrt().min(1.0))
}

/// All possible edges of a table: 0, the first observation angle, by equal ratios to the last, and on to the widest cut-off. The number of
/// those up to the last observation angle comes second.
fn edges(table: &RetroTable) -> (Vec<f32>, usize) {
    let (first, last) = table.observation_range();
    let widest = MAX_CUT_OFF_DEG.to_radians() as f32;
    let between = |low: f32, high: f32| (1..=STEPS).map(move |i| low * exp(i as f32 / STEPS as f32 * ln(high / low)));
    let mut angles = vec![0.0, first];
    if last > first {
        angles.extend(between(first, last));
    }
    let known = angles.len();
    if last < widest {
        angles.extend(between(last, widest));
    }
    let versed = |a: f32| 2.0 * sin(0.5 * a) * sin(0.5 * a);
    (angles.into_iter().map(versed).collect(), known)
}

impl RetroLobe {
    /// The lobe cut off after `cells` of its possible cells.
    fn cut(table: &RetroTable, beneath: f32, edges: &[f32], cells: usize) -> Self {
        let deepest = table.entrance_deg()[table.entrance_deg().len() - 1].max(GRAZING_DEG);
        let edges = edges[..=cells].to_vec();
        let mut lobe = Self {
            least_cos: cos(deepest.to_radians() as f32),
            cumulative: table.entrance().iter().map(|beta| cumulative(table, &edges, *beta)).collect(),
            table: table.clone(),
            beneath,
            edges,
            albedo: AlbedoTable::new(|_| 0.0),
        };
        lobe.albedo = AlbedoTable::new(|cos| lobe.albedo_at(cos));
        lobe
    }

    /// Lobes by decreasing cut-off: the widest first, the last cut off at the end of the table. `beneath` is the BSDF of the base.
    pub(super) fn widest_first(table: &RetroTable, beneath: f32) -> impl Iterator<Item = Self> + '_ {
        let (edges, known) = edges(table);
        (known - 1..edges.len()).rev().map(move |cells| Self::cut(table, beneath, &edges, cells))
    }

    /// R_A cos θᵢ/(cos β cos ν) minus the base's value, 1/sr.
    pub(super) fn value_cos(&self, wo: Vec3, wi: Vec3) -> f32 {
        let k = one_minus_cos(wo, wi);
        if k >= self.cut_off() {
            return 0.0;
        }
        let coefficient = self.table.at(angle(k), acos(wi.z.min(1.0)));
        let value = coefficient / (wi.z.max(self.least_cos) * wo.z.max(self.least_cos));
        (value - self.beneath).max(0.0) * wi.z
    }

    fn cut_off(&self) -> f32 {
        self.edges[self.edges.len() - 1]
    }

    /// The observation angle beyond which nothing is reflected, degrees.
    pub(super) fn cut_off_deg(&self) -> f64 {
        f64::from(angle(self.cut_off()).to_degrees())
    }

    /// By the midpoint rule, on both halves of each cell and half a turn about the viewer.
    fn albedo_at(&self, cos: f32) -> f64 {
        const TURN: usize = 16;
        let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
        let basis = Basis::about(wo);
        let ring = |k: f32| -> f64 {
            let at = |j: usize| direction(&basis, k, PI * (j as f32 + 0.5) / TURN as f32);
            (0..TURN).map(at).filter(|wi| wi.z > 0.0).map(|wi| f64::from(self.value_cos(wo, wi))).sum::<f64>()
                / TURN as f64
        };
        let cell = |e: &[f32]| {
            let width = e[1] - e[0];
            0.5 * f64::from(width * TAU) * (ring(e[0] + 0.25 * width) + ring(e[0] + 0.75 * width))
        };
        self.edges.windows(2).map(cell).sum()
    }

    /// The fractions for a viewer: those of the nearest entrance angle.
    fn cumulative_row(&self, wo: Vec3) -> &[f32] {
        let nu = acos(wo.z.min(1.0));
        let entrance = self.table.entrance();
        let i = entrance.windows(2).take_while(|pair| 0.5 * (pair[0] + pair[1]) < nu).count();
        &self.cumulative[i]
    }

    /// Samples a direction about `wo`, by the light reflected from there; it may lie below the surface.
    pub(super) fn sample(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let fractions = self.cumulative_row(wo);
        let i = fractions.partition_point(|c| *c <= u.x).clamp(1, fractions.len() - 1) - 1;
        let within = ((u.x - fractions[i]) / (fractions[i + 1] - fractions[i]).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let k = self.edges[i] + (self.edges[i + 1] - self.edges[i]) * within;
        direction(&Basis::about(wo), k, TAU * u.y)
    }

    /// Density of [`Self::sample`], 1/sr.
    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let k = one_minus_cos(wo, wi);
        if k >= self.cut_off() {
            return 0.0;
        }
        let i = self.edges.partition_point(|e| *e <= k) - 1;
        let fractions = self.cumulative_row(wo);
        (fractions[i + 1] - fractions[i]) / (TAU * (self.edges[i + 1] - self.edges[i]))
    }
}

/// The direction at 1 − cos = k and an azimuth about a basis' third axis.
fn direction(basis: &Basis, k: f32, azimuth: f32) -> Vec3 {
    let (s, c) = sin_cos(azimuth);
    let sin = (k * (2.0 - k)).max(0.0).sqrt();
    basis.outward(Vec3::new(sin * c, sin * s, 1.0 - k))
}

/// Fractions of R_A × solid angle below each edge, for an entrance angle.
fn cumulative(table: &RetroTable, edges: &[f32], entrance: f32) -> Vec<f32> {
    let cell = |e: &[f32]| f64::from((e[1] - e[0]) * table.at(angle(0.5 * (e[0] + e[1])), entrance));
    let total: f64 = edges.windows(2).map(cell).sum();
    let mut sum = 0.0;
    let mut fractions = vec![0.0];
    fractions.extend(edges.windows(2).map(|e| {
        sum += cell(e) / total;
        sum.min(1.0) as f32
    }));
    fractions
}
