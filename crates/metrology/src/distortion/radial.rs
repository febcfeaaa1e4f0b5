//! k₁ and k₂ of one image of a chart.

use etendue_projection::{DistortionDirection, RadialDistortion};
use glam::{DMat3, DVec2};

use crate::fit::{Fit, FitError, Homography, Problem, fit};
use crate::{Estimate, calibrate::Sighting};

/// The radial polynomial r′ = r (1 + k₁ r² + k₂ r⁴) nearest to an image, r and r′ in half diagonals about its own centre, after a
/// homography from the chart (eight more parameters).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialFit {
    /// From ideal to observed, or back.
    pub sense: DistortionDirection,
    /// k₁, per half diagonal squared.
    pub k1: Estimate,
    /// k₂, per half diagonal to the fourth.
    pub k2: Estimate,
    /// Centre of distortion, raster coordinates; with infinite uncertainty if the distortion is too weak to determine it (then the
    /// curve's centre is used).
    pub centre_px: [Estimate; 2],
    /// Covariance of k₁, k₂ and the centre's x and y.
    pub covariance: [[f64; 4]; 4],
    /// Root mean square distance of the points from the fit, px.
    pub rms_px: f64,
    /// From the chart to the undistorted image, px.
    pub(super) plane: Homography,
}

impl RadialFit {
    pub(super) fn new(
        points: &[Sighting],
        sense: DistortionDirection,
        centre: DVec2,
        half_diagonal_px: f64,
    ) -> Result<Self, FitError> {
        let pairs: Vec<[DVec2; 2]> = points.iter().map(|p| [p.chart, p.at]).collect();
        let few = FitError::Underdetermined { residuals: 2 * pairs.len(), parameters: 12 };
        let start = Homography::direct(&pairs).ok_or(few)?;
        let (chart, size) = middle(&pairs);
        let problem = Radial { points, sense, half_diagonal_px, centre, free: false, chart, size };
        let mut numbers = problem.first(&start);
        numbers.extend([0.0; 2]);
        // Without distortion the centre is arbitrary: it is freed after k₁ and k₂ are fitted.
        let fixed_centre = fit(&problem, &numbers)?;
        let numbers = [&fixed_centre.parameters[..], &centre.to_array()].concat();
        let free = fit(&Radial { free: true, ..problem.clone() }, &numbers).ok();
        // A centre with an uncertainty above a twentieth of the half diagonal counts as undetermined.
        let known = |f: &Fit| (10..12).all(|i| f.estimate(i).standard_uncertainty < 0.05 * half_diagonal_px);
        let (result, centre_px) = match free.filter(known) {
            Some(result) => (result.clone(), [result.estimate(10), result.estimate(11)]),
            None => (fixed_centre, [centre.x, centre.y].map(|c| Estimate::new(c, f64::INFINITY))),
        };
        let squares: f64 = result.residuals.iter().flatten().map(|r| r * r).sum();
        let rms_px = (squares / points.len() as f64).sqrt();
        let plane = problem.plane(&result.parameters);
        let unknown = |i: usize, j: usize| if i == j { f64::INFINITY } else { 0.0 };
        let fitted = result.parameters.len() - 8;
        let covariance =
            |i: usize, j: usize| if i.max(j) < fitted { result.covariance.at(8 + i, 8 + j) } else { unknown(i, j) };
        let covariance = std::array::from_fn(|i| std::array::from_fn(|j| covariance(i, j)));
        Ok(Self { sense, k1: result.estimate(8), k2: result.estimate(9), centre_px, covariance, rms_px, plane })
    }
}

impl RadialFit {
    /// Observed over ideal radius at an observed one, in half diagonals about the fit's own centre, for a fit from observed to
    /// ideal.
    pub(super) fn ratio(&self, field: f64) -> Estimate {
        let (square, fourth) = (field * field, field * field * field * field);
        let ratio = 1.0 / (1.0 + self.k1.value * square + self.k2.value * fourth);
        let c = &self.covariance;
        let variance = square * square * c[0][0] + 2.0 * square * fourth * c[0][1] + fourth * fourth * c[1][1];
        Estimate::new(ratio, ratio * ratio * variance.max(0.0).sqrt())
    }
}

fn middle(pairs: &[[DVec2; 2]]) -> (DVec2, f64) {
    let centre = pairs.iter().map(|p| p[0]).sum::<DVec2>() / pairs.len() as f64;
    (centre, pairs.iter().map(|p| (p[0] - centre).length()).fold(0.0, f64::max))
}

/// Parameters: the homography from the chart (centred, scaled to size 1) to half diagonals about `centre`, row by row without the
/// last element; k₁, k₂; the centre if free.
#[derive(Clone)]
struct Radial<'a> {
    points: &'a [Sighting],
    sense: DistortionDirection,
    half_diagonal_px: f64,
    centre: DVec2,
    free: bool,
    chart: DVec2,
    size: f64,
}

impl Radial<'_> {
    /// From the chart to the undistorted image, px.
    fn plane(&self, numbers: &[f64]) -> Homography {
        let unit = |centre: DVec2, size: f64| DMat3::from_translation(centre) * DMat3::from_scale(DVec2::splat(size));
        let matrix = unit(self.centre, self.half_diagonal_px) * homography(numbers).matrix;
        Homography { matrix: matrix * unit(self.chart, self.size).inverse() }
    }

    fn first(&self, start: &Homography) -> Vec<f64> {
        let unit = |centre: DVec2, size: f64| DMat3::from_translation(centre) * DMat3::from_scale(DVec2::splat(size));
        let matrix = unit(self.centre, self.half_diagonal_px).inverse() * start.matrix * unit(self.chart, self.size);
        let rows = (matrix / matrix.z_axis.z).transpose().to_cols_array();
        rows[..8].to_vec()
    }
}

/// The homography of its parameters, row by row.
fn homography(p: &[f64]) -> Homography {
    let rows = [p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], 1.0];
    Homography { matrix: DMat3::from_cols_array(&rows).transpose() }
}

impl Problem for Radial<'_> {
    type State = (Homography, RadialDistortion, DVec2);

    fn state(&self, p: &[f64]) -> Option<Self::State> {
        let homography = homography(p);
        let centre = if self.free { DVec2::new(p[10], p[11]) } else { self.centre };
        Some((homography, RadialDistortion::new(self.sense, p[8], p[9], 1.0).ok()?, centre))
    }

    fn blocks(&self) -> usize {
        1
    }

    fn residuals(&self, (homography, distortion, centre): &Self::State, _: usize) -> Option<Vec<f64>> {
        let mut residuals = Vec::with_capacity(2 * self.points.len());
        for point in self.points {
            let undistorted = homography.image((point.chart - self.chart) / self.size)?;
            // In half diagonals about the centre of distortion.
            let moved = undistorted - (*centre - self.centre) / self.half_diagonal_px;
            let observed = distortion.observed(moved)?;
            residuals.extend((*centre + observed * self.half_diagonal_px - point.at).to_array());
        }
        Some(residuals)
    }

    fn depends(&self, _: usize, _: usize) -> bool {
        true
    }

    fn reach(&self, parameter: usize) -> f64 {
        if parameter < 10 { 0.03 } else { 0.03 * self.half_diagonal_px }
    }
}
