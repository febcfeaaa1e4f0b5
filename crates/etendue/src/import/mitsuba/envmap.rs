//! Pictures of light from infinity.

use super::access::{number, text};
use super::importer::Importer;
use super::transform::transform_of;
use crate::import::naming::{azimuth_elevation_deg, rounded};
use crate::import::scenery::linear_pixels;
use etendue_core::maths::f64 as maths;
use etendue_io::Error;
use etendue_io::mitsuba::MitsubaElement;
use etendue_io::picture::read_picture;
use etendue_scene::record::Environment;
use etendue_scene::record::environment::EnvironmentImage;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// From the space of a picture of Mitsuba's to that of ours: its middle column is seen along +z and its upper edge is +y.
fn picture_axes() -> DMat3 {
    DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X)
}

impl<'a> Importer<'a> {
    /// `None`, and a note, of a picture that is not read, or of one that is dark.
    pub(super) fn envmap(&mut self, element: &'a MitsubaElement) -> Result<Option<Environment>, Error> {
        let file = text(element, "filename")?.ok_or_else(|| element.fault("an envmap without \"filename\""))?;
        let scale = number(element, "scale", 1.0)?;
        if scale <= 0.0 {
            self.scenery.report.note("an emitter \"envmap\" is dark and left out");
            return Ok(None);
        }
        let to_world = transform_of(element, "to_world")?.matrix3;
        let to_world = DMat3::from_cols(
            to_world.x_axis.normalize_or_zero(),
            to_world.y_axis.normalize_or_zero(),
            to_world.z_axis.normalize_or_zero(),
        );
        let image = read_picture(&self.file(file)).map_err(|e| element.fault(e.to_string()))?;
        let Some(pixel) = linear_pixels(&image) else {
            let told = format!("the picture of light `{file}` is left out: expected linear numbers (EXR, HDR)");
            self.scenery.report.note(told);
            return Ok(None);
        };
        // From our pictures' space, by Mitsuba's, to our world.
        let turn = self.scenery.to_ours * to_world * picture_axes().transpose();
        let is_upright = (turn.z_axis - DVec3::Z).length() < 1e-9 && turn.determinant() > 0.0;
        if is_upright {
            let [azimuth, _] = azimuth_elevation_deg(turn.x_axis);
            let [degrees, ..] = rounded([azimuth, 0.0, 0.0]);
            let path = self.path(file);
            self.scenery.report.note(format!("the light of `{file}`: 1 is {scale} cd/m²"));
            let picture = EnvironmentImage::new(path.as_str(), scale);
            let rotation_deg = (degrees != 0.0).then(|| degrees.into());
            return Ok(Some(Environment::Image(EnvironmentImage { rotation_deg, ..picture })));
        }
        let (columns, rows) = (image.width as usize, image.height as usize);
        let to_picture = turn.transpose();
        let found = |direction: DVec3| {
            let d = to_picture * direction;
            let [across, down] = [0.5 - maths::atan2(d.y, d.x) / TAU, maths::acos(d.z.clamp(-1.0, 1.0)) / PI];
            bilinear(&*pixel, [columns, rows], [across * columns as f64 - 0.5, down * rows as f64 - 0.5])
        };
        let written = self.scenery.environment_file(rows, &found).map_err(|told| element.fault(told))?;
        self.scenery.report.note(format!("the light of `{file}`: turned, and resampled; 1 is {scale} cd/m²"));
        Ok(Some(Environment::Image(EnvironmentImage::new(written.as_str(), scale))))
    }
}

/// Columns go round, rows end at the poles.
fn bilinear(pixel: &dyn Fn(usize) -> [f32; 3], [columns, rows]: [usize; 2], [x, y]: [f64; 2]) -> [f64; 3] {
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let at = |dx: f64, dy: f64| {
        let column = (x0 + dx).rem_euclid(columns as f64) as usize;
        let row = (y0 + dy).clamp(0.0, (rows - 1) as f64) as usize;
        pixel(row * columns + column.min(columns - 1)).map(f64::from)
    };
    let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
    std::array::from_fn(|i| (1.0 - fy) * ((1.0 - fx) * a[i] + fx * b[i]) + fy * ((1.0 - fx) * c[i] + fx * d[i]))
}
