//! What a side-car says of when the rows of a picture were exposed.

use super::side_car::beside;
use crate::Error;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// When the rows of a picture were exposed, as far as its side-car says.
#[derive(Clone, Debug, PartialEq)]
pub struct StatedTiming {
    /// The side-car.
    pub file: PathBuf,
    /// The picture's frame.
    pub frame: Option<u32>,
    /// From one row of the picture to the next.
    pub rows: StatedRows,
    /// Exposure of a row, s.
    pub exposure_s: Option<f64>,
    /// From frame to frame, s.
    pub frame_period_s: Option<f64>,
}

/// How the rows of a picture follow each other.
#[derive(Clone, Debug, PartialEq)]
pub enum StatedRows {
    /// It is not said.
    Unknown,
    /// All together.
    Together,
    /// Downwards, each this many seconds after the one above.
    Downwards {
        /// Seconds from row to row.
        row_time_s: f64,
    },
    /// In another order or with unequal exposures, in words.
    Otherwise(String),
}

/// The timing of a picture; `None` where no side-car lists it.
///
/// # Errors
/// Where a side-car cannot be read.
pub fn stated_timing(file: &Path) -> Result<Option<StatedTiming>, Error> {
    let Some(found) = beside(file)? else { return Ok(None) };
    let said = &found.said;
    let number = said["sensor"].is_object().then(|| number(&found.picture)).flatten();
    let of_frame = said["frames"].as_array().into_iter().flatten().find(|frame| frame["frame"].as_u64() == number);
    let exposure_s = of_frame.and_then(|frame| frame["exposure_s"].as_f64());
    Ok(Some(StatedTiming {
        frame: number.and_then(|n| u32::try_from(n).ok()),
        rows: rows(&said["sensor"]["shutter"], of_frame),
        exposure_s: exposure_s.or_else(|| said["sensor"]["electronics"]["exposure_s"].as_f64()),
        frame_period_s: said["frame_period_s"].as_f64().filter(|s| *s > 0.0),
        file: found.file,
    }))
}

/// The frame in a name such as `picture.0007.png`.
fn number(name: &str) -> Option<u64> {
    name.rsplit('.').nth(1)?.parse().ok()
}

fn rows(shutter: &Value, frame: Option<&Value>) -> StatedRows {
    let word = match shutter["type"].as_str() {
        None => return StatedRows::Unknown,
        Some("global") => return StatedRows::Together,
        Some(word) => word,
    };
    if word != "rolling" {
        return StatedRows::Otherwise("rows are exposed the longer the later they are read (global reset)".to_owned());
    }
    if shutter["direction"] == "up" {
        return StatedRows::Otherwise("rows are read upwards".to_owned());
    }
    if shutter["fields"].as_u64().is_some_and(|fields| fields > 1) {
        return StatedRows::Otherwise("rows are read in fields".to_owned());
    }
    let read = shutter["rows"].as_f64();
    let written = frame.and_then(|frame| frame["picture_in_raw_px"][3].as_f64()).filter(|rows| *rows > 0.0);
    // Binned rows of the picture are several of the sensor.
    let binned = read.zip(written).map_or(1.0, |(read, written)| (read / written).floor().max(1.0));
    let row_time_s = shutter["row_time_s"].as_f64();
    row_time_s.map_or(StatedRows::Unknown, |s| StatedRows::Downwards { row_time_s: s * binned })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn stated(shutter: Value) -> StatedTiming {
        let folder = tempfile::tempdir().expect("a folder");
        let said = json!({
            "program": "etendue",
            "files": { "picture.0003.png": {} },
            "frame_period_s": 0.05,
            "sensor": { "shutter": shutter, "electronics": { "exposure_s": 0.01 } },
            "frames": [{ "frame": 3, "exposure_s": 0.008, "picture_in_raw_px": [0, 0, 20, 12] }],
        });
        std::fs::write(folder.path().join("camera.json"), said.to_string()).expect("written");
        let found = stated_timing(&folder.path().join("picture.0003.png")).expect("readable");
        assert_eq!(stated_timing(&folder.path().join("picture.0004.png")).expect("readable"), None, "not listed");
        found.expect("a side-car")
    }

    #[test]
    fn rows_frames_and_exposure_are_those_of_the_frame() {
        let rolling = json!({ "type": "rolling", "row_time_s": 1e-5, "direction": "down", "fields": 1, "rows": 24 });
        let found = stated(rolling.clone());
        assert_eq!((found.frame, found.exposure_s, found.frame_period_s), (Some(3), Some(0.008), Some(0.05)));
        assert_eq!(found.rows, StatedRows::Downwards { row_time_s: 2e-5 }, "two rows of the sensor are one");
        assert_eq!(stated(json!({ "type": "global" })).rows, StatedRows::Together);
        for (key, value) in [("direction", json!("up")), ("fields", json!(2)), ("type", json!("global_reset"))] {
            let mut other = rolling.clone();
            other[key] = value;
            assert!(matches!(stated(other).rows, StatedRows::Otherwise(_)), "{key}");
        }
    }
}
