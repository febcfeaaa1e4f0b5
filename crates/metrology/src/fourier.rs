//! The discrete Fourier transform of any length.
//!
//! ```text
//! F[k] = Σ_n f[n] exp(−2πi k n/N)
//! ```
//!
//! By splitting the length into its prime factors (Cooley & Tukey 1965): N Σ p operations over the primes p of N. Large primes
//! are slow (N²) but correct.

use core::f64::consts::TAU;

use etendue_core::maths::f64::sin_cos;

/// Real and imaginary part.
pub(crate) type Complex = [f64; 2];

/// The transform of `values`.
#[must_use]
pub(crate) fn transform(values: &[Complex]) -> Vec<Complex> {
    let length = values.len();
    let roots: Vec<Complex> = (0..length).map(|k| root(k, length)).collect();
    split(values, 0, 1, length, &roots)
}

/// exp(−2πi k/N).
fn root(k: usize, length: usize) -> Complex {
    let (sine, cosine) = sin_cos(-TAU * k as f64 / length as f64);
    [cosine, sine]
}

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// The transform of `length` values from `first` on, `stride` apart.
fn split(values: &[Complex], first: usize, stride: usize, length: usize, roots: &[Complex]) -> Vec<Complex> {
    if length <= 1 {
        return values.get(first).copied().into_iter().collect();
    }
    let factor = smallest_factor(length);
    let rest = length / factor;
    let parts: Vec<Vec<Complex>> =
        (0..factor).map(|r| split(values, first + r * stride, stride * factor, rest, roots)).collect();
    // The roots of this length are every (N/length)-th of those of N.
    let step = roots.len() / length;
    let bin = |k: usize| {
        parts.iter().enumerate().fold([0.0; 2], |[re, im], (r, part)| {
            let [a, b] = times(part[k % rest], roots[step * ((r * k) % length)]);
            [re + a, im + b]
        })
    };
    (0..length).map(bin).collect()
}

fn smallest_factor(n: usize) -> usize {
    (2..).take_while(|p| p * p <= n).find(|p| n.is_multiple_of(*p)).unwrap_or(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sum_of_its_definition() {
        for length in [1, 2, 7, 12, 30, 49, 64] {
            let values: Vec<Complex> = (0..length).map(|i| [((i * 7) % 11) as f64, ((i * 5) % 3) as f64]).collect();
            let fast = transform(&values);
            for (k, actual) in fast.iter().enumerate() {
                let expected = values.iter().enumerate().fold([0.0; 2], |[re, im], (n, v)| {
                    let [a, b] = times(*v, root((k * n) % length, length));
                    [re + a, im + b]
                });
                // Rounding: about fifty operations on values up to 10 · 64.
                assert!(
                    (actual[0] - expected[0]).abs() < 1e-11 && (actual[1] - expected[1]).abs() < 1e-11,
                    "{length} {k}"
                );
            }
        }
    }
}
