//! `measure colour`: the colours of a ColorChecker after a fitted matrix.

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_arguments::place;
use etendue_charts::design::ColorChecker;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Estimate;
use etendue_metrology::colour::{ColourError, ColourPatch, measure_colour};
use etendue_spectra::{colour, illuminant, observer, reflectance::colorchecker};
use glam::DVec2;

use super::pictures::{MeasurementInput, refused};
use super::{readings::Readings, truth::Truth, truth::place::PatchPlace};
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure colour`
#[derive(Args, Clone, Debug)]
pub struct ColourRequest {
    /// Colour image of a ColorChecker with 24 patches
    #[arg(value_name = "IMAGE")]
    pub picture: PathBuf,
    /// Centres of the four corner patches, raster coordinates, in the chart's order: dark skin, bluish green, black, white
    #[arg(long, value_name = "X,Y", num_args = 4, value_parser = corner, required_unless_present = "truth", conflicts_with = "truth")]
    pub corners: Vec<DVec2>,
    /// Side of the measured squares, as a fraction of the patch spacing
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = 0.5,
        conflicts_with = "truth",
        allow_negative_numbers = true
    )]
    pub patch: f64,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

fn corner(text: &str) -> Result<DVec2, String> {
    place(text).map(DVec2::from)
}

impl ColourRequest {
    /// Creates a request with the program's defaults.
    pub fn new(image: impl Into<PathBuf>) -> Self {
        Self { picture: image.into(), corners: Vec::new(), patch: 0.5, input: MeasurementInput::default() }
    }
}

/// Columns and rows of the chart.
const CHART: (usize, usize) = (6, 4);

/// Colours of a ColorChecker after a fitted matrix, CIEDE2000.
///
/// # Errors
/// If the image is not in colour or its patches cannot be used.
pub fn colour(request: &ColourRequest) -> Result<Report, Error> {
    Ok(measured(request)?.0)
}

/// The patches of a chart in the camera's colours.
pub(crate) struct MeasuredPatches {
    pub(crate) patches: Vec<ColourPatch>,
    pub(crate) black: f64,
    pub(crate) full_scale: Option<f64>,
    pub(crate) shared_px: usize,
    /// XYZ of the chart's light.
    pub(crate) white_xyz: [f64; 3],
}

/// The report, and its inputs.
pub(crate) fn measured(request: &ColourRequest) -> Result<(Report, MeasuredPatches), Error> {
    let Some(colours) = request.input.selection.colours(&request.picture)? else {
        let expected = "expected a colour image: channels R, G and B, or a raw mosaic of them";
        return Err(refused(&request.picture, expected));
    };
    let (patches, white_xyz) = match request.input.truth(&[ColorChecker::NAME], &request.picture, &colours[1])? {
        Some(truth) => (patches_from_truth(&truth, &request.picture, &colours)?, truth.white_xyz()),
        None => (between_corners(request, &colours)?, colour::D65_WHITE),
    };
    let levels = &request.input.levels;
    let (black, full_scale) = (levels.black(&colours[1]), levels.full_scale(&colours[1]));
    let shared_px = colours[1].shared_px;
    let result = measure_colour(&patches, black, full_scale, white_xyz, shared_px);
    let result = result.map_err(|error| refused(&request.picture, error))?;
    let mut report = report(&patches, &result);
    report.encoding(&colours[1].stated);
    for patch in &patches {
        for (channel, name) in patch.pixels.iter().zip(["red", "green", "blue"]) {
            report.note_cut(&format!("{}, {name}", patch.name.replace('_', " ")), channel, full_scale);
        }
    }
    Ok((report, MeasuredPatches { patches, black, full_scale, shared_px, white_xyz }))
}

/// The patches that a chart's ground truth locates and describes, in its own light.
fn patches_from_truth(truth: &Truth, image: &Path, colours: &[Readings; 3]) -> Result<Vec<ColourPatch>, Error> {
    let lists: Vec<Vec<PatchPlace>> =
        colours.iter().map(|one| Ok(truth.patches(one)?.0)).collect::<Result<_, Error>>()?;
    // Green rises with luminance.
    truth.shown(image, &lists[1], &colours[1])?;
    let one = |patch: &PatchPlace| {
        let pixels = |c: usize| {
            let place = lists[c].iter().find(|other| other.name == patch.name)?;
            colours[c].part(place.at, &patch.name).ok()
        };
        let pixels = [pixels(0)?, pixels(1)?, pixels(2)?];
        Some(ColourPatch { name: patch.name.clone(), pixels, reference: patch.xyz })
    };
    Ok(lists[1].iter().filter_map(one).collect())
}

fn between_corners(request: &ColourRequest, colours: &[Readings; 3]) -> Result<Vec<ColourPatch>, Error> {
    if !(request.patch > 0.0 && request.patch <= 1.0) {
        return Err(Error::argument("patch", "`patch`: expected a fraction above 0 and at most 1")
            .with_code(ErrorCode::OutOfRange));
    }
    let [a, b, c, d] = request.corners[..] else {
        return Err(Error::argument("corners", "`corners`: expected four of them").with_code(ErrorCode::WrongCount));
    };
    let (columns, rows) = ((CHART.0 - 1) as f64, (CHART.1 - 1) as f64);
    // Bilinear between the corners: exact if the chart is parallel to the sensor, otherwise approximate.
    let middle = |i: usize| {
        let (u, v) = ((i % CHART.0) as f64 / columns, (i / CHART.0) as f64 / rows);
        (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v
    };
    let half = 0.5 * request.patch * ((b - a).length() / columns).min((d - a).length() / rows);
    let patch = |(i, patch): (usize, &etendue_spectra::reflectance::Patch)| {
        let (low, high) = (middle(i) - half, middle(i) + half);
        let outside =
            || Error::argument("corners", "`corners`: a patch is outside the image").with_code(ErrorCode::OutOfRange);
        let at = super::readings::pixels(low.into(), high.into(), colours[1].picture_px.0, colours[1].picture_px.1)
            .ok_or_else(outside)?;
        let one = |c: usize| colours[c].part(at, "`corners`: a patch").map_err(|error| error.with_field("corners"));
        let reference = observer::xyz_of_reflectance(&patch.reflectance, illuminant::d65());
        Ok(ColourPatch { name: patch.name.to_owned(), pixels: [one(0)?, one(1)?, one(2)?], reference })
    };
    colorchecker().iter().enumerate().map(patch).collect()
}

fn report(patches: &[ColourPatch], result: &ColourError) -> Report {
    let method = "ColorChecker after a fitted 3 × 3 matrix, CIEDE2000 (± one standard uncertainty)";
    let mut report = Report::new("colour", method);
    report.figure("mean_delta_e00", "mean ΔE00", "", result.mean);
    report.fact("largest_delta_e00", "largest ΔE00", "", result.largest);
    let number = |x: f64| Cell::Number(x, 2);
    let row = |((patch, difference), [measured, reference]): ((&ColourPatch, &Estimate), &[[f64; 3]; 2])| {
        let lab = measured.iter().chain(reference).map(|x| number(*x));
        [Cell::Text(patch.name.replace('_', " ")), Cell::Estimate(*difference)].into_iter().chain(lab).collect()
    };
    report.table(Table {
        key: "patches",
        columns: vec![
            ("patch", "patch"),
            ("delta_e00", "ΔE00"),
            ("l", "L*"),
            ("a", "a*"),
            ("b", "b*"),
            ("reference_l", "true L*"),
            ("reference_a", "true a*"),
            ("reference_b", "true b*"),
        ],
        rows: patches.iter().zip(&result.differences).zip(&result.colours).map(row).collect(),
    });
    let to = ["X", "Y", "Z"];
    report.table(Table {
        key: "matrix",
        columns: vec![("to", "XYZ ="), ("red", "red"), ("green", "green"), ("blue", "blue")],
        rows: to
            .iter()
            .zip(result.matrix)
            .map(|(name, row)| {
                let cells = row.map(|m| Cell::Estimate(Estimate::new(m, 0.0)));
                std::iter::once(Cell::Text((*name).to_owned())).chain(cells).collect()
            })
            .collect(),
    });
    report.plot(plot(result));
    report
}

/// Red-green and yellow-blue coordinates of the patches: references, and values from the matrix.
fn plot(result: &ColourError) -> Plot {
    let places = |name: &str, which: usize| {
        Series::new(name, Mark::Points, result.colours.iter().map(move |pair| (pair[which][1], pair[which][2])))
    };
    Plot {
        title: "colours of the patches".to_owned(),
        x: Axis::linear("a*"),
        y: Axis::linear("b*"),
        series: vec![places("true", 1), places("measured", 0)],
    }
}
