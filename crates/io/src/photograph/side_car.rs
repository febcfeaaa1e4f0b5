//! Side-car of this program next to an image.

use std::path::{Path, PathBuf};

use etendue_core::quantity::{DigitalNumber, Quantity};
use serde_json::Value;

use super::Encoding;
use crate::{Error, sidecar};

/// Names of side-cars: of a render, and of a development.
const NAMES: [&str; 2] = ["camera.json", "develop.json"];

/// Side-car that lists an image.
pub(super) struct SideCar {
    pub file: PathBuf,
    pub content: Value,
    /// Name of the image in its list.
    pub image: String,
}

/// Side-car that lists `file`: in its folder, or in the parent folder, as for undistorted images.
pub(super) fn find(file: &Path) -> Result<Option<SideCar>, Error> {
    let Some(name) = file.file_name().and_then(|name| name.to_str()) else { return Ok(None) };
    let folder = file.parent().unwrap_or(Path::new(""));
    let within = folder.file_name().and_then(|folder| folder.to_str());
    let outer = within.zip(folder.parent()).map(|(within, outer)| (outer, format!("{within}/{name}")));
    for (folder, image) in [(folder, name.to_owned())].into_iter().chain(outer) {
        for candidate in NAMES.map(|name| folder.join(name)).into_iter().filter(|candidate| candidate.is_file()) {
            let content = sidecar::read(&candidate)?;
            if content["program"] == "etendue" && !content["files"][&image].is_null() {
                return Ok(Some(SideCar { file: candidate, content, image }));
            }
        }
    }
    Ok(None)
}

impl SideCar {
    /// Name of its file.
    pub(super) fn name(&self) -> String {
        self.file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// Entry of the image.
    pub(super) fn entry(&self) -> &Value {
        &self.content["files"][&self.image]
    }

    /// Pixels whose errors may be correlated, because their paths shared samples.
    pub(super) fn correlated_block_px(&self) -> Result<u32, Error> {
        let stated = &self.content["sampling"]["correlated_block_px"];
        if stated.is_null() {
            return Ok(1);
        }
        let number = stated.as_u64().and_then(|n| u32::try_from(n).ok()).filter(|n| *n > 0);
        let strange =
            || format!("sampling.correlated_block_px is {stated}; expected a whole number above 0: render again");
        number.ok_or_else(|| Error::new(&self.file, strange()))
    }

    /// Encoding of the image's numbers, if stated.
    pub(super) fn encoding(&self) -> Result<Option<Encoding>, Error> {
        let stated = &self.entry()["encoding"];
        let strange = || {
            let problem = format!("states an unknown encoding of {}; render again", self.image);
            Error::new(&self.file, problem)
        };
        if stated.is_null() { Ok(None) } else { Encoding::from_json(stated).map(Some).ok_or_else(strange) }
    }
}

/// Colour filters: a tile of channels that repeats from the top left, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilterTile {
    /// Columns of the tile.
    pub columns: usize,
    /// Names of the channels, row by row.
    pub channels: Vec<String>,
}

/// Levels and filters of a raw image.
#[derive(Clone, Debug, PartialEq)]
pub struct RawFacts {
    /// Digital number at zero charge.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    pub exposure_s: f64,
    /// Colour filters; one channel of one column if there are none.
    pub filters: FilterTile,
    /// Facts of the frame; `None` if the side-car does not state which frame the image is.
    pub frame: Option<RawFrame>,
}

/// Facts that a side-car states of one frame. The levels and the exposure of [`RawFacts`] are also those of the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct RawFrame {
    /// Frame number.
    pub number: u32,
    /// Seed of its noise.
    pub seed: u64,
    /// Index of the camera in its job.
    pub camera_index: u32,
    /// Bits of its numbers.
    pub bits: u32,
    /// Light-sensitive part of the image: first column, first row, columns, rows.
    pub picture_px: [usize; 4],
    /// Knees of the companding curve, without (0, 0): linear and companded numbers.
    pub companding_knees_dn: Option<Vec<[f64; 2]>>,
}

/// Facts of a side-car that lists the image as digital numbers; `None` if it lists it otherwise.
pub(super) fn facts(side_car: &SideCar) -> Result<Option<RawFacts>, Error> {
    if side_car.entry()["quantity"] != DigitalNumber::NAME {
        return Ok(None);
    }
    let lacks = || {
        let problem =
            format!("lists {} as raw, but lacks levels, filters or a valid exposure; render again", side_car.image);
        Error::new(&side_car.file, problem)
    };
    stated(&side_car.content, &side_car.image).map(Some).ok_or_else(lacks)
}

fn stated(content: &Value, name: &str) -> Option<RawFacts> {
    let electronics = &content["sensor"]["electronics"];
    let frames = content["frames"].as_array().map_or(&[][..], Vec::as_slice);
    let entry = frames.iter().find(|frame| frame["raw"] == name);
    let number = |key: &str| entry.unwrap_or(electronics)[key].as_f64();
    Some(RawFacts {
        black_level_dn: number("black_level_dn")?,
        white_level_dn: number("white_level_dn")?,
        exposure_s: number("exposure_s").filter(|s| *s >= 0.0)?,
        filters: filters(&electronics["cfa"])?,
        frame: match entry {
            Some(entry) => Some(frame(content, entry)?),
            None => None,
        },
    })
}

