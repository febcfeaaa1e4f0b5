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
    serde_json::from_slice(&read_description_bytes(file, "boxes")?).map_err(|cause| {
        Error::at(
            file,
            cause.line(),
            format!("does not contain boxes of objects in the form of boxes.0000.json: {cause}"),
        )
    })
}

/// Draws the boxes of `boxes` over the image of a report.
///
/// # Errors
/// If the file holds no boxes or those of an image of another size, or if the report has no image.
pub(super) fn draw(report: &mut FileReport, boxes: &Path) -> Result<(), Error> {
    let recorded = read_boxes(boxes)?;
    let Some(preview) = &mut report.preview else {
        return Err(Error::coded(
            ErrorCode::UnsuitableFile,
            &report.file,
            "contains no image to draw boxes on; give an image",
        ));
    };
    let Preview { width, height, .. } = *preview;
    if (width, height) != (recorded.width_px, recorded.height_px) {
        let (w, h) = (recorded.width_px, recorded.height_px);
        let message = format!(
            "the boxes are of an image of {w} x {h} pixels, but the image has {width} x {height}; give the boxes of this image"
        );
        return Err(Error::new(boxes, message));
    }
    drawing::draw_boxes(preview, &recorded.objects);
    let visible_count = recorded.objects.iter().filter(|object| object.visible_box_px.is_some()).count();
    report.notes.push(format!(
        "boxes of {visible_count} visible objects in the colours of their ids: solid lines around the visible part, dots around the whole object"
    ));
    Ok(())
}
