//! What a side-car states of a raw picture.

use etendue_core::quantity::{DigitalNumber, Quantity};
use serde_json::Value;

use super::side_car::SideCar;
use crate::Error;

/// Colour filters: a tile of channels that repeats from the top left, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilterTile {
    /// Columns of the tile.
    pub columns: usize,
    /// Names of the channels, row by row.
    pub channels: Vec<String>,
}

/// Levels and filters of a raw picture.
#[derive(Clone, Debug, PartialEq)]
pub struct RawFacts {
    /// Digital number of no charge.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// Exposure, s.
    pub exposure_s: f64,
    /// The colour filters; one channel of one column where there are none.
    pub filters: FilterTile,
    /// What is stated of the frame; `None` where the side-car does not say which frame the picture is.
    pub frame: Option<RawFrame>,
}

/// What a side-car states of one frame. The levels and the exposure of [`RawFacts`] are the frame's, too.
#[derive(Clone, Debug, PartialEq)]
pub struct RawFrame {
    /// Its number.
    pub number: u32,
    /// The seed of its noise.
    pub seed: u64,
    /// The camera's place in its job.
    pub camera_index: u32,
    /// Bits of its numbers.
    pub bits: u32,
    /// The part that light reached: first column, first row, columns, rows.
    pub picture_px: [usize; 4],
    /// Linear and companded numbers at the ends of the lines by which numbers were put into fewer bits, without (0, 0).
    pub companding_knees_dn: Option<Vec<[f64; 2]>>,
}

/// The facts of a side-car that lists the picture as digital numbers; `None` where it lists it otherwise.
pub(super) fn facts(beside: &SideCar) -> Result<Option<RawFacts>, Error> {
    if beside.entry()["quantity"] != DigitalNumber::NAME {
        return Ok(None);
    }
    let lacks = || {
        let problem = format!(
            "it lists {} as raw and lacks levels, filters or a possible exposure; render again",
            beside.picture
        );
        Error::new(&beside.file, problem)
    };
    stated(&beside.said, &beside.picture).map(Some).ok_or_else(lacks)
}

fn stated(said: &Value, name: &str) -> Option<RawFacts> {
    let electronics = &said["sensor"]["electronics"];
    let frames = said["frames"].as_array().map_or(&[][..], Vec::as_slice);
    let entry = frames.iter().find(|frame| frame["raw"] == name);
    let number = |key: &str| entry.unwrap_or(electronics)[key].as_f64();
    Some(RawFacts {
        black_level_dn: number("black_level_dn")?,
        white_level_dn: number("white_level_dn")?,
        exposure_s: number("exposure_s").filter(|s| *s >= 0.0)?,
        filters: filters(&electronics["cfa"])?,
        frame: match entry {
            Some(entry) => Some(frame(said, entry)?),
            None => None,
        },
    })
}

fn filters(cfa: &Value) -> Option<FilterTile> {
    let names = cfa["channels"].as_array()?.iter().map(|name| name.as_str().map(str::to_owned));
    let columns = usize::try_from(cfa["columns"].as_u64()?).ok()?;
    let channels = names.collect::<Option<Vec<_>>>()?;
    let whole = columns > 0 && !channels.is_empty() && channels.len().is_multiple_of(columns);
    whole.then_some(FilterTile { columns, channels })
}

fn frame(said: &Value, entry: &Value) -> Option<RawFrame> {
    let small = |value: &Value| u32::try_from(value.as_u64()?).ok();
    Some(RawFrame {
        number: small(&entry["frame"])?,
        seed: said["seed"].as_u64()?,
        camera_index: small(&said["camera_index"])?,
        bits: small(&said["sensor"]["electronics"]["bits"])?,
        picture_px: serde_json::from_value(entry["picture_in_raw_px"].clone()).ok()?,
        companding_knees_dn: serde_json::from_value(entry["companding_knees_dn"].clone()).ok()?,
    })
}
