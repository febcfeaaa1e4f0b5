//! Root finding: of an increasing function by Newton's method in a bracket, and of a polynomial by its stationary points.

/// Maximum Newton steps; enough to bisect a bracket of any size to nothing.
const STEPS: usize = 200;

/// The argument in [`low`, `high`) at which an increasing function has the value `target`; `None` if it reaches it at the upper end or later.
/// `function` gives value and slope. Newton's method from `guess`, kept in the bracket; if it would leave or its steps do not halve, the bracket is
/// bisected instead. Accurate to the last units in the last place.
pub(crate) fn increasing(
    target: f64,
    [mut low, mut high]: [f64; 2],
    guess: f64,
    function: impl Fn(f64) -> [f64; 2],
) -> Option<f64> {
    if target.is_nan() || target >= function(high)[0] {
        return None;
    }
    let mut x = guess.clamp(low, high);
    let mut last = high - low;
    for _ in 0..STEPS {
        let [value, slope] = function(x);
        let error = value - target;
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let step = error / slope;
        if step.abs() <= f64::EPSILON * x.abs() || error.abs() <= f64::EPSILON * target.abs() {
            return Some(if step.is_finite() { (x - step).clamp(low, high) } else { x });
        }
        let newton = x - step;
        let converges = newton >= low && newton <= high && step.abs() <= 0.5 * last;
        let next = if converges { newton } else { 0.5 * (low + high) };
        last = (next - x).abs();
        if last == 0.0 {
            return Some(x);
        }
        x = next;
    }
    Some(x)
}

/// c₀ + c₁ x + c₂ x² + …
pub(crate) fn polynomial(c: &[f64], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The derivative's coefficients.
pub(crate) fn derivative(c: &[f64]) -> Vec<f64> {
    c.iter().enumerate().skip(1).map(|(i, c)| i as f64 * c).collect()
}

/// The coefficients of a product of polynomials.
pub(crate) fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut c = vec![0.0; a.len() + b.len() - 1];
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            c[i + j] += a * b;
        }
    }
    c
}

/// The smallest x in (0, `limit`] at which the polynomial changes its sign. Touching zero does not count.
pub(crate) fn first_sign_change(c: &[f64], limit: f64) -> Option<f64> {
    sign_changes(c, limit.min(bound(c))).first().copied()
}

/// Cauchy's bound of the roots.
fn bound(c: &[f64]) -> f64 {
    let leading = c.iter().rev().find(|c| **c != 0.0).copied().unwrap_or(1.0);
    1.0 + c.iter().map(|c| (c / leading).abs()).fold(0.0, f64::max)
}

/// All sign changes, ascending: between stationary points a polynomial has one at most.
fn sign_changes(c: &[f64], limit: f64) -> Vec<f64> {
    if c.iter().skip(1).all(|c| *c == 0.0) {
        return Vec::new();
    }
    let mut knots = vec![0.0];
    knots.extend(sign_changes(&derivative(c), limit));
    knots.push(limit);
    knots.windows(2).filter_map(|w| crossing([w[0], w[1]], |x| polynomial(c, x))).collect()
}

/// The sign change of `function` between two ends of different signs, by bisection.
pub(crate) fn crossing([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> Option<f64> {
    let rising = function(low) < 0.0;
    if rising == (function(high) < 0.0) {
        return None;
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return Some(high);
        }
        if (function(middle) < 0.0) == rising {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_known_roots_is_found() {
        // (1 − x)(2 − x)(5 − x)
        let c = product(&product(&[1.0, -1.0], &[2.0, -1.0]), &[5.0, -1.0]);
        assert!((first_sign_change(&c, f64::INFINITY).expect("1") - 1.0).abs() < 1e-14);
        assert_eq!(sign_changes(&c, 10.0).len(), 3);
        assert!(first_sign_change(&c, 0.9).is_none());
        assert!(first_sign_change(&[1.0, 0.0, 1.0], f64::INFINITY).is_none());
        assert!(first_sign_change(&[1.0, 0.0, 0.0], f64::INFINITY).is_none());
        // (x − 1)² only touches.
        assert!(first_sign_change(&[1.0, -2.0, 1.0], f64::INFINITY).is_none());
    }

    #[test]
    fn an_increasing_function_is_inverted_in_any_bracket() {
        let cube = |x: f64| [x * x * x, 3.0 * x * x];
        for high in [3.0, 1e8] {
            // Newton stops at a step of one unit in the last place.
            assert!((increasing(8.0, [0.0, high], 0.1, cube).expect("inside") - 2.0).abs() < 1e-15);
        }
        // Newton's steps alone alternate for ever: √|x − 2| with the sign of x − 2, from any guess.
        let root = |x: f64| [(x - 2.0).signum() * (x - 2.0).abs().sqrt() + 2.0, 0.5 / (x - 2.0).abs().sqrt()];
        assert!((increasing(2.0, [0.0, 5.0], 3.0, root).expect("inside") - 2.0).abs() < 1e-15);
        assert!(increasing(27.0, [0.0, 3.0], 1.0, cube).is_none());
        assert!(increasing(f64::NAN, [0.0, 3.0], 1.0, cube).is_none());
    }
}
