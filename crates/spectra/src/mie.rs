//! Scattering by a homogeneous sphere (Mie 1908), by the series of Bohren and Huffman ("Absorption and Scattering of Light by Small
//! Particles", 1983, ch. 4 and app. A), and by droplets of log-normal sizes.
//!
//! A sphere of diameter d and index m = n − i k relative to air has the size parameter x = π d/λ. Its amplitudes are
//!
//! S₁ = Σ (2j + 1)/(j(j + 1)) (a_j π_j + b_j τ_j), S₂ the same with π and τ exchanged,
//!
//! a and b by the logarithmic derivative D_j(m x), by downward recurrence, and the Riccati–Bessel functions ψ and ξ, by upward recurrence.
//! Unpolarised light is scattered in proportion to |S₁|² + |S₂|². The series holds in f64 for size parameters x up to some thousands.
//!
//! Left out: polarisation, non-spherical drops, and interference between drops.

use core::f64::consts::PI;
use core::ops::{Add, Mul, Sub};

use etendue_core::maths::f64::{cbrt, exp, ln, sin_cos};

/// A complex number, with the operations that the series needs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    fn norm2(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    fn scaled(self, by: f64) -> Self {
        Self::new(self.re * by, self.im * by)
    }

    fn inverse(self) -> Self {
        let norm2 = self.norm2();
        Self::new(self.re / norm2, -self.im / norm2)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }
}

/// Scattering by one sphere.
#[derive(Clone, Debug)]
pub struct MieSphere {
    /// a_j and b_j, j from 1.
    coefficients: Vec<(Complex, Complex)>,
    x: f64,
}

impl MieSphere {
    /// A sphere of size parameter `x` = π d/λ (positive) and index `n` − i `k` relative to its surroundings.
    #[must_use]
    pub fn new(x: f64, n: f64, k: f64) -> Self {
        // Wiscombe (1980).
        let terms = (x + 4.05 * cbrt(x) + 2.0).ceil() as usize;
        let m = Complex::new(n, -k);
        let derivative = logarithmic_derivative(m.scaled(x), terms);
        let (sin, cos) = sin_cos(x);
        let (mut psi_before, mut psi, mut chi_before, mut chi) = (cos, sin, -sin, cos);
        let mut coefficients = Vec::with_capacity(terms);
        for (j, logarithmic) in (1_u32..).zip(&derivative[1..]) {
            let order = f64::from(j);
            (psi_before, psi) = (psi, (2.0 * order - 1.0) * psi / x - psi_before);
            (chi_before, chi) = (chi, (2.0 * order - 1.0) * chi / x - chi_before);
            // ξ = ψ + i χ in the convention of time exp(+iωt) that n − i k belongs to.
            let (xi_before, xi) = (Complex::new(psi_before, chi_before), Complex::new(psi, chi));
            let of = |factor: Complex| {
                let factor = factor + Complex::new(order / x, 0.0);
                (factor.scaled(psi) - Complex::new(psi_before, 0.0)) * (factor * xi - xi_before).inverse()
            };
            coefficients.push((of(*logarithmic * m.inverse()), of(*logarithmic * m)));
        }
        Self { coefficients, x }
    }

    /// Extinction efficiency: cross section over π d²/4. Tends to 2 for large spheres.
    #[must_use]
    pub fn extinction_efficiency(&self) -> f64 {
        2.0 / (self.x * self.x) * self.sum(|(a, b)| a.re + b.re)
    }

    /// Scattering efficiency; equal to the extinction efficiency if k is 0.
    #[must_use]
    pub fn scattering_efficiency(&self) -> f64 {
        2.0 / (self.x * self.x) * self.sum(|(a, b)| a.norm2() + b.norm2())
    }

    fn sum(&self, of: impl Fn((Complex, Complex)) -> f64) -> f64 {
        (1_u32..).zip(&self.coefficients).map(|(j, pair)| f64::from(2 * j + 1) * of(*pair)).sum()
    }

