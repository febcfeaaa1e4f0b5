//! What the truth.json of a chart says of a picture of it.

use crate::failure::Failure;
use serde_json::Value;
use std::path::Path;

/// How much of an edge's length its region takes along it, and across it to both sides together.
const ALONG: f64 = 0.6;
const ACROSS: f64 = 0.5;

/// Regions about the edges of a chart as a camera sees them, whole within the picture: left column, top row, width, height, in
/// readings that lie `period` columns and rows of the file apart.
pub(super) fn edges(
    file: &Path,
    camera: Option<&str>,
    size: (usize, usize),
    period: (usize, usize),
) -> Result<Vec<[usize; 4]>, Failure> {
    let text = crate::job::read_text(file).map_err(Failure::input)?;
    let refused = |what: String| Failure::input(format!("{}: {what}", file.display()));
    let truth: Value = serde_json::from_str(&text).map_err(|cause| refused(format!("not JSON ({cause})")))?;
    let cameras = truth["cameras"].as_array().filter(|list| !list.is_empty());
    let cameras = cameras.ok_or_else(|| refused("no truth of a chart: it lacks cameras".to_owned()))?;
    let named = |c: &&Value| camera.is_none_or(|name| c["name"] == name);
    let seen = cameras.iter().find(named).ok_or_else(|| {
        let names: Vec<&str> = cameras.iter().filter_map(|c| c["name"].as_str()).collect();
        refused(format!("no camera '{}'; it has {}", camera.unwrap_or_default(), names.join(", ")))
    })?;
    let places = truth["features"].as_array().zip(seen["features_px"].as_array());
    let (features, places) = places.ok_or_else(|| refused("no truth of a chart: it lacks features".to_owned()))?;
    let pairs = features.iter().zip(places).filter(|(feature, _)| feature["kind"] == "edge");
    let regions: Vec<[usize; 4]> = pairs.filter_map(|(_, ends)| region(ends, size, period)).collect();
    if regions.is_empty() {
        return Err(refused("the camera sees no whole edge of this chart: is it a chart of slanted edges?".to_owned()));
    }
    Ok(regions)
}

/// About an edge from one end to the other.
fn region(ends: &Value, size: (usize, usize), period: (usize, usize)) -> Option<[usize; 4]> {
    let point = |i: usize| Some([ends[i][0].as_f64()? / period.0 as f64, ends[i][1].as_f64()? / period.1 as f64]);
    let (a, b) = (point(0)?, point(1)?);
    let run = [(b[0] - a[0]).abs(), (b[1] - a[1]).abs()];
    let length = run[0].max(run[1]);
    let sides = if run[1] > run[0] { [ACROSS, ALONG] } else { [ALONG, ACROSS] }.map(|share| share * length);
    let start = [0, 1].map(|i| 0.5 * (a[i] + b[i]) - 0.5 * sides[i]);
    let within = start[0] >= 0.0
        && start[1] >= 0.0
        && start[0] + sides[0] <= size.0 as f64
        && start[1] + sides[1] <= size.1 as f64;
    within.then(|| [start[0], start[1], sides[0], sides[1]].map(|v| v as usize))
}
