//! What a side-car states of a raw picture.

use std::path::Path;

use etendue_core::quantity::{DigitalNumber, Quantity};
use serde_json::Value;

use crate::Error;
use crate::source::{decode_text, read_bytes};

/// The side-car's name.
const SIDECAR: &str = "camera.json";

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
}

/// The facts of a side-car of this program beside `file` that lists it as digital numbers; `None` without one.
pub(super) fn facts_beside(file: &Path) -> Result<Option<RawFacts>, Error> {
    let sidecar = file.with_file_name(SIDECAR);
    let Some(name) = file.file_name().and_then(|name| name.to_str()).filter(|_| sidecar.is_file()) else {
        return Ok(None);
    };
    let bytes = read_bytes(&sidecar, "side-car")?;
    let said: Value = serde_json::from_str(decode_text(&sidecar, &bytes)?)
        .map_err(|cause| Error::new(&sidecar, format!("not JSON ({cause}); remove it, or render again")))?;
    if said["program"] != "etendue" || said["files"][name]["quantity"] != DigitalNumber::NAME {
        return Ok(None);
    }
    let lacks = || Error::new(&sidecar, format!("it lists {name} as raw and lacks levels or filters; render again"));
    facts(&said["sensor"]["electronics"]).map(Some).ok_or_else(lacks)
}

fn facts(electronics: &Value) -> Option<RawFacts> {
    let number = |key: &str| electronics[key].as_f64();
    let cfa = &electronics["cfa"];
    let names = cfa["channels"].as_array()?.iter().map(|name| name.as_str().map(str::to_owned));
    let filters = FilterTile {
        columns: usize::try_from(cfa["columns"].as_u64()?).ok()?,
        channels: names.collect::<Option<_>>()?,
    };
    let whole =
        filters.columns > 0 && !filters.channels.is_empty() && filters.channels.len().is_multiple_of(filters.columns);
    Some(RawFacts {
        black_level_dn: number("black_level_dn")?,
        white_level_dn: number("white_level_dn")?,
        exposure_s: number("exposure_s")?,
        filters,
    })
    .filter(|_| whole)
}
