//! A projection by a table: radii over field angles, and a smooth curve through them.
//!
//! The interpolated quantity is q = r/θ, which varies little: a cubic spline in θ, even about the axis (q′(0) = 0), with constant curvature in the
//! last interval. On the axis q is that of a parabola in θ² through the first two points. r(θ) = θ q(θ) goes through every point; its slope, which
//! determines the light per position, is that of the curve.

use core::f64::consts::PI;

use super::ModelError;
use super::profile::{FieldEdge, Profile};
use crate::rectilinear::legal;
use crate::root::{first_sign_change, increasing};

/// A projection by a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TabulatedProjection {
    /// Field angles from 0, rad, with the spline at each.
    knots: Vec<Knot>,
}

/// The spline of q at one of its knots.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    angle: f64,
    /// r.
    radius: f64,
    /// q.
    ratio: f64,
    /// q″.
    second_derivative: f64,
}

impl TabulatedProjection {
    /// Creates the curve through (field angle, rad; radius in units of the image plane), two or more points beyond the axis; the axis itself is not
    /// included.
    ///
    /// # Errors
    /// If there are fewer, angles do not rise within (0, π], radii do not rise from above 0, or the curve falls between two points.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, ModelError> {
        legal("the number of points", points.len() as f64, points.len() >= 2, "two or more beyond the axis")?;
        let mut last = (0.0, 0.0);
        for (angle, radius) in points.iter().copied() {
            let rises = angle > last.0 && angle <= PI;
            legal("a field angle", angle.to_degrees(), rises, "angles that increase from above 0° to 180° at most")?;
            legal("a radius", radius, radius > last.1 && radius.is_finite(), "radii that increase with the angles")?;
            last = (angle, radius);
        }
        let [first, second] = [points[0], points[1]].map(|(angle, radius)| (angle * angle, radius / angle));
        let on_axis = (first.1 * second.0 - second.1 * first.0) / (second.0 - first.0);
        legal("the focal length", on_axis, on_axis > 0.0, "a table whose first points give one above 0")?;
        let axis = Knot { angle: 0.0, radius: 0.0, ratio: on_axis, second_derivative: 0.0 };
        let beyond = points.iter().map(|(angle, radius)| Knot {
            angle: *angle,
            radius: *radius,
            ratio: radius / angle,
            second_derivative: 0.0,
        });
        let mut knots: Vec<Knot> = core::iter::once(axis).chain(beyond).collect();
        solve_second_derivatives(&mut knots);
        let tabulated = Self { knots };
        tabulated.check_rises()?;
        Ok(tabulated)
    }

    /// The points of the table: field angle, rad, and radius.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.knots[1..].iter().map(|knot| (knot.angle, knot.radius))
    }

    fn check_rises(&self) -> Result<(), ModelError> {
        for pair in self.knots.windows(2) {
            let (from, h) = (pair[0], pair[1].angle - pair[0].angle);
            let [c0, c1, c2, c3] = coefficients(pair);
            // r = (θ₀ + x) (c₀ + c₁ x + c₂ x² + c₃ x³)
            let t = from.angle;
            let slope = [c0 + t * c1, 2.0 * (c1 + t * c2), 3.0 * (c2 + t * c3), 4.0 * c3];
            let falls = slope[0] <= 0.0 || first_sign_change(&slope, h).is_some();
            let expected = "a table whose curve increases everywhere; check the table for jumps";
            legal("a field angle before which the radius decreases", pair[1].angle.to_degrees(), !falls, expected)?;
        }
        Ok(())
    }

    /// r and dr/dθ.
    fn value(&self, angle: f64) -> [f64; 2] {
        let after = self.knots.partition_point(|knot| knot.angle <= angle).clamp(1, self.knots.len() - 1);
        let pair = &self.knots[after - 1..=after];
        let [c0, c1, c2, c3] = coefficients(pair);
        let x = angle - pair[0].angle;
        let ratio = c0 + x * (c1 + x * (c2 + x * c3));
        let slope = c1 + x * (2.0 * c2 + x * 3.0 * c3);
        [angle * ratio, ratio + angle * slope]
    }
}

/// Coefficients of the cubic between two knots, by the distance from the first.
fn coefficients(pair: &[Knot]) -> [f64; 4] {
    let (a, b) = (pair[0], pair[1]);
    let h = b.angle - a.angle;
    let slope = (b.ratio - a.ratio) / h - h * (2.0 * a.second_derivative + b.second_derivative) / 6.0;
    [a.ratio, slope, 0.5 * a.second_derivative, (b.second_derivative - a.second_derivative) / (6.0 * h)]
}

