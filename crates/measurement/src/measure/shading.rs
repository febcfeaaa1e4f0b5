//! `measure vignetting` and `etendue measure shading`: a flat field.

use std::{ops::RangeInclusive, path::PathBuf};

use clap::Args;
use etendue_arguments::{in_range, point};
use etendue_charts::design::{Backlit, FlatField};
use etendue_io::failure::{Error, ErrorCode, check_integer};
use etendue_metrology::Estimate;
use etendue_metrology::shading::{
    ColourShading, Shading, ShadingError, ShadingSettings, colour_shading, measure_shading,
};
use glam::DVec2;

use super::pictures::{MeasurementInput, refused};
use super::readings::Readings;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// Image of a uniformly lit surface, and the centre of the fall-off.
#[derive(Args, Clone, Debug)]
pub struct FlatFieldRequest {
    /// Image of a uniformly lit surface
    #[arg(value_name = "IMAGE")]
    pub picture: PathBuf,
    /// Centre of the fall-off, raster coordinates [default: the image centre]
    #[arg(long, value_name = "X,Y", value_parser = point)]
    pub centre_px: Option<(f64, f64)>,
    /// Rings of the profile over the radial field position
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = in_range(RINGS))]
    pub rings: u32,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl FlatFieldRequest {
    /// Creates a request with the program's defaults.
    pub fn new(image: impl Into<PathBuf>) -> Self {
        Self { picture: image.into(), centre_px: None, rings: 20, input: MeasurementInput::default() }
    }
}

/// `etendue measure vignetting`
#[derive(Args, Clone, Debug)]
pub struct VignettingRequest {
    /// The image and its rings.
    #[command(flatten)]
    pub flat: FlatFieldRequest,
    /// True if the report includes the results as keys of a camera file.
    #[arg(skip)]
    pub camera_keys: bool,
    /// Pixel pitch, µm, for --camera-out
    #[arg(long, value_name = "UM", allow_negative_numbers = true, requires = "camera_keys", display_order = 16)]
    pub pixel_pitch_um: Option<f64>,
}

impl VignettingRequest {
    /// Creates a request with the program's defaults.
    pub fn new(flat: FlatFieldRequest) -> Self {
        Self { flat, camera_keys: false, pixel_pitch_um: None }
    }
}

/// `etendue measure shading`
#[derive(Args, Clone, Debug)]
pub struct ShadingRequest {
    /// The image and its rings.
    #[command(flatten)]
    pub flat: FlatFieldRequest,
    /// Blocks of the map along each side, an odd number
    #[arg(long, value_name = "N", default_value_t = DEFAULT_BLOCKS, value_parser = in_range(BLOCKS), display_order = 14)]
    pub blocks: u32,
}

impl ShadingRequest {
    /// Creates a request with the program's defaults.
    pub fn new(flat: FlatFieldRequest) -> Self {
        Self { flat, blocks: DEFAULT_BLOCKS }
    }
}

/// Blocks of the map along each side (ISO 17957).
const DEFAULT_BLOCKS: u32 = 11;
/// Allowed numbers of blocks of a map.
const BLOCKS: RangeInclusive<u32> = 1..=501;
/// Allowed numbers of rings of a profile.
const RINGS: RangeInclusive<u32> = 4..=1000;
/// Charts of one uniform surface.
const CHARTS: [&str; 2] = [FlatField::NAME, Backlit::NAME];

impl FlatFieldRequest {
    fn settings(&self, readings: &Readings, blocks: u32) -> ShadingSettings {
        ShadingSettings {
            black: self.input.levels.black(readings),
            full_scale: self.input.levels.full_scale(readings),
            // Position among the readings, which for a mosaic are those of one colour.
            centre_px: self.centre_px.map(|(x, y)| readings.place([x, y]).into()),
            rings: self.rings as usize,
            blocks: blocks as usize,
        }
    }

    fn refused(&self, error: &ShadingError) -> Error {
        refused(&self.picture, error)
    }

    /// Checks, if a chart's ground truth is given, that the chart is uniform and fills this image.
    fn check(&self, readings: &Readings) -> Result<(), Error> {
        self.input.truth(&CHARTS, &self.picture, readings)?.map_or(Ok(()), |truth| truth.filled())
    }

