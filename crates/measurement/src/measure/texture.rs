//! `measure star` and `etendue measure texture`: fine structure.

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_arguments::point;
use etendue_charts::design::{DeadLeaves, SiemensStar};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::photograph::SourcedEncoding;
use etendue_metrology::texture::leaves::{TexturePoint, measure_texture};
use etendue_metrology::texture::{Star, StarPoint, measure_star};
use etendue_metrology::{Estimate, Image};

use super::encoding::EncodingChoice;
use super::pictures::{MeasurementInput, refused};
use super::readings::{Readings, Selection};
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure star`
#[derive(Args, Clone, Debug)]
pub struct StarRequest {
    /// Image of a Siemens star
    #[arg(value_name = "IMAGE")]
    pub picture: PathBuf,
    /// Centre of the star, raster coordinates, within two pixels
    #[arg(long, value_name = "X,Y", value_parser = point, required_unless_present = "truth", conflicts_with = "truth")]
    pub centre_px: Option<(f64, f64)>,
    /// Number of dark and bright cycles around the circle
    #[arg(long, value_name = "N", required_unless_present = "truth", conflicts_with = "truth")]
    pub cycles: Option<u32>,
    /// Radius of the smallest circle, px [with --truth: where the star has half a cycle per pixel, or begins]
    #[arg(long, value_name = "PX", required_unless_present = "truth", allow_negative_numbers = true)]
    pub inner_px: Option<f64>,
    /// Radius of the largest circle, px, where the response is set to 1 [with --truth: slightly inside the star's edge]
    #[arg(long, value_name = "PX", required_unless_present = "truth", allow_negative_numbers = true)]
    pub outer_px: Option<f64>,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl StarRequest {
    /// Creates a request with the program's defaults.
    pub fn new(image: impl Into<PathBuf>) -> Self {
        Self {
            picture: image.into(),
            centre_px: None,
            cycles: None,
            inner_px: None,
            outer_px: None,
            input: MeasurementInput::default(),
        }
    }
}

/// `etendue measure texture`
#[derive(Args, Clone, Debug)]
pub struct TextureRequest {
    /// Image of a texture such as dead leaves
    #[arg(value_name = "IMAGE")]
    pub picture: PathBuf,
    /// The texture itself at the same position, pixel by pixel: a sharp render without noise (radiance.exr of --set
    /// output.radiance=true)
    #[arg(value_name = "REFERENCE")]
    pub reference: PathBuf,
    /// Image of a uniform surface of the same brightness, for the noise
    #[arg(long, value_name = "IMAGE")]
    pub even: Option<PathBuf>,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl TextureRequest {
    /// Creates a request with the program's defaults.
    pub fn new(image: impl Into<PathBuf>, reference: impl Into<PathBuf>) -> Self {
        Self { picture: image.into(), reference: reference.into(), even: None, input: MeasurementInput::default() }
    }
}

/// Margin left out at a star's edge: a fraction of its radius, and at least this many pixels of blur.
const MARGIN_FRACTION: f64 = 0.03;
const MARGIN_PX: f64 = 2.0;

/// The star from the arguments or the chart's ground truth; its circles begin where half a cycle fills a pixel.
fn star_from_truth(request: &StarRequest, readings: &Readings) -> Result<Star, Error> {
    let levels = &request.input.levels;
    let (black, full_scale) = (levels.black(readings), levels.full_scale(readings));
    let needed =
        || Error::coded(ErrorCode::NotStated, "expected `centre_px`, `cycles`, `inner_px` and `outer_px`, or `truth`");
    // In units of readings, which are some pixels apart.
    let step = readings.period.0 as f64;
    let star = |(x, y): (f64, f64), cycles, inner_px: f64, outer_px: f64| {
        let centre_px = readings.place([x, y]).into();
        Star { centre_px, cycles, inner_px: inner_px / step, outer_px: outer_px / step, black, full_scale }
    };
    let Some(truth) = request.input.truth(&[SiemensStar::NAME], &request.picture, readings)? else {
        let circles = request.inner_px.zip(request.outer_px);
        let (inner_px, outer_px) = circles.ok_or_else(needed)?;
        let (centre_px, cycles) = request.centre_px.zip(request.cycles).ok_or_else(needed)?;
        return Ok(star(centre_px, cycles, inner_px, outer_px));
    };
    let visible = truth.star()?;
    let nyquist_px = step * f64::from(visible.cycles) / core::f64::consts::PI;
    let outer_px = request.outer_px.unwrap_or(visible.outer_px - MARGIN_PX.max(MARGIN_FRACTION * visible.outer_px));
    let inner_px = request.inner_px.unwrap_or((visible.inner_px + MARGIN_PX).max(nyquist_px));
    if inner_px + 2.0 > outer_px {
        let coarse = f64::from(visible.cycles) / (core::f64::consts::TAU * outer_px);
        return Err(refused(
            &request.picture,
            format!(
                "the star is too small: its outer circle has {coarse:.2} cycles per pixel, but at most {:.2} can be measured; use a star of fewer cycles",
                0.5 / step
            ),
        ));
    }
    Ok(star(visible.centre_px.into(), visible.cycles, inner_px, outer_px))
}

/// A Siemens star: response over frequency (ISO 12233).
///
/// # Errors
/// If the image contains no such star.
pub fn star(request: &StarRequest) -> Result<Report, Error> {
    let readings = request.input.linear(&request.picture)?;
    readings.independent(&request.picture, 1)?;
    let star = star_from_truth(request, &readings)?;
    let named = |error| refused(&request.picture, error);
    let (points, (x, y)) = measure_star(&readings.image, &star).map_err(named)?;
    let step = readings.period.0 as f64;
    let to_picture = |at: f64, first: usize| (at - 0.5) * step + first as f64 + 0.5;
    let (x, y) = (to_picture(x, readings.first.0), to_picture(y, readings.first.1));
    let mut report =
        Report::new("star", "Siemens star after ISO 12233, over its outer circle (± one standard uncertainty)");
    report.encoding(&readings.stated);
    let levels = &request.input.levels;
    report.note_cut(&request.picture.display().to_string(), &readings.image, levels.full_scale(&readings));
    report.figure("centre_x_px", "centre, x", "px", Estimate::new(x, 0.01 * step));
    report.figure("centre_y_px", "centre, y", "px", Estimate::new(y, 0.01 * step));
    let row = |p: &StarPoint| {
        vec![Cell::Number(p.radius_px * step, 1), Cell::Number(p.frequency / step, 4), Cell::Estimate(p.response)]
    };
    report.table(Table {
        key: "circles",
        columns: vec![("radius_px", "radius px"), ("cycles_per_px", "c/px"), ("response", "response")],
        rows: points.iter().map(row).collect(),
    });
    let curve = points.iter().map(|p| (p.frequency / step, p.response.value, 2.0 * p.response.standard_uncertainty));
    report.plot(response_plot("response of the star (bars: 95 %)", vec![Series::with_errors("", Mark::Line, curve)]));
    Ok(report)
}

fn response_plot(title: &str, series: Vec<Series>) -> Plot {
    Plot {
        title: title.to_owned(),
        x: Axis::linear("cycles per pixel").showing(&[0.0]),
        y: Axis::linear("response").showing(&[0.0, 1.0]),
        series,
    }
}

/// An image of the leaves, its saturation level, and the conversion from its numbers to light.
struct LeavesImage {
    image: Image,
    full_scale: Option<f64>,
    stated: SourcedEncoding,
}

/// An image of the leaves, cropped to them if the chart's ground truth gives their position.
fn leaves(input: &MeasurementInput, readings: Readings, file: &Path) -> Result<LeavesImage, Error> {
    readings.independent(file, 1)?;
    let (full_scale, stated) = (input.levels.full_scale(&readings), readings.stated.clone());
    let image = match input.truth(&[DeadLeaves::NAME], file, &readings)? {
        Some(truth) => readings
            .part(truth.patches(&readings)?.0[0].at, "`truth`: the leaves")
            .map_err(|error| error.with_field("truth"))?,
        None => readings.image,
    };
    Ok(LeavesImage { image, full_scale, stated })
}

/// Compares a texture such as dead leaves with its reference: response, invented structure, coherence.
///
/// # Errors
/// If the images differ in size or cannot be used.
pub fn texture(request: &TextureRequest) -> Result<Report, Error> {
    let input = &request.input;
    input.check_without_black()?;
    let read = |file: &Path| leaves(input, input.linear(file)?, file);
    let image = read(&request.picture)?;
    // The reference is another kind of image with its own encoding.
    let own = Selection { encoding: EncodingChoice::default(), ..input.selection.clone() };
    let reference = leaves(input, own.linear(&request.reference)?, &request.reference)?;
    let uniform = request.even.as_ref().map(|file| read(file)).transpose()?;
    let points = measure_texture(&image.image, &reference.image, uniform.as_ref().map(|e| &e.image), image.full_scale);
    let result = points.map_err(|error| refused(&request.picture, error))?;
    let points = result.points;
    let mut report =
        Report::new("texture", "response to a texture relative to its reference (± one standard uncertainty)");
    [&image.stated, &reference.stated].into_iter().for_each(|stated| report.encoding(stated));
    report.note_cut(&request.picture.display().to_string(), &image.image, image.full_scale);
    report.fact("shift_x_px", "shift of the image to the right of the reference, removed", "px", result.shift_px[0]);
    report.fact("shift_y_px", "shift of the image below the reference, removed", "px", result.shift_px[1]);
    if uniform.is_none() {
        report.note("without `even`, noise counts as structure in 'direct'");
    }
    let row = |p: &TexturePoint| {
        vec![
            Cell::Number(p.frequency, 4),
            Cell::Estimate(p.response),
            Cell::Number(p.direct, 4),
            Cell::Number(p.coherence, 4),
        ]
    };
    report.table(Table {
        key: "bands",
        columns: vec![
            ("cycles_per_px", "c/px"),
            ("response", "response"),
            ("direct", "direct"),
            ("coherence", "coherence"),
        ],
        rows: points.iter().map(row).collect(),
    });
    let plotted = points.iter().map(|p| (p.frequency, p.response.value, 2.0 * p.response.standard_uncertainty));
    report.plot(response_plot(
        "response to texture (bars: 95 %)",
        vec![
            Series::with_errors("kept", Mark::Line, plotted),
            Series::new("structure of any kind", Mark::Broken, points.iter().map(|p| (p.frequency, p.direct))),
        ],
    ));
    Ok(report)
}
