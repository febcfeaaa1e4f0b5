//! What one picture does not tell and is assumed: its share of the uncertainty.

use super::found::Found;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::calibrate::{Calibrated, Family, Options, Radial, Sightings, calibrate_as_stated};
use glam::DVec2;

/// Standard uncertainty of a principal point that is taken for the picture's middle, of its wider side.
pub(crate) const MIDDLE: f64 = 0.01;

/// Takes into a camera's covariance that its principal point is not known, and that its lens may bend beyond its model:
/// of the first half the change from one standard uncertainty more to one less, and what is left of it to second order
/// (z² of a normal z has the mean square 3); of the second the change to a model of one term more, where that is more than the noise
/// which the term lets in.
pub(crate) fn widen(found: &mut Found, sightings: &[Sightings], family: Family, options: Options) -> Result<(), Error> {
    let size = found.camera.calibration.size_px();
    let values = |camera: &Calibrated| camera.parameters.iter().map(|p| p.estimate.value).collect::<Vec<f64>>();
    let here = values(&found.camera);
    let fitted = |family, options| {
        calibrate_as_stated(sightings, size, family, options)
            .map_err(|error| Error::coded(ErrorCode::NotMeasurable, error.to_string()))
    };
    let Some(principal) = options.principal_px else { return Ok(()) };
    let focal = |camera: &Calibrated| camera.estimate("fx_px");
    let now = focal(&found.camera);
    let wider = size[0].max(size[1]) as f64;
    for step in [DVec2::X, DVec2::Y].map(|axis| MIDDLE * wider * axis) {
        let moved = |by: DVec2| -> Result<Vec<f64>, Error> {
            Ok(values(&fitted(family, Options { principal_px: Some(principal + by), ..options })?))
        };
        let (more, less) = (moved(step)?, moved(-step)?);
        add(found, 1.0, |i| 0.5 * (more[i] - less[i]));
        add(found, 3.0, |i| 0.5 * (more[i] + less[i]) - here[i]);
    }
    let Some(family) = richer(family) else { return Ok(()) };
    if let (Some(now), Ok(other)) = (now, fitted(family, options))
        && let Some(then) = focal(&other)
    {
        let (u, v) = (now.standard_uncertainty, then.standard_uncertainty);
        let off = then.value - now.value;
        let beyond = (off * off - (v * v - u * u).max(0.0)).max(0.0).sqrt();
        add(found, 1.0, |i| if i == 0 { beyond } else { 0.0 });
    }
    Ok(())
}

/// The same with a radial term more.
fn richer(family: Family) -> Option<Family> {
    match family {
        Family::Perspective { radial: Radial::Polynomial(n), tangential } if n < 3 => {
            Some(Family::Perspective { radial: Radial::Polynomial(n + 1), tangential })
        }
        Family::Polynomial(_) => Some(Family::Perspective { radial: Radial::Polynomial(3), tangential: false }),
        _ => None,
    }
}

/// Adds weight · d dᵀ to the covariance.
fn add(found: &mut Found, weight: f64, d: impl Fn(usize) -> f64) {
    let count = found.camera.parameters.len();
    for i in 0..count {
        for j in 0..count {
            *found.camera.covariance.at_mut(i, j) += weight * d(i) * d(j);
        }
    }
    for i in 0..count {
        found.camera.parameters[i].estimate.standard_uncertainty = found.camera.covariance.at(i, i).sqrt();
    }
}
