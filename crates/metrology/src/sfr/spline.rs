//! B-splines of degree 4 and their integral.

/// How many step functions differ from 0 and 1 at a place: the support of β⁴ in steps.
pub(super) const SUPPORT: usize = 5;

/// β⁴(u), the cardinal B-spline of degree 4, unit area, zero beyond |u| = 5/2 (Schoenberg 1946).
pub(super) fn bell(u: f64) -> f64 {
    let u = u.abs();
    if u < 0.5 {
        let v = u * u;
        115.0 / 192.0 - 5.0 / 8.0 * v + 0.25 * v * v
    } else if u < 1.5 {
        let v = u * u;
        (55.0 + 20.0 * u - 120.0 * v + 80.0 * v * u - 16.0 * v * v) / 96.0
    } else if u < 2.5 {
        let w = 2.5 - u;
        w * w * w * w / 24.0
    } else {
        0.0
    }
}

/// ∫ β⁴ from −∞ to u: from 0 to 1.
pub(super) fn step(u: f64) -> f64 {
    if u > 0.0 { 1.0 - lower(-u) } else { lower(u) }
}

/// The integral for u ≤ 0.
fn lower(u: f64) -> f64 {
    let a = -u;
    if a >= 2.5 {
        0.0
    } else if a >= 1.5 {
        let w = 2.5 - a;
        w * w * w * w * w / 120.0
    } else if a >= 0.5 {
        let at = |a: f64| a * (55.0 + a * (10.0 + a * (-40.0 + a * (20.0 - 3.2 * a)))) / 96.0;
        1.0 / 120.0 + at(1.5) - at(a)
    } else {
        let v = a * a;
        0.5 - a * (115.0 / 192.0 + v * (-5.0 / 24.0 + 0.05 * v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_is_the_integral_of_the_bell() {
        let (mut sum, fine) = (0.0, 1e-4);
        for i in -30_000..30_000 {
            let u = f64::from(i) * fine;
            if i % 1000 == 0 {
                assert!((step(u) - sum).abs() < 1e-8, "{u}: {} {sum}", step(u));
            }
            sum += fine * bell(u + 0.5 * fine);
        }
        assert!((sum - 1.0).abs() < 1e-8);
        // A partition of unity.
        let total: f64 = (-4..5).map(|k| bell(0.3 - f64::from(k))).sum();
        assert!((total - 1.0).abs() < 1e-14);
    }
}
