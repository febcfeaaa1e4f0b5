//! Fit of a camera to its views: assumptions, suitability of the model, and the result as a camera file.

use std::{fmt::Display, path::Path};

use etendue_core::{maths::f64::ln, observer::Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::calibrate::{
    CalibrateError, CalibrationOptions, CalibrationResult, CameraModel, Family, RadialTerms, Sightings, calibrate,
    calibrate_as_stated, calibrate_rejecting_outliers,
};
use etendue_pipeline::stated_projection;
use etendue_scene::record::{self, Camera, Lens, Sensor};
use etendue_scene::{record::lens::calibrated::PixelDirections, written::File};
use glam::DVec2;

use super::{CalibratedViews, ViewsRequest};
use crate::measure::point_list::{DetectedChart, RejectedImage, all};

/// An error with the name of its image.
fn with_files(error: &CalibrateError, views: &[DetectedChart]) -> String {
    match error {
        CalibrateError::View { view, .. } | CalibrateError::Sparse { view, .. } => {
            format!("{}: {error}", views[*view].file.display())
        }
        _ => error.to_string(),
    }
}

impl ViewsRequest {
    pub(crate) fn calibrate(
        &self,
        options: CalibrationOptions,
        observer: &dyn Observer,
    ) -> Result<CalibratedViews, Error> {
        self.calibrate_with(|_| options, observer)
    }

    /// Fit with the principal point assumed at the image centre; its uncertainty is added to the covariance.
    pub(crate) fn calibrate_centred(
        &self,
        options: CalibrationOptions,
        observer: &dyn Observer,
    ) -> Result<CalibratedViews, Error> {
        let middle = |[width, height]: [usize; 2]| 0.5 * DVec2::new(width as f64, height as f64);
        let centred_options = |size| CalibrationOptions { principal_px: Some(middle(size)), ..options };
        let mut calibrated = self.calibrate_with(centred_options, observer)?;
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> =
            calibrated.views.iter().map(|v| Sightings::from_grid(&v.grid, pitch_mm)).collect();
        let size = calibrated.camera.calibration.size_px();
        widen(&mut calibrated, &sightings, self.model.family(), centred_options(size))?;
        let px = PRINCIPAL_UNCERTAINTY * size[0].max(size[1]) as f64;
        calibrated.notes.push(format!(
            "single image: the principal point is assumed at the image centre, ± {px:.1} px in each direction, and the lens to \
             follow this model approximately, both included in the ±; pixels are assumed square, which is not included in the ±"
        ));
        Ok(calibrated)
    }

    /// Fit with options that may depend on the image size.
    fn calibrate_with(
        &self,
        options: impl Fn([usize; 2]) -> CalibrationOptions,
        observer: &dyn Observer,
    ) -> Result<CalibratedViews, Error> {
        let detected = all(&self.chart, &self.files, observer)?;
        let options = options(detected.0[0].size_px);
        let calibrated = self.fitted(self.model, &detected.0, &detected.1, options)?;
        self.advised(self.model, calibrated, options)
    }

    /// Fit with the best of several models: minimum of ln(Σ r²/n) + 2 k ln n/n, with n coordinates and k coefficients. This is the
    /// criterion of Schwarz (1978) with twice its penalty per coefficient, as neighbouring points share errors, so that there are
    /// fewer independent errors than points.
    pub(crate) fn calibrate_best_of(
        &self,
        models: &[CameraModel],
        options: CalibrationOptions,
        observer: &dyn Observer,
    ) -> Result<(CalibratedViews, Vec<CandidateModel>), Error> {
        let detected = all(&self.chart, &self.files, observer)?;
        let (mut best, mut candidates, mut first_error): (
            Option<(f64, CameraModel, CalibratedViews)>,
            Vec<CandidateModel>,
            _,
        ) = (None, Vec::new(), None);
        for model in models {
            let calibrated = match self.fitted(*model, &detected.0, &detected.1, options) {
                Ok(calibrated) => calibrated,
                Err(error) => {
                    first_error.get_or_insert(error);
                    continue;
                }
            };
            let residuals = calibrated.camera.residuals_px.iter().flatten();
            let (count, squares) = residuals.fold((0.0, 0.0), |(n, s), r| (n + 2.0, s + r.length_squared()));
            let coefficients = calibrated.camera.parameters.len() as f64;
            let information = ln(squares / count) + 2.0 * coefficients * ln(count) / count;
            // A model that folds the image over is not a valid camera.
            let is_valid = calibrated.camera.calibration.check().is_ok();
            candidates.push(CandidateModel {
                model: *model,
                rms_px: calibrated.camera.rms_px(),
                information,
                is_valid,
            });
            if is_valid && best.as_ref().is_none_or(|(min_information, ..)| information < *min_information) {
                best = Some((information, *model, calibrated));
            }
        }
        match (best, first_error) {
            (Some((_, model, calibrated)), _) => Ok((self.advised(model, calibrated, options)?, candidates)),
            (None, Some(error)) => Err(error),
            (None, None) => Err(Error::coded(
                ErrorCode::NotMeasurable,
                "every camera model folds the image over; add views that fill it",
            )),
        }
    }

    fn fitted(
        &self,
        model: CameraModel,
        views: &[DetectedChart],
        without: &[RejectedImage],
        options: CalibrationOptions,
    ) -> Result<CalibratedViews, Error> {
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> = views.iter().map(|v| Sightings::from_grid(&v.grid, pitch_mm)).collect();
        let size = views[0].size_px;
        let robust = calibrate_rejecting_outliers(&sightings, size, model.family(), options);
        let robust = robust.map_err(|error| Error::coded(ErrorCode::NotMeasurable, with_files(&error, views)))?;
        let left_out = |file: &Path, reason: &dyn Display| format!("warning: {}: omitted: {reason}", file.display());
        let mut notes: Vec<String> = without.iter().map(|(file, reason)| left_out(file, reason)).collect();
        notes.extend(robust.rejected.iter().map(|(v, reason)| left_out(&views[*v].file, reason)));
        let views: Vec<DetectedChart> = robust.accepted.iter().map(|v| views[*v].clone()).collect();
        Ok(CalibratedViews { model: model.name().to_owned(), views, camera: robust.camera, notes })
    }

    /// Adds a warning if the model does not describe the points.
    fn advised(
        &self,
        model: CameraModel,
        mut calibrated: CalibratedViews,
        options: CalibrationOptions,
    ) -> Result<CalibratedViews, Error> {
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> =
            calibrated.views.iter().map(|v| Sightings::from_grid(&v.grid, pitch_mm)).collect();
        let sightings: Vec<&Sightings> = sightings.iter().collect();
        calibrated.notes.extend(model_warning(model, &calibrated.camera, &calibrated.views, &sightings, options));
        Ok(calibrated)
    }
}

/// A fitted model.
pub(crate) struct CandidateModel {
    pub(crate) model: CameraModel,
    pub(crate) rms_px: f64,
    /// Schwarz's criterion over the number of coordinates: less is better.
    pub(crate) information: f64,
    /// True if the model does not fold the image over.
    pub(crate) is_valid: bool,
}

/// Standard uncertainty of a principal point at the image centre, relative to the wider side.
pub(crate) const PRINCIPAL_UNCERTAINTY: f64 = 0.01;

/// Adds two uncertainties to the covariance of a camera: that of the assumed principal point, and that of distortion beyond the model.
///
/// For the first, the camera is fitted with the principal point moved by ± one standard uncertainty along each axis. Half the
/// difference of the two fits is the linear change; their mean less the original fit is the quadratic change, which counts three
/// times (the mean of z⁴ of a standard normal z is 3). The second applies to the focal length: its change in a fit with more radial
/// terms, less the variance that these terms add.
fn widen(
    calibrated: &mut CalibratedViews,
    sightings: &[Sightings],
    family: Family,
    options: CalibrationOptions,
) -> Result<(), Error> {
    let size = calibrated.camera.calibration.size_px();
    let values = |camera: &CalibrationResult| camera.parameters.iter().map(|p| p.estimate.value).collect::<Vec<f64>>();
    let base_values = values(&calibrated.camera);
    let fitted = |family, options| {
        calibrate_as_stated(sightings, size, family, options)
            .map_err(|error| Error::coded(ErrorCode::NotMeasurable, error.to_string()))
    };
    let Some(principal) = options.principal_px else { return Ok(()) };
    let focal = |camera: &CalibrationResult| camera.estimate("fx_px");
    let now = focal(&calibrated.camera);
    let wider = size[0].max(size[1]) as f64;
    for step in [DVec2::X, DVec2::Y].map(|axis| PRINCIPAL_UNCERTAINTY * wider * axis) {
        let moved = |by: DVec2| -> Result<Vec<f64>, Error> {
            Ok(values(&fitted(family, CalibrationOptions { principal_px: Some(principal + by), ..options })?))
        };
        let (more, less) = (moved(step)?, moved(-step)?);
        add(calibrated, 1.0, |i| 0.5 * (more[i] - less[i]));
        add(calibrated, 3.0, |i| 0.5 * (more[i] + less[i]) - base_values[i]);
    }
    let Some(family) = richer(family) else { return Ok(()) };
    if let (Some(now), Ok(other)) = (now, fitted(family, options))
        && let Some(other_focal) = focal(&other)
    {
        let (u, v) = (now.standard_uncertainty, other_focal.standard_uncertainty);
        let off = other_focal.value - now.value;
        let added_uncertainty = (off * off - (v * v - u * u).max(0.0)).max(0.0).sqrt();
        add(calibrated, 1.0, |i| if i == 0 { added_uncertainty } else { 0.0 });
    }
    Ok(())
}

/// A model family with more radial terms; `None` if there is none.
fn richer(family: Family) -> Option<Family> {
    match family {
        Family::Perspective { radial: RadialTerms::Polynomial(n), tangential } if n < 3 => {
            Some(Family::Perspective { radial: RadialTerms::Polynomial(n + 1), tangential })
        }
        Family::Polynomial(_) => Some(Family::Perspective { radial: RadialTerms::Polynomial(3), tangential: false }),
        _ => None,
    }
}

/// Adds weight · d dᵀ to the covariance.
fn add(calibrated: &mut CalibratedViews, weight: f64, d: impl Fn(usize) -> f64) {
    let count = calibrated.camera.parameters.len();
    for i in 0..count {
        for j in 0..count {
            *calibrated.camera.covariance.at_mut(i, j) += weight * d(i) * d(j);
        }
    }
    for i in 0..count {
        calibrated.camera.parameters[i].estimate.standard_uncertainty = calibrated.camera.covariance.at(i, i).sqrt();
    }
}

impl CalibratedViews {
    /// A camera file, generated by a verb; the f-number cannot be determined from these images.
    ///
    /// # Errors
    /// If the camera folds over inside its image.
    pub(crate) fn camera_file(&self, verb: &str, pixel_pitch_um: f64, f_number: Option<f64>) -> Result<String, Error> {
        let refused = |folds| {
            Error::coded(ErrorCode::UnusableLens, format!("no camera file can be written, only figures: {folds}"))
        };
        self.camera.calibration.check().map_err(refused)?;
        let [width, height] = self.camera.calibration.size_px().map(|n| n as u64);
        let view = PixelDirections::Projection(Box::new(stated_projection(&self.camera.calibration)));
        let lens = Lens::Calibrated(Box::new(record::lens::CalibratedLens::new(view, f_number.unwrap_or(4.0))));
        let camera = Camera::new(lens, Sensor::new(width, height, pixel_pitch_um));
        let count = self.views.len();
        let views = if count == 1 { "view" } else { "views" };
        let rms_px = self.camera.rms_px();
        let comment =
            format!("Measured by etendue {verb} from {count} {views}; points lie {rms_px:.4} px (rms) from the fit.");
        let file = File::new(camera.to_table()).head(comment);
        Ok(match f_number {
            Some(_) => file,
            None => file.beside("lens.f_number", "a placeholder: not measured"),
        }
        .to_string())
    }
}

/// Minimum residual, as a multiple of the uncertainty of the points, from which other models are tried.
const MIN_RESIDUAL_RATIO: f64 = 5.0;
/// Minimum residual from which other models are tried, px.
const MIN_RESIDUAL_PX: f64 = 0.05;
/// Maximum residual of another model, as a fraction of that of the fitted model, at which the other model is suggested.
const MAX_REMAINING_FRACTION: f64 = 0.5;
/// Multiple of both minimum residuals above which a warning is given although no other model fits better.
const CLEAR_FACTOR: f64 = 4.0;
/// Candidate models.
const CANDIDATES: [CameraModel; 5] = [
    CameraModel::Opencv,
    CameraModel::KannalaBrandt,
    CameraModel::RadialInverse,
    CameraModel::ExtendedUnified,
    CameraModel::Opencv5,
];

/// A warning if the residuals are far larger than the points' own uncertainties.
fn model_warning(
    model: CameraModel,
    camera: &CalibrationResult,
    views: &[DetectedChart],
    sightings: &[&Sightings],
    options: CalibrationOptions,
) -> Option<String> {
    let nodes = || views.iter().flat_map(|v| &v.grid.nodes);
    let squares: f64 = nodes().map(|n| n.uncertainty_px * n.uncertainty_px).sum();
    let own = (squares / nodes().count() as f64).sqrt();
    let left = camera.sigma_px;
    if left < MIN_RESIDUAL_PX || left < MIN_RESIDUAL_RATIO * own {
        return None;
    }
    let sightings: Vec<Sightings> = sightings.iter().map(|s| (*s).clone()).collect();
    let size = camera.calibration.size_px();
    let fitted =
        |other: CameraModel| Some((other, calibrate(&sightings, size, other.family(), options).ok()?.sigma_px));
    let others = CANDIDATES.into_iter().filter(|other| *other != model).filter_map(fitted);
    let better = others.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, sigma)| *sigma < MAX_REMAINING_FRACTION * left);
    let times = if own > 0.0 { format!(", {:.0} times their own uncertainty", left / own) } else { String::new() };
    let distance_text = format!("the points lie {left:.3} px from the fit (standard deviation of a coordinate){times}");
    let named = model.name();
    match better {
        Some((other, sigma)) => {
            let other = other.name();
            Some(format!(
                "warning: {distance_text}: the model {named} does not describe this camera; {other} leaves {sigma:.3} px"
            ))
        }
        None if own > 0.0 && left > CLEAR_FACTOR * MIN_RESIDUAL_PX.max(MIN_RESIDUAL_RATIO * own) => Some(format!(
            "warning: {distance_text}: the model {named} does not describe this camera, or the chart is not flat; uncertainties are too small"
        )),
        None => None,
    }
}
