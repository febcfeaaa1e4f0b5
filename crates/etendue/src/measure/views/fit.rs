//! A camera fitted to its views.

use super::found::Found;
use super::request::ViewsRequest;
use super::{advice, assumed};
use crate::error::Error;
use crate::measure::chart_points::{Seen, all};
use crate::observer::Observer;
use etendue_metrology::calibrate::{CalibrateError, Options, Sightings, calibrate_rejecting_outliers};
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
        let (views, without) = all(&self.chart, &self.files, observer)?;
        let pitch_mm = self.pitch_mm()?;
        let sightings: Vec<Sightings> = views.iter().map(|v| Sightings::of_grid(&v.grid, pitch_mm)).collect();
        let size = views[0].size_px;
        let options = options(size);
        let spared = calibrate_rejecting_outliers(&sightings, size, self.model.family(), options);
        let spared = spared.map_err(|error| Error::input(of_files(&error, &views)))?;
        let left_out = |file: &Path, why: &dyn Display| format!("warning: {}: left out: {why}", file.display());
        let mut notes: Vec<String> = without.iter().map(|(file, why)| left_out(file, why)).collect();
        notes.extend(spared.left_out.iter().map(|(v, why)| left_out(&views[*v].file, why)));
        let kept: Vec<&Sightings> = spared.kept.iter().map(|v| &sightings[*v]).collect();
        let views: Vec<Seen> = spared.kept.iter().map(|v| views[*v].clone()).collect();
        notes.extend(advice::unsuited(self.model, &spared.camera, &views, &kept, options));
        Ok(Found { model: self.model.name().to_owned(), views, camera: spared.camera, notes })
    }
}
