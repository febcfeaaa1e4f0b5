//! Tabulated phase functions: droplets by Mie's series, and a fit to them.
//!
//! Nodes lie at θ = π t² with equidistant t, finest in the forward peak. p is linear in v = 1 − cos θ between them and normalised as such, so that
//! sampling the table is exact. Between the table's wavelengths p is linear.

use core::{f32::consts::TAU, f64::consts::PI};

use etendue_core::maths::f32::atan2;
use etendue_core::maths::f64::{asin, cos, exp, sin};
use etendue_spectra::{Spectrum, mie::Droplets};
use rayon::prelude::*;

use crate::materials::fresnel;

/// Intervals of a table.
const STEPS: usize = 720;

/// Wavelengths at which droplets are computed, nm.
const NM: [f32; 3] = [450.0, 550.0, 650.0];

/// A phase function at one wavelength.
#[derive(Clone, Debug, PartialEq)]
struct PhaseTable {
    /// v of each node.
    v: Vec<f32>,
    /// p, 1/sr.
    density: Vec<f32>,
    /// Fraction of light scattered by less than the angle of each node.
    below: Vec<f32>,
}

/// Orders of rays leaving a ball that are traced, the reflected one first; the remainder is added to the last.
const ORDERS: u32 = 12;

/// Rays over a ball's radius.
const RAYS: u32 = 60_000;

/// A part of scattered light.
struct ScatteredPart {
    /// 1 − cos of the angle over 2.
    v: f64,
    strength: f64,
}

/// Scattering of uniform light by a ball of index n. A ray that hits it at an angle of incidence i, refracted to r, leaves after p passages
/// deflected by 2 (i − r) + (p − 1)(π − 2 r), reflected outside by π − 2 i (van de Hulst 1957, section 12.2).
fn balls(n: f64) -> impl Iterator<Item = ScatteredPart> {
    let ray = move |k: u32| {
        let b = (f64::from(k) + 0.5) / f64::from(RAYS);
        let (i, r) = (asin(b), asin(b / n));
        let planes = fresnel::planes(cos(i) as f32, n as f32);
        let part = move |order: u32| {
            let turned = match order {
                0 => PI - 2.0 * i,
                _ => 2.0 * (i - r) + f64::from(order - 1) * (PI - 2.0 * r),
            };
            let d = 2.0 * sin(0.5 * turned);
            let strength: f64 = planes.map(f64::from).map(|mirrored| order_fraction(order, mirrored)).iter().sum();
            ScatteredPart { v: 0.5 * d * d, strength: b * strength }
        };
        (0..=ORDERS).map(part)
    };
    (0..RAYS).flat_map(ray)
}

/// Fraction of light that leaves after an order's passages, for an interface of reflectance `mirrored`.
fn order_fraction(order: u32, mirrored: f64) -> f64 {
    let through = (1.0 - mirrored) * (1.0 - mirrored);
    let inside = (1..order).fold(1.0, |fraction, _| fraction * mirrored);
    match order {
        0 => mirrored,
        ORDERS => (1.0 - mirrored) * inside,
        _ => through * inside,
    }
}

/// Angles of the nodes, rad.
fn angles() -> impl Iterator<Item = f64> {
    (0..=STEPS).map(|i| PI * (i as f64 / STEPS as f64) * (i as f64 / STEPS as f64))
}

impl PhaseTable {
    /// A table of values proportional to a phase function at the nodes' angles (rad), normalised here.
    fn new(values: &[f64]) -> Self {
        // 1 − cos θ = 2 sin²(θ/2), without loss.
        let v: Vec<f64> =
            angles().map(|angle| 2.0 * etendue_core::maths::f64::sin(0.5 * angle)).map(|d| 0.5 * d * d).collect();
        let parts: Vec<f64> = (0..STEPS).map(|i| PI * (values[i] + values[i + 1]) * (v[i + 1] - v[i])).collect();
        let total: f64 = parts.iter().sum();
        let mut sum = 0.0;
        let mut below = vec![0.0];
        for part in parts {
            sum += part;
            below.push((sum / total) as f32);
        }
        let density = values.iter().map(|value| (value / total) as f32).collect();
        Self { v: v.into_iter().map(|v| v as f32).collect(), density, below }
    }

    /// A table of light that is scattered in parts.
    fn from_parts(parts: impl Iterator<Item = ScatteredPart>) -> Self {
        let v: Vec<f64> = angles()
            .map(|angle| {
                let d = 2.0 * sin(0.5 * angle);
                0.5 * d * d
            })
            .collect();
        let mut sums = vec![0.0; v.len()];
        for ScatteredPart { v: at, strength } in parts {
            let i = v.partition_point(|node| *node <= at).clamp(1, STEPS) - 1;
            let fraction = ((at - v[i]) / (v[i + 1] - v[i])).clamp(0.0, 1.0);
            sums[i] += strength * (1.0 - fraction);
            sums[i + 1] += strength * fraction;
        }
        let width = |i: usize| v[(i + 1).min(STEPS)] - v[i.saturating_sub(1)];
        Self::new(&sums.iter().enumerate().map(|(i, sum)| sum / width(i)).collect::<Vec<_>>())
    }

