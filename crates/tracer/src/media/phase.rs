//! Phase functions: distribution of scattered light over the angle from the forward direction.
//!
//! All are normalised, ∫ p dω = 1 over the sphere, in 1/sr, and sampled exactly: samples have the weight 1. An angle is given by v = 1 − cos θ, which
//! is 0 straight on, since cosines near 1 have no digits left for narrow forward peaks.

use core::f32::consts::{FRAC_1_PI, TAU};

use etendue_core::maths::f32::{cbrt, sin_cos};
use etendue_core::{Basis, Wavelengths, maths::f64::sin};
use etendue_spectra::Spectrum;
use glam::{Vec2, Vec3};

use super::phase_table::SpectralTable;

/// 1/(4π).
const PER_SPHERE: f32 = 0.25 * FRAC_1_PI;

/// A phase function.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// Equal in all directions.
    Isotropic,
    /// Henyey and Greenstein (1941) of mean cosine g, −0.99 to 0.99.
    HenyeyGreenstein {
        /// Mean cosine.
        g: f32,
    },
    /// Molecules: 3/(16π) (1 + cos² θ), Rayleigh (1871).
    Rayleigh,
    /// Tabulated.
    Table(SpectralTable),
}

/// Half angle of a forward peak, rad: 20°. Of 12 µm droplets under sun and sky it changes fog's radiance by less than 1 %.
const PEAK_RAD: f64 = 20.0 / 180.0 * core::f64::consts::PI;

/// Mean cosine from which on the Henyey–Greenstein function has a peak.
const PEAKED: f32 = 0.5;

impl Phase {
    /// The phase function without its forward peak, and the fraction of light in the peak, by wavelength; `None` if there is none. Light of
    /// the peak continues within 20° of its direction. If that makes no difference, it may be treated as not scattered at all (the δ
    /// approximation of Joseph, Wiscombe and Weinman 1976).
    pub(super) fn without_peak(&self) -> Option<(Spectrum, Self)> {
        let (fraction, table) = match self {
            Self::Isotropic | Self::Rayleigh => return None,
            Self::HenyeyGreenstein { g } if *g < PEAKED => return None,
            Self::HenyeyGreenstein { g } => {
                let of = |angle: f64| {
                    let far = 2.0 * sin(0.5 * angle);
                    f64::from(henyey_greenstein(*g, (0.5 * far * far) as f32))
                };
                SpectralTable::grey(of).without_peak(PEAK_RAD)
            }
            Self::Table(table) => table.without_peak(PEAK_RAD),
        };
        Some((fraction, Self::Table(table)))
    }

    /// p, 1/sr, of light that is scattered from the unit direction `from` into the unit direction `to`; for tables the mean over the
    /// wavelengths.
    #[must_use]
    pub fn density<const N: usize>(&self, from: Vec3, to: Vec3, wavelengths: &Wavelengths<N>) -> f32 {
        match self {
            Self::Table(_) => wavelengths.nm.iter().map(|nm| self.density_at(from, to, *nm)).sum::<f32>() / N as f32,
            _ => self.density_at(from, to, wavelengths.nm[0]),
        }
    }

    /// p, 1/sr, at a wavelength.
    pub(super) fn density_at(&self, from: Vec3, to: Vec3, nm: f32) -> f32 {
        let v = (0.5 * (to - from).length_squared()).min(2.0);
        match self {
            Self::Isotropic => PER_SPHERE,
            Self::HenyeyGreenstein { g } => henyey_greenstein(*g, v),
            Self::Rayleigh => rayleigh(1.0 - v),
            Self::Table(table) => table.density(nm, v),
        }
    }

    /// p at each wavelength, 1/sr.
    #[must_use]
    pub fn values<const N: usize>(&self, from: Vec3, to: Vec3, wavelengths: &Wavelengths<N>) -> [f32; N] {
        match self {
            Self::Table(table) => {
                let v = (0.5 * (to - from).length_squared()).min(2.0);
                wavelengths.nm.map(|nm| table.density(nm, v))
            }
            _ => [self.density(from, to, wavelengths); N],
        }
    }

    /// Samples a unit direction by [`Phase::density`], for light that travels along the unit `from`.
    #[must_use]
    pub fn sample<const N: usize>(&self, from: Vec3, choice: f32, u: Vec2, wavelengths: &Wavelengths<N>) -> Vec3 {
        let v = match self {
            Self::Isotropic => 2.0 * u.x,
            Self::HenyeyGreenstein { g } => henyey_greenstein_at(*g, u.x),
            Self::Rayleigh => rayleigh_at(u.x),
            Self::Table(table) => {
                let chosen = choice * N as f32;
                let i = (chosen as usize).min(N - 1);
                table.sample(wavelengths.nm[i], chosen - i as f32, u.x)
            }
        }
        .clamp(0.0, 2.0);
        let sin = (v * (2.0 - v)).sqrt();
        let (s, c) = sin_cos(TAU * u.y);
        Basis::about(from).outward(Vec3::new(sin * c, sin * s, 1.0 - v)).normalize()
    }
}

