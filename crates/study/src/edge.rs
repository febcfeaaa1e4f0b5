//! What a measurement of the contrast transfer sees of a change: slanted edges before the job's camera as it is and with the change (ISO 12233).

use crate::error::Estimate;
use crate::frame_render::FrameRenderer;
use etendue::chart::{ChartBeforeCamera, ChartRequest, design};
use etendue::measure::{SfrRequest, sfr};
use etendue::report::{Cell, Report, Table};
use etendue::{Error, RenderOptions};
use serde::Serialize;
use std::path::PathBuf;

/// Samples a pixel: flat sheets in even light have little noise of their own.
const SPP: u32 = 32;
/// Luminance of the ground over that of the squares.
const CONTRAST: f64 = 4.0;
/// By how much they are turned, degrees.
const ANGLE_DEG: f64 = 5.0;
/// What white reaches of the sensor's saturation: a change that makes the picture brighter shall not clip.
const WHITE: f64 = 0.3;
/// The field position, % of half the diagonal, up to which edges are of the middle, and from which on they are far out.
const MIDDLE_PERCENT: f64 = 30.0;
const FAR_PERCENT: f64 = 60.0;
/// Least distance of squares, px: 0.3 of it is the width of the part about an edge that is measured, 16 px at least.
const COLUMN_PX: usize = 72;
/// No edge is known better than this, (cycles a pixel)².
const LEAST_VARIANCE: f64 = 1e-8;

/// Spatial frequencies at which the response of edges falls to one half, cycles a pixel; means over the edges of a part of the field, weighed by what is known of each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Mtf50 {
    /// Up to 30 % of half the picture's diagonal from its middle; `None`: no edge there has one.
    pub middle: Option<Estimate>,
    /// From 60 % on; `None`: no edge there has one.
    pub far: Option<Estimate>,
}

/// A chart of edges before a job's camera, and what is measured of it as the job says. Its folder goes when this does.
pub(crate) struct EdgeChart<'a> {
    renderer: &'a FrameRenderer<'a>,
    chart: ChartBeforeCamera,
    /// Held for its end alone.
    _folder: Folder,
    stated: Mtf50,
}

/// A folder that was made here.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left of it does no harm.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl<'a> EdgeChart<'a> {
    /// Where the contrast transfer was asked for: the chart, photographed once.
    ///
    /// # Errors
    /// Where the folder is there already or cannot be written, the camera makes no picture of the chart, or no edge in it can be measured.
    pub(crate) fn open(renderer: &'a FrameRenderer<'a>) -> Result<Option<Self>, Error> {
        let Some(path) = &renderer.request.edges else { return Ok(None) };
        let parent = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let made = parent.and_then(|()| std::fs::create_dir(path));
        made.map_err(|error| Error::Run(format!("{}: {error}", path.display())))?;
        let folder = Folder(path.clone());
        let design = design::SlantedEdges { size: grid(renderer), angle_deg: ANGLE_DEG, contrast: CONTRAST };
        // The camera is the job's.
        let request = ChartRequest { white: WHITE, ..ChartRequest::new(design.into(), "") };
        let chart = ChartBeforeCamera::make(&request, (&renderer.own, &renderer.camera), path)?;
        let mut own = Self { renderer, chart, _folder: folder, stated: Mtf50::default() };
        own.stated = own.measure(&[])?;
        Ok(Some(own))
    }

    /// Without and with these changes of keys; `None` where the camera with them makes no picture of the chart in which edges can be measured.
    pub(crate) fn change(&self, set: &[String]) -> Result<Option<[Mtf50; 2]>, Error> {
        match self.measure(set) {
            Ok(changed) => Ok(Some([self.stated, changed])),
            Err(Error::Input(_)) => Ok(None),
            Err(other) => Err(other),
        }
    }

    fn measure(&self, set: &[String]) -> Result<Mtf50, Error> {
        let mut job = self.renderer.own.clone();
        job.set.extend(set.iter().cloned());
        let options = RenderOptions { simd: self.renderer.request.simd, ..RenderOptions::default() };
        let picture = self.chart.photograph(&job, SPP, &options, &self.renderer.quiet())?;
        let mut request = SfrRequest::new(picture);
        request.input.truth.truth = Some(self.chart.truth());
        Ok(of_report(&sfr(&request)?))
    }
}

/// Squares whose edges have the pixels that a measurement needs: five columns, fewer in a small picture.
fn grid(renderer: &FrameRenderer<'_>) -> design::GridSize {
    let plan = renderer.job.plan();
    let own = plan.cameras.iter().find(|camera| camera.name == renderer.camera);
    let columns = own.map(|camera| (camera.body.raster.width() / COLUMN_PX).clamp(1, 5) as u32);
    design::GridSize { columns, ..design::GridSize::default() }
}

/// Means over the edges of a report.
fn of_report(report: &Report) -> Mtf50 {
    let edges: Vec<(f64, Estimate)> = report.tables().filter(|table| table.key == "edges").flat_map(of_table).collect();
    let mean = |is_in: &dyn Fn(f64) -> bool| {
        let inside = edges.iter().filter(|(field, _)| is_in(*field)).map(|(_, mtf50)| *mtf50);
        weighted_mean(inside)
    };
    Mtf50 { middle: mean(&|field| field <= MIDDLE_PERCENT), far: mean(&|field| field >= FAR_PERCENT) }
}

/// Weighed by what is known of each; `None` where nothing is.
fn weighted_mean(estimates: impl Iterator<Item = Estimate>) -> Option<Estimate> {
    let known = estimates.filter(|e| e.value.is_finite() && !e.uncertainty.is_nan());
    let (sum, weight) = known.fold((0.0, 0.0), |(sum, weight), e| {
        let own = 1.0 / (e.uncertainty * e.uncertainty).max(LEAST_VARIANCE);
        (sum + own * e.value, weight + own)
    });
    (weight > 0.0).then(|| Estimate { value: sum / weight, uncertainty: 1.0 / weight.sqrt() })
}

/// Field positions in per cent, and the frequencies there.
fn of_table(table: &Table) -> Vec<(f64, Estimate)> {
    let column = |key: &str| table.columns.iter().position(|(own, _)| *own == key);
    let Some((field, mtf50)) = column("field_percent").zip(column("mtf50_cycles_per_px")) else { return Vec::new() };
    let of_row = |row: &Vec<Cell>| match (&row[field], &row[mtf50]) {
        (Cell::Number(field, _), Cell::Estimate(e)) => {
            Some((*field, Estimate { value: e.value, uncertainty: e.standard_uncertainty }))
        }
        _ => None,
    };
    table.rows.iter().filter_map(of_row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_that_are_badly_known_weigh_little() {
        let of = |value, uncertainty| Estimate { value, uncertainty };
        let mean = weighted_mean([of(0.3, 0.01), of(0.4, 0.02), of(9.0, f64::INFINITY)].into_iter()).expect("known");
        assert!(
            (mean.value - 0.32).abs() < 1e-12 && (mean.uncertainty - 0.01 * 0.8_f64.sqrt()).abs() < 1e-12,
            "{mean:?}"
        );
        assert_eq!(weighted_mean([of(0.3, 0.01), of(0.4, f64::NAN)].into_iter()), Some(of(0.3, 0.01)));
        assert_eq!(weighted_mean(std::iter::empty()), None);
        assert_eq!(weighted_mean([of(1.0, f64::INFINITY)].into_iter()), None);
    }
}