    /// As [`SpectralTable::without_peak`].
    fn without_peak(&self, within_rad: f64) -> (f64, Self) {
        let first = angles().take_while(|angle| *angle < within_rad).count().min(STEPS);
        let plateau = self.density[first];
        let cut: Vec<f64> = self
            .density
            .iter()
            .enumerate()
            .map(|(i, p)| f64::from(if i < first { p.min(plateau) } else { *p }))
            .collect();
        let remaining: f64 =
            (0..STEPS).map(|i| PI * (cut[i] + cut[i + 1]) * (f64::from(self.v[i + 1]) - f64::from(self.v[i]))).sum();
        ((1.0 - remaining).max(0.0), Self::new(&cut))
    }

    #[inline]
    fn cell(&self, v: f32) -> usize {
        // θ/2 by its sine and cosine.
        let angle = 2.0 * atan2((0.5 * v).sqrt(), (1.0 - 0.5 * v).max(0.0).sqrt());
        let i = ((angle / core::f32::consts::PI).sqrt() * STEPS as f32) as usize;
        let i = i.min(STEPS - 1);
        // The root may round across a node.
        if v < self.v[i] {
            i - 1
        } else if v >= self.v[i + 1] && i + 1 < STEPS {
            i + 1
        } else {
            i
        }
    }

    /// p, 1/sr.
    #[inline]
    fn density(&self, v: f32) -> f32 {
        let i = self.cell(v);
        let fraction = ((v - self.v[i]) / (self.v[i + 1] - self.v[i])).clamp(0.0, 1.0);
        self.density[i] + fraction * (self.density[i + 1] - self.density[i])
    }

    /// v below which the fraction `u` of the light lies.
    fn sample(&self, u: f32) -> f32 {
        let i = self.below.partition_point(|below| *below <= u).clamp(1, STEPS) - 1;
        let rest = (u - self.below[i]) / TAU;
        let (p, width) = (self.density[i], self.v[i + 1] - self.v[i]);
        let slope = (self.density[i + 1] - p) / width;
        // p x + slope x²/2 = rest, without loss where the slope is small.
        let root = (p * p + 2.0 * slope * rest).max(0.0).sqrt();
        let x = if p + root > 0.0 { 2.0 * rest / (p + root) } else { 0.0 };
        self.v[i] + x.clamp(0.0, width)
    }
}

/// A phase function by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralTable {
    /// Wavelengths, nm, rising.
    nm: Vec<f32>,
    tables: Vec<PhaseTable>,
}

impl SpectralTable {
    /// A phase function of the angle, rad, the same at all wavelengths and known up to a factor.
    pub(super) fn grey(of: impl Fn(f64) -> f64) -> Self {
        Self { nm: vec![550.0], tables: vec![PhaseTable::new(&angles().map(of).collect::<Vec<_>>())] }
    }

    /// The phase function without its forward peak: within `within_rad` at most its value at that angle. Also the fraction of light in the
    /// peak, by wavelength.
    pub(super) fn without_peak(&self, within_rad: f64) -> (Spectrum, Self) {
        let (fractions, tables): (Vec<f64>, Vec<PhaseTable>) =
            self.tables.iter().map(|table| table.without_peak(within_rad)).unzip();
        let fraction = |nm: f64| {
            let (i, between) = self.place(nm as f32);
            let next = fractions.get(i + 1).copied().unwrap_or(fractions[i]);
            fractions[i] + f64::from(between) * (next - fractions[i])
        };
        (Spectrum::from_fn(fraction), Self { nm: self.nm.clone(), tables })
    }

    /// Water droplets of log-normal sizes about a median diameter, µm (0.1 to 100), by Mie's series (`etendue_spectra::mie`).
    #[must_use]
    pub fn from_water(diameter_um: f64) -> Self {
        let cosines: Vec<f64> = angles().map(cos).collect();
        let table = |nm: f32| PhaseTable::new(&Droplets::from_water(diameter_um).phase(f64::from(nm), &cosines));
        Self { nm: NM.to_vec(), tables: NM.into_par_iter().map(table).collect() }
    }