/// (1 − g²)/(4π (1 + g² − 2 g cos θ)^{3/2}).
fn henyey_greenstein(g: f32, v: f32) -> f32 {
    let below = (1.0 - g) * (1.0 - g) + 2.0 * g * v;
    PER_SPHERE * (1.0 - g * g) / (below * below.sqrt())
}

/// v below which a fraction `u` of the light is scattered.
fn henyey_greenstein_at(g: f32, u: f32) -> f32 {
    if g.abs() < 1e-3 {
        return 2.0 * u;
    }
    // 2 g v = s² − (1 − g)², s = (1 − g²)/(1 + g − 2 g u).
    let s = (1.0 - g * g) / (1.0 + g - 2.0 * g * u);
    (s - (1.0 - g)) * (s + (1.0 - g)) / (2.0 * g)
}

fn rayleigh(cos: f32) -> f32 {
    0.75 * PER_SPHERE * (1.0 + cos * cos)
}

/// The real root of c³ + 3 c = z, z = 4 − 8 u, by Cardano.
fn rayleigh_at(u: f32) -> f32 {
    let half = 2.0 - 4.0 * u;
    let root = (half * half + 1.0).sqrt();
    1.0 - (cbrt(half + root) + cbrt(half - root))
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::{philox4x32, unit_f32};
    use etendue_stats::chi_square;

    const BINS: usize = 40;

    fn all() -> Vec<(&'static str, Phase)> {
        vec![
            ("isotropic", Phase::Isotropic),
            ("forward", Phase::HenyeyGreenstein { g: 0.86 }),
            ("backward", Phase::HenyeyGreenstein { g: -0.4 }),
            ("even", Phase::HenyeyGreenstein { g: 0.0 }),
            ("molecules", Phase::Rayleigh),
            ("water", Phase::Table(SpectralTable::from_water(8.0))),
            ("fit", Phase::Table(SpectralTable::fitted_to_water(12.0).expect("in range"))),
        ]
    }

    /// The density integrates to one, and samples follow it: χ² over bins of equal expected counts in angle. 2·10⁵ samples.
    #[test]
    fn directions_are_sampled_by_the_density() {
        let wavelengths = Wavelengths::<4>::uniform(400.0, 700.0, 0.3);
        let from = Vec3::new(0.48, 0.6, 0.64).normalize();
        let (along, across) = from.any_orthonormal_pair();
        for (name, phase) in all() {
            // Nodes dense in the forward peak.
            let n = 200_000_u32;
            let v_of = |t: f64| 2.0 * t * t * t * t;
            let mut fractions = vec![0.0_f64; n as usize];
            for (i, fraction) in fractions.iter_mut().enumerate() {
                let t = (i as f64 + 0.5) / f64::from(n);
                let v = v_of(t);
                let (cos, sin) = ((1.0 - v) as f32, (v * (2.0 - v)).max(0.0).sqrt() as f32);
                let to = from * cos + along * (0.6 * sin) + across * (0.8 * sin);
                *fraction = f64::from(phase.density(from, to, &wavelengths)) * core::f64::consts::TAU * 8.0 * t * t * t
                    / f64::from(n);
            }
            let total: f64 = fractions.iter().sum();
            assert!((total - 1.0).abs() < 2e-3, "{name}: {total}");
            let edges: Vec<f64> = {
                let (mut sum, mut edges) = (0.0, vec![]);
                for (i, fraction) in fractions.iter().enumerate() {
                    sum += fraction / total;
                    while edges.len() + 1 < BINS && sum > (edges.len() + 1) as f64 / BINS as f64 {
                        edges.push(v_of((i as f64 + 1.0) / f64::from(n)));
                    }
                }
                edges
            };
            let expected_shares: Vec<f64> = {
                let mut bins = vec![0.0; BINS];
                for (i, fraction) in fractions.iter().enumerate() {
                    let v = v_of((i as f64 + 0.5) / f64::from(n));
                    bins[edges.partition_point(|edge| *edge <= v)] += fraction / total;
                }
                bins
            };
            let samples = 200_000_u32;
            let (mut counts, mut turns) = (vec![0_u64; BINS], vec![0_u64; 16]);
            for i in 0..samples {
                let r = philox4x32([i, 0, 0, 0], [5, 9]);
                let u = Vec2::new(unit_f32(r[1]), unit_f32(r[2]));
                let to = phase.sample(from, unit_f32(r[0]), u, &wavelengths);
                assert!((to.length() - 1.0).abs() < 1e-6);
                let v = f64::from(0.5 * (to - from).length_squared());
                counts[edges.partition_point(|edge| *edge <= v)] += 1;
                let turn = etendue_core::maths::f32::atan2(to.dot(across), to.dot(along)) / TAU + 0.5;
                turns[((turn * 16.0) as usize).min(15)] += 1;
            }
            let expected: Vec<f64> = expected_shares.iter().map(|fraction| fraction * f64::from(samples)).collect();
            let test = chi_square::goodness_of_fit(&counts, &expected).expect("bins");
            assert!(test.p > 1e-3, "{name}: {test:?}");
            let test = chi_square::goodness_of_fit(&turns, &[f64::from(samples) / 16.0; 16]).expect("bins");
            assert!(test.p > 1e-3, "{name}, azimuth: {test:?}");
        }
    }
}
