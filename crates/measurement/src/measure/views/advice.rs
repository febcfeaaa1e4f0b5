//! Whether the model suits the points, and which would suit them better.

use crate::measure::chart_points::Seen;
use etendue_metrology::calibrate::{Calibrated, CameraModel, Options, Sightings, calibrate};

/// A fit that leaves this many times the points' own uncertainty, and this much, is looked into.
const TIMES: f64 = 5.0;
const MIN_PX: f64 = 0.05;
/// It is told where another model leaves less than this share of it, or where it is as many times the uncertainty, and as much, again.
const SHARE: f64 = 0.5;
const SURELY: f64 = 4.0;
/// Models that are tried.
const OTHERS: [CameraModel; 5] = [
    CameraModel::Opencv,
    CameraModel::KannalaBrandt,
    CameraModel::RadialInverse,
    CameraModel::ExtendedUnified,
    CameraModel::Opencv5,
];

/// A warning where the fit leaves far more than the points' own uncertainties.
pub(crate) fn unsuited(
    model: CameraModel,
    camera: &Calibrated,
    views: &[Seen],
    sightings: &[&Sightings],
    options: Options,
) -> Option<String> {
    let nodes = || views.iter().flat_map(|v| &v.grid.nodes);
    let squares: f64 = nodes().map(|n| n.uncertainty_px * n.uncertainty_px).sum();
    let own = (squares / nodes().count() as f64).sqrt();
    let left = camera.sigma_px;
    if left < MIN_PX || left < TIMES * own {
        return None;
    }
    let sightings: Vec<Sightings> = sightings.iter().map(|s| (*s).clone()).collect();
    let size = camera.calibration.size_px();
    let fitted =
        |other: CameraModel| Some((other, calibrate(&sightings, size, other.family(), options).ok()?.sigma_px));
    let others = OTHERS.into_iter().filter(|other| *other != model).filter_map(fitted);
    let better = others.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, sigma)| *sigma < SHARE * left);
    let times = if own > 0.0 { format!(", {:.0} times their own uncertainty", left / own) } else { String::new() };
    let than = format!("the points lie {left:.3} px from the fit (standard deviation of a coordinate){times}");
    let named = model.name();
    match better {
        Some((other, sigma)) => {
            let other = other.name();
            Some(format!(
                "warning: {than}: the model {named} does not describe this camera; {other} leaves {sigma:.3} px"
            ))
        }
        None if own > 0.0 && left > SURELY * MIN_PX.max(TIMES * own) => Some(format!(
            "warning: {than}: the model {named} does not describe this camera, or the chart is not flat; uncertainties are too small"
        )),
        None => None,
    }
}