    fn measured(&self, blocks: u32, report: &mut Report) -> Result<(Shading, (f64, f64)), Error> {
        check_integer("rings", self.rings, RINGS)?;
        check_integer("blocks", blocks, BLOCKS)?;
        let readings = self.input.linear(&self.picture)?;
        readings.independent(&self.picture, 1)?;
        self.check(&readings)?;
        report.encoding(&readings.stated);
        report.note_cut(&self.picture.display().to_string(), &readings.image, self.input.levels.full_scale(&readings));
        let shading =
            measure_shading(&readings.image, &self.settings(&readings, blocks)).map_err(|e| self.refused(&e))?;
        let (columns, rows) = readings.picture_px;
        Ok((shading, (columns as f64, rows as f64)))
    }
}

impl VignettingRequest {
    fn pitch_um(&self) -> Result<Option<f64>, Error> {
        let needed = || {
            Error::argument(
                "camera_keys",
                "`camera_keys`: expected `pixel_pitch_um` above 0, because a lens states its fall-off in millimetres",
            )
            .with_code(ErrorCode::NotStated)
        };
        let pitch_um = self.pixel_pitch_um.filter(|p| *p > 0.0 && p.is_finite());
        if self.camera_keys { pitch_um.ok_or_else(needed).map(Some) } else { Ok(None) }
    }

    /// Relative illumination as a lens states it: radii, mm, and ratios.
    pub(crate) fn relative_illumination(&self, shading: &Shading, size_px: DVec2, pitch_um: f64) -> [Vec<f64>; 2] {
        let DVec2 { x: width, y: height } = size_px;
        let (x, y) = self.flat.centre_px.unwrap_or((0.5 * width, 0.5 * height));
        let (x, y) = (x.max(width - x), y.max(height - y));
        let corner_mm = (x * x + y * y).sqrt() * pitch_um / 1000.0;
        let steps = || (0..=20).map(|i| f64::from(i) / 20.0);
        // The last step is slightly beyond the corner, as the lens's table must reach it.
        let radii = steps().map(|p| p * corner_mm * (1.0 + 1e-6)).collect();
        [radii, steps().map(|p| shading.falloff(p).max(0.0)).collect()]
    }

    /// The same as keys of a camera file.
    fn camera(&self, shading: &Shading, size_px: DVec2, pitch_um: f64) -> String {
        let list = |values: Vec<f64>| values.iter().map(|v| format!("{v:.6}")).collect::<Vec<_>>().join(", ");
        let [radii, ratios] = self.relative_illumination(shading, size_px, pitch_um).map(list);
        format!(
            "# Measured relative illumination, corner ± {:.1e}: for [lens] of a camera file.\nformat = 1\n\n\
             [lens.relative_illumination]\nradius_mm = [{radii}]\nratio = [{ratios}]\n",
            shading.corner.standard_uncertainty
        )
    }
}

/// Fall-off of a flat field against the radial field position.
///
/// # Errors
/// If the image is not of a uniform surface that fills it.
pub fn vignetting(request: &VignettingRequest) -> Result<Report, Error> {
    Ok(falloff(request)?.0)
}

/// The same with the fall-off itself and the image's columns and rows.
pub(crate) fn falloff(request: &VignettingRequest) -> Result<(Report, Shading, (f64, f64)), Error> {
    let pitch_um = request.pitch_um()?;
    let mut report = Report::new(
        "vignetting",
        "relative illumination of a flat field over the radial field position (± one standard uncertainty)",
    );
    let (shading, size) = request.flat.measured(DEFAULT_BLOCKS, &mut report)?;
    report.figure("centre", "reading at the centre, above black", "", shading.centre);
    report.figure("corner_percent", "illumination at the corner", "%", shading.corner.scaled(100.0));
    let labels = [("a2", "a₂ of 1 + a₂ r² + a₄ r⁴ + a₆ r⁶ + a₈ r⁸"), ("a4", "a₄"), ("a6", "a₆"), ("a8", "a₈")];
    for ((key, label), value) in labels.into_iter().zip(shading.coefficients) {
        report.figure(key, label, "", value);
    }
    let percent = |e: Estimate| e.scaled(100.0);
    report.table(Table {
        key: "profile",
        columns: vec![("field_percent", "field %"), ("illumination_percent", "illumination %")],
        rows: shading
            .profile
            .iter()
            .map(|ring| vec![Cell::Number(100.0 * ring.position, 2), Cell::Estimate(percent(ring.relative))])
            .collect(),
    });
    report.plot(profile_plot(&[("", &shading)]));
    if let Some(pitch_um) = pitch_um {
        report.camera(request.camera(&shading, size.into(), pitch_um));
    }
    Ok((report, shading, size))
}

