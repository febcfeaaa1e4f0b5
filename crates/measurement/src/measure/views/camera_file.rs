//! What was found, as a camera file.

use super::found::Found;
use etendue_io::failure::{Error, ErrorCode};
use etendue_pipeline::stated_projection;
use etendue_scene::record::lens::calibrated::View;
use etendue_scene::record::{self, Camera, Lens, Sensor};
use etendue_scene::written::File;

impl Found {
    /// A camera file by a verb; the f-number cannot be told from these pictures.
    ///
    /// # Errors
    /// Where the camera folds over inside its picture.
    pub(crate) fn camera_file(&self, verb: &str, pixel_pitch_um: f64, f_number: Option<f64>) -> Result<String, Error> {
        let refused =
            |folds| Error::coded(ErrorCode::UnusableLens, format!("no camera file of this, figures only: {folds}"));
        self.camera.calibration.check().map_err(refused)?;
        let [width, height] = self.camera.calibration.size_px().map(|n| n as u64);
        let view = View::Projection(Box::new(stated_projection(&self.camera.calibration)));
        let lens = Lens::Calibrated(Box::new(record::lens::Calibrated::new(view, f_number.unwrap_or(4.0))));
        let camera = Camera::new(lens, Sensor::new(width, height, pixel_pitch_um));
        let count = self.views.len();
        let views = if count == 1 { "view" } else { "views" };
        let rms_px = self.camera.rms_px();
        let about =
            format!("Found by etendue {verb} from {count} {views}; points lie {rms_px:.4} px (rms) from the fit.");
        let file = File::new(camera.to_table()).head(about);
        Ok(match f_number {
            Some(_) => file,
            None => file.beside("lens.f_number", "a stand-in: not measured"),
        }
        .to_string())
    }
}
