//! The mean of the readings of noisy light through a curve.
//!
//! A pixel of light L + σ z, z normal, reads y(L + σ z), and the mean of many is not y(L): a curve that bends, such as the end of a tone curve or a saturation, moves it. σ follows
//! from the readings' own standard deviation s, which is measured,
//!
//! ```text
//! ∫ y(L + σ z)² φ(z) dz − (∫ y(L + σ z) φ(z) dz)² = s²        mean = ∫ y(L + σ z) φ(z) dz
//! ```
//!
//! by 161 steps of the trapezoidal rule over |z| ≤ 5 (its error for smooth curves is beyond rounding; a knee of slopes m₁ and m₂ within leaves (m₁ − m₂) σ h²/8 at most, h 1/16: 5·10⁻⁴ of
//! the bend over σ).

use etendue_core::maths::f64::exp;

/// The mean reading of light whose readings scatter by `noise`.
pub fn noisy_mean(curve: impl Fn(f64) -> f64, light: f64, noise: f64) -> f64 {
    let of = |sigma: f64| moments(&curve, light, sigma);
    if noise <= 0.0 || noise.is_nan() {
        return curve(light);
    }
    // Upwards until the readings scatter enough; never where the curve is flat.
    let mut high = 1e-6 * light.abs().max(1e-6);
    while of(high).1 < noise {
        high *= 2.0;
        if high > 1e6 * light.abs().max(1e-6) {
            return curve(light);
        }
    }
    let mut low = 0.0;
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if of(middle).1 < noise { low = middle } else { high = middle }
    }
    of(0.5 * (low + high)).0
}

/// Mean and standard deviation of the readings.
fn moments(curve: &impl Fn(f64) -> f64, light: f64, sigma: f64) -> (f64, f64) {
    let (mut whole, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for i in -80..=80 {
        let z = f64::from(i) / 16.0;
        let (weight, y) = (exp(-0.5 * z * z), curve(light + sigma * z));
        whole += weight;
        sum += weight * y;
        squares += weight * y * y;
    }
    let mean = sum / whole;
    (mean, (squares / whole - mean * mean).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_s_mean_has_the_variance_more() {
        // Of L + σ z squared: mean L² + σ², variance 4 L² σ² + 2 σ⁴.
        let (light, sigma) = (3.0_f64, 0.2_f64);
        let noise = (4.0 * light * light * sigma * sigma + 2.0 * sigma * sigma * sigma * sigma).sqrt();
        let mean = noisy_mean(|l| l * l, light, noise);
        assert!((mean - light * light - sigma * sigma).abs() < 1e-5, "{mean}");
    }

    #[test]
    fn light_at_the_saturation_reads_less() {
        // Of min(z, 0): mean −1/√(2π), variance (1 − 1/π)/2.
        let noise = (0.5 - 0.5 / core::f64::consts::PI).sqrt();
        let mean = noisy_mean(|l| l.min(1.0), 1.0, 0.01 * noise);
        assert!((mean - 1.0 + 0.01 / core::f64::consts::TAU.sqrt()).abs() < 1e-5, "{mean}");
        assert_eq!(noisy_mean(|l| l.min(1.0), 3.0, 0.0), 1.0);
    }
}
