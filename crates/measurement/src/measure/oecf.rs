//! `measure oecf`: the tone curve from a series of exposures, or from steps in one image.

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_charts::design::{Backlit, FlatField, OecfSteps};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::photograph::{Encoding, SourcedEncoding};
use etendue_metrology::oecf::response::{Response, ResponseSettings, camera_response};
use etendue_metrology::oecf::{ExposurePoint, Oecf};
use etendue_metrology::{Estimate, Image};

use super::pictures::{Clipping, MeasurementInput, refused};
use super::readings::{Readings, SignalLevels};
use super::truth::Truth;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure oecf`
#[derive(Args, Clone, Debug)]
pub struct OecfRequest {
    /// Images of one uniform surface, one per exposure; with --steps, or the --truth of a chart of steps, one image
    #[arg(value_name = "IMAGE", required = true)]
    pub pictures: Vec<PathBuf>,
    /// Exposure of each image in order, any unit [default: the side-cars' exposure_s]
    #[arg(long, value_name = "H,…", value_delimiter = ',', conflicts_with_all = ["steps", "truth"], allow_negative_numbers = true)]
    pub exposures: Vec<f64>,
    /// Table of steps in the image: x, y, width, height, luminance; one step per line, # for comments
    #[arg(long, value_name = "STEPS.csv", conflicts_with = "truth")]
    pub steps: Option<PathBuf>,
    /// Find the camera's response from images of one non-uniform scene at relatively known exposures
    #[arg(long, conflicts_with_all = ["steps", "truth"])]
    pub response: bool,
    /// With --response: find the ratios of the exposures too
    #[arg(long, requires = "response")]
    pub refine: bool,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl OecfRequest {
    /// Creates a request with the program's defaults.
    pub fn new(images: Vec<PathBuf>) -> Self {
        Self {
            pictures: images,
            exposures: Vec::new(),
            steps: None,
            response: false,
            refine: false,
            input: MeasurementInput::default(),
        }
    }
}

/// Maximum degree of a response.
const MAX_DEGREE: usize = 8;

/// The tone curve from a series of exposures or from steps (ISO 14524); the camera's response from a scene at relatively known
/// exposures.
///
/// # Errors
/// If the images or their exposures cannot be used.
pub fn oecf(request: &OecfRequest) -> Result<Report, Error> {
    if request.response {
        return response(request);
    }
    let truth = request.input.truth.read(&CHARTS)?;
    let measured = match (&request.steps, &truth) {
        (Some(table), _) => steps(request, table)?,
        (None, Some(truth)) if UNIFORM_CHARTS.contains(&truth.chart()) => shots(request, truth)?,
        (None, Some(truth)) => patches(request, truth)?,
        (None, None) => exposures(request)?,
    };
    let oecf = Oecf::new(measured.points.clone()).map_err(|error| refused(&request.pictures[0], error))?;
    let mut report = report(&oecf, &measured);
    // Saturated points end the curve; black ones count as readings.
    for (point, cut) in measured.points.iter().zip(&measured.clippings) {
        if let Some(cut @ (Clipping::Black { .. } | Clipping::Throughout { reading: ..=0.0 })) = cut {
            let (exposure, unit) = (point.exposure, measured.unit);
            report.note(format!("exposure {exposure} {unit}: {}; its point does not account for it", cut.words()));
        }
    }
    measured.left_out.iter().for_each(|name| report.note(format!("omitted: {name} is not entirely in the image")));
    if let Some(channel) = &request.input.selection.channel {
        report.setting("channel", channel.clone());
    }
    Ok(report)
}

/// Charts of one uniform surface, and of steps.
const UNIFORM_CHARTS: [&str; 2] = [FlatField::NAME, Backlit::NAME];
const CHARTS: [&str; 3] = [OecfSteps::NAME, FlatField::NAME, Backlit::NAME];

/// Points of the curve, the reading without light, the unit of the exposures, and patches that are not visible.
struct OecfInput {
    points: Vec<ExposurePoint>,
    /// Kind of readings, and those without light and at saturation.
    readings: &'static str,
    black: f64,
    full_scale: Option<f64>,
    unit: &'static str,
    left_out: Vec<String>,
    encoding: SourcedEncoding,
    /// Clipping of the readings of each point.
    clippings: Vec<Option<Clipping>>,
}

impl OecfInput {
    fn new(measured: Vec<(ExposurePoint, Option<Clipping>)>, levels: &SignalLevels, readings: &Readings) -> Self {
        let (points, cuts) = measured.into_iter().unzip();
        let (black, full_scale) = (levels.black(readings), levels.full_scale(readings));
        let encoding = readings.stated.clone();
        Self {
            points,
            readings: kind(readings),
            black,
            full_scale,
            unit: "",
            left_out: Vec::new(),
            encoding,
            clippings: cuts,
        }
    }
}

/// Returns the point of an exposure of a uniform surface, and the clipping of its readings.
fn point(
    exposure: f64,
    surface: &Image,
    levels: &SignalLevels,
    readings: &Readings,
) -> (ExposurePoint, Option<Clipping>) {
    let full_scale = levels.full_scale(readings);
    (
        ExposurePoint::from_surface(exposure, surface, full_scale, readings.shared_px),
        Clipping::from_region(surface, full_scale),
    )
}

/// Kind of readings: decoded ones no longer reflect the tone curve of the file.
fn kind(readings: &Readings) -> &'static str {
    if readings.stated.encoding == Encoding::Linear { readings.kind() } else { "decoded" }
}

/// Images with their exposures.
fn series(request: &OecfRequest) -> Result<Vec<(f64, Readings)>, Error> {
    let count = (request.pictures.len(), request.exposures.len());
    if count.1 > 0 && count.0 != count.1 {
        let message = format!("`exposures`: expected one per image ({}), not {}", count.0, count.1);
        return Err(Error::argument("exposures", message));
    }
    let stated_exposure = |i: usize, file: &Path| match request.exposures.get(i) {
        Some(exposure) => Ok(*exposure),
        None => exposure_of_file(file),
    };
    let one = |(i, file): (usize, &PathBuf)| Ok((stated_exposure(i, file)?, request.input.selection.stored(file)?));
    let series = request.pictures.iter().enumerate().map(one).collect::<Result<Vec<_>, Error>>()?;
    let size = |r: &Readings| (r.image.width(), r.image.height());
    if let Some(other) = series.iter().position(|(_, r)| size(r) != size(&series[0].1)) {
        let (a, b) = (size(&series[other].1), size(&series[0].1));
        let file = request.pictures[other].display();
        return Err(Error::coded(
            ErrorCode::NotComparable,
            format!("{file}: {} × {} pixels, but the first image has {} × {}", a.0, a.1, b.0, b.1),
        ));
    }
    copies(request, &series)?;
    Ok(series)
}

/// Refuses the same image given twice: two noisy images that are equal pixel by pixel.
fn copies(request: &OecfRequest, series: &[(f64, Readings)]) -> Result<(), Error> {
    let noisy = |image: &Image| image.samples().iter().any(|s| *s != image.samples()[0]);
    for (i, (_, a)) in series.iter().enumerate() {
        if let Some(j) = (0..i).find(|j| series[*j].1.image == a.image && noisy(&a.image)) {
            let (a, b) = (request.pictures[j].display(), request.pictures[i].display());
            return Err(Error::coded(
                ErrorCode::NotComparable,
                format!("{a} and {b} are copies; give one image per exposure"),
            ));
        }
    }
    Ok(())
}

fn exposure_of_file(file: &Path) -> Result<f64, Error> {
    let photograph = etendue_io::photograph::read_photograph(file).map_err(Error::input)?;
    let missing = || {
        Error::coded(ErrorCode::NotStated, format!("{}: its exposure is not known; give `exposures`", file.display()))
    };
    photograph.raw.map(|facts| facts.exposure_s).ok_or_else(missing)
}

fn exposures(request: &OecfRequest) -> Result<OecfInput, Error> {
    let series = series(request)?;
    let levels = &request.input.levels;
    let points = series.iter().map(|(exposure, readings)| point(*exposure, &readings.image, levels, readings));
    Ok(OecfInput::new(points.collect(), levels, &series[0].1))
}

/// The centre of a uniform chart at its cameras' exposures; each image is in the folder of its camera.
fn shots(request: &OecfRequest, truth: &Truth) -> Result<OecfInput, Error> {
    if request.input.truth.camera.is_some() {
        return Err(Error::argument(
            "camera",
            "`camera`: has no effect on a series, as each image's folder names its camera; leave it out",
        )
        .with_code(ErrorCode::NoEffect));
    }
    let exposures = truth.exposures()?;
    let mut series = Vec::new();
    for file in &request.pictures {
        let folder = file.parent().and_then(Path::file_name).and_then(|name| name.to_str()).unwrap_or_default();
        let known = exposures.iter().find(|(name, _)| *name == folder).map(|(_, exposure)| *exposure);
        let names = || exposures.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        let unknown_camera =
            || refused(file, format!("is in the folder '{folder}', which is not one of the cameras {}", names()));
        let exposure = known.ok_or_else(unknown_camera)?;
        let readings = request.input.selection.stored(file)?;
        truth.fits(file, &readings)?;
        series.push((exposure, readings));
    }
    copies(request, &series)?;
    let levels = &request.input.levels;
    let middle_point = |(exposure, readings): &(f64, Readings)| {
        let middle = readings.part_of("truth", truth.middle(readings)?)?;
        Ok(point(*exposure, &middle, levels, readings))
    };
    let points = series.iter().map(middle_point).collect::<Result<Vec<_>, Error>>()?;
    Ok(OecfInput { unit: "cd s/m²", ..OecfInput::new(points, levels, &series[0].1) })
}

fn only_image<'a>(request: &'a OecfRequest, field: &str) -> Result<&'a Path, Error> {
    match &request.pictures[..] {
        [image] => Ok(image),
        more => Err(Error::argument(
            field,
            format!("`{field}`: expected one image that contains all steps, not {}", more.len()),
        )),
    }
}

/// The steps of a chart.
fn patches(request: &OecfRequest, truth: &Truth) -> Result<OecfInput, Error> {
    let image = only_image(request, "truth")?;
    let readings = request.input.selection.stored(image)?;
    truth.fits(image, &readings)?;
    let (patches, left_out) = truth.patches(&readings)?;
    truth.shown(image, &patches, &readings)?;
    let levels = &request.input.levels;
    let patch_point = |patch: &super::truth::place::PatchPlace| {
        let surface = readings.part(patch.at, &patch.name)?;
        Ok(point(patch.luminance_cd_m2, &surface, levels, &readings))
    };
    let points = patches.iter().map(patch_point).collect::<Result<Vec<_>, Error>>()?;
    Ok(OecfInput { unit: "cd/m²", left_out, ..OecfInput::new(points, levels, &readings) })
}

fn steps(request: &OecfRequest, table: &Path) -> Result<OecfInput, Error> {
    let image = only_image(request, "steps")?;
    let readings = request.input.selection.stored(image)?;
    let text = etendue_io::source::text_of(table)?;
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && !line.trim().starts_with('#'));
    let step = |(number, line): (u32, &str)| {
        let place = format!("{}: line {number}", table.display());
        let expected = || {
            Error::coded(
                ErrorCode::MalformedFile,
                format!("{place}: expected x, y, width, height, luminance, not '{line}'"),
            )
        };
        let words: Option<Vec<f64>> = line.split(',').map(|word| word.trim().parse().ok()).collect();
        let [x, y, width, height, luminance] = words.ok_or_else(expected)?[..] else { return Err(expected()) };
        let region = [x, y, width, height];
        if region.iter().any(|v| *v < 0.0 || v.fract() != 0.0) || width < 2.0 || height < 2.0 {
            return Err(Error::coded(
                ErrorCode::MalformedFile,
                format!("{place}: expected whole pixels, two or more wide and high, not '{line}'"),
            ));
        }
        let surface = readings.part(region.map(|v| v as usize), &place)?;
        Ok(point(luminance, &surface, &request.input.levels, &readings))
    };
    Ok(OecfInput::new(lines.map(step).collect::<Result<_, _>>()?, &request.input.levels, &readings))
}

fn report(oecf: &Oecf, measured: &OecfInput) -> Report {
    let mut report =
        Report::new("oecf", "opto-electronic conversion function after ISO 14524 (± one standard uncertainty)");
    report.encoding(&measured.encoding);
    report.setting("readings", measured.readings.to_owned());
    report.setting("exposure_unit", measured.unit.to_owned());
    if let Some(full_scale) = measured.full_scale {
        report.fact("full_scale", "largest reading", "", full_scale);
    }
    let line = oecf.linearity(measured.black);
    if let Some(line) = &line {
        report.fact("slope", "slope of the straight line", "", line.slope);
        report.fact("offset", "offset of the straight line", "", line.offset);
        report.fact("linearity_error_percent", "largest deviation, 5 to 95 %", "%", 100.0 * line.largest);
    }
    if let Some(range) = oecf.dynamic_range() {
        report.fact("dynamic_range", "dynamic range (SNR 1 to saturation)", "", range);
    }
    match oecf.points().get(oecf.saturation()) {
        Some(point) => report.fact("saturation_exposure", "first saturated exposure", measured.unit, point.exposure),
        None => report.note("no exposure saturates: the dynamic range is a lower bound"),
    }
    let row = |(i, p): (usize, &ExposurePoint)| {
        let deviation = line.as_ref().map_or(Cell::Nothing, |line| Cell::Number(100.0 * line.deviations[i], 3));
        vec![
            Cell::Estimate(Estimate::new(p.exposure, 0.0)),
            Cell::Estimate(p.reading),
            p.noise.map_or(Cell::Nothing, |n| Cell::Number(n, 4)),
            Cell::Number(oecf.gain(p.exposure), 4),
            deviation,
        ]
    };
    report.table(Table {
        key: "points",
        columns: vec![
            ("exposure", if measured.unit == "cd/m²" { "luminance cd/m²" } else { "exposure" }),
            ("reading", "reading"),
            ("noise", "noise"),
            ("gain", "slope"),
            ("deviation_percent", "deviation %"),
        ],
        rows: oecf.points().iter().enumerate().map(row).collect(),
    });
    report.plot(plot(oecf, line.map(|l| (l.offset, l.slope)), measured.unit));
    report
}

fn plot(oecf: &Oecf, line: Option<(f64, f64)>, unit: &str) -> Plot {
    let exposure = if unit.is_empty() { "exposure".to_owned() } else { format!("exposure, {unit}") };
    let points = oecf.points();
    let (first, last) = (points[0].exposure, points[points.len() - 1].exposure);
    let at = |i: i32| first + (last - first) * f64::from(i) / 200.0;
    let measured = points.iter().map(|p| (p.exposure, p.reading.value, 2.0 * p.reading.standard_uncertainty));
    let mut series = vec![
        Series::with_errors("measured", Mark::Points, measured),
        Series::new("monotone cubic", Mark::Line, (0..=200).map(at).map(|h| (h, oecf.reading(h)))),
    ];
    if let Some((offset, slope)) = line {
        let top = points[points.len() - 1].reading.value;
        let end = ((top - offset) / slope).min(last);
        series.push(Series::new("straight line", Mark::Broken, [first, end].map(|h| (h, offset + slope * h))));
    }
    Plot {
        title: "tone curve".to_owned(),
        x: Axis::linear(&exposure).showing(&[0.0]),
        y: Axis::linear("reading").showing(&[0.0]),
        series,
    }
}

fn response(request: &OecfRequest) -> Result<Report, Error> {
    let series = series(request)?;
    let full_scale = request.input.levels.full_scale(&series[0].1);
    let full_scale = full_scale.ok_or_else(|| {
        Error::argument("full_scale", "`full_scale`: a response needs the reading of a saturated pixel")
            .with_code(ErrorCode::NotStated)
    })?;
    let settings = ResponseSettings {
        full_scale,
        black: request.input.levels.black(&series[0].1),
        degree: MAX_DEGREE,
        refine: request.refine,
    };
    let exposed_images: Vec<(f64, &Image)> = series.iter().map(|(exposure, r)| (*exposure, &r.image)).collect();
    let result = camera_response(&exposed_images, &settings).map_err(|error| refused(&request.pictures[0], error))?;
    let mut report = response_report(&result);
    report.encoding(&series[0].1.stated);
    Ok(report)
}

fn response_report(result: &Response) -> Report {
    let method =
        "camera response from relatively known exposures, after Mitsunaga and Nayar (± one standard uncertainty)";
    let mut report = Report::new("response", method);
    for (n, c) in result.coefficients.iter().enumerate().skip(1) {
        report.fact(&format!("c{n}"), &format!("coefficient of M^{n}"), "", *c);
    }
    report.fact("residual_percent", "noise of a reading, relative to full scale", "%", 100.0 * result.residual);
    let row = |i: i32| {
        let reading = f64::from(i) / 20.0;
        vec![Cell::Number(100.0 * reading, 0), Cell::Estimate(result.estimate(reading).scaled(100.0))]
    };
    report.table(Table {
        key: "response",
        columns: vec![("reading_percent", "reading %"), ("light_percent", "light %")],
        rows: (0..=20).map(row).collect(),
    });
    let ratios = result.ratios.iter().enumerate();
    report.table(Table {
        key: "exposures",
        columns: vec![("picture", "image"), ("ratio", "exposure relative to the first")],
        rows: ratios.map(|(i, r)| vec![Cell::Number(i as f64 + 1.0, 0), Cell::Number(*r, 5)]).collect(),
    });
    let curve = (0..=100).map(|i| f64::from(i) / 100.0).map(|m| (result.light(m), m));
    report.plot(Plot {
        title: "camera response".to_owned(),
        x: Axis::linear("light, relative to the largest"),
        y: Axis::linear("reading over full scale"),
        series: vec![Series::new("", Mark::Line, curve)],
    });
    report
}