    /// (|S₁|² + |S₂|²)/2 at scattering angles of these cosines; divided by k² = (2π/λ)² it is the differential cross section.
    #[must_use]
    pub fn intensities(&self, cosines: &[f64]) -> Vec<f64> {
        let mut angles: Vec<_> = cosines.iter().map(|cos| AngleAmplitudes::new(*cos)).collect();
        for (j, pair) in (1_u32..).zip(&self.coefficients) {
            let order = f64::from(j);
            angles.iter_mut().for_each(|angle| angle.add(order, pair.0, pair.1));
        }
        angles.iter().map(|angle| 0.5 * (angle.s1.norm2() + angle.s2.norm2())).collect()
    }
}

/// The amplitudes at one angle, term by term.
struct AngleAmplitudes {
    cos: f64,
    /// π of the term before, and of this one.
    pi: [f64; 2],
    s1: Complex,
    s2: Complex,
}

impl AngleAmplitudes {
    fn new(cos: f64) -> Self {
        Self { cos, pi: [0.0, 1.0], s1: Complex::default(), s2: Complex::default() }
    }

    #[inline(always)]
    fn add(&mut self, order: f64, a: Complex, b: Complex) {
        let [before, pi] = self.pi;
        let factor = (2.0 * order + 1.0) / (order * (order + 1.0));
        let tau = (order * self.cos * pi - (order + 1.0) * before) * factor;
        let scaled = pi * factor;
        self.s1 = self.s1 + a.scaled(scaled) + b.scaled(tau);
        self.s2 = self.s2 + a.scaled(tau) + b.scaled(scaled);
        self.pi = [pi, ((2.0 * order + 1.0) * self.cos * pi - (order + 1.0) * before) / order];
    }
}

/// D_j(z), j from 0 to `terms`, by downward recurrence from zero far above, where the error decays.
fn logarithmic_derivative(z: Complex, terms: usize) -> Vec<Complex> {
    let first = terms.max(z.norm2().sqrt() as usize) + 16;
    let inverse = z.inverse();
    let (mut of, mut d) = (vec![Complex::default(); terms + 1], Complex::default());
    for j in (1..=first).rev() {
        let ratio = inverse.scaled(j as f64);
        d = ratio - (d + ratio).inverse();
        if j - 1 <= terms {
            of[j - 1] = d;
        }
    }
    of
}

/// Droplets of log-normal diameters: by number, ln d is normally distributed about the ln of the median.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Droplets {
    /// The median of d by number, µm.
    pub diameter_um: f64,
    /// Geometric standard deviation; 1.35 is usual for fog.
    pub spread: f64,
    /// Index n of the droplets.
    pub n: f64,
    /// Index k of the droplets.
    pub k: f64,
}

/// Number of sampled sizes. Single spheres have narrow resonances, strongest in backscattering: 80 sizes leave 10 to 20 % of them, 2000 about 1 %.
const SIZES: i32 = 2000;
/// Range of the sampled sizes, in standard deviations.
const REACH: f64 = 3.5;

impl Droplets {
    /// Water droplets (n = 1.333, k = 2e-9), with the usual spread, 1.35.
    #[must_use]
    pub fn from_water(diameter_um: f64) -> Self {
        Self { diameter_um, spread: 1.35, n: 1.333, k: 2e-9 }
    }

