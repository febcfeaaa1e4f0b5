//! The parts of a truth.json that measurements read.

use std::path::Path;

use etendue_io::failure::{Error, ErrorCode};
use serde::Deserialize;
use serde_json::{Map, Value};

/// Points of the image, px; `None` outside it.
type Places = Vec<Option<[f64; 2]>>;

#[derive(Debug, Deserialize)]
pub(crate) struct Said {
    pub chart: String,
    pub sizes: Map<String, Value>,
    pub seen: SeenSaid,
    pub light: LightSaid,
    pub inks: Vec<InkSaid>,
    #[serde(default)]
    pub features: Vec<FeatureSaid>,
    #[serde(default)]
    pub patches: Vec<PatchSaid>,
    pub cameras: Vec<CameraSaid>,
    #[serde(default)]
    pub panels: Vec<PanelSaid>,
}

/// A sheet: transform from its millimetres to the world's metres.
#[derive(Debug, Deserialize)]
pub(crate) struct PanelSaid {
    pub sheet_mm_to_world_m: [[f64; 4]; 3],
}

#[derive(Debug, Deserialize)]
pub(crate) struct SeenSaid {
    pub fills_the_field: bool,
}

#[derive(Debug, Deserialize)]
pub(crate) struct LightSaid {
    pub luminance_cd_m2: f64,
    pub xyz: [f64; 3],
}

#[derive(Debug, Deserialize)]
pub(crate) struct InkSaid {
    pub name: String,
    pub luminance_cd_m2: f64,
    pub xyz: [f64; 3],
}

#[derive(Debug, Deserialize)]
pub(crate) struct FeatureSaid {
    pub kind: String,
    pub index: Option<[usize; 2]>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct PatchSaid {
    pub name: String,
    pub ink: String,
}

#[derive(Debug, Deserialize)]
pub(crate) struct CameraSaid {
    pub name: String,
    pub dark: bool,
    pub picture_px: [usize; 2],
    pub exposure_s: Option<f64>,
    pub camera_to_world: Option<[[f64; 4]; 3]>,
    #[serde(default)]
    pub features_px: Vec<Places>,
    #[serde(default)]
    pub patches_px: Vec<Places>,
}

impl Said {
    /// Returns a number among the chart's sizes.
    pub(crate) fn size(&self, key: &str) -> Option<f64> {
        self.sizes.get(key)?.as_f64()
    }
}

pub(crate) fn read(file: &Path) -> Result<Said, Error> {
    let text = etendue_io::source::text_of(file)?;
    let refused = |cause: serde_json::Error| {
        Error::coded(
            ErrorCode::MalformedFile,
            format!(
                "{}: not the ground truth of a chart ({cause}); expected a truth.json of etendue chart",
                file.display()
            ),
        )
    };
    let said: Said = serde_json::from_str(&text).map_err(refused)?;
    Ok(said)
}