fn filters(cfa: &Value) -> Option<FilterTile> {
    let names = cfa["channels"].as_array()?.iter().map(|name| name.as_str().map(str::to_owned));
    let columns = usize::try_from(cfa["columns"].as_u64()?).ok()?;
    let channels = names.collect::<Option<Vec<_>>>()?;
    let is_complete = columns > 0 && !channels.is_empty() && channels.len().is_multiple_of(columns);
    is_complete.then_some(FilterTile { columns, channels })
}

fn frame(content: &Value, entry: &Value) -> Option<RawFrame> {
    let small = |value: &Value| u32::try_from(value.as_u64()?).ok();
    Some(RawFrame {
        number: small(&entry["frame"])?,
        seed: content["seed"].as_u64()?,
        camera_index: small(&content["camera_index"])?,
        bits: small(&content["sensor"]["electronics"]["bits"])?,
        picture_px: serde_json::from_value(entry["picture_in_raw_px"].clone()).ok()?,
        companding_knees_dn: serde_json::from_value(entry["companding_knees_dn"].clone()).ok()?,
    })
}

/// Exposure timing of an image's rows, as far as its side-car states it.
#[derive(Clone, Debug, PartialEq)]
pub struct StatedTiming {
    /// Side-car file.
    pub file: PathBuf,
    /// Frame of the image.
    pub frame: Option<u32>,
    /// Timing from one row of the image to the next.
    pub rows: StatedRows,
    /// Exposure of a row, s.
    pub exposure_s: Option<f64>,
    /// Period from frame to frame, s.
    pub frame_period_s: Option<f64>,
}

/// Order in which the rows of an image are exposed.
#[derive(Clone, Debug, PartialEq)]
pub enum StatedRows {
    /// Not stated.
    Unknown,
    /// All simultaneously.
    Together,
    /// Downwards, each by this time later than the one above.
    Downwards {
        /// Time from row to row, s.
        row_time_s: f64,
    },
    /// In another order or with unequal exposures, in words.
    Otherwise(String),
}

/// Timing of an image; `None` if no side-car lists it.
///
/// # Errors
/// If a side-car cannot be read.
pub fn stated_timing(file: &Path) -> Result<Option<StatedTiming>, Error> {
    let Some(side_car) = find(file)? else { return Ok(None) };
    let content = &side_car.content;
    let number = content["sensor"].is_object().then(|| number(&side_car.image)).flatten();
    let of_frame = content["frames"].as_array().into_iter().flatten().find(|frame| frame["frame"].as_u64() == number);
    let exposure_s = of_frame.and_then(|frame| frame["exposure_s"].as_f64());
    Ok(Some(StatedTiming {
        frame: number.and_then(|n| u32::try_from(n).ok()),
        rows: rows(&content["sensor"]["shutter"], of_frame),
        exposure_s: exposure_s.or_else(|| content["sensor"]["electronics"]["exposure_s"].as_f64()),
        frame_period_s: content["frame_period_s"].as_f64().filter(|s| *s > 0.0),
        file: side_car.file,
    }))
}

/// Frame number in a name such as `picture.0007.png`.
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
        return StatedRows::Otherwise("rows that are read later are exposed longer (global reset)".to_owned());
    }
    if shutter["direction"] == "up" {
        return StatedRows::Otherwise("rows are read from bottom to top".to_owned());
    }
    if shutter["fields"].as_u64().is_some_and(|fields| fields > 1) {
        return StatedRows::Otherwise("rows are read in fields".to_owned());
    }
    let read = shutter["rows"].as_f64();
    let written = frame.and_then(|frame| frame["picture_in_raw_px"][3].as_f64()).filter(|rows| *rows > 0.0);
    // Binned rows of the image correspond to several rows of the sensor.
    let binned = read.zip(written).map_or(1.0, |(read, written)| (read / written).floor().max(1.0));
    let row_time_s = shutter["row_time_s"].as_f64();
    row_time_s.map_or(StatedRows::Unknown, |s| StatedRows::Downwards { row_time_s: s * binned })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn stated(shutter: Value) -> StatedTiming {
        let folder = tempfile::tempdir().expect("a folder");
        let content = json!({
            "program": "etendue",
            "files": { "picture.0003.png": {} },
            "frame_period_s": 0.05,
            "sensor": { "shutter": shutter, "electronics": { "exposure_s": 0.01 } },
            "frames": [{ "frame": 3, "exposure_s": 0.008, "picture_in_raw_px": [0, 0, 20, 12] }],
        });
        std::fs::write(folder.path().join("camera.json"), content.to_string()).expect("written");
        let timing = stated_timing(&folder.path().join("picture.0003.png")).expect("readable");
        assert_eq!(stated_timing(&folder.path().join("picture.0004.png")).expect("readable"), None, "not listed");
        timing.expect("a side-car")
    }

    #[test]
    fn rows_frames_and_exposure_are_those_of_the_frame() {
        let rolling = json!({ "type": "rolling", "row_time_s": 1e-5, "direction": "down", "fields": 1, "rows": 24 });
        let timing = stated(rolling.clone());
        assert_eq!((timing.frame, timing.exposure_s, timing.frame_period_s), (Some(3), Some(0.008), Some(0.05)));
        assert_eq!(timing.rows, StatedRows::Downwards { row_time_s: 2e-5 }, "two rows of the sensor are one");
        assert_eq!(stated(json!({ "type": "global" })).rows, StatedRows::Together);
        for (key, value) in [("direction", json!("up")), ("fields", json!(2)), ("type", json!("global_reset"))] {
            let mut other = rolling.clone();
            other[key] = value;
            assert!(matches!(stated(other).rows, StatedRows::Otherwise(_)), "{key}");
        }
    }
}
