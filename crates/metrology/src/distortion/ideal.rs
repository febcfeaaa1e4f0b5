//! Map from the image to the ideal image of a camera without distortion.
//!
//! ideal(p) = base(p) + Σ βₖ Fₖ(p), with the base a radial polynomial ([`base`](super::base)), F its derivatives by its own
//! parameters and the fields of [`fields`], none of which has position, slope or tilt at the centre; and ideal(p) = H(chart), H a
//! homography. β and the correction of H are found by least squares of the distances in the image ([`fit_mixed_model`]). All
//! fields except the base's own are as small as the image shows them to be: large if many points determine them; if few do, their
//! possible size is included in the uncertainty.

use glam::{DMat2, DMat3, DVec2};

use super::fields::{self, PLANE};
use super::{DistortionError, RadialFit, base::RadialBase};
use crate::fit::{Homography, MixedModelFit, fit_mixed_model};
use crate::{linear::Matrix, patch_statistics::centroid_shift, target::Node};

/// Minimum number of points.
pub(super) const MIN_NODES: usize = 16;

/// Minimum error of a coordinate, px: 1 000 px have 1e-13 px of rounding, times thousands of operations.
const ROUNDING_PX: f64 = 1e-9;

pub(super) fn chart(node: &Node) -> DVec2 {
    DVec2::new(node.index[0] as f64, node.index[1] as f64)
}

/// The map from the image to the ideal image, and the homography between that and the chart.
#[derive(Clone, Debug)]
pub struct IdealMap {
    base: RadialBase,
    centre: DVec2,
    /// Maximum distance of a point of the chart from the centre, px: the fields' unit.
    reach: f64,
    /// From the chart (steps) to the ideal image, and back.
    plane: Homography,
    chart: Homography,
    sizes: Vec<f64>,
    covariance: Matrix,
    sigma: f64,
    tau: f64,
}

impl IdealMap {
    /// From points about a centre, starting with two radial fits.
    pub(super) fn from_nodes(
        nodes: &[Node],
        centre: DVec2,
        fits: [&RadialFit; 2],
        unit: f64,
    ) -> Result<Self, DistortionError> {
        let reach = nodes.iter().map(|n| (n.at - centre).length()).fold(0.0, f64::max);
        let is_invertible = |base: &RadialBase| nodes.iter().all(|n| base.slope(n.at).is_some());
        let [a, b] = fits;
        let ordered = if a.rms_px <= b.rms_px { [a, b] } else { [b, a] };
        let choices = [&ordered[..], &ordered[..1], &ordered[1..]];
        let mut candidates = choices.into_iter().filter_map(|fits| RadialBase::from_fits(fits, centre, unit));
        let start = candidates.find(|(base, _)| is_invertible(base)).or_else(|| {
            let pairs: Vec<[DVec2; 2]> = nodes.iter().map(|n| [chart(n), n.at]).collect();
            Some((RadialBase::none(centre, unit)?, Homography::direct(&pairs)?))
        });
        // Prior scale of a coordinate's error; lists of exact points have no residuals, and their rounding counts.
        let rough = (ordered[0].rms_px * core::f64::consts::FRAC_1_SQRT_2).max(ROUNDING_PX);
        let (base, plane) = start.ok_or(DistortionError::Few { points: nodes.len(), least: MIN_NODES })?;
        // The homography's own change affects it again by less than its square.
        const ROUNDS: usize = 2;
        let mut ideal = Self::unfitted(base, centre, reach, plane);
        for _ in 0..ROUNDS {
            ideal = ideal.fitted(nodes, rough)?;
        }
        let origin = ideal.chart(centre);
        let covered = origin.is_some_and(|origin| nodes.iter().any(|n| (chart(n) - origin).length() < 1.5));
        if covered { Ok(ideal) } else { Err(DistortionError::Centre { centre_px: centre.to_array() }) }
    }

    fn unfitted(base: RadialBase, centre: DVec2, reach: f64, plane: Homography) -> Self {
        let covariance = Matrix::zeros(0, 0);
        Self {
            base,
            centre,
            reach,
            plane,
            chart: inverse(&plane, centre),
            sizes: Vec::new(),
            covariance,
            sigma: 0.0,
            tau: 0.0,
        }
    }

    /// Fits the sizes of the fields, and updates the homography by the residual.
    fn fitted(self, nodes: &[Node], rough: f64) -> Result<Self, DistortionError> {
        let (design, values) =
            self.equations(nodes, rough).ok_or(DistortionError::Few { points: nodes.len(), least: MIN_NODES })?;
        let MixedModelFit { parameters, covariance, sigma, tau } =
            fit_mixed_model(&design, &values, PLANE + self.base.count().0)?;
        let plane = self.moved(&parameters[..PLANE]);
        let count = parameters.len() - PLANE;
        let part = |i: usize| (0..count).map(|j| covariance.at(PLANE + i, PLANE + j)).collect::<Vec<f64>>();
        let covariance = Matrix::from_rows(count, (0..count).map(part));
        let sizes = parameters[PLANE..].to_vec();
        Ok(Self { plane, chart: inverse(&plane, self.centre), sizes, covariance, sigma, tau, ..self })
    }

