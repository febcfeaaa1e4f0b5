//! Result of a calibration.

use etendue_projection::{Calibration, CameraMatrix};
use glam::DVec2;

use super::{CalibrateError, Family, Pose, problem::CalibrationProblem, shared};
use crate::fit::{Fit, Problem};
use crate::{Estimate, linear::Matrix};

/// A fitted parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name: fx_px, fy_px, cx_px, cy_px (raster coordinates), then the model's.
    pub name: &'static str,
    /// Value.
    pub estimate: Estimate,
}

/// A calibrated camera.
#[derive(Clone, Debug)]
pub struct CalibrationResult {
    /// The camera.
    pub calibration: Calibration,
    /// Fitted parameters of the camera.
    pub parameters: Vec<Parameter>,
    /// Their covariance, in their order.
    pub covariance: Matrix,
    /// Their standard uncertainties under the assumption of independent point errors, as other programs state them.
    pub independent_uncertainties: Vec<f64>,
    /// Pose of the chart in each view.
    pub poses: Vec<Pose>,
    /// Residuals, fitted less observed, px, of every point of each view.
    pub residuals_px: Vec<Vec<DVec2>>,
    /// Standard deviation of a coordinate, px: √(Σ r²/ν).
    pub sigma_px: f64,
    /// ν.
    pub degrees_of_freedom: usize,
    /// The model's family.
    pub(super) family: Family,
}

impl CalibrationResult {
    /// The fitted parameter of a name.
    #[must_use]
    pub fn estimate(&self, name: &str) -> Option<Estimate> {
        self.parameters.iter().find(|p| p.name == name).map(|p| p.estimate)
    }

    /// A quantity derived from the camera, with its uncertainty from the parameters' covariance, to first order; `None` if the
    /// camera has none.
    pub fn follows(&self, number: impl Fn(&Calibration) -> Option<f64>) -> Option<Estimate> {
        /// Step of numerical derivatives, in standard uncertainties.
        const STEP: f64 = 0.1;
        let value = number(&self.calibration)?;
        let slope = |i: usize| {
            let step = STEP * self.parameters[i].estimate.standard_uncertainty;
            let moved = |by: f64| number(&self.moved(i, by)?);
            Some(if step > 0.0 { (moved(step)? - moved(-step)?) / (2.0 * step) } else { 0.0 })
        };
        let slopes: Option<Vec<f64>> = (0..self.parameters.len()).map(slope).collect();
        let variance = slopes.map_or(f64::INFINITY, |slopes| self.covariance.form(&slopes));
        Some(Estimate::new(value, variance.sqrt()))
    }

    /// The camera with one parameter changed.
    fn moved(&self, parameter: usize, by: f64) -> Option<Calibration> {
        let value = |(i, p): (usize, &Parameter)| p.estimate.value + if i == parameter { by } else { 0.0 };
        let values: Vec<f64> = self.parameters.iter().enumerate().map(value).collect();
        let at = |name: &str| self.parameters.iter().position(|p| p.name == name).map(|i| values[i]);
        let known = self.calibration.matrix();
        let fx = at("fx_px").unwrap_or(known.fx);
        let (cx, cy) = (at("cx_px").unwrap_or(known.cx), at("cy_px").unwrap_or(known.cy));
        let matrix = CameraMatrix { fx, fy: at("fy_px").unwrap_or(fx), cx, cy, ..known };
        let coefficients = &values[values.len() - self.family.names().len()..];
        Calibration::new(self.family.model(coefficients).ok()?, matrix, self.calibration.size_px()).ok()
    }

    /// Root mean square distance of a view's points, px.
    #[must_use]
    pub fn view_rms_px(&self, view: usize) -> f64 {
        let residuals = &self.residuals_px[view];
        (residuals.iter().map(|r| r.length_squared()).sum::<f64>() / residuals.len() as f64).sqrt()
    }

    /// Root mean square distance of all points, px.
    #[must_use]
    pub fn rms_px(&self) -> f64 {
        let count: usize = self.residuals_px.iter().map(Vec::len).sum();
        let squares: f64 = self.residuals_px.iter().flatten().map(|r| r.length_squared()).sum();
        (squares / count as f64).sqrt()
    }
}

/// Relative standard uncertainty above which a focal length counts as undetermined.
const FOCAL_LIMIT: f64 = 0.05;

pub(super) fn result(problem: &CalibrationProblem<'_>, fit: Fit) -> Result<CalibrationResult, CalibrateError> {
    let names = problem.names();
    let widening = if problem.options.robust { problem.widening(&fit) } else { 1.0 };
    let all = shared::covariance(problem, &fit);
    let mut covariance = Matrix::zeros(names.len(), names.len());
    for i in 0..names.len() {
        for j in 0..names.len() {
            *covariance.at_mut(i, j) = widening * all.at(i, j);
        }
    }
    let parameter = |(i, name): (usize, &&'static str)| Parameter {
        name,
        estimate: Estimate::new(fit.parameters[i], covariance.at(i, i).sqrt()),
    };
    let parameters: Vec<Parameter> = names.iter().enumerate().map(parameter).collect();
    let unknown: Vec<String> = parameters.iter().filter(|p| is_unknown(p)).map(|p| p.name.to_owned()).collect();
    if !unknown.is_empty() {
        return Err(CalibrateError::Undetermined { names: unknown });
    }
    let placed = problem.state(&fit.parameters).ok_or(CalibrateError::Start)?;
    let off = |v: usize, p: usize| {
        let image = placed.calibration.project(placed.poses[v].camera(problem.views[v].points[p].chart));
        image.map(|image| image - problem.corrected_position(v, p))
    };
    let independent = |i: usize| (widening * fit.covariance.at(i, i)).sqrt();
    let residuals_px: Option<Vec<Vec<DVec2>>> =
        (0..problem.views.len()).map(|v| (0..problem.views[v].points.len()).map(|p| off(v, p)).collect()).collect();
    Ok(CalibrationResult {
        calibration: placed.calibration,
        parameters,
        covariance,
        independent_uncertainties: (0..names.len()).map(independent).collect(),
        poses: placed.poses,
        residuals_px: residuals_px.ok_or(CalibrateError::Start)?,
        sigma_px: fit.sigma,
        degrees_of_freedom: fit.degrees_of_freedom,
        family: problem.family,
    })
}

fn is_unknown(p: &Parameter) -> bool {
    let Estimate { value, standard_uncertainty } = p.estimate;
    let focal = p.name == "fx_px" || p.name == "fy_px";
    !standard_uncertainty.is_finite() || (focal && standard_uncertainty > FOCAL_LIMIT * value)
}
