//! The fall-off over the field: an even polynomial of the distance from the centre divided by the square of 1 + c r².

use super::report::{Basis, Ring, ShadingError, ShadingSettings, TERMS};
use super::sums::RegionSums;
use crate::Estimate;
use crate::linear::{Matrix, Normal, dot};

/// I₀ (1 + …) as Σ b_k φ_k(r²) of a [`Basis`], with φ₀ = 1 at the centre and the others 0.
pub(super) struct Falloff {
    pub(super) basis: Basis,
    pub(super) b: Vec<f64>,
    /// Covariance of the coefficients, including the misfit of the rings' means.
    pub(super) covariance: Matrix,
    /// Covariance of b₀ with each coefficient due to the rings' own noise.
    pub(super) centre_covariance: Vec<f64>,
    /// For each ring, by its number: the covariance of b₀ with the line noise in its mean, and the variance of that noise.
    pub(super) with_lines: Vec<[f64; 2]>,
}

/// Minimum relative noise of a pixel in the fit, so that no ring dominates.
const MIN_NOISE: f64 = 1e-3;

/// Weight of a ring in the fit.
pub(super) fn weight(ring: &RegionSums) -> f64 {
    let (u, min_uncertainty) = (ring.standard_uncertainty(), MIN_NOISE * ring.mean().abs() / ring.count.sqrt());
    1.0 / (u * u + min_uncertainty * min_uncertainty).max(f64::MIN_POSITIVE)
}

impl Falloff {
    /// Fits the rings, whose means have a covariance due to lines in addition to their own noise.
    pub(super) fn fitted(rings: &[RegionSums], basis: Basis, shared: &Matrix) -> Result<Self, ShadingError> {
        let mut normal = Normal::new(TERMS);
        for ring in rings {
            normal.add(&ring.mean_terms(), ring.mean(), weight(ring));
        }
        let none = ShadingError::NotFlat { percent: f64::NAN, blocks: 0 };
        let (b, own) = normal.solve().zip(normal.inverse()).ok_or(none)?;
        // Dependence of each coefficient on the means of the rings.
        let influence = |ring: &RegionSums| own.times(&ring.mean_terms().map(|p| p * weight(ring)));
        let influences = Matrix::from_rows(TERMS, rings.iter().map(influence));
        let column = |k: usize| (0..rings.len()).map(|i| influences.at(i, k)).collect::<Vec<f64>>();
        let shared_products: Vec<Vec<f64>> = (0..TERMS).map(|k| shared.times(&column(k))).collect();
        let centre_covariance = own.row(0).to_vec();
        let misfit = misfit_factor(rings, &b, &own, shared);
        let mut covariance = own.scaled(misfit);
        for (i, product) in shared_products.iter().enumerate() {
            (0..TERMS).for_each(|j| *covariance.at_mut(i, j) += dot(product, &column(j)));
        }
        let mut with_lines = vec![[0.0; 2]; rings.iter().map(|ring| ring.number + 1).max().unwrap_or(0)];
        rings
            .iter()
            .enumerate()
            .for_each(|(i, ring)| with_lines[ring.number] = [shared_products[0][i], shared.at(i, i)]);
        Ok(Self { basis, b, covariance, centre_covariance, with_lines })
    }

    pub(super) fn centre(&self, settings: &ShadingSettings) -> Result<Estimate, ShadingError> {
        let centre = Estimate::new(self.b[0], self.covariance.at(0, 0).sqrt());
        let dark = ShadingError::Dark { reading: centre.value + settings.black, black: settings.black };
        if centre.value > 3.0 * centre.standard_uncertainty && centre.value > 0.0 { Ok(centre) } else { Err(dark) }
    }

    /// Reading at a squared position.
    pub(super) fn at(&self, square: f64) -> f64 {
        self.basis.at(square).iter().zip(&self.b).map(|(p, b)| p * b).sum()
    }

    /// Mean of the fall-off over a ring or block.
    pub(super) fn mean(&self, pixels: &RegionSums) -> f64 {
        pixels.mean_terms().iter().zip(&self.b).map(|(p, b)| p * b).sum()
    }

    /// A ring relative to the centre, which depends on the ring itself by its weight in the fit.
    pub(super) fn ring(&self, ring: &RegionSums) -> Ring {
        let relative_light = self.at(ring.square_position());
        let curved = self.mean(ring) - relative_light;
        let (value, u) = ((ring.mean() - curved) / self.b[0], ring.standard_uncertainty());
        let along: f64 = self.centre_covariance.iter().zip(ring.mean_terms()).map(|(c, p)| c * p).sum();
        let [with_centre, line_part] = self.with_lines[ring.number];
        let common = u * u * along * weight(ring) + with_centre;
        let variance = u * u + line_part + value * value * self.covariance.at(0, 0) - 2.0 * value * common;
        let u = variance.max(0.0).sqrt() / self.b[0];
        Ring { position: ring.square_position().sqrt(), relative: Estimate::new(value, u) }
    }

    /// A linear form of the coefficients divided by b₀.
    fn over_centre(&self, form: [f64; TERMS]) -> Estimate {
        let value = form.iter().zip(&self.b).map(|(f, b)| f * b).sum::<f64>() / self.b[0];
        let mut slopes = form.map(|f| f / self.b[0]);
        slopes[0] -= value / self.b[0];
        Estimate::new(value, self.covariance.form(&slopes).max(0.0).sqrt())
    }

    /// a₂ … a₈ of the polynomial 1 + a₂ r² + … + a₈ r⁸ nearest to the fall-off over the image's circle.
    pub(super) fn polynomial(&self) -> [Estimate; TERMS - 1] {
        self.basis.nearest_polynomial().map(|(form, constant)| {
            let scaled = self.over_centre(form);
            Estimate::new(scaled.value - constant, scaled.standard_uncertainty)
        })
    }

    pub(super) fn corner(&self) -> Estimate {
        self.over_centre(self.basis.at(1.0))
    }

    /// Coefficients relative to that of the centre.
    pub(super) fn shape(&self) -> [f64; TERMS] {
        core::array::from_fn(|k| self.b[k] / self.b[0])
    }
}

/// Ratio of the rings' squared residuals to their expectation from noise and line noise, at least 1: the fit's own error, which
/// its covariance does not include (Birge 1932). With W the weights, A the rings' terms, C the covariance of the fit and S that
/// of the lines, the expected sum of squared residuals is ν + tr((W − W A C Aᵀ W) S), with ν the rings less the coefficients.
fn misfit_factor(rings: &[RegionSums], b: &[f64], own: &Matrix, shared: &Matrix) -> f64 {
    if rings.len() <= TERMS {
        return 1.0;
    }
    let weights: Vec<f64> = rings.iter().map(weight).collect();
    let terms: Vec<[f64; TERMS]> = rings.iter().map(RegionSums::mean_terms).collect();
    let residual = |i: usize| rings[i].mean() - dot(&terms[i], b);
    let squares: f64 = (0..rings.len()).map(|i| weights[i] * residual(i) * residual(i)).sum();
    let influences: Vec<Vec<f64>> = terms.iter().map(|row| own.times(row)).collect();
    let line_covariance = |(i, j): (usize, usize)| {
        let own = if i == j { weights[i] } else { 0.0 };
        (own - weights[i] * weights[j] * dot(&terms[i], &influences[j])) * shared.at(j, i)
    };
    let pairs = (0..rings.len()).flat_map(|i| (0..rings.len()).map(move |j| (i, j)));
    let expected = (rings.len() - TERMS) as f64 + pairs.map(line_covariance).sum::<f64>().max(0.0);
    (squares / expected).max(1.0)
}
