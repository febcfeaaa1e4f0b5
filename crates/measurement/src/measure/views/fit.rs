//! A camera fitted to its views.

use super::found::Found;
use super::request::ViewsRequest;
use super::{advice, assumed};
use crate::measure::chart_points::{Seen, WithoutChart, all};
use etendue_core::maths::f64::ln;
use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::calibrate::{CalibrateError, CameraModel, Options, Sightings, calibrate_rejecting_outliers};
use glam::DVec2;
use std::fmt::Display;
use std::path::Path;

/// An error by its picture.
fn of_files(error: &CalibrateError, views: &[Seen]) -> String {
    match error {
        CalibrateError::View { view, .. } | CalibrateError::Sparse { view, .. } => {
            format!("{}: {error}", views[*view].file.display())
        }
        _ => error.to_string(),
    }
}

impl ViewsRequest {
    pub(crate) fn found(&self, options: Options, observer: &dyn Observer) -> Result<Found, Error> {
        self.found_by(|_| options, observer)
    }

    /// The same with the principal point in the picture's middle, which is uncertain.
    pub(crate) fn found_about_middle(&self, options: Options, observer: &dyn Observer) -> Result<Found, Error> {
        let middle = |[width, height]: [usize; 2]| 0.5 * DVec2::new(width as f64, height as f64);
        let about = |size| Options { principal_px: Some(middle(size)), ..options };
        let mut found = self.found_by(about, observer)?;
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> = found.views.iter().map(|v| Sightings::of_grid(&v.grid, pitch_mm)).collect();
        let size = found.camera.calibration.size_px();
        assumed::widen(&mut found, &sightings, self.model.family(), about(size))?;
        let px = assumed::MIDDLE * size[0].max(size[1]) as f64;
        found.notes.push(format!(
            "one picture: the principal point is taken for the picture's middle, ± {px:.1} px in each direction, and the lens for one of this \
             model or nearly so, which is in the ±; pixels are taken for square, which is in no ±"
        ));
        Ok(found)
    }

    /// By options that may follow from the picture's size.
    fn found_by(&self, options: impl Fn([usize; 2]) -> Options, observer: &dyn Observer) -> Result<Found, Error> {
        let seen = all(&self.chart, &self.files, observer)?;
        let options = options(seen.0[0].size_px);
        let found = self.fitted(self.model, &seen.0, &seen.1, options)?;
        self.advised(self.model, found, options)
    }

    /// By the model of several that suits the points best: the least of ln(Σ r²/n) + 2 k ln n/n, n coordinates and k coefficients: the criterion of Schwarz
    /// (1978) with twice its price of a coefficient, as errors that neighbouring points share are fewer than there are points.
    pub(crate) fn found_by_best_of(
        &self,
        models: &[CameraModel],
        options: Options,
        observer: &dyn Observer,
    ) -> Result<(Found, Vec<TriedModel>), Error> {
        let seen = all(&self.chart, &self.files, observer)?;
        let (mut best, mut tried, mut first_error): (Option<(f64, CameraModel, Found)>, Vec<TriedModel>, _) =
            (None, Vec::new(), None);
        for model in models {
            let found = match self.fitted(*model, &seen.0, &seen.1, options) {
                Ok(found) => found,
                Err(error) => {
                    first_error.get_or_insert(error);
                    continue;
                }
            };
            let residuals = found.camera.residuals_px.iter().flatten();
            let (count, squares) = residuals.fold((0.0, 0.0), |(n, s), r| (n + 2.0, s + r.length_squared()));
            let coefficients = found.camera.parameters.len() as f64;
            let information = ln(squares / count) + 2.0 * coefficients * ln(count) / count;
            // One that folds the picture over is no camera.
            let whole = found.camera.calibration.check().is_ok();
            tried.push(TriedModel { model: *model, rms_px: found.camera.rms_px(), information, whole });
            if whole && best.as_ref().is_none_or(|(least, ..)| information < *least) {
                best = Some((information, *model, found));
            }
        }
        match (best, first_error) {
            (Some((_, model, found)), _) => Ok((self.advised(model, found, options)?, tried)),
            (None, Some(error)) => Err(error),
            (None, None) => Err(Error::coded(
                ErrorCode::NotMeasurable,
                "every camera model folds the picture over: add views that fill it",
            )),
        }
    }

    fn fitted(
        &self,
        model: CameraModel,
        views: &[Seen],
        without: &[WithoutChart],
        options: Options,
    ) -> Result<Found, Error> {
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> = views.iter().map(|v| Sightings::of_grid(&v.grid, pitch_mm)).collect();
        let size = views[0].size_px;
        let spared = calibrate_rejecting_outliers(&sightings, size, model.family(), options);
        let spared = spared.map_err(|error| Error::coded(ErrorCode::NotMeasurable, of_files(&error, views)))?;
        let left_out = |file: &Path, why: &dyn Display| format!("warning: {}: left out: {why}", file.display());
        let mut notes: Vec<String> = without.iter().map(|(file, why)| left_out(file, why)).collect();
        notes.extend(spared.left_out.iter().map(|(v, why)| left_out(&views[*v].file, why)));
        let views: Vec<Seen> = spared.kept.iter().map(|v| views[*v].clone()).collect();
        Ok(Found { model: model.name().to_owned(), views, camera: spared.camera, notes })
    }

    /// The same with a warning where another model would suit the points far better.
    fn advised(&self, model: CameraModel, mut found: Found, options: Options) -> Result<Found, Error> {
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> = found.views.iter().map(|v| Sightings::of_grid(&v.grid, pitch_mm)).collect();
        let sightings: Vec<&Sightings> = sightings.iter().collect();
        found.notes.extend(advice::unsuited(model, &found.camera, &found.views, &sightings, options));
        Ok(found)
    }
}

/// A model that was fitted.
pub(crate) struct TriedModel {
    pub(crate) model: CameraModel,
    pub(crate) rms_px: f64,
    /// Schwarz's criterion over the number of coordinates: less is better.
    pub(crate) information: f64,
    /// Whether it does not fold the picture over.
    pub(crate) whole: bool,
}