/// The second derivatives at the knots: a tridiagonal system, solved from both ends (Thomas).
fn solve_second_derivatives(knots: &mut [Knot]) {
    let last = knots.len() - 1;
    let step = |i: usize, knots: &[Knot]| knots[i + 1].angle - knots[i].angle;
    let slope = |i: usize, knots: &[Knot]| (knots[i + 1].ratio - knots[i].ratio) / step(i, knots);
    // For each row the factor of the next knot's second derivative, and the right-hand side.
    let (mut upper, mut right) = (vec![0.0; last + 1], vec![0.0; last + 1]);
    // q′(0) = 0.
    upper[0] = 0.5;
    right[0] = 3.0 * slope(0, knots) / step(0, knots);
    for i in 1..last {
        let (before, after) = (step(i - 1, knots), step(i, knots));
        let diagonal = 2.0 * (before + after) - before * upper[i - 1];
        upper[i] = after / diagonal;
        right[i] = (6.0 * (slope(i, knots) - slope(i - 1, knots)) - before * right[i - 1]) / diagonal;
    }
    // The last interval has one curvature: the last second derivative is the one before it.
    knots[last - 1].second_derivative = right[last - 1] / (1.0 + upper[last - 1]);
    knots[last].second_derivative = knots[last - 1].second_derivative;
    for i in (0..last - 1).rev() {
        knots[i].second_derivative = right[i] - upper[i] * knots[i + 1].second_derivative;
    }
}

impl Profile for TabulatedProjection {
    fn edge(&self) -> FieldEdge {
        FieldEdge::end(self.knots[self.knots.len() - 1].angle)
    }

    fn radius(&self, angle_rad: f64) -> f64 {
        self.value(angle_rad)[0]
    }

    fn slope(&self, angle_rad: f64) -> f64 {
        self.value(angle_rad)[1]
    }

    fn angle(&self, radius: f64) -> Option<f64> {
        let after = self.knots.partition_point(|knot| knot.radius <= radius);
        let pair = self.knots.get(after.checked_sub(1)?..=after)?;
        let fraction = (radius - pair[0].radius) / (pair[1].radius - pair[0].radius);
        let guess = pair[0].angle + fraction * (pair[1].angle - pair[0].angle);
        increasing(radius, [pair[0].angle, pair[1].angle], guess, |angle| self.value(angle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::maths::f64::{sin, tan};

    fn table(r: impl Fn(f64) -> f64, maximum: f64, count: usize) -> TabulatedProjection {
        let at = |i: usize| maximum * (i + 1) as f64 / count as f64;
        let points: Vec<(f64, f64)> = (0..count).map(|i| (at(i), r(at(i)))).collect();
        TabulatedProjection::new(&points).expect("a rising table")
    }

    #[test]
    fn curves_between_points_are_those_that_points_were_taken_of() {
        let distorted = |t: f64| 8.0 * tan(t) * (1.0 - 0.1 * tan(t) * tan(t));
        let fisheye = |t: f64| 2.0 * sin(0.5 * t);
        for (r, maximum) in [(&distorted as &dyn Fn(f64) -> f64, 0.7), (&fisheye, 3.0)] {
            let tabulated = table(r, maximum, 40);
            for i in 1..400 {
                let angle = maximum * f64::from(i) / 401.0;
                let [radius, slope] = tabulated.value(angle);
                let h = 1e-5;
                let expected = (r(angle + h) - r(angle - h)) / (2.0 * h);
                // The last interval's curvature is assumed constant: errors of h² there, of h⁴ elsewhere.
                let near_end = angle > maximum * 0.9;
                let bound = if near_end { 3e-5 } else { 2e-6 };
                assert!((radius / r(angle) - 1.0).abs() < bound, "{angle}: {radius} {}", r(angle));
                assert!((slope / expected - 1.0).abs() < 100.0 * bound, "{angle}: {slope} {expected}");
                let back = tabulated.angle(radius).expect("within the table");
                assert!((back - angle).abs() < 1e-12 * (1.0 + angle), "{angle} {back}");
            }
            assert_eq!(tabulated.angle(r(maximum) * 1.001), None);
            assert!((tabulated.value(0.0)[1] - (r(1e-6) / 1e-6)).abs() < 1e-4 * tabulated.value(0.0)[1]);
        }
    }

    #[test]
    fn points_are_exact_and_bad_tables_refused() {
        let points = [(0.1, 1.0), (0.25, 2.4), (0.3, 2.95), (0.6, 5.5)];
        let tabulated = TabulatedProjection::new(&points).expect("rising");
        for (angle, radius) in points {
            assert!((tabulated.value(angle)[0] - radius).abs() < 1e-12);
        }
        assert_eq!(tabulated.points().collect::<Vec<_>>(), points);
        for bad in [
            &points[..1],
            &[(0.2, 1.0), (0.1, 2.0)],
            &[(0.1, 2.0), (0.2, 1.0)],
            &[(0.1, 1.0), (3.2, 2.0)],
            &[(0.1, 1.0), (0.2, 9.0), (0.3, 9.01), (0.4, 9.02)],
            &[(0.1, 0.1), (0.2, f64::NAN)],
        ] {
            TabulatedProjection::new(bad).expect_err("no lens");
        }
    }
}
