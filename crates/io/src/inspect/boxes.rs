//! Reader of the object boxes written by this program (`boxes.0000.json`).

use std::path::Path;

use serde::Deserialize;

use super::drawing::{self, ObjectBox};
use super::{FileReport, Preview};
use crate::{Error, ErrorCode, source::read_description_bytes};

/// Boxes of a frame.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Boxes {
    /// Columns of the image.
    pub width_px: usize,
    /// Its rows.
    pub height_px: usize,
    /// The objects, in the order of their identities.
    pub objects: Vec<ObjectBox>,
}

/// Reads the boxes of a frame.
///
/// # Errors
/// If the file holds no boxes.
pub fn read_boxes(file: &Path) -> Result<Boxes, Error> {
    serde_json::from_slice(&read_description_bytes(file, "file of boxes")?).map_err(|cause| {
        Error::at(file, cause.line(), format!("no boxes of objects, as boxes.0000.json has them: {cause}"))
    })
}

/// Draws the boxes of `boxes` over the image of a report.
///
/// # Errors
/// If the file holds no boxes or those of an image of another size, or if the report has no image.
pub(super) fn draw(report: &mut FileReport, boxes: &Path) -> Result<(), Error> {
    let found = read_boxes(boxes)?;
    let Some(preview) = &mut report.preview else {
        return Err(Error::coded(
            ErrorCode::UnsuitableFile,
            &report.file,
            "there is no picture on which boxes could be drawn; give a picture",
        ));
    };
    let Preview { width, height, .. } = *preview;
    if (width, height) != (found.width_px, found.height_px) {
        let (w, h) = (found.width_px, found.height_px);
        let message =
            format!("boxes of a picture of {w} x {h} pixels, for one of {width} x {height}; give those of it");
        return Err(Error::new(boxes, message));
    }
    drawing::draw_boxes(preview, &found.objects);
    let seen = found.objects.iter().filter(|object| object.visible_box_px.is_some()).count();
    report.notes.push(format!(
        "boxes of {seen} objects that are seen: full lines about what is seen, dots about the whole object, in the colours of their ids"
    ));
    Ok(())
}
