//! First approximation of a distortion: the radial polynomial nearest to the image, normalised to the scale at the centre.

use etendue_projection::{DistortionDirection, RadialDistortion};
use glam::{DMat2, DMat3, DVec2};

use super::RadialFit;
use crate::fit::Homography;

/// A radial polynomial about a point, r in half diagonals.
#[derive(Clone, Copy, Debug)]
struct Polynomial {
    /// In px.
    distortion: RadialDistortion,
    middle: DVec2,
}

impl Polynomial {
    fn new(sense: DistortionDirection, [k1, k2]: [f64; 2], middle: DVec2, half_diagonal_px: f64) -> Option<Self> {
        let distortion = RadialDistortion::new(sense, k1, k2, half_diagonal_px).ok()?;
        Some(Self { distortion, middle })
    }

    fn half_diagonal_px(&self) -> f64 {
        self.distortion.unit_mm()
    }

    /// Undistorted position of an observed position; `None` beyond the polynomial's fold.
    fn ideal(&self, at: DVec2) -> Option<DVec2> {
        Some(self.middle + self.distortion.ideal(at - self.middle)?)
    }

    /// The same with one parameter changed: k₁, k₂, the centre's x or y.
    fn changed(&self, number: usize, by: f64) -> Option<Self> {
        let (mut k, mut middle) = (self.distortion.coefficients(), self.middle);
        match number {
            0 | 1 => k[number] += by,
            _ => middle[number - 2] += by * self.half_diagonal_px(),
        }
        Self::new(self.distortion.sense(), k, middle, self.half_diagonal_px())
    }
}

/// A map from the image to an ideal one: value, slope and (as nearly as possible) curvature at the centre are those of no
/// distortion.
#[derive(Clone, Copy, Debug)]
struct NormalisedPolynomial {
    polynomial: Polynomial,
    /// From the polynomial's plane to the ideal image.
    normalisation: Homography,
}

/// Step of finite differences, relative to half a diagonal: derivatives to 1e-6 of the polynomial's third.
const STEP: f64 = 1e-3;

impl NormalisedPolynomial {
    /// The homography after which the polynomial has value, slope and tilt of the identity at the centre: v = slope⁻¹ (x − value),
    /// then v/(1 − tilt · v). A homography's curvature is −2 tₓ eₓ, −(tₓ e_y + t_y eₓ), −2 t_y e_y; the nearest tilt is used.
    fn new(polynomial: Polynomial, centre: DVec2) -> Option<Self> {
        let step = STEP * polynomial.half_diagonal_px();
        let at = |x: f64, y: f64| polynomial.ideal(centre + step * DVec2::new(x, y));
        let value = at(0.0, 0.0)?;
        let slope = DMat2::from_cols(at(1.0, 0.0)? - at(-1.0, 0.0)?, at(0.0, 1.0)? - at(0.0, -1.0)?) * (0.5 / step);
        let inverse = slope.inverse();
        let second = |sum: DVec2| inverse * sum / (step * step);
        let xx = second(at(1.0, 0.0)? + at(-1.0, 0.0)? - 2.0 * value);
        let yy = second(at(0.0, 1.0)? + at(0.0, -1.0)? - 2.0 * value);
        let xy = second(0.25 * (at(1.0, 1.0)? + at(-1.0, -1.0)? - at(1.0, -1.0)? - at(-1.0, 1.0)?));
        let tilt = DVec2::new(-(xx.x + xy.y) / 3.0, -(yy.y + xy.x) / 3.0);
        let rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-tilt.x, -tilt.y, 1.0]];
        let tilted = DMat3::from_cols_array_2d(&rows).transpose();
        let back = DMat3::from_mat2(inverse) * DMat3::from_translation(-value);
        let matrix = DMat3::from_translation(centre) * tilted * back;
        matrix.is_finite().then_some(Self { polynomial, normalisation: Homography { matrix } })
    }

    fn place(&self, at: DVec2) -> Option<DVec2> {
        self.normalisation.image(self.polynomial.ideal(at)?)
    }
}

