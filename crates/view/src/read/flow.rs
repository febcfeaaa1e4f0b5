//! Optical flow in the files of the benchmarks.

use crate::found::FoundFile;
use crate::layer::{Kind, Layer, NamedPlane, Samples};
use etendue_core::Plane;
use etendue_core::quantity::OpticalFlow;

pub(super) fn layer(file: &FoundFile, flow: &Plane<OpticalFlow>) -> Layer {
    let component = |axis: usize| Samples::Exact(flow.samples().iter().map(|vector| vector[axis]).collect());
    Layer {
        name: file.stem.clone(),
        kind: Kind::Flow,
        unit: "px".to_owned(),
        meaning: "place in the other frame minus place here, x right, y down; NaN: not known".to_owned(),
        size: (flow.width(), flow.height()),
        planes: vec![NamedPlane::value("X", component(0)), NamedPlane::value("Y", component(1))],
    }
}
