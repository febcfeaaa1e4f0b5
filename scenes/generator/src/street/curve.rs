//! Smooth curves through a few points that never overshoot (Fritsch and Carlson 1980, monotone cubics).

/// Points (x, y) in rising x.
#[derive(Clone, Debug)]
pub(super) struct Curve(pub(super) Vec<[f64; 2]>);

impl Curve {
    /// The value at x; held outside.
    #[must_use]
    pub(super) fn at(&self, x: f64) -> f64 {
        let points = &self.0;
        let last = points.len() - 1;
        let x = x.clamp(points[0][0], points[last][0]);
        let i = points.partition_point(|p| p[0] <= x).clamp(1, last) - 1;
        let [[x0, y0], [x1, y1]] = [points[i], points[i + 1]];
        let (h, t) = (x1 - x0, (x - x0) / (x1 - x0));
        let (t2, t3) = (t * t, t * t * t);
        y0 * (2.0 * t3 - 3.0 * t2 + 1.0)
            + y1 * (3.0 * t2 - 2.0 * t3)
            + h * (self.slope(i) * (t3 - 2.0 * t2 + t) + self.slope(i + 1) * (t3 - t2))
    }

    /// The harmonic mean of the neighbouring slopes, zero at a turn.
    fn slope(&self, i: usize) -> f64 {
        let secant = |i: usize| (self.0[i + 1][1] - self.0[i][1]) / (self.0[i + 1][0] - self.0[i][0]);
        if i == 0 {
            return secant(0);
        }
        if i == self.0.len() - 1 {
            return secant(i - 1);
        }
        let (a, b) = (secant(i - 1), secant(i));
        if a * b <= 0.0 { 0.0 } else { 2.0 * a * b / (a + b) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_meets_its_points_and_stays_between() {
        let curve = Curve(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 0.5]]);
        assert!([0.0, 1.0, 2.0].iter().all(|&x| (curve.at(x) - curve.0[x as usize][1]).abs() < 1e-12));
        assert!((0..=300).all(|i| (0.0..=1.0).contains(&curve.at(f64::from(i) / 100.0))));
    }
}
