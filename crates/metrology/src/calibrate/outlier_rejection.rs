//! Calibration with rejection of wrong views: wrongly numbered charts, another chart, an image of another camera.
//!
//! If the fit of all views does not converge, or one view has far larger residuals than the others, the camera is fitted without
//! each view in turn, and the view whose omission gives the best fit is left out. At least three views, and two thirds of all,
//! must remain.

use super::{CalibrateError, CalibrationOptions, CalibrationResult, Family, Sightings, calibrate};

/// A camera, and the rejected views.
#[derive(Clone, Debug)]
pub struct OutlierRejection {
    /// The camera from the accepted views, with their poses and residuals in order.
    pub camera: CalibrationResult,
    /// Accepted views, from 0.
    pub accepted: Vec<usize>,
    /// Rejected views, with the reason.
    pub rejected: Vec<(usize, String)>,
}

/// Minimum number of views for a calibration; as many must remain after rejection.
pub const MIN_VIEWS: usize = 3;
/// Ratio of a view's residual to the median of the others above which the fit is tried without it; the view is rejected if that
/// halves the others' residuals.
const OUTLIER_RATIO: f64 = 5.0;
const MIN_IMPROVEMENT: f64 = 0.5;

/// Calibrates the camera from all views, or most of them.
///
/// # Errors
/// [`CalibrateError`]; [`CalibrateError::View`] if one view causes the failure and too few remain without it.
pub fn calibrate_rejecting_outliers(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: CalibrationOptions,
) -> Result<OutlierRejection, CalibrateError> {
    let calibrate_subset = |subset: &[usize]| {
        let subset: Vec<Sightings> = subset.iter().map(|v| views[*v].clone()).collect();
        calibrate(&subset, size_px, family, options)
    };
    let mut accepted: Vec<usize> = (0..views.len()).collect();
    let mut left_out = Vec::new();
    loop {
        let may = accepted.len() > MIN_VIEWS && 3 * (accepted.len() - 1) >= 2 * views.len();
        let (next, reason) = match calibrate_subset(&accepted) {
            Ok(camera) => match outlier_view(&camera).filter(|_| may) {
                Some(v) => match calibrate_subset(&without(&accepted, v)) {
                    Ok(better) if better.rms_px() < MIN_IMPROVEMENT * camera.rms_px() => {
                        (v, format!("its points are {:.1} px from the fit", camera.view_rms_px(v)))
                    }
                    _ => return Ok(OutlierRejection { camera, accepted, rejected: left_out }),
                },
                None => return Ok(OutlierRejection { camera, accepted, rejected: left_out }),
            },
            Err(error) => match worst_view(&accepted, &error, &calibrate_subset) {
                Some(v) if may => (v, error.to_string()),
                Some(v) => {
                    return Err(match error {
                        CalibrateError::Sparse { points, least: min_points, .. } => {
                            CalibrateError::Sparse { view: accepted[v], points, least: min_points }
                        }
                        cause => CalibrateError::View { view: accepted[v], cause: Box::new(cause) },
                    });
                }
                None => return Err(error),
            },
        };
        left_out.push((accepted[next], reason));
        accepted.remove(next);
    }
}

fn without(remaining: &[usize], v: usize) -> Vec<usize> {
    remaining.iter().enumerate().filter(|(i, _)| *i != v).map(|(_, view)| *view).collect()
}

/// The view with far larger residuals than the others.
fn outlier_view(camera: &CalibrationResult) -> Option<usize> {
    let rms: Vec<f64> = (0..camera.poses.len()).map(|v| camera.view_rms_px(v)).collect();
    let mut sorted = rms.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[(sorted.len() - 1) / 2];
    let worst = (0..rms.len()).max_by(|a, b| rms[*a].total_cmp(&rms[*b]))?;
    (rms[worst] > OUTLIER_RATIO * median).then_some(worst)
}

/// The view without which the others fit best, if a single view may prevent the fit.
fn worst_view(
    remaining: &[usize],
    error: &CalibrateError,
    calibrate_subset: &impl Fn(&[usize]) -> Result<CalibrationResult, CalibrateError>,
) -> Option<usize> {
    let concerns_one_view = matches!(
        error,
        CalibrateError::Fit(_) | CalibrateError::Start | CalibrateError::Model(_) | CalibrateError::Undetermined { .. }
    );
    if let CalibrateError::Sparse { view, .. } = error {
        return Some(*view);
    }
    if !concerns_one_view || remaining.len() < 2 {
        return None;
    }
    let rest = (0..remaining.len()).filter_map(|v| Some((v, calibrate_subset(&without(remaining, v)).ok()?.rms_px())));
    rest.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(v, _)| v)
}
