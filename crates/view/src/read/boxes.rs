//! Boxes of objects.

use crate::found::FoundFile;
use crate::layer::{Kind, Layer};
use etendue::Error;
use etendue_io::inspect::{ObjectBox, identity_colour, read_boxes};
use serde_json::{Value, json};

pub(super) fn layer(file: &FoundFile) -> Result<Layer, Error> {
    let boxes = read_boxes(&file.path).map_err(Error::input)?;
    Ok(Layer {
        name: file.stem.clone(),
        kind: Kind::Boxes { objects: boxes.objects.iter().map(object).collect() },
        unit: "px".to_owned(),
        meaning: "full lines about what is seen, broken ones about whole objects".to_owned(),
        size: (boxes.width_px, boxes.height_px),
        planes: Vec::new(),
    })
}

fn object(object: &ObjectBox) -> Value {
    json!({
        "id": object.id,
        "name": object.name,
        "class": object.class,
        "colour": identity_colour(object.id),
        "visible": object.visible_box_px,
        "amodal": object.amodal_box_px,
        "visible_fraction": object.visible_fraction,
    })
}
