//! Layers of images, of optical flow and of boxes: raws by their side-car, others by the encoding that is assumed for their
//! numbers.

use etendue::Error;
use etendue_core::{Plane, quantity::OpticalFlow};
use etendue_io::inspect::{ObjectBox, identity_colour, read_boxes};
use etendue_io::photograph::{Encoding, Photograph, PhotographChannel, read_photograph};
use serde_json::{Value, json};

use super::facts::{self, SideCar};
use crate::layer::{Layer, LayerKind, NamedPlane, Samples};
use crate::result_files::ResultFile;

pub(super) fn picture_layer(file: &ResultFile, side_car: &SideCar) -> Result<Layer, Error> {
    let photograph = read_photograph(&file.path).map_err(Error::input)?;
    let size = (photograph.width, photograph.height);
    let [quantity, stated] = side_car.entry(&file.name);
    let (kind, unit, meaning) = match (&photograph.raw, photograph.channels.len(), photograph.full_scale) {
        (Some(raw), ..) => {
            let filters =
                Some((raw.filters.columns, raw.filters.channels.clone())).filter(|(_, names)| names.len() > 1);
            let kind = LayerKind::Raw { black: raw.black_level_dn, white: raw.white_level_dn, filters };
            (kind, "DN".to_owned(), format!("exposure {} s", raw.exposure_s))
        }
        (None, 3.., None) => (LayerKind::Colour, facts::written(stated), quantity.to_owned()),
        (None, _, None) => (LayerKind::Number, facts::written(stated), quantity.to_owned()),
        // Depth and disparity as images.
        (None, 1 | 2, Some(_)) if !stated.is_empty() && !stated.ends_with("bits") => {
            (LayerKind::Number, stated.to_owned(), quantity.to_owned())
        }
        // A raw without stated levels.
        (None, 1 | 2, Some(_)) if photograph.stated.encoding == Encoding::Linear => {
            (LayerKind::Number, "DN".to_owned(), format!("linear ({})", photograph.stated.reason))
        }
        (None, _, Some(full)) => {
            let stated = &photograph.stated;
            let kind = LayerKind::Picture { full, encoding: stated.encoding.name() };
            (kind, "DN".to_owned(), format!("{} ({})", stated.encoding.name(), stated.reason))
        }
    };
    Ok(Layer { name: file.stem.clone(), kind, unit, meaning, size, planes: planes(photograph) })
}

/// Colour, or the one channel; without transparency.
fn planes(photograph: Photograph) -> Vec<NamedPlane> {
    let full = photograph.full_scale;
    let shown = photograph.channels.into_iter().filter(|channel| channel.name != "A");
    let plane = |PhotographChannel { name, samples }: PhotographChannel| {
        let samples = match full {
            Some(full) if full <= 255.0 => Samples::Bytes(samples.iter().map(|v| *v as u8).collect()),
            Some(full) if full <= 65_535.0 => Samples::Words(samples.iter().map(|v| *v as u16).collect()),
            Some(_) => Samples::Integers(samples.iter().map(|v| *v as u32).collect()),
            None => Samples::Exact(samples),
        };
        NamedPlane::value(name, samples)
    };
    shown.map(plane).collect()
}

pub(super) fn flow_layer(file: &ResultFile, flow: &Plane<OpticalFlow>) -> Layer {
    let component = |axis: usize| Samples::Exact(flow.samples().iter().map(|vector| vector[axis]).collect());
    Layer {
        name: file.stem.clone(),
        kind: LayerKind::Flow,
        unit: "px".to_owned(),
        meaning: "position in the other frame minus position in this one, x right, y down; NaN: not known".to_owned(),
        size: (flow.width(), flow.height()),
        planes: vec![NamedPlane::value("X", component(0)), NamedPlane::value("Y", component(1))],
    }
}

pub(super) fn boxes_layer(file: &ResultFile) -> Result<Layer, Error> {
    let boxes = read_boxes(&file.path).map_err(Error::input)?;
    Ok(Layer {
        name: file.stem.clone(),
        kind: LayerKind::Boxes { objects: boxes.objects.iter().map(object).collect() },
        unit: "px".to_owned(),
        meaning: "solid lines around visible parts, dashed lines around whole objects".to_owned(),
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