/// The mean of the polynomials of both directions: charts of few points do not distinguish them, although they differ beyond the
/// points. With the maps in which one parameter of the first is changed: k₁, k₂ and, if the image determines it, the centre.
#[derive(Clone, Debug)]
pub(super) struct RadialBase {
    /// One or two maps.
    maps: Vec<NormalisedPolynomial>,
    /// Maps with each parameter increased and decreased.
    changed: Vec<[NormalisedPolynomial; 2]>,
}

impl RadialBase {
    /// From fits about a centre, the better first, with the homography from the chart to the ideal image; `None` if one of them
    /// folds there.
    pub(super) fn from_fits(fits: &[&RadialFit], centre: DVec2, half_diagonal_px: f64) -> Option<(Self, Homography)> {
        let map = |fit: &&RadialFit| {
            let middle = fit.centre_px.map(|c| c.value).into();
            NormalisedPolynomial::new(
                Polynomial::new(fit.sense, [fit.k1.value, fit.k2.value], middle, half_diagonal_px)?,
                centre,
            )
        };
        let maps: Option<Vec<NormalisedPolynomial>> = fits.iter().map(map).collect();
        let (maps, first) = (maps?, fits.first()?);
        let chart = Homography { matrix: maps[0].normalisation.matrix * first.plane.matrix };
        let moves = first.centre_px[0].standard_uncertainty.is_finite();
        Some((Self { changed: changed(&maps[0].polynomial, centre, moves)?, maps }, chart))
    }

    /// Without distortion.
    pub(super) fn none(centre: DVec2, half_diagonal_px: f64) -> Option<Self> {
        let none = Polynomial::new(DistortionDirection::ObservedToIdeal, [0.0; 2], centre, half_diagonal_px)?;
        Some(Self { maps: vec![NormalisedPolynomial::new(none, centre)?], changed: changed(&none, centre, false)? })
    }

    /// Number of fields, and true if the last of them is half the difference of the two directions: ± 1 times it gives the
    /// polynomial of either.
    pub(super) fn count(&self) -> (usize, bool) {
        let both = self.maps.len() > 1;
        (self.changed.len() + usize::from(both), both)
    }

    /// Ideal position of an observed position; `None` beyond the polynomial's fold.
    pub(super) fn place(&self, at: DVec2) -> Option<DVec2> {
        let sum = self.maps.iter().try_fold(DVec2::ZERO, |sum, map| Some(sum + map.place(at)?));
        Some(sum? / self.maps.len() as f64)
    }

    /// Derivatives of the ideal position by each parameter, and half the difference of both directions: displacement fields with
    /// neither position nor slope nor tilt at the centre.
    pub(super) fn fields(&self, at: DVec2) -> Option<Vec<DVec2>> {
        let half = |[more, less]: [&NormalisedPolynomial; 2]| Some(0.5 * (more.place(at)? - less.place(at)?));
        let field = |[more, less]: &[NormalisedPolynomial; 2]| Some(half([more, less])? / STEP);
        let mut fields: Vec<DVec2> = self.changed.iter().map(field).collect::<Option<_>>()?;
        if let [a, b] = &self.maps[..] {
            fields.push(half([a, b])?);
        }
        Some(fields)
    }

    /// Slope at a position.
    pub(super) fn slope(&self, at: DVec2) -> Option<DMat2> {
        let step = STEP * self.maps[0].polynomial.half_diagonal_px();
        let along = |d: DVec2| Some((self.place(at + step * d)? - self.place(at - step * d)?) * (0.5 / step));
        Some(DMat2::from_cols(along(DVec2::X)?, along(DVec2::Y)?))
    }
}

/// Maps with a parameter changed up and down.
fn changed(polynomial: &Polynomial, centre: DVec2, moves: bool) -> Option<Vec<[NormalisedPolynomial; 2]>> {
    let changed = |number: usize, by: f64| NormalisedPolynomial::new(polynomial.changed(number, by * STEP)?, centre);
    let both = |k: usize| Some([changed(k, 1.0)?, changed(k, -1.0)?]);
    (0..if moves { 4 } else { 2 }).map(both).collect()
}
