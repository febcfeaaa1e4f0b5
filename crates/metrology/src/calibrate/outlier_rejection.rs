//! Calibration with rejection of wrong views: wrongly numbered charts, another chart, an image of another camera.
//!
//! If the fit of all views does not converge, or one view has far larger residuals than the others, the camera is fitted without
//! each view in turn, and the view whose omission gives the best fit is left out. At least three views, and two thirds of all,
//! must remain.

use super::{CalibrateError, Calibrated, Family, Options, Sightings, calibrate};

/// A camera, and the rejected views.
#[derive(Clone, Debug)]
pub struct OutlierRejection {
    /// The camera from the accepted views, with their poses and residuals in order.
    pub camera: Calibrated,
    /// Accepted views, from 0.
    pub kept: Vec<usize>,
    /// Rejected views, with the reason.
    pub left_out: Vec<(usize, String)>,
}

/// Minimum number of views for a calibration; as many must remain after rejection.
pub const MIN_VIEWS: usize = 3;
/// Ratio of a view's residual to the median of the others above which the fit is tried without it; the view is rejected if that
/// halves the others' residuals.
const STRAY: f64 = 5.0;
const GAIN: f64 = 0.5;

/// Calibrates the camera from all views, or most of them.
///
/// # Errors
/// [`CalibrateError`]; [`CalibrateError::View`] if one view causes the failure and too few remain without it.
pub fn calibrate_rejecting_outliers(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: Options,
) -> Result<OutlierRejection, CalibrateError> {
    let of = |kept: &[usize]| {
        let kept: Vec<Sightings> = kept.iter().map(|v| views[*v].clone()).collect();
        calibrate(&kept, size_px, family, options)
    };
    let mut kept: Vec<usize> = (0..views.len()).collect();
    let mut left_out = Vec::new();
    loop {
        let may = kept.len() > MIN_VIEWS && 3 * (kept.len() - 1) >= 2 * views.len();
        let (next, reason) = match of(&kept) {
            Ok(camera) => match stray(&camera).filter(|_| may) {
                Some(v) => match of(&without(&kept, v)) {
                    Ok(better) if better.rms_px() < GAIN * camera.rms_px() => {
                        (v, format!("its points are {:.1} px from the fit", camera.view_rms_px(v)))
                    }
                    _ => return Ok(OutlierRejection { camera, kept, left_out }),
                },
                None => return Ok(OutlierRejection { camera, kept, left_out }),
            },
            Err(error) => match culprit(&kept, &error, &of) {
                Some(v) if may => (v, error.to_string()),
                Some(v) => {
                    return Err(match error {
                        CalibrateError::Sparse { points, least, .. } => {
                            CalibrateError::Sparse { view: kept[v], points, least }
                        }
                        cause => CalibrateError::View { view: kept[v], cause: Box::new(cause) },
                    });
                }
                None => return Err(error),
            },
        };
        left_out.push((kept[next], reason));
        kept.remove(next);
    }
}

fn without(kept: &[usize], v: usize) -> Vec<usize> {
    kept.iter().enumerate().filter(|(i, _)| *i != v).map(|(_, view)| *view).collect()
}

/// The view with far larger residuals than the others.
fn stray(camera: &Calibrated) -> Option<usize> {
    let rms: Vec<f64> = (0..camera.poses.len()).map(|v| camera.view_rms_px(v)).collect();
    let mut sorted = rms.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[(sorted.len() - 1) / 2];
    let worst = (0..rms.len()).max_by(|a, b| rms[*a].total_cmp(&rms[*b]))?;
    (rms[worst] > STRAY * median).then_some(worst)
}

/// The view without which the others fit best, if a single view may prevent the fit.
fn culprit(
    kept: &[usize],
    error: &CalibrateError,
    of: &impl Fn(&[usize]) -> Result<Calibrated, CalibrateError>,
) -> Option<usize> {
    let of_a_view = matches!(
        error,
        CalibrateError::Fit(_) | CalibrateError::Start | CalibrateError::Model(_) | CalibrateError::Undetermined { .. }
    );
    if let CalibrateError::Sparse { view, .. } = error {
        return Some(*view);
    }
    if !of_a_view || kept.len() < 2 {
        return None;
    }
    let rest = (0..kept.len()).filter_map(|v| Some((v, of(&without(kept, v)).ok()?.rms_px())));
    rest.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(v, _)| v)
}
