//! Settings, basis of a fall-off, results and errors of a shading measurement.
//!
//! Basis of a fall-off:
//!
//! ```text
//! φ_k(s) = sᵏ/(1 + c s)²      s = r², r = 1 in the corner, k = 0 … 4
//! ```
//!
//! The irradiance of a lens falls approximately as cos⁴ θ = 1/(1 + s tan² θ_corner)². At 37 % in the corner, a polynomial alone
//! is off by 0.16 points there and by 0.05 % at the centre, far more than the noise of a good image. With the c from a first fit
//! by polynomials (c = 0), cos⁴ is one of the terms, and the effects of pixels, pupils and distortion are smooth and small.

use etendue_core::maths::f64::cos;

use crate::Estimate;
use crate::linear::{Cholesky, Matrix};

/// Reason why a flat field cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShadingError {
    #[error("{percent:.1} % of the pixels of the flat field are saturated: expose less")]
    Saturated {
        /// Percentage of saturated pixels.
        percent: f64,
    },
    /// No light.
    #[error(
        "the centre of the flat field reads {reading}, no more than black ({black}): expose more, or check the black level"
    )]
    Dark {
        /// Reading of the centre.
        reading: f64,
        /// The black level.
        black: f64,
    },
    /// Not a flat field.
    #[error(
        "the image does not show a uniformly lit surface: it differs from a smooth fall-off by {percent:.0} % (root mean square of {blocks} × {blocks} blocks)"
    )]
    NotFlat {
        /// Relative deviation.
        percent: f64,
        /// Number of blocks along a side.
        blocks: usize,
    },
    /// A reading is NaN or infinite.
    #[error("the image contains readings that are not finite: give finite values")]
    NotFinite,
    /// Too few pixels for the rings and blocks.
    #[error(
        "an image of {width} × {height} pixels is too small for {rings} rings and {blocks} × {blocks} blocks (an odd number of blocks, four pixels or \
         more each)"
    )]
    TooSmall {
        /// Pixels per row.
        width: usize,
        /// Rows.
        height: usize,
        /// Requested rings.
        rings: usize,
        /// Requested blocks.
        blocks: usize,
    },
    /// Channels of different sizes.
    #[error("the channels differ in size: give images of one size")]
    Sizes,
}

/// Settings of a flat-field measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingSettings {
    /// Reading without light.
    pub black: f64,
    /// Reading of a saturated pixel.
    pub full_scale: Option<f64>,
    /// Centre of the fall-off, raster coordinates; `None`: the image centre.
    pub centre_px: Option<(f64, f64)>,
    /// Rings of the profile.
    pub rings: usize,
    /// Blocks of the map along each side, an odd number.
    pub blocks: usize,
}

impl Default for ShadingSettings {
    fn default() -> Self {
        Self { black: 0.0, full_scale: None, centre_px: None, rings: 20, blocks: 11 }
    }
}

/// A ring of the profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Radial field position, as a fraction of the distance from the centre to the farthest corner.
    pub position: f64,
    /// Illumination relative to the centre.
    pub relative: Estimate,
}

/// Shading of a flat field.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {
    /// From the centre outwards.
    pub profile: Vec<Ring>,
    /// The centre's reading less black.
    pub centre: Estimate,
    /// a₂, a₄, a₆, a₈ of the polynomial nearest to the fitted fall-off over the circle, with positions as fractions.
    pub coefficients: [Estimate; 4],
    /// Fitted illumination at the farthest corner relative to the centre.
    pub corner: Estimate,
    /// Block means relative to the central one, rows from the top.
    pub map: Vec<Vec<Estimate>>,
    /// The fitted fall-off: its terms, and their coefficients relative to that of the centre.
    pub(super) fitted: (Basis, [f64; TERMS]),
}

impl Shading {
    /// The fitted fall-off at a radial field position (1 at the farthest corner).
    #[must_use]
    pub fn falloff(&self, position: f64) -> f64 {
        let (basis, shape) = self.fitted;
        basis.at(position * position).iter().zip(shape).map(|(term, b)| term * b).sum()
    }
}

/// Number of terms of a fall-off.
pub(super) const TERMS: usize = 5;
/// c of a corner with a twentieth of the light.
const MAX_STEEPNESS: f64 = 3.47;

