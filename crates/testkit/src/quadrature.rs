//! Integrals by plain sums.

/// Simpson's rule on `intervals` (even) equal parts: exact for cubics.
///
/// # Panics
/// Where the number of intervals is odd or zero.
#[must_use]
pub fn simpson(low: f64, high: f64, intervals: usize, f: impl Fn(f64) -> f64) -> f64 {
    assert!(intervals > 0 && intervals.is_multiple_of(2), "Simpson's rule needs pairs of intervals");
    let step = (high - low) / intervals as f64;
    let weight = |i: usize| match i {
        0 => 1.0,
        i if i == intervals => 1.0,
        i if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=intervals).map(|i| weight(i) * f(low + step * i as f64)).sum::<f64>() * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_exact() {
        let integral = simpson(-1.0, 3.0, 2, |x| 2.0 * x * x * x - x + 1.0);
        assert!((integral - 40.0).abs() < 1e-13, "{integral}");
    }
}
