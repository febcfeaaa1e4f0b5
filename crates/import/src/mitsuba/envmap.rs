//! Pictures of light from infinity.

use super::access::{number, text};
use super::importer::Importer;
use super::transform::transform_of;
use crate::scenery::{LightPicture, linear_pixels};
use crate::syntax::mitsuba::MitsubaElement;
use etendue_io::Error;
use etendue_io::picture::read_picture;
use etendue_scene::record::Environment;
use glam::{DMat3, DVec3};

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
        let image = read_picture(&self.file(file)).map_err(|e| element.fault(e.to_string()))?.in_rec_709();
        let Some(pixel) = linear_pixels(&image) else {
            let told = format!("the picture of light `{file}` is left out: expected linear numbers (EXR, HDR)");
            self.scenery.report.note(told);
            return Ok(None);
        };
        // From our pictures' space, by Mitsuba's, to our world.
        let turn = self.scenery.to_ours * to_world * picture_axes().transpose();
        let path = self.path(file);
        let picture = LightPicture { shown: file, path: &path, columns: image.width as usize, pixel: &*pixel };
        let made = self.scenery.light_picture(&picture, image.height as usize, turn, scale);
        made.map(Some).map_err(|told| element.fault(told))
    }
}
