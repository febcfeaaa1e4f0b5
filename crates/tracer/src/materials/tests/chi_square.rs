//! Sampled directions against the stated density, by counting.
//!
//! The sphere is divided into cells, finer about the directions where lobes are narrow. Counts in each cell are compared with the integral of the
//! density over it by Pearson's χ². Absorbed samples, and those in exact directions, are counted in a separate cell, which expects 1 − ∫ pdf dω.
//! Families of such tests are judged together: see [`judge`].

use super::*;
use etendue_core::Basis;
use etendue_core::maths::f32::{atan2, sin_cos};
use etendue_stats::chi_square;

/// Polar cells about a direction: tan(θ/2) = scale · t/(1 − t), t and φ in equal steps, so that a narrow lobe is
/// resolved. They cover the whole sphere.
struct PolarCells {
    basis: Basis,
    scale: f32,
}

const RINGS: usize = 20;
const SECTORS: usize = 16;
const CELLS: usize = RINGS * SECTORS;

impl PolarCells {
    fn index(&self, direction: Vec3) -> usize {
        let local = self.basis.inward(direction);
        let tan_half = (local.x * local.x + local.y * local.y).sqrt() / (1.0 + local.z).max(1e-9);
        let t = tan_half / (self.scale + tan_half);
        let turn = atan2(local.y, local.x) / core::f32::consts::TAU;
        let sector = ((turn - turn.floor()) * SECTORS as f32) as usize;
        ((t * RINGS as f32) as usize).min(RINGS - 1) * SECTORS + sector.min(SECTORS - 1)
    }

    /// ∫ f dω over each cell, by the midpoint rule on `SUB`² points of it.
    fn integrals(&self, f: impl Fn(Vec3) -> f32) -> Vec<f64> {
        const SUB: usize = 24;
        let mut sums = vec![0.0; CELLS];
        for i in 0..RINGS * SUB {
            let t = (i as f32 + 0.5) / (RINGS * SUB) as f32;
            let x = self.scale * t / (1.0 - t);
            let (cos, sin) = ((1.0 - x * x) / (1.0 + x * x), 2.0 * x / (1.0 + x * x));
            let dx_dt = self.scale / ((1.0 - t) * (1.0 - t));
            let area = 4.0 * x / ((1.0 + x * x) * (1.0 + x * x)) * dx_dt * core::f32::consts::TAU
                / (RINGS * SUB * SECTORS * SUB) as f32;
            for j in 0..SECTORS * SUB {
                let phi = core::f32::consts::TAU * (j as f32 + 0.5) / (SECTORS * SUB) as f32;
                let (s, c) = sin_cos(phi);
                let direction = self.basis.outward(Vec3::new(sin * c, sin * s, cos));
                sums[(i / SUB) * SECTORS + j / SUB] += f64::from(f(direction) * area);
            }
        }
        sums
    }
}

/// A direction, and the approximate tangent of half the lobe's half angle about it.
#[derive(Clone, Copy)]
pub(in crate::materials) struct LobeAxis {
    axis: Vec3,
    scale: f32,
}

pub(in crate::materials) fn lobe(axis: Vec3, scale: f32) -> LobeAxis {
    LobeAxis { axis, scale }
}

/// Cells for each side of a surface.
pub(in crate::materials) struct DirectionGrid {
    above: PolarCells,
    below: PolarCells,
}

impl DirectionGrid {
    /// Cells about a direction above the surface and one below; each `scale` is about the tangent of half a lobe's half angle (α for
    /// microfacets), 1 for uniform cells.
    pub(in crate::materials) fn new(above: LobeAxis, below: LobeAxis) -> Self {
        let polar = |lobe: LobeAxis| PolarCells { basis: Basis::about(lobe.axis), scale: lobe.scale };
        Self { above: polar(above), below: polar(below) }
    }

    /// Cells about the mirror direction, and uniform ones below.
    pub(in crate::materials) fn about_mirror(wo: Vec3, scale: f32) -> Self {
        Self::new(lobe(Vec3::new(-wo.x, -wo.y, wo.z), scale), lobe(Vec3::NEG_Z, 1.0))
    }

