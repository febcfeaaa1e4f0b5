//! Camera calibration from views of a plane chart with known points.
//!
//! Unknown are the camera matrix (fx, fy, cx, cy; no skew), the coefficients of a model of the projection crate ([`Family`]), and
//! for each view the pose of the chart (rotation vector, position). Steps:
//!
//! 1. For several focal lengths, the model's first guess converts each view's points to directions, and the homography from the
//!    chart to these directions gives the chart's pose. The focal length with the smallest reprojection error is used
//!    (`problem.rs`). This is Zhang's (2000) condition, that the homography's first two columns are orthonormal, searched instead
//!    of solved: it also holds for wide fields and strong distortion.
//! 2. All parameters together by Levenberg and Marquardt: least squares of the distances in the image (`problem.rs`).
//! 3. For discs: the shift of each centroid ([`disc`](crate::patch_statistics)) under the current camera is subtracted, and step
//!    2 repeated until the shifts converge.
//!
//! Lengths of charts, poses and distances are in one unit chosen by the caller. Uncertainty: the covariance of step 2, from the
//! residuals (degrees of freedom: coordinates less parameters). A stated distance is one observation with its own uncertainty (0
//! if exact) in addition to the points; a distance that contradicts the views is refused. Parameters that the views do not
//! determine, such as the focal length from one frontal view, are refused ([`CalibrateError::Undetermined`]).
//!
//! Robust weights are off by default ([`CalibrationOptions::robust`]): if on, after step 2 the residual of a point at a distance d beyond
//! 2.5 σ (σ from the median) is multiplied by √(2.5 σ/d) (Huber 1964), and step 2 is repeated five times; the covariance is widened to compensate for
//! these weights (Huber 1981).
//!
//! Limitations: no skew, no charts that are not flat or not known, no multi-camera calibration.

mod outlier_rejection;
mod pose;
mod problem;
mod result;
mod shared;
mod sightings;

use crate::Estimate;
use crate::fit::{Fit, fit};
use problem::CalibrationProblem;

pub use etendue_projection::model::{CameraModel, Family, RadialTerms};

pub use outlier_rejection::{MIN_VIEWS, OutlierRejection, calibrate_rejecting_outliers};
pub use pose::Pose;
pub use result::{CalibrationResult, Parameter};
pub use sightings::{CalibrateError, CalibrationOptions, Sighting, Sightings};

/// Minimum number of points of a view.
const MIN_POINTS: usize = 6;

/// Calibrates the camera of an image size from its views.
///
/// # Errors
/// [`CalibrateError`].
pub fn calibrate(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: CalibrationOptions,
) -> Result<CalibrationResult, CalibrateError> {
    let result = calibrate_as_stated(views, size_px, family, options)?;
    if let Some(stated) = options.distance {
        // If the fit needs the distance, the views cannot contradict it.
        if let Ok(free) = solve(views, size_px, family, CalibrationOptions { distance: None, ..options }) {
            contradiction(stated, &free).map_or(Ok(()), Err)?;
        }
    }
    Ok(result)
}

/// Same as [`calibrate`], but accepts a stated distance that contradicts the views.
///
/// # Errors
/// [`CalibrateError`], except for a distance that contradicts the views.
pub fn calibrate_as_stated(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: CalibrationOptions,
) -> Result<CalibrationResult, CalibrateError> {
    if let Some(view) = views.iter().position(|v| v.points.len() < MIN_POINTS) {
        return Err(CalibrateError::Sparse { view, points: views[view].points.len(), least: MIN_POINTS });
    }
    if views.is_empty() {
        return Err(CalibrateError::NoViews);
    }
    solve(views, size_px, family, options)
}

fn solve(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: CalibrationOptions,
) -> Result<CalibrationResult, CalibrateError> {
    let mut problem = CalibrationProblem::new(views, size_px, family, options);
    let start = problem::guess(&problem).ok_or(CalibrateError::Start)?;
    let mut fitted = fit(&problem, &start)?;
    // The weight of the distance follows from the residuals of the points.
    for _ in 0..options.distance.map_or(0, |_| 2) {
        problem.weigh_distance(&fitted);
        fitted = fit(&problem, &fitted.parameters)?;
    }
    if options.robust {
        for _ in 0..5 {
            problem.reweigh(&fitted);
            fitted = fit(&problem, &fitted.parameters)?;
        }
    }
    fitted = correct_disc_shifts(&mut problem, fitted)?;
    result::result(&problem, fitted)
}

/// Returns an error if the distance from the views alone differs from the stated one by more than three standard uncertainties of
/// the difference.
fn contradiction(stated: Estimate, free: &CalibrationResult) -> Option<CalibrateError> {
    const LIMIT: f64 = 3.0;
    // The relative uncertainty of the distance equals that of the focal length.
    let focal = free.estimate("fx_px")?;
    let distance = free.poses[0].distance();
    let shown = Estimate::new(distance, distance * focal.standard_uncertainty / focal.value);
    let variance = |e: Estimate| e.standard_uncertainty * e.standard_uncertainty;
    let joint_uncertainty = (variance(stated) + variance(shown)).sqrt();
    ((shown.value - stated.value).abs() > LIMIT * joint_uncertainty)
        .then_some(CalibrateError::Distance { stated, shown })
}

/// Repeats the fit with the observed positions of the discs' centres.
fn correct_disc_shifts(problem: &mut CalibrationProblem<'_>, mut fitted: Fit) -> Result<Fit, CalibrateError> {
    const ROUNDS: usize = 6;
    const MIN_CHANGE_PX: f64 = 1e-4;
    for _ in 0..ROUNDS {
        let moved = problem.shift(&fitted.parameters);
        if moved < MIN_CHANGE_PX {
            break;
        }
        fitted = fit(problem, &fitted.parameters)?;
    }
    Ok(fitted)
}
