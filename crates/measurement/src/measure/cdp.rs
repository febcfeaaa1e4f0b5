//! `measure cdp`: contrast detection probability of pairs of patches.

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_arguments::region;
use etendue_charts::design::{ContrastPatches, OecfSteps};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::Image;
use etendue_metrology::contrast::{ContrastPair, ContrastSettings, Patch, measure_contrast};
use etendue_metrology::patch_statistics::saturated_percent;

use super::pictures::{MeasurementInput, refused, region_label};
use super::readings::Readings;
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure cdp`
#[derive(Args, Clone, Debug)]
pub struct CdpRequest {
    /// Image of grey patches
    #[arg(value_name = "IMAGE")]
    pub picture: PathBuf,
    /// Darker patch of a pair: left column, top row, width, height; once per pair
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub darker: Vec<[usize; 4]>,
    /// Brighter patch of a pair, in the same order
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required_unless_present = "truth", conflicts_with = "truth")]
    pub brighter: Vec<[usize; 4]>,
    /// Weber contrast of a pair in the scene: brighter over darker luminance, less 1; in the same order
    #[arg(
        long,
        value_name = "K",
        required_unless_present = "truth",
        conflicts_with = "truth",
        allow_negative_numbers = true
    )]
    pub contrast: Vec<f64>,
    /// Maximum relative deviation of a measured contrast from the scene's
    #[arg(long, value_name = "FRACTION", default_value_t = 0.5, allow_negative_numbers = true)]
    pub tolerance: f64,
    /// Image of uniform illumination by the same camera: readings are divided by it, which removes the lens's fall-off
    #[arg(long, value_name = "FLAT")]
    pub flat: Option<PathBuf>,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl CdpRequest {
    /// Creates a request with the program's defaults.
    pub fn new(image: impl Into<PathBuf>) -> Self {
        Self {
            picture: image.into(),
            darker: Vec::new(),
            brighter: Vec::new(),
            contrast: Vec::new(),
            tolerance: 0.5,
            flat: None,
            input: MeasurementInput::default(),
        }
    }
}

/// Charts of patches of one luminance each.
const CHARTS: [&str; 2] = [ContrastPatches::NAME, OecfSteps::NAME];

/// Two patches of the scene.
struct PatchPair {
    darker: [usize; 4],
    brighter: [usize; 4],
    contrast: f64,
    /// Luminance of the darker one, if known.
    luminance_cd_m2: Option<f64>,
}

/// Contrast detection probability of pairs of patches (IEEE P2020).
///
/// # Errors
/// If the image or its patches cannot be used.
pub fn cdp(request: &CdpRequest) -> Result<Report, Error> {
    let readings = request.input.linear(&request.picture)?;
    let pairs = pairs(request, &readings)?;
    let settings = ContrastSettings {
        black: request.input.levels.black(&readings),
        full_scale: request.input.levels.full_scale(&readings),
        tolerance: request.tolerance,
        shared_px: readings.shared_px,
    };
    let flat = request.flat.as_deref().map(|file| FlatField::read(file, request, &readings)).transpose()?;
    let patch = |name: &str, at: [usize; 4]| -> Result<Patch, Error> {
        let readings = readings.part_of(name, at)?;
        Ok(Patch { flat: flat.as_ref().map(|flat| flat.part(name, at)).transpose()?, readings })
    };
    let (mut measured_pairs, mut refusals) = (Vec::new(), Vec::new());
    for pair in pairs {
        let (darker, brighter) = (patch("darker", pair.darker)?, patch("brighter", pair.brighter)?);
        match measure_contrast(&darker, &brighter, pair.contrast, &settings) {
            Ok(contrast) => measured_pairs.push((pair, contrast)),
            Err(error) if pair.luminance_cd_m2.is_some() => refusals.push(format!("{}: {error}", places(&pair))),
            Err(error) => return Err(refused(&request.picture, error)),
        }
    }
    if measured_pairs.is_empty() {
        return Err(refused(&request.picture, &refusals[0]));
    }
    let mut report = report(&measured_pairs);
    if let Some(file) = &request.flat {
        report.note(format!("readings are divided by those of {}", file.display()));
    }
    report.encoding(&readings.stated);
    for (pair, _) in &measured_pairs {
        for at in [pair.darker, pair.brighter] {
            report.note_cut(&region_label("patch", at), &readings.part_of("darker", at)?, settings.full_scale);
        }
    }
    refusals.into_iter().for_each(|reason| report.note(format!("omitted: patches at {reason}")));
    Ok(report)
}

/// Relative sensitivity of the pixels, from an image of uniform illumination.
struct FlatField(Readings);

impl FlatField {
    /// Reads the image with the channel and the levels of the request, and divides the light by its mean.
    fn read(file: &Path, request: &CdpRequest, readings: &Readings) -> Result<Self, Error> {
        let mut flat = request.input.linear(file)?;
        let layout = |readings: &Readings| (readings.picture_px, readings.first, readings.period);
        if layout(&flat) != layout(readings) {
            let message = format!(
                "`flat`: {} has another size or mosaic than the image; give an image of the same camera",
                file.display()
            );
            return Err(Error::argument("flat", &message).with_code(ErrorCode::NotComparable));
        }
        if let Some(percent) = saturated_percent([&flat.image], request.input.levels.full_scale(&flat)) {
            return Err(refused(file, format!("{percent:.1} % of the flat field is saturated; reduce its exposure")));
        }
        let black = request.input.levels.black(&flat);
        let light: Vec<f64> = flat.image.samples().iter().map(|reading| f64::from(*reading) - black).collect();
        let is_lit = |value: &f64| *value > 0.0 && value.is_finite();
        if !light.iter().all(is_lit) {
            return Err(refused(file, "a pixel of the flat field has no light above black; increase its exposure"));
        }
        let mean = light.iter().sum::<f64>() / light.len() as f64;
        let relative = light.iter().map(|value| (value / mean) as f32).collect();
        flat.image =
            Image::from_samples(flat.image.width(), flat.image.height(), relative).expect("the size of the readings");
        Ok(Self(flat))
    }

    fn part(&self, name: &str, at: [usize; 4]) -> Result<Image, Error> {
        self.0.part_of(name, at)
    }
}

fn places(pair: &PatchPair) -> String {
    format!("{},{} {},{}", pair.darker[0], pair.darker[1], pair.brighter[0], pair.brighter[1])
}

fn pairs(request: &CdpRequest, readings: &Readings) -> Result<Vec<PatchPair>, Error> {
    if let Some(truth) = request.input.truth(&CHARTS, &request.picture, readings)? {
        let (mut patches, _) = truth.patches(readings)?;
        truth.shown(&request.picture, &patches, readings)?;
        patches.sort_by(|a, b| a.luminance_cd_m2.total_cmp(&b.luminance_cd_m2));
        let pair = |two: &[super::truth::place::PatchPlace]| PatchPair {
            darker: two[0].at,
            brighter: two[1].at,
            contrast: two[1].luminance_cd_m2 / two[0].luminance_cd_m2 - 1.0,
            luminance_cd_m2: Some(two[0].luminance_cd_m2),
        };
        let patch_pairs: Vec<PatchPair> = patches.windows(2).map(pair).filter(|pair| pair.contrast > 0.0).collect();
        let none = || refused(&request.picture, "shows fewer than two patches of different luminance");
        return if patch_pairs.is_empty() { Err(none()) } else { Ok(patch_pairs) };
    }
    let (darker, brighter, contrasts) = (&request.darker, &request.brighter, &request.contrast);
    if darker.len() != brighter.len() || darker.len() != contrasts.len() {
        return Err(Error::argument(
            "darker",
            "`darker`, `brighter` and `contrast`: expected each of them once per pair",
        )
        .with_code(ErrorCode::WrongCount));
    }
    let pair = |((darker, brighter), contrast): ((&[usize; 4], &[usize; 4]), &f64)| PatchPair {
        darker: *darker,
        brighter: *brighter,
        contrast: *contrast,
        luminance_cd_m2: None,
    };
    Ok(darker.iter().zip(brighter).zip(contrasts).map(pair).collect())
}

fn report(pairs: &[(PatchPair, ContrastPair)]) -> Report {
    let method = "contrast detection probability after IEEE P2020 (Weber contrast; ± one standard uncertainty)";
    let mut report = Report::new("cdp", method);
    let row = |(pair, measured): &(PatchPair, ContrastPair)| {
        vec![
            Cell::Text(places(pair)),
            pair.luminance_cd_m2.map_or(Cell::Nothing, |l| Cell::Number(l, 3)),
            Cell::Number(pair.contrast, 4),
            Cell::Estimate(measured.measured),
            Cell::Estimate(measured.detection),
            Cell::Estimate(measured.transfer),
            Cell::Estimate(measured.contrast_snr),
        ]
    };
    report.table(Table {
        key: "pairs",
        columns: vec![
            ("at_px", "patches at px"),
            ("darker_cd_m2", "darker cd/m²"),
            ("scene_contrast", "scene"),
            ("measured_contrast", "measured"),
            ("cdp", "CDP"),
            ("cta", "CTA"),
            ("csnr", "CSNR"),
        ],
        rows: pairs.iter().map(row).collect(),
    });
    report.plot(plot(pairs));
    report
}

/// Against luminance if known, otherwise against the scene's contrast.
fn plot(measured: &[(PatchPair, ContrastPair)]) -> Plot {
    let known = measured.iter().all(|(pair, _)| pair.luminance_cd_m2.is_some());
    let x = |pair: &PatchPair| pair.luminance_cd_m2.filter(|_| known).unwrap_or(pair.contrast);
    let series = |name: &str, quantity: fn(&ContrastPair) -> etendue_metrology::Estimate| {
        let points =
            measured.iter().map(|(pair, m)| (x(pair), quantity(m).value, 2.0 * quantity(m).standard_uncertainty));
        Series::with_errors(name, Mark::Points, points)
    };
    Plot {
        title: "contrast detection probability and contrast transfer (bars: 95 %)".to_owned(),
        x: Axis::log(if known { "luminance of the darker patch, cd/m²" } else { "contrast of the scene" }),
        y: Axis::linear("CDP, CTA").showing(&[0.0, 1.0]),
        series: vec![series("CDP", |m| m.detection), series("CTA", |m| m.transfer)],
    }
}