    fn index(&self, direction: Vec3) -> usize {
        if direction.z > 0.0 { self.above.index(direction) } else { CELLS + self.below.index(direction) }
    }

    fn integrals(&self, f: impl Fn(Vec3) -> f32) -> Vec<f64> {
        let mut sums = self.above.integrals(|w| if w.z > 0.0 { f(w) } else { 0.0 });
        sums.extend(self.below.integrals(|w| if w.z > 0.0 { 0.0 } else { f(w) }));
        sums
    }
}

/// p-value of the counts of sampled directions against the stated density. `draw` names the random numbers.
pub(in crate::materials) fn p_of_samples(bsdf: &Bsdf<'_, 4>, wo: Vec3, grid: &DirectionGrid, seed: u32) -> f64 {
    p_value(bsdf, bsdf, wo, grid, seed)
}

/// The same for the density of one BSDF and samples of another.
fn p_value(stated: &Bsdf<'_, 4>, sampled: &Bsdf<'_, 4>, wo: Vec3, grid: &DirectionGrid, seed: u32) -> f64 {
    const N: usize = 100_000;
    let mut expected = grid.integrals(|wi| stated.evaluate(wo, wi).pdf);
    let other = 1.0 - expected.iter().sum::<f64>();
    // The quadrature's error at the horizon, where the density may end abruptly.
    assert!(other > -2e-3, "the density integrates to {}", 1.0 - other);
    expected.push(other.max(0.0));
    let mut observed = vec![0_u64; expected.len()];
    let mut stream = noise(seed);
    for _ in 0..N {
        let u = Vec2::new(stream.unit_f32(), stream.unit_f32());
        let sample = sampled.sample(wo, stream.unit_f32(), u).filter(|s| s.event == Event::Scatter);
        observed[sample.map_or(2 * CELLS, |s| grid.index(s.wi))] += 1;
    }
    // Cells of nearly zero expectation take part only with their neighbours: a floor keeps stray counts finite.
    let expected: Vec<_> = expected.iter().map(|e| (e * N as f64).max(1e-3)).collect();
    chi_square::goodness_of_fit(&observed, &expected).expect("many cells").p
}

/// Fails for a family of tests, each named, whose least p-value would occur by chance in less than one of a hundred.
pub(in crate::materials) fn check_p_values(p_values: &[(f64, String)]) {
    let (minimum, name) = p_values.iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("cases");
    let level = chi_square::sidak_level(0.01, p_values.len());
    assert!(*minimum > level, "{name}: p = {minimum:e} is below {level:e}");
}

#[test]
fn a_wrong_density_is_found() {
    let (stated, sampled) = (material_table(perfect_metal(0.40)), material_table(perfect_metal(0.42)));
    let wo = at_degrees(30.0);
    let p = p_value(&bsdf(&stated), &bsdf(&sampled), wo, &DirectionGrid::about_mirror(wo, 0.5), 999);
    assert!(p < 1e-6, "a roughness told 5 % wrong has p = {p}");
}

#[test]
fn directions_are_sampled_by_the_density_stated() {
    let cases = [
        (Surface::Diffuse(grey(0.5)), 1.0),
        (metal_of("Al", 0.01), 0.01),
        (metal_of("Au", 0.1), 0.1),
        (metal_of("Cu", 0.5), 0.5),
        (perfect_metal(1.0), 1.0),
        (paint(0.5, 1.5, 0.1), 0.2),
        (paint(0.9, 1.7, 0.4), 0.5),
    ];
    let mut p_values = vec![];
    for (k, (surface, scale)) in cases.into_iter().enumerate() {
        let material_table = material_table(surface);
        for (i, degrees) in [0.0, 30.0, 70.0, 86.0].into_iter().enumerate() {
            let wo = at_degrees(degrees);
            let p =
                p_of_samples(&bsdf(&material_table), wo, &DirectionGrid::about_mirror(wo, scale), (k * 4 + i) as u32);
            p_values.push((p, format!("case {k} at {degrees}°")));
        }
    }
    check_p_values(&p_values);
}