/// The terms for one c.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Basis {
    /// c.
    steepness: f64,
}

impl Basis {
    /// The terms for which the square of 1 + c s alone gives a corner its light relative to the centre.
    pub(super) fn from_corner(relative: f64) -> Self {
        let steepness = if relative > 0.0 { 1.0 / relative.sqrt() - 1.0 } else { MAX_STEEPNESS };
        Self { steepness: steepness.clamp(0.0, MAX_STEEPNESS) }
    }

    /// The terms at a squared position, 0 to 1.
    pub(super) fn at(self, square: f64) -> [f64; TERMS] {
        let root = 1.0 + self.steepness * square;
        let mut terms = [1.0 / (root * root); TERMS];
        (1..TERMS).for_each(|k| terms[k] = terms[k - 1] * square);
        terms
    }

    /// For each coefficient of the polynomial 1 + a₂ s + … + a₈ s⁴ nearest to Σ b_k φ_k/b₀ by least squares over s from 0 to 1 (the
    /// area of a circle): weights of b_k/b₀, and the constant subtracted from their sum. Without steepness these are the
    /// coefficients themselves.
    pub(super) fn nearest_polynomial(self) -> [([f64; TERMS], f64); TERMS - 1] {
        let inverse = inverse_hilbert();
        // ∫ sⁱ φ_k ds and ∫ sⁱ ds, i = 1 … 4.
        let mut moments = [[0.0; TERMS]; TERMS - 1];
        for (s, weight) in nodes() {
            let (terms, mut power) = (self.at(s), 1.0);
            for row in &mut moments {
                power *= s;
                row.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * power * term);
            }
        }
        core::array::from_fn(|i| {
            let form = core::array::from_fn(|k| (0..TERMS - 1).map(|j| inverse.at(i, j) * moments[j][k]).sum());
            let constant = (0..TERMS - 1).map(|j| inverse.at(i, j) / (j as f64 + 2.0)).sum();
            (form, constant)
        })
    }
}

/// The inverse of ∫ sⁱ sʲ ds = 1/(i + j + 1), i and j = 1 … 4.
fn inverse_hilbert() -> Matrix {
    let row = |i: usize| (0..TERMS - 1).map(|j| 1.0 / (i + j + 3) as f64).collect::<Vec<_>>();
    let moments = Matrix::from_rows(TERMS - 1, (0..TERMS - 1).map(row));
    Cholesky::new(&moments, 1e-14).expect("powers are independent").inverse()
}

/// Nodes and weights of Fejér's first rule on 0 to 1: exact for polynomials of a degree below the number of nodes, and equally
/// accurate for φ_k, whose pole is far away.
fn nodes() -> impl Iterator<Item = (f64, f64)> {
    const COUNT: u32 = 48;
    (0..COUNT).map(|i| {
        let angle = core::f64::consts::PI * (f64::from(i) + 0.5) / f64::from(COUNT);
        let terms = (1..=COUNT / 2).map(|m| cos(2.0 * f64::from(m) * angle) / f64::from(4 * m * m - 1));
        (0.5 * (1.0 - cos(angle)), (1.0 - 2.0 * terms.sum::<f64>()) / f64::from(COUNT))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_their_own_nearest() {
        for (i, (form, constant)) in Basis::default().nearest_polynomial().into_iter().enumerate() {
            for (k, weight) in form.into_iter().enumerate() {
                let own = if k == 0 { constant } else { f64::from(u8::from(k == i + 1)) };
                assert!((weight - own).abs() < 1e-8, "{i} {k}: {weight} and {own}");
            }
        }
    }

    /// 1/(1 + c s)² and the polynomial nearest to it, for a corner of 37 %.
    #[test]
    fn the_nearest_polynomial_is_near() {
        let basis = Basis::from_corner(0.37);
        assert!((basis.at(1.0)[0] - 0.37).abs() < 1e-12);
        let a = basis.nearest_polynomial().map(|(form, constant)| form[0] - constant);
        for i in 0..=20 {
            let s = f64::from(i) / 20.0;
            let polynomial = 1.0 + s * (a[0] + s * (a[1] + s * (a[2] + s * a[3])));
            assert!((polynomial - basis.at(s)[0]).abs() < 2e-3, "{s}: {polynomial}");
        }
    }
}
