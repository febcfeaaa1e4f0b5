//! Plane to plane by a polynomial of two variables.
//!
//! Each coordinate of the image is Σ a_ij T_i(u) T_j(v) over i + j ≤ n, T Chebyshev polynomials of the first kind and
//! (u, v) = (p − c)/s the point moved and scaled so that all fitted points lie within −1 … 1: columns of about equal size
//! and little correlation. Least squares by reflections, so degrees up to 12 keep ten digits.
//!
//! Uncertainty: covariance of a coordinate's coefficients = s² (AᵀA)⁻¹, s² = Σ r²/ν over both coordinates.

use super::levenberg::FitError;
use crate::linear::{Matrix, Orthogonal};
use glam::{DMat2, DVec2};

/// A polynomial map.
#[derive(Clone, Debug)]
pub struct PolynomialMap {
    degree: usize,
    centre: DVec2,
    scale: f64,
    /// Coefficients of x′ and of y′, in the order of [`terms`].
    coefficients: [Vec<f64>; 2],
    unit_covariance: Matrix,
    /// √(Σ r²/ν) of a coordinate, in units of the image.
    pub sigma: f64,
    /// ν: coordinates less coefficients.
    pub degrees_of_freedom: usize,
}

/// Value and derivatives of a map at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// The image.
    pub value: DVec2,
    /// ∂(x′, y′)/∂(x, y).
    pub slope: DMat2,
    /// ∂²/∂x², ∂²/∂x∂y, ∂²/∂y² of (x′, y′).
    pub curvature: [DVec2; 3],
}

/// Exponents (i, j), i + j ≤ degree.
fn terms(degree: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..=degree).flat_map(move |sum| (0..=sum).map(move |j| (sum - j, j)))
}

