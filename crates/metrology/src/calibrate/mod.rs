//! Cameras from views of a plane chart whose points are known.
//!
//! Unknown are the camera matrix (fx, fy, cx, cy; no skew), the coefficients of a model of the projection crate
//! ([`Family`]), and of each view where the chart stands (turn as a vector, place). Steps:
//!
//! 1. For some focal lengths, each view's points become directions by the model's first guess, and the homography from the
//!    chart to these directions gives the chart's pose; the focal length whose poses throw the points nearest to where
//!    they are seen is taken (`problem.rs`). That is Zhang's (2000) condition, that the homography's first two columns are
//!    orthonormal, searched instead of solved: it holds for wide fields and strong distortion as well.
//! 2. All numbers together by Levenberg and Marquardt: least squares of the distances in the picture (`problem.rs`).
//! 3. Of discs: the shift of each centroid ([`disc`](crate::patch_statistics)) by the camera just found is taken off, and 2 repeated
//!    until it stays.
//!
//! Lengths of charts, poses and distances are in one unit of the caller's. Uncertainty: the covariance of 2, from the
//! residuals (degrees of freedom: coordinates less numbers). A stated distance is one observation with its own uncertainty, 0
//! being exact, beside the points; a distance that is not what the views show is refused. What the views do not
//! determine, such as the focal length of one view from the front, is refused ([`CalibrateError::Undetermined`]).
//!
//! Robust weights are off unless asked for ([`Options::robust`]): then, after 2, a point whose distance d is beyond 2.5 σ
//! (σ from the median) counts with √(2.5 σ/d) (Huber 1964), and 2 is repeated five times; the covariance is widened by what
//! these weights take from it (Huber 1981).
//!
//! Left out: skew, charts that are not flat or not known, several cameras.

mod outlier_rejection;
mod pose;
mod problem;
mod result;
mod shared;
mod sightings;

use crate::Estimate;
use crate::fit::{Fit, fit};
use problem::Bundle;

pub use etendue_projection::model::{CameraModel, Family, Radial};

pub use outlier_rejection::{MIN_VIEWS, OutlierRejection, calibrate_rejecting_outliers};
pub use pose::Pose;
pub use result::{Calibrated, Parameter};
pub use sightings::{CalibrateError, Options, Sighting, Sightings};

/// Least of points of a view.
const MIN_POINTS: usize = 6;

/// The camera of a picture size that saw the views.
///
/// # Errors
/// [`CalibrateError`].
pub fn calibrate(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: Options,
) -> Result<Calibrated, CalibrateError> {
    let found = calibrate_as_stated(views, size_px, family, options)?;
    if let Some(stated) = options.distance {
        // What cannot be told without the distance does not speak against it.
        if let Ok(free) = solved(views, size_px, family, Options { distance: None, ..options }) {
            contradiction(stated, &free).map_or(Ok(()), Err)?;
        }
    }
    Ok(found)
}

/// The same, believing a stated distance whatever the views show by themselves.
///
/// # Errors
/// [`CalibrateError`], but for a distance that the views contradict.
pub fn calibrate_as_stated(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: Options,
) -> Result<Calibrated, CalibrateError> {
    if let Some(view) = views.iter().position(|v| v.points.len() < MIN_POINTS) {
        return Err(CalibrateError::Sparse { view, points: views[view].points.len(), least: MIN_POINTS });
    }
    if views.is_empty() {
        return Err(CalibrateError::NoViews);
    }
    solved(views, size_px, family, options)
}

fn solved(
    views: &[Sightings],
    size_px: [usize; 2],
    family: Family,
    options: Options,
) -> Result<Calibrated, CalibrateError> {
    let mut bundle = Bundle::new(views, size_px, family, options);
    let start = problem::guess(&bundle).ok_or(CalibrateError::Start)?;
    let mut found = fit(&bundle, &start)?;
    // The weight of the distance follows from what the points leave.
    for _ in 0..options.distance.map_or(0, |_| 2) {
        bundle.weigh_distance(&found);
        found = fit(&bundle, &found.parameters)?;
    }
    if options.robust {
        for _ in 0..5 {
            bundle.reweigh(&found);
            found = fit(&bundle, &found.parameters)?;
        }
    }
    found = without_shifts(&mut bundle, found)?;
    result::result(&bundle, found)
}

/// Where the distance that the views show by themselves is off the stated one by more than three standard uncertainties of the
/// difference.
fn contradiction(stated: Estimate, free: &Calibrated) -> Option<CalibrateError> {
    const LIMIT: f64 = 3.0;
    // The distance is known as well as the focal length, in proportion.
    let focal = free.estimate("fx_px")?;
    let distance = free.poses[0].distance();
    let shown = Estimate::new(distance, distance * focal.standard_uncertainty / focal.value);
    let variance = |e: Estimate| e.standard_uncertainty * e.standard_uncertainty;
    let joint = (variance(stated) + variance(shown)).sqrt();
    ((shown.value - stated.value).abs() > LIMIT * joint).then_some(CalibrateError::Distance { stated, shown })
}

/// The fit to where the discs' centres are seen.
fn without_shifts(bundle: &mut Bundle<'_>, mut found: Fit) -> Result<Fit, CalibrateError> {
    const ROUNDS: usize = 6;
    const STILL_PX: f64 = 1e-4;
    for _ in 0..ROUNDS {
        let moved = bundle.shift(&found.parameters);
        if moved < STILL_PX {
            break;
        }
        found = fit(bundle, &found.parameters)?;
    }
    Ok(found)
}
