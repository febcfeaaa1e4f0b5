//! The parts of a truth.json that measurements read.

use std::path::Path;

use etendue_io::failure::{Error, ErrorCode};
use serde::Deserialize;
use serde_json::{Map, Value};

/// Points of the image, px; `None` outside it.
type ImagePoints = Vec<Option<[f64; 2]>>;

#[derive(Debug, Deserialize)]
pub(crate) struct TruthFile {
    pub chart: String,
    pub sizes: Map<String, Value>,
    #[serde(rename = "seen")]
    pub view: ViewRecord,
    pub light: LightRecord,
    pub inks: Vec<InkRecord>,
    #[serde(default)]
    pub features: Vec<FeatureRecord>,
    #[serde(default)]
    pub patches: Vec<PatchRecord>,
    pub cameras: Vec<CameraRecord>,
    #[serde(default)]
    pub panels: Vec<PanelRecord>,
}

/// A sheet: transform from its millimetres to the world's metres.
#[derive(Debug, Deserialize)]
pub(crate) struct PanelRecord {
    pub sheet_mm_to_world_m: [[f64; 4]; 3],
}

#[derive(Debug, Deserialize)]
pub(crate) struct ViewRecord {
    pub fills_the_field: bool,
}

#[derive(Debug, Deserialize)]
pub(crate) struct LightRecord {
    pub luminance_cd_m2: f64,
    pub xyz: [f64; 3],
}

#[derive(Debug, Deserialize)]
pub(crate) struct InkRecord {
    pub name: String,
    pub luminance_cd_m2: f64,
    pub xyz: [f64; 3],
}

#[derive(Debug, Deserialize)]
pub(crate) struct FeatureRecord {
    pub kind: String,
    pub index: Option<[usize; 2]>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct PatchRecord {
    pub name: String,
    pub ink: String,
}

#[derive(Debug, Deserialize)]
pub(crate) struct CameraRecord {
    pub name: String,
    pub dark: bool,
    pub picture_px: [usize; 2],
    pub exposure_s: Option<f64>,
    pub camera_to_world: Option<[[f64; 4]; 3]>,
    #[serde(default)]
    pub features_px: Vec<ImagePoints>,
    #[serde(default)]
    pub patches_px: Vec<ImagePoints>,
}

impl TruthFile {
    /// Returns a number among the chart's sizes.
    pub(crate) fn size(&self, key: &str) -> Option<f64> {
        self.sizes.get(key)?.as_f64()
    }
}

pub(crate) fn read(file: &Path) -> Result<TruthFile, Error> {
    let text = etendue_io::source::text_of(file)?;
    let refused = |error: serde_json::Error| {
        Error::coded(
            ErrorCode::MalformedFile,
            format!(
                "{}: not the ground truth of a chart ({error}); expected a truth.json of etendue chart",
                file.display()
            ),
        )
    };
    let truth: TruthFile = serde_json::from_str(&text).map_err(refused)?;
    Ok(truth)
}