    /// The fit of Jendersie and d'Eon ("An approximate Mie scattering function for fog and cloud rendering", SIGGRAPH 2023 Talks, eq. 4 to 7)
    /// to water droplets of a mean diameter of 5 to 50 µm: Henyey and Greenstein's and Draine's (2003) functions, the same at all wavelengths.
    /// `None` outside that range. Straight back it is four to five times too dark.
    #[must_use]
    pub fn fitted_to_water(diameter_um: f64) -> Option<Self> {
        if !(5.0..=50.0).contains(&diameter_um) {
            return None;
        }
        let d = diameter_um;
        let g_hg = exp(-0.099_056_7 / (d - 1.671_54));
        let g_d = exp(-2.206_79 / (d + 3.910_29) - 0.428_934);
        let alpha = exp(3.624_89 - 8.292_88 / (d + 5.528_25));
        let fraction = exp(-0.599_085 / (d - 0.641_583) - 0.665_888);
        let value = |angle: f64| {
            let mu = cos(angle);
            let far = 2.0 * etendue_core::maths::f64::sin(0.5 * angle);
            let v = 0.5 * far * far;
            let of = |g: f64| {
                let x = (1.0 - g) * (1.0 - g) + 2.0 * g * v;
                (1.0 - g * g) / (x * x.sqrt()) * 0.25 / PI
            };
            let draine = of(g_d) * (1.0 + alpha * mu * mu) / (1.0 + alpha * (1.0 + 2.0 * g_d * g_d) / 3.0);
            (1.0 - fraction) * of(g_hg) + fraction * draine
        };
        Some(Self::grey(value))
    }

    /// Balls of a refractive index, far larger than the wavelength, by geometric optics without diffraction: scattering of the light that
    /// hits the ball. Both polarisations, up to twelve passages. For water this includes the rainbows.
    #[must_use]
    pub fn from_large_balls(index: &Spectrum) -> Self {
        let nm: Vec<f32> = (0..=8).map(|i| 380.0 + 42.5 * i as f32).collect();
        let table = |nm: &f32| PhaseTable::from_parts(balls(f64::from(index.at(*nm))));
        let tables = nm.par_iter().map(table).collect();
        Self { nm, tables }
    }

    /// p at a wavelength, 1/sr.
    #[inline]
    pub(super) fn density(&self, nm: f32, v: f32) -> f32 {
        let (i, fraction) = self.place(nm);
        let low = self.tables[i].density(v);
        if fraction > 0.0 { low + fraction * (self.tables[i + 1].density(v) - low) } else { low }
    }

    /// Samples v at a wavelength; `choice` selects one of the two tables around it.
    pub(super) fn sample(&self, nm: f32, choice: f32, u: f32) -> f32 {
        let (i, fraction) = self.place(nm);
        self.tables[if choice < fraction { i + 1 } else { i }].sample(u)
    }

    /// The table below a wavelength, and the weight of the next one.
    fn place(&self, nm: f32) -> (usize, f32) {
        let above = self.nm.partition_point(|at| *at <= nm);
        if above == 0 || above == self.nm.len() {
            return (above.saturating_sub(1), 0.0);
        }
        (above - 1, (nm - self.nm[above - 1]) / (self.nm[above] - self.nm[above - 1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean cosines of water fog at 550 nm by miepython 3.3.0, 3001 sizes. The table is linear between its nodes.
    #[test]
    fn mean_cosines_of_water() {
        for (diameter_um, g) in [(5.0, 0.834_63), (12.0, 0.858_98), (20.0, 0.867_63)] {
            let table = &SpectralTable::from_water(diameter_um).tables[1];
            let n = 20_000;
            let mean: f64 =
                (0..n).map(|i| 1.0 - f64::from(table.sample((i as f32 + 0.5) / n as f32))).sum::<f64>() / f64::from(n);
            assert!((mean - g).abs() < 1e-3, "{diameter_um}: {mean} {g}");
        }
    }

    /// The ratios of the fit to Mie's function stated in PHYSICS.md §18: 0.92 to 1.25 from 5° to 60°, 0.30 to 0.65 at 140°, 0.19 to 0.28
    /// straight back.
    #[test]
    fn the_fit_is_as_far_from_the_series_as_others_find_it() {
        for diameter_um in [5.0, 12.0, 20.0] {
            let (mie, fit) = (
                SpectralTable::from_water(diameter_um),
                SpectralTable::fitted_to_water(diameter_um).expect("in range"),
            );
            let ratio = |degrees: f32| {
                let d = 2.0 * etendue_core::maths::f32::sin_cos(0.5 * degrees.to_radians()).0;
                let v = 0.5 * d * d;
                fit.density(550.0, v) / mie.density(550.0, v)
            };
            for (degrees, low, high) in
                [(8.0, 0.85, 1.35), (30.0, 0.85, 1.3), (60.0, 0.85, 1.3), (140.0, 0.27, 0.72), (180.0, 0.17, 0.33)]
            {
                let ratio = ratio(degrees);
                assert!(ratio > low && ratio < high, "{diameter_um} µm, {degrees}°: {ratio}");
            }
        }
    }

    #[test]
    fn cells_hold_what_lies_in_them() {
        let table = &SpectralTable::fitted_to_water(10.0).expect("in range").tables[0];
        for v in [0.0, 1e-9, 1e-6, 0.3, 1.0, 1.999_99, 2.0] {
            let i = table.cell(v);
            assert!(table.v[i] <= v && v <= table.v[i + 1], "{v}");
        }
        assert!(SpectralTable::fitted_to_water(4.0).is_none() && table.density(1.0) > 0.0);
    }
}
