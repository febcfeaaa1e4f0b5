//! Cameras from views of which some do not belong: a chart numbered wrongly, another chart, a picture of another camera.
//!
//! Where the fit of all views does not settle, or one view lies far off beside the others, the camera is found without each view in
//! turn, and the one without which the rest fits best is left out. What is left must be three views at least, and two thirds of all.

use super::{CalibrateError, Calibrated, Family, Options, Sightings, calibrate};

/// A camera, and the views that are not in it.
#[derive(Clone, Debug)]
pub struct OutlierRejection {
    /// The camera of the other views, its poses and residuals in their order.
    pub camera: Calibrated,
    /// Views in it, from 0.
    pub kept: Vec<usize>,
    /// Views left out, with the reason.
    pub left_out: Vec<(usize, String)>,
}

/// Least of views that make a camera by themselves: as many must be left where others are left out.
pub const MIN_VIEWS: usize = 3;
/// A view this many times farther off than the median of the others is tried without, and left out where that makes the others' distances
/// half as large.
const STRAY: f64 = 5.0;
const GAIN: f64 = 0.5;

/// The camera that saw the views, or most of them.
///
/// # Errors
/// [`CalibrateError`]; [`CalibrateError::View`] where one view is at fault and too few are left without it.
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
                        (v, format!("its points lie {:.1} px from the fit", camera.view_rms_px(v)))
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

/// The view that lies far off beside the others.
fn stray(camera: &Calibrated) -> Option<usize> {
    let rms: Vec<f64> = (0..camera.poses.len()).map(|v| camera.view_rms_px(v)).collect();
    let mut sorted = rms.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[(sorted.len() - 1) / 2];
    let worst = (0..rms.len()).max_by(|a, b| rms[*a].total_cmp(&rms[*b]))?;
    (rms[worst] > STRAY * median).then_some(worst)
}

/// The view without which the others fit best, where a view may be the reason why there is no fit.
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