    /// The phase function of unpolarised light, 1/sr, at scattering angles of these cosines, at a wavelength; its integral over all directions is 1.
    #[must_use]
    pub fn phase(&self, nm: f64, cosines: &[f64]) -> Vec<f64> {
        let (mut of, mut total) = (vec![0.0; cosines.len()], 0.0);
        let log_spread = ln(self.spread);
        for i in 0..SIZES {
            // By area, sizes are log-normal about a diameter larger by twice the variance.
            let deviation = REACH * (2.0 * (f64::from(i) + 0.5) / f64::from(SIZES) - 1.0) + 2.0 * log_spread;
            let diameter_um = self.diameter_um * exp(deviation * log_spread);
            let sphere = MieSphere::new(PI * diameter_um * 1e3 / nm, self.n, self.k);
            let weight = exp(-0.5 * deviation * deviation);
            total += weight * PI * sphere.x * sphere.x * sphere.scattering_efficiency();
            of.iter_mut().zip(sphere.intensities(cosines)).for_each(|(sum, intensity)| *sum += weight * intensity);
        }
        of.iter().map(|sum| sum / total).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::maths::f64::{cos, pow};

    /// Bohren and Huffman, app. A: x = 3 for a vacuum wavelength of 0.6328 µm, a = 0.525 µm, index 1.55 in a medium of 1: x = 5.213, Q_sca = 3.105
    /// 43, Q_ext the same, Q_back 2.925 34.
    #[test]
    fn the_sphere_of_bohren_and_huffman() {
        let x = 2.0 * PI * 0.525 / 0.6328;
        let sphere = MieSphere::new(x, 1.55, 0.0);
        assert!((sphere.scattering_efficiency() - 3.105_43).abs() < 1e-5, "{}", sphere.scattering_efficiency());
        assert!((sphere.extinction_efficiency() - 3.105_43).abs() < 1e-5);
        let back = 4.0 * sphere.intensities(&[-1.0])[0] / (x * x);
        assert!((back - 2.925_34).abs() < 1e-4, "{back}");
    }

    /// Small spheres follow Rayleigh's law: Q = 8/3 x⁴ |(m² − 1)/(m² + 2)|², to the order of x².
    #[test]
    fn small_spheres_scatter_as_rayleigh_says() {
        let (x, n) = (0.01_f64, 1.333_f64);
        let sphere = MieSphere::new(x, n, 0.0);
        let lorentz = (n * n - 1.0) / (n * n + 2.0);
        let expected = 8.0 / 3.0 * pow(x, 4.0) * lorentz * lorentz;
        assert!((sphere.scattering_efficiency() / expected - 1.0).abs() < 1e-3);
        let ratio = sphere.intensities(&[0.0])[0] / sphere.intensities(&[1.0])[0];
        assert!((ratio - 0.5).abs() < 1e-3, "{ratio}");
    }

    #[test]
    fn absorbing_spheres_extinguish_more_than_they_scatter() {
        let sphere = MieSphere::new(40.0, 1.5, 0.1);
        assert!(sphere.extinction_efficiency() > 1.5 * sphere.scattering_efficiency());
        assert!((sphere.extinction_efficiency() - 2.0).abs() < 0.3, "{}", sphere.extinction_efficiency());
    }

    /// The integral of the scattered light over all directions is the scattering efficiency; without absorption it equals the extinction
    /// efficiency, by the optical theorem Q_ext = 4/x² Re S(0).
    #[test]
    fn light_scattered_in_all_directions_is_all_that_is_scattered() {
        let sphere = MieSphere::new(25.0, 1.333, 0.0);
        let n = 20_000_u32;
        let cosines: Vec<_> = (0..n).map(|i| -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(n)).collect();
        let sum: f64 = sphere.intensities(&cosines).iter().sum();
        let q = 4.0 * sum / f64::from(n) / (25.0 * 25.0);
        assert!((q / sphere.scattering_efficiency() - 1.0).abs() < 1e-4, "{q}");
    }

    /// Reference values of the package miepython 3.3.0 (tests/oracles/mie.py): water at 550 nm, n = 1.333 − 2e-9 i, 20 001 sizes within four standard
    /// deviations. The tolerance is that of the remaining resonances.
    #[test]
    fn water_fog_agrees_with_an_independent_program() {
        let degrees = [0.0, 5.0, 30.0, 90.0, 140.0, 170.0, 180.0_f64];
        let cosines = degrees.map(|degrees| cos(degrees.to_radians()));
        for (diameter_um, expected) in [
            (5.0, [60.7864, 3.36400, 0.181_461, 0.004_383_40, 0.016_289_9, 0.019_018_7, 0.049_855_4]),
            (12.0, [335.628, 1.57484, 0.181_216, 0.002_461_14, 0.021_293_7, 0.011_034_2, 0.052_552_6]),
            (20.0, [919.557, 1.19069, 0.182_001, 0.001_858_18, 0.026_694_0, 0.008_299_25, 0.054_028_4]),
        ] {
            let phase = Droplets::from_water(diameter_um).phase(550.0, &cosines);
            for ((actual, expected), degrees) in phase.iter().zip(expected).zip(degrees) {
                assert!((actual / expected - 1.0).abs() < 0.03, "{diameter_um} µm, {degrees}°: {actual} {expected}");
            }
        }
    }
}