/// T_n, T_n′, T_n″ at x for n up to a degree.
fn chebyshev(x: f64, degree: usize) -> Vec<[f64; 3]> {
    let mut list = vec![[1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    for n in 2..=degree.max(1) {
        let ([a, a1, a2], [b, b1, b2]) = (list[n - 1], list[n - 2]);
        list.push([2.0 * x * a - b, 2.0 * a + 2.0 * x * a1 - b1, 4.0 * a1 + 2.0 * x * a2 - b2]);
    }
    list
}

/// Highest degree.
const HIGHEST: usize = 12;

/// T_0 … at x.
fn values(x: f64) -> [f64; HIGHEST + 1] {
    let mut values = [1.0; HIGHEST + 1];
    values[1] = x;
    for n in 2..=HIGHEST {
        values[n] = 2.0 * x * values[n - 1] - values[n - 2];
    }
    values
}

impl PolynomialMap {
    /// The number of coefficients of one coordinate.
    #[must_use]
    pub fn count(degree: usize) -> usize {
        (degree + 1) * (degree + 2) / 2
    }

    /// The polynomial of a degree nearest to pairs of a point and its image.
    ///
    /// # Errors
    /// Where there are too few points, or they lie on too few lines, for the degree.
    pub fn fitted(degree: usize, pairs: &[[DVec2; 2]]) -> Result<Self, FitError> {
        assert!(degree <= HIGHEST, "a polynomial of degree {degree}, beyond {HIGHEST}");
        let count = Self::count(degree);
        let few = || FitError::Few { residuals: pairs.len(), parameters: count };
        if pairs.len() <= count {
            return Err(few());
        }
        let (low, high) = pairs.iter().fold((pairs[0][0], pairs[0][0]), |(l, h), p| (l.min(p[0]), h.max(p[0])));
        let (centre, scale) = (0.5 * (low + high), 0.5 * (high - low).max_element());
        let rows = pairs.iter().map(|[p, _]| basis(degree, (*p - centre) / scale));
        let factored = Orthogonal::of(&Matrix::from_rows(count, rows), 1e-10).ok_or_else(few)?;
        let solve = |coordinate: usize| factored.solve(&pairs.iter().map(|p| p[1][coordinate]).collect::<Vec<_>>());
        let solutions = [solve(0), solve(1)];
        let degrees_of_freedom = 2 * (pairs.len() - count);
        let squares: f64 = solutions.iter().map(|s| s.residual_squares).sum();
        Ok(Self {
            degree,
            centre,
            scale,
            sigma: (squares / degrees_of_freedom as f64).sqrt(),
            degrees_of_freedom,
            unit_covariance: factored.unit_covariance(),
            coefficients: solutions.map(|s| s.parameters),
        })
    }

    /// Its degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The image of a point.
    #[must_use]
    pub fn image(&self, point: DVec2) -> DVec2 {
        let at = (point - self.centre) / self.scale;
        let (u, v) = (values(at.x), values(at.y));
        let mut sum = DVec2::ZERO;
        for ((i, j), (x, y)) in terms(self.degree).zip(self.coefficients[0].iter().zip(&self.coefficients[1])) {
            sum += u[i] * v[j] * DVec2::new(*x, *y);
        }
        sum
    }

    /// The image and its derivatives.
    #[must_use]
    pub fn jet(&self, point: DVec2) -> Jet {
        let at = (point - self.centre) / self.scale;
        let (u, v) = (chebyshev(at.x, self.degree), chebyshev(at.y, self.degree));
        let derivative = |dx: usize, dy: usize| {
            let rows: Vec<f64> = terms(self.degree).map(|(i, j)| u[i][dx] * v[j][dy]).collect();
            self.sum(&rows) / [1.0, self.scale, self.scale * self.scale][dx + dy]
        };
        Jet {
            value: derivative(0, 0),
            slope: DMat2::from_cols(derivative(1, 0), derivative(0, 1)),
            curvature: [derivative(2, 0), derivative(1, 1), derivative(0, 2)],
        }
    }

    /// How a coordinate of a point's image depends on its coefficients.
    #[must_use]
    pub fn row(&self, point: DVec2) -> Vec<f64> {
        basis(self.degree, (point - self.centre) / self.scale)
    }

    /// How a coordinate of the slope along a direction depends on its coefficients.
    #[must_use]
    pub fn slope_row(&self, point: DVec2, direction: DVec2) -> Vec<f64> {
        let at = (point - self.centre) / self.scale;
        let (u, v) = (chebyshev(at.x, self.degree), chebyshev(at.y, self.degree));
        let along = direction / self.scale;
        terms(self.degree).map(|(i, j)| along.x * u[i][1] * v[j][0] + along.y * u[i][0] * v[j][1]).collect()
    }

    /// How a coordinate of the second derivatives ∂²/∂x², ∂²/∂x∂y, ∂²/∂y² depends on its coefficients.
    #[must_use]
    pub fn curvature_rows(&self, point: DVec2) -> [Vec<f64>; 3] {
        let at = (point - self.centre) / self.scale;
        let (u, v) = (chebyshev(at.x, self.degree), chebyshev(at.y, self.degree));
        let square = self.scale * self.scale;
        [(2, 0), (1, 1), (0, 2)].map(|(dx, dy)| terms(self.degree).map(|(i, j)| u[i][dx] * v[j][dy] / square).collect())
    }

    /// The variance of what depends on a coordinate's coefficients by a row.
    #[must_use]
    pub fn variance(&self, row: &[f64]) -> f64 {
        self.sigma * self.sigma * self.unit_covariance.form(row)
    }

    fn sum(&self, row: &[f64]) -> DVec2 {
        let [x, y] = [0, 1].map(|c: usize| crate::linear::matrix::dot(row, &self.coefficients[c]));
        DVec2::new(x, y)
    }
}

fn basis(degree: usize, at: DVec2) -> Vec<f64> {
    let (u, v) = (values(at.x), values(at.y));
    terms(degree).map(|(i, j)| u[i] * v[j]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic map about (300, 200).
    fn image(p: DVec2) -> DVec2 {
        let q = (p - DVec2::new(300.0, 200.0)) / 100.0;
        p + q * q.length_squared() + DVec2::new(q.x * q.y, 0.5 * q.x * q.x)
    }

    #[test]
    fn a_map_of_the_family_comes_back_with_its_derivatives() {
        let points = (0..13).flat_map(|i| (0..10).map(move |j| DVec2::new(50.0 * f64::from(i), 45.0 * f64::from(j))));
        let pairs: Vec<_> = points.map(|p| [p, image(p)]).collect();
        let map = PolynomialMap::fitted(7, &pairs).expect("enough points");
        let at = DVec2::new(310.0, 222.0);
        let jet = map.jet(at);
        assert!((jet.value - image(at)).length() < 1e-10 && map.sigma < 1e-10, "{jet:?}");
        let h = 1e-3;
        let (x, y) = (DVec2::X * h, DVec2::Y * h);
        let slope_x = (image(at + x) - image(at - x)) / (2.0 * h);
        // The cubic's own third derivative makes the difference h²/6 · 6e-6; the rest is rounding over h.
        assert!((jet.slope.x_axis - slope_x).length() < 1e-9, "{jet:?} {slope_x}");
        let bent = (image(at + y) - 2.0 * image(at) + image(at - y)) / (h * h);
        assert!((jet.curvature[2] - bent).length() < 2e-6, "{jet:?} {bent}");
        assert!(PolynomialMap::fitted(7, &pairs[..36]).is_err());
        let line: Vec<_> = pairs.iter().copied().filter(|p| p[0].x < 60.0).chain(pairs[..9].iter().copied()).collect();
        assert!(PolynomialMap::fitted(3, &line).is_err());
    }
}
