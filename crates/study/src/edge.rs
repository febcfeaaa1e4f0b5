//! Effect of a change on the measured contrast transfer: slanted edges before the job's camera, without and with the change (ISO 12233).

use crate::error::Estimate;
use crate::frame_render::FrameRenderer;
use etendue::chart::{ChartForCamera, ChartRequest, design};
use etendue::measure::{SfrRequest, sfr};
use etendue::report::{Cell, Report, Table};
use etendue::{Error, RenderOptions};
use serde::Serialize;
use std::path::PathBuf;

/// Samples per pixel: flat sheets in uniform illumination have little noise.
const SPP: u32 = 32;
/// Luminance ratio of the background to the squares.
const CONTRAST: f64 = 4.0;
/// Rotation of the squares, degrees.
const ANGLE_DEG: f64 = 5.0;
/// Level of white as a fraction of the sensor's saturation: leaves headroom for changes that make the image brighter.
const WHITE: f64 = 0.3;
/// Field position, % of half the diagonal, up to which edges count as central, and from which on they count as far.
const MIDDLE_PERCENT: f64 = 30.0;
const FAR_PERCENT: f64 = 60.0;
/// Minimum spacing of squares, px: the measured region around an edge is 0.3 of it wide, at least 16 px.
const COLUMN_PX: usize = 72;
/// Minimum variance of an edge's frequency, (cycles per pixel)².
const MIN_VARIANCE: f64 = 1e-8;

/// Spatial frequencies at which the response of edges falls to one half, cycles per pixel: means over the edges of a part of the field that are measured both
/// without and with a change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mtf50 {
    /// Up to 30 % of half the image diagonal from the centre; `None`: no edge there has a result.
    pub middle: Option<Estimate>,
    /// From 60 % on; `None`: no edge there has a result.
    pub far: Option<Estimate>,
}

/// A chart of edges before a job's camera, and its measurement with the unchanged job. Its folder is removed on drop.
pub(crate) struct EdgeChart<'a> {
    renderer: &'a FrameRenderer<'a>,
    chart: ChartForCamera,
    /// Held only to be dropped.
    _folder: TemporaryFolder,
    unchanged_edges: Vec<EdgeResult>,
}

/// A folder created here; removed on drop.
struct TemporaryFolder(PathBuf);

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // Remaining files are harmless.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl<'a> EdgeChart<'a> {
    /// Captures the chart once, if contrast transfer is requested.
    ///
    /// # Errors
    /// The folder exists already or cannot be written, the camera makes no image of the chart, or no edge in it can be measured.
    pub(crate) fn open(renderer: &'a FrameRenderer<'a>) -> Result<Option<Self>, Error> {
        let Some(path) = &renderer.request.edges else { return Ok(None) };
        let parent = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let created = parent.and_then(|()| std::fs::create_dir(path));
        created.map_err(|error| Error::Run(format!("{}: {error}", path.display())))?;
        let folder = TemporaryFolder(path.clone());
        let design = design::SlantedEdges { size: grid(renderer), angle_deg: ANGLE_DEG, contrast: CONTRAST };
        // The camera is that of the job.
        let request = ChartRequest { white: WHITE, ..ChartRequest::new(design.into(), "") };
        let chart = ChartForCamera::make(&request, &renderer.own, &renderer.camera, path)?;
        let mut own = Self { renderer, chart, _folder: folder, unchanged_edges: Vec::new() };
        own.unchanged_edges = own.measure(&[])?;
        Ok(Some(own))
    }

    /// Frequencies without and with these changes of keys, over the edges that are measured in both; `None` if the changed camera makes no image of the chart
    /// with measurable edges.
    pub(crate) fn change(&self, set: &[String]) -> Result<Option<[Mtf50; 2]>, Error> {
        match self.measure(set) {
            Ok(changed) => Ok(Some(means_of_common_edges(&self.unchanged_edges, &changed))),
            Err(Error::Input(_)) => Ok(None),
            Err(other) => Err(other),
        }
    }

    fn measure(&self, set: &[String]) -> Result<Vec<EdgeResult>, Error> {
        let mut job = self.renderer.own.clone();
        job.set.extend(set.iter().cloned());
        let options = RenderOptions { simd: self.renderer.request.simd, ..RenderOptions::default() };
        let image = self.chart.capture(&job, SPP, &options, &self.renderer.without_messages())?;
        let mut request = SfrRequest::new(image);
        request.input.truth.truth = Some(self.chart.truth());
        Ok(edges_in_report(&sfr(&request)?))
    }
}

/// Grid of squares whose edges have enough pixels for a measurement: five columns, fewer in a small image.
fn grid(renderer: &FrameRenderer<'_>) -> design::GridSize {
    let plan = renderer.job.plan();
    let own = plan.cameras.iter().find(|camera| camera.name == renderer.camera);
    let columns = own.map(|camera| (camera.body.raster.width() / COLUMN_PX).clamp(1, 5) as u32);
    design::GridSize { columns, ..design::GridSize::default() }
}

/// An edge whose response falls to one half.
#[derive(Clone, Debug, PartialEq)]
struct EdgeResult {
    /// Position of the measurement in the image and direction of the edge, as the report states them.
    position_and_direction: [String; 2],
    field_percent: f64,
    mtf50: Estimate,
}