/// Fall-off of a flat field as a map, and its colour shading (ISO 17957).
///
/// # Errors
/// If the image is not of a uniform surface that fills it.
pub fn shading(request: &ShadingRequest) -> Result<Report, Error> {
    let method = "shading of a flat field after ISO 17957: blocks relative to the centre (± one standard uncertainty)";
    let mut report = Report::new("shading", method);
    let (flat, blocks) = (&request.flat, request.blocks);
    match flat.input.selection.colours(&flat.picture)? {
        Some(colours) => {
            colours[1].independent(&flat.picture, 1)?;
            flat.check(&colours[1])?;
            report.encoding(&colours[1].stated);
            let settings = flat.settings(&colours[1], blocks);
            let [red, green, blue] = &colours;
            for (channel, name) in colours.iter().zip(["red", "green", "blue"]) {
                let name = format!("{}, {name}", flat.picture.display());
                report.note_cut(&name, &channel.image, flat.input.levels.full_scale(channel));
            }
            let result = colour_shading([&red.image, &green.image, &blue.image], &settings);
            in_colour(&mut report, &result.map_err(|e| flat.refused(&e))?);
        }
        None => {
            let (result, _) = flat.measured(blocks, &mut report)?;
            extreme(&mut report, "illumination", "minimum illumination", &result.map);
            report.table(map("illumination_percent", &result.map));
            report.plot(profile_plot(&[("", &result)]));
        }
    }
    Ok(report)
}

fn in_colour(report: &mut Report, result: &ColourShading) {
    let [red, blue] = result.extremes();
    report.figure("red_percent", "red over green, largest deviation from the centre", "%", red.scaled(100.0));
    report.figure("blue_percent", "blue over green, largest deviation from the centre", "%", blue.scaled(100.0));
    for (key, label, channel) in [("red", "minimum red", 0), ("green", "minimum green", 1), ("blue", "minimum blue", 2)]
    {
        extreme(report, key, label, &result.channels[channel].map);
    }
    report.table(map("green_percent", &result.channels[1].map));
    report.table(map("red_over_green_percent", &result.red));
    report.table(map("blue_over_green_percent", &result.blue));
    let [red, green, blue] = &result.channels;
    report.plot(profile_plot(&[("blue", blue), ("red", red), ("green", green)]));
}

fn extreme(report: &mut Report, key: &str, label: &str, map: &[Vec<Estimate>]) {
    let lower = |a: Estimate, b: Estimate| if b.value < a.value { b } else { a };
    let min = map.iter().flatten().copied().reduce(lower).unwrap_or(Estimate::new(1.0, 0.0));
    report.figure(&format!("{key}_least_percent"), label, "%", min.scaled(100.0));
}

/// A map as a table: one table row per row of blocks.
fn map(key: &'static str, map: &[Vec<Estimate>]) -> Table {
    let row = |(i, blocks): (usize, &Vec<Estimate>)| {
        vec![Cell::Number(i as f64 + 1.0, 0), Cell::List(blocks.iter().map(|e| 100.0 * e.value).collect(), 2)]
    };
    Table {
        key,
        columns: vec![("row", "row"), ("blocks", heading(key))],
        rows: map.iter().enumerate().map(row).collect(),
    }
}

fn heading(key: &str) -> &'static str {
    match key {
        "green_percent" => "green %",
        "red_over_green_percent" => "red over green %",
        "blue_over_green_percent" => "blue over green %",
        _ => "illumination %",
    }
}

fn profile_plot(channels: &[(&str, &Shading)]) -> Plot {
    let series = channels.iter().map(|(name, shading)| {
        let ring = |r: &etendue_metrology::shading::Ring| {
            (100.0 * r.position, 100.0 * r.relative.value, 200.0 * r.relative.standard_uncertainty)
        };
        Series::with_errors(name, Mark::Points, shading.profile.iter().map(ring))
    });
    Plot {
        title: "relative illumination (bars: 95 %)".to_owned(),
        x: Axis::linear("radial field position, % of the half diagonal").showing(&[0.0, 100.0]),
        y: Axis::linear("illumination, % of the centre").showing(&[100.0]),
        series: series.collect(),
    }
}
