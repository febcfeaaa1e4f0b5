//! Measurements of cameras from images, and of lenses without rendering: one kind of measurement per file.
//!
//! Each takes a request with typed arguments and returns a [`Report`](crate::report::Report): numbers with unit and standard
//! uncertainty, tables, plots and notes. Images are read from files.

mod balanced_mosaic;
mod cdp;
mod chromatic;
pub(crate) mod colour;
mod compare;
mod dark_current;
mod depth;
mod distortion;
mod encoding;
mod flare;
mod flicker;
mod focal;
mod frame_times;
mod lens;
mod noise;
mod oecf;
pub(crate) mod pictures;
mod point_list;
pub(crate) mod ptc;
pub(crate) mod readings;
pub(crate) mod sfr;
pub(crate) mod shading;
mod texture;
pub(crate) mod truth;
pub(crate) mod views;

pub use etendue_metrology::{calibrate::CameraModel, target::Target};

pub use cdp::{CdpRequest, cdp};
pub use chromatic::{ChromaticRequest, chromatic};
pub use colour::{ColourRequest, colour};
pub use compare::{CompareRequest, MeasurementComparison, compare};
pub use dark_current::{DarkCurrentRequest, dark_current};
pub use depth::{DepthAlignment, DepthRequest, depth_errors};
pub use distortion::{DistortionRequest, distortion};
pub use encoding::{ChosenEncoding, EncodingChoice};
pub use flare::{FlareRequest, flare};
pub use flicker::{FlickerRequest, flicker};
pub use focal::{CalibrationRequest, FocalRequest, calibrate, focal};
pub use lens::{LensMeasurement, LensRequest, lens};
pub use noise::{NoiseRequest, noise};
pub use oecf::{OecfRequest, oecf};
pub use pictures::MeasurementInput;
pub use point_list::ChartInput;
pub use ptc::{PtcRequest, ptc};
pub use readings::{Selection, SignalLevels};
pub use sfr::{SfrRequest, sfr};
pub use shading::{FlatFieldRequest, ShadingRequest, VignettingRequest, shading, vignetting};
pub use texture::{StarRequest, TextureRequest, star, texture};
pub use truth::TruthInput;
pub use views::{StatedLength, ViewsRequest};