    /// One row per coordinate: H(chart) − base(p) by fields, over the base's slope, so that errors are those of positions in the
    /// image. One more row is the prior that a lens follows either direction, or lies between or slightly beyond them: half the
    /// difference has the coefficient 0 ± 1.
    fn equations(&self, nodes: &[Node], rough: f64) -> Option<(Matrix, Vec<f64>)> {
        let (mut rows, mut values) = (Vec::with_capacity(2 * nodes.len()), Vec::with_capacity(2 * nodes.len()));
        for node in nodes {
            let ideal = self.plane.image(chart(node))?;
            let back = self.base.slope(node.at)?.inverse();
            let off = back * (ideal - self.base.place(node.at)?);
            let fields = fields::plane((ideal - self.centre) / self.reach).into_iter().chain(self.fields(node.at)?);
            let fields: Vec<DVec2> = fields.map(|f| back * f).collect();
            rows.extend([0, 1].map(|c| fields.iter().map(|f| f[c]).collect::<Vec<f64>>()));
            values.extend(off.to_array());
        }
        let columns = rows.first()?.len();
        if let (count, true) = self.base.count() {
            let mut row = vec![0.0; columns];
            row[PLANE + count - 1] = rough;
            rows.push(row);
            values.push(0.0);
        }
        Some((Matrix::from_rows(columns, rows), values))
    }

    /// The homography less its plane fields: x − a − A x over 1 + t · x, about the centre.
    fn moved(&self, fields: &[f64]) -> Homography {
        let f = fields.iter().map(|f| f / self.reach).collect::<Vec<f64>>();
        let rows = [[1.0 - f[2], -f[3], -f[0]], [-f[4], 1.0 - f[5], -f[1]], [f[6], f[7], 1.0]];
        let unit = DMat3::from_translation(self.centre) * DMat3::from_scale(DVec2::splat(self.reach));
        let matrix = unit * DMat3::from_cols_array_2d(&rows).transpose() * unit.inverse() * self.plane.matrix;
        Homography { matrix }
    }

    fn fields(&self, at: DVec2) -> Option<Vec<DVec2>> {
        let mut fields = self.base.fields(at)?;
        fields.extend(fields::distortion((at - self.centre) / self.reach));
        Some(fields)
    }

    /// The centre, px.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        self.centre
    }

    /// Degree of the highest field.
    #[must_use]
    pub fn degree(&self) -> usize {
        fields::DEGREE
    }

    /// Standard deviation of a coordinate of a point about the fit, px.
    #[must_use]
    pub fn sigma_px(&self) -> f64 {
        self.sigma
    }

    /// Standard deviation of each term beyond k₁ and k₂ at the chart's farthest point, px.
    #[must_use]
    pub fn tau_px(&self) -> f64 {
        self.tau
    }

    /// Length of a step of the chart at the centre, px: the square root of its cell's area.
    #[must_use]
    pub fn step_px(&self) -> f64 {
        let step = |d: DVec2| {
            let origin = self.chart(self.centre)?;
            Some(self.plane.image(origin + 1e-3 * d)? - self.plane.image(origin - 1e-3 * d)?)
        };
        let cell = step(DVec2::X).zip(step(DVec2::Y));
        cell.map_or(0.0, |(x, y)| DMat2::from_cols(x, y).determinant().abs().sqrt() / 2e-3)
    }

    /// The chart's point at an observed position, steps; `None` if the map has none.
    #[must_use]
    pub fn chart(&self, at: DVec2) -> Option<DVec2> {
        self.chart.image(self.place(at)?)
    }

    /// Undistorted position of an observed position, px; `None` if the map has none.
    #[must_use]
    pub fn place(&self, at: DVec2) -> Option<DVec2> {
        let base = self.base.place(at)?;
        Some(base + self.fields(at)?.iter().zip(&self.sizes).map(|(f, size)| *size * *f).sum::<DVec2>())
    }

    /// Derivatives of the logarithm of the ideal distance at a position by the fields' sizes.
    pub(super) fn log_distance_row(&self, at: DVec2) -> Option<Vec<f64>> {
        let v = self.place(at)? - self.centre;
        let influence = v / v.length_squared();
        Some(self.fields(at)?.iter().map(|f| influence.dot(*f)).collect())
    }

    pub(super) fn variance(&self, row: &[f64]) -> f64 {
        self.covariance.form(row)
    }

    /// Covariance of the fields' sizes with a quantity that depends on them by a row.
    pub(super) fn influence(&self, row: &[f64]) -> Vec<f64> {
        self.covariance.times(row)
    }

    /// Offset of the centroid of a disc about a point of the chart from its centre's image, px. The image near a node is found by
    /// steps along the slope there.
    pub(super) fn disc_shift(&self, node: &Node, radius: f64) -> Option<DVec2> {
        const STEPS: usize = 4;
        let h = 1e-3 * self.reach;
        let along = |d: DVec2| Some((self.place(node.at + h * d)? - self.place(node.at - h * d)?) * (0.5 / h));
        let back = DMat2::from_cols(along(DVec2::X)?, along(DVec2::Y)?).inverse();
        let image = |point: DVec2| {
            let target = self.plane.image(point)?;
            (0..STEPS).try_fold(node.at, |at, _| Some(at + back * (target - self.place(at)?)))
        };
        centroid_shift(image, chart(node), radius)
    }
}

/// The inverse of a homography, with the centre's image in front of the plane.
fn inverse(plane: &Homography, centre: DVec2) -> Homography {
    let matrix = plane.matrix.inverse();
    Homography { matrix: matrix / (matrix * centre.extend(1.0)).z }
}
