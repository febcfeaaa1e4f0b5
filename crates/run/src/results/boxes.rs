//! The boxes of a frame as JSON.

use super::metadata::add_time;
use etendue_pipeline::boxes::{ObjectBoxes, PixelBox, SolidBox, Stance};
use etendue_pipeline::frame_view::FrameView;
use etendue_pipeline::plan::Plan;
use serde_json::{Value, json};

/// What `boxes.json` says of a frame.
pub(super) fn boxes_json(plan: &Plan, frame: &FrameView<'_>, boxes: &[ObjectBoxes]) -> Value {
    let raster = &frame.camera.body.raster;
    let size = (raster.width(), raster.height());
    let mut facts = json!({
        "camera": frame.camera.name,
        "frame": frame.frame,
        "width_px": size.0,
        "height_px": size.1,
        "conventions": {
            "boxes": "left, top, right, bottom; raster coordinates, px: a pixel (x, y) fills x to x + 1 and y to y + 1",
            "visible_box_px": "about the pixels that show the object; null: none",
            "amodal_box_px": "about the whole object, also beyond the picture; where is_cut about the parts that have an image",
            "amodal_box_in_picture_px": "about the part of the whole object's image within the picture, whatever hides it; null: none",
            "visible_fraction": "pixels that show it over those that would if it were alone",
            "truncated_fraction": "part of the amodal box's area outside the picture; null where is_cut",
            "box_3d": "along the object's axes (x forward, y left, z up) at time_s: size; centre and rotation (quaternion w, x, y, z) in the \
                       camera's frame (x right, y down, z forward) and in the world (x forward, y left, z up)",
            "id": "as instance.ID of the ground truth, the same in all frames",
        },
        "objects": boxes.iter().map(|object| object_json(plan, size, object)).collect::<Vec<_>>(),
    });
    let timing = &frame.camera.timing;
    add_time(&mut facts, timing, "time", timing.frame_middle(frame.frame));
    facts
}

fn object_json(plan: &Plan, (width, height): (usize, usize), object: &ObjectBoxes) -> Value {
    let identity = plan.identity(object.id);
    json!({
        "id": object.id,
        "name": identity.map(|identity| &identity.name),
        "class": identity.and_then(|identity| identity.class.as_ref()),
        "visible_box_px": object.visible.map(edges),
        "amodal_box_px": object.amodal.map(edges),
        "amodal_box_in_picture_px": object.amodal_in_picture.map(edges),
        "is_cut": object.is_cut,
        "visible_pixels": object.visible_pixels,
        "alone_pixels": object.alone_pixels,
        "visible_fraction": object.visible_fraction(),
        "truncated_fraction": object.truncated_fraction(width, height),
        "box_3d": solid(&object.solid),
    })
}

fn edges(found: PixelBox) -> [f64; 4] {
    found.edges_px()
}

fn solid(found: &SolidBox) -> Value {
    json!({ "size_m": found.size_m.to_array(), "world": stance(&found.world), "camera": stance(&found.camera) })
}

fn stance(found: &Stance) -> Value {
    let [x, y, z, w] = found.rotation.to_array();
    json!({ "centre_m": found.centre_m.to_array(), "rotation_wxyz": [w, x, y, z] })
}