/// The edges of a report.
fn edges_in_report(report: &Report) -> Vec<EdgeResult> {
    report.tables().filter(|table| table.key == "edges").flat_map(edges_in_table).collect()
}

fn edges_in_table(table: &Table) -> Vec<EdgeResult> {
    let column =
        |key: &str| table.columns.iter().position(|(own, _)| *own == key).expect("a column of the measurement");
    let [at, direction, field, mtf50] = ["at_px", "direction", "field_percent", "mtf50_cycles_per_px"].map(column);
    let of_row = |row: &Vec<Cell>| match (&row[at], &row[direction], &row[field], &row[mtf50]) {
        (Cell::Text(at), Cell::Text(direction), Cell::Number(field_percent, _), Cell::Estimate(e)) => {
            Some(EdgeResult {
                position_and_direction: [at.clone(), direction.clone()],
                field_percent: *field_percent,
                mtf50: Estimate { value: e.value, uncertainty: e.standard_uncertainty },
            })
        }
        _ => None,
    };
    table.rows.iter().filter_map(of_row).collect()
}

/// Means of two captures over the edges that both contain, with weights of both, so that an edge missing in one affects neither.
fn means_of_common_edges(without: &[EdgeResult], with: &[EdgeResult]) -> [Mtf50; 2] {
    let pair = |edge: &EdgeResult| {
        with.iter()
            .find(|other| other.position_and_direction == edge.position_and_direction)
            .map(|other| [edge.clone(), other.clone()])
    };
    let pairs: Vec<[EdgeResult; 2]> = without.iter().filter_map(pair).collect();
    let mean = |is_in: &dyn Fn(f64) -> bool| {
        let inside = pairs.iter().filter(|[edge, _]| is_in(edge.field_percent));
        weighted_means(inside.map(|pair| pair.clone().map(|edge| edge.mtf50)))
    };
    let (middle, far_field) = (mean(&|field| field <= MIDDLE_PERCENT), mean(&|field| field >= FAR_PERCENT));
    [0, 1].map(|i| Mtf50 { middle: middle.map(|pair| pair[i]), far: far_field.map(|pair| pair[i]) })
}

/// Means of pairs, each weighted by the combined uncertainty of both; `None` without pairs.
fn weighted_means(pairs: impl Iterator<Item = [Estimate; 2]>) -> Option<[Estimate; 2]> {
    let (mut weighted, mut variances, mut total_weight) = ([0.0; 2], [0.0; 2], 0.0);
    for pair in pairs {
        let both: f64 = pair.iter().map(|e| e.uncertainty * e.uncertainty).sum();
        let is_known = both.is_finite() && pair.iter().all(|e| e.value.is_finite());
        let weight = if is_known { 1.0 / both.max(MIN_VARIANCE) } else { continue };
        total_weight += weight;
        for (i, e) in pair.iter().enumerate() {
            weighted[i] += weight * e.value;
            variances[i] += weight * weight * e.uncertainty * e.uncertainty;
        }
    }
    let mean =
        |i: usize| Estimate { value: weighted[i] / total_weight, uncertainty: variances[i].sqrt() / total_weight };
    (total_weight > 0.0).then(|| [0, 1].map(mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64, uncertainty: f64) -> Estimate {
        Estimate { value, uncertainty }
    }

    #[test]
    fn edges_that_are_badly_known_weigh_little() {
        let exact = estimate(0.5, 0.0);
        let pairs = [
            [estimate(0.3, 0.01), exact],
            [estimate(0.4, 0.02), exact],
            [estimate(9.0, f64::INFINITY), exact],
            [exact, estimate(1.0, f64::NAN)],
        ];
        let [mean, other] = weighted_means(pairs.into_iter()).expect("known");
        assert!(
            (mean.value - 0.32).abs() < 1e-12 && (mean.uncertainty - 0.01 * 0.8_f64.sqrt()).abs() < 1e-12,
            "{mean:?}"
        );
        assert!((other.value - 0.5).abs() < 1e-12 && other.uncertainty == 0.0, "{other:?}");
        assert_eq!(weighted_means([].into_iter()), None);
        assert_eq!(weighted_means([[estimate(1.0, f64::INFINITY); 2]].into_iter()), None);
    }

    #[test]
    fn an_edge_that_one_photograph_does_not_know_moves_no_mean() {
        let edge = |at: &str, field_percent, value| EdgeResult {
            position_and_direction: [at.to_owned(), "horizontal".to_owned()],
            field_percent,
            mtf50: estimate(value, 0.01),
        };
        let without = [edge("1,1", 10.0, 0.3), edge("2,1", 20.0, 0.9), edge("9,9", 80.0, 0.2)];
        let with = [edge("9,9", 80.0, 0.25), edge("1,1", 10.0, 0.4)];
        let [a, b] = means_of_common_edges(&without, &with);
        let value = |e: Option<Estimate>| e.expect("known").value;
        let actual = [value(a.middle), value(b.middle), value(a.far), value(b.far)];
        let all_near =
            actual.iter().zip([0.3, 0.4, 0.2, 0.25]).all(|(actual, expected)| (actual - expected).abs() < 1e-12);
        assert!(all_near, "{actual:?}");
        let [none, _] = means_of_common_edges(&without, &[]);
        assert_eq!(none, Mtf50 { middle: None, far: None });
    }
}
