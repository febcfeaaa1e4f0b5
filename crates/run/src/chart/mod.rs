//! A chart as a scene ready to render, with ground truth.

mod camera;
mod changes;
mod own_camera;

use camera::ChartCamera;
use changes::Changes;
pub use etendue_charts::design;
use etendue_charts::{
    CameraResponse, ChartSpecification, Contents, Drawing, Footprint, Light, RasterRay, RayCamera, camera_file,
    camera_stations, chart_image, files,
};
pub use etendue_charts::{Chart, ChartError, Exposures, Spacing};
use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;
use etendue_io::failure::check_integer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::photograph::Encoding;
use etendue_io::png::{encode_display, encode_raw16};
use etendue_io::{ExistingFiles, OutputFolder};
use etendue_pipeline::light_meter::LightMeter;
use glam::DVec2;
pub use own_camera::ChartForCamera;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Maximum number of views of a chart.
pub const MAX_VIEWS: u32 = 200;

/// Distance of a sheet from a camera that states no focus distance, m.
const DISTANCE_M: f64 = 1.0;
/// Luminance of white before a camera without electronics, cd/m².
const LUMINANCE_CD_M2: f64 = 1000.0;

/// A series of exposures, one camera each.
#[derive(Clone, Debug, PartialEq)]
pub struct ExposureSeries {
    /// Level of white in each exposure.
    pub exposures: Exposures,
    /// If true, a camera whose exposure cannot be computed is refused; otherwise the chart is made without the series.
    pub required: bool,
}

/// A chart, the camera that looks at it, its light and its exposures.
#[derive(Clone, Debug)]
pub struct ChartRequest {
    pub chart: Chart,
    /// The camera: a camera file (its name ends in `.toml`), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory.
    pub camera: String,
    /// Changes of the written job's keys, `key=value`, e.g. `render.spp=16` or `cameras.camera.lens.f_number=4`: the chart is drawn for the changed camera.
    pub set: Vec<String>,
    /// Distance of the sheet from the entrance pupil, m, above 0; `None`: the camera's focus distance, or 1.
    pub distance_m: Option<f64>,
    /// Width of the part of the sheet that the camera sees, mm, above 0; determines the distance.
    pub width_mm: Option<f64>,
    /// The light's spectrum: D65, A, E, LED-B3, …
    pub illuminant: String,
    /// Luminance of a perfect white sheet (or of the panel), cd/m²; `None`: the luminance that `white` requires.
    pub luminance_cd_m2: Option<f64>,
    /// Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure.
    pub white: f64,
    /// The seed of all random numbers.
    pub seed: u64,
    /// Resolution of an additional `chart.png`, px per inch; `None`: no such file.
    pub png_dpi: Option<f64>,
    /// Number of views: the first is perpendicular to the chart, the others are tilted by 25 degrees in all directions.
    pub views: u32,
    /// If true, the views deviate at random (by `seed`), as if hand-held: up to 0.5 % of the distance sideways, 2 % farther away, rolled by 1.5 degrees.
    pub hand_held: bool,
    /// Exposures, one camera each; `None`: the camera's own.
    pub series: Option<ExposureSeries>,
    /// If true, each exposure has a dark frame.
    pub dark: bool,
}

impl ChartRequest {
    /// One view by a camera at 0.7 of its saturation, illuminant D65.
    pub fn new(chart: Chart, camera: impl Into<String>) -> Self {
        Self {
            chart,
            camera: camera.into(),
            set: Vec::new(),
            distance_m: None,
            width_mm: None,
            illuminant: "D65".to_owned(),
            luminance_cd_m2: None,
            white: 0.7,
            seed: 0,
            png_dpi: None,
            views: 1,
            hand_held: false,
            series: None,
            dark: false,
        }
    }
}

impl ChartRequest {
    /// The light: of the requested luminance, or of the one that reaches the requested fraction of saturation.
    fn light(&self, meter: Option<&CameraResponse<'_>>, otherwise_cd_m2: f64) -> Result<Light, ChartError> {
        let named = |luminance_cd_m2| Light::named(&self.illuminant, luminance_cd_m2);
        if let Some(luminance_cd_m2) = self.luminance_cd_m2 {
            return named(luminance_cd_m2);
        }
        let white = self.white;
        if !(white.is_finite() && white > 0.0) {
            return Err(ChartError::option("white", white, "expected a fraction of saturation above 0"));
        }
        let unit = named(1.0)?;
        let saturation =
            meter.map(|meter| meter.saturation_fraction(unit.radiance())).filter(|saturation| *saturation > 0.0);
        named(saturation.map_or(otherwise_cd_m2, |saturation| white / saturation))
    }

    /// Exposures of the series, s; empty without a series.
    fn exposures_s(
        &self,
        light: &Light,
        drawing: &Drawing,
        meter: Option<&CameraResponse<'_>>,
    ) -> Result<Vec<f64>, ChartError> {
        let Some(ExposureSeries { exposures, required }) = &self.series else { return Ok(Vec::new()) };
        let saturation = meter
            .map(|meter| meter.saturation_fraction(&drawing.inks[0].radiance(light)))
            .filter(|saturation| *saturation > 0.0);
        let (Some(meter), Some(saturation)) = (meter, saturation) else {
            let problem = || {
                "this camera has no electronics that respond to the light; give a camera whose sensor has electronics"
                    .to_owned()
            };
            return match required {
                false => Ok(Vec::new()),
                true => Err(ChartError::Camera(format!("`exposures`, `levels`: {}", problem()))),
            };
        };
        let exposures_s: Vec<f64> = exposures.fractions.iter().map(|s| meter.exposure_s * s / saturation).collect();
        let longest_s = exposures_s.iter().copied().fold(0.0, f64::max);
        match meter.longest_s {
            Some(limit_s) if longest_s > limit_s => Err(ChartError::Camera(format!(
                "the longest exposure would be {longest_s:.3e} s, more than the camera's frame period of {limit_s} \
                 s: increase the light with `luminance_cd_m2` or `white`, or lower `highest`"
            ))),
            _ => Ok(exposures_s),
        }
    }
}

/// Makes a chart as a scene with its job, cameras and ground truth in a folder; returns the paths of the files.
///
/// # Errors
/// The camera cannot be used, the chart does not fit it, a change names no key of the job, or the folder cannot be written.
pub fn make(request: &ChartRequest, folder: &Path, existing: ExistingFiles) -> Result<Vec<PathBuf>, Error> {
    check_integer("views", request.views, 1..=MAX_VIEWS)?;
    let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
    let changes = Changes(&request.set);
    let camera_changes = changes.camera_changes();
    if !camera_changes.is_empty() {
        // Errors in keys are reported as errors of the job, before the chart is drawn for the changed camera.
        let unchanged = draw_chart(request, &[], folder.path())?;
        changes.check(folder.path(), &unchanged.texts())?;
    }
    let mut files = draw_chart(request, &camera_changes, folder.path())?;
    if !request.set.is_empty() {
        let mut texts = files.texts();
        changes.check(folder.path(), &texts)?;
        changes.write(folder.path(), &files.camera_files, &mut texts)?;
        files.replace(texts);
    }
    folder.claim(files.all.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
    files.all.iter().try_for_each(|(name, bytes)| folder.write(name, bytes).map_err(Error::run))?;
    folder.commit().map_err(Error::run)
}

/// The files of a chart, by their names in its folder.
struct ChartFiles {
    all: Vec<(String, Vec<u8>)>,
    /// Names of its camera files.
    camera_files: Vec<String>,
}

impl ChartFiles {
    /// Returns the job, scene and camera files (TOML) by name.
    fn texts(&self) -> BTreeMap<String, String> {
        let is_text = |name: &str| name.ends_with(".toml");
        let texts = self.all.iter().filter(|(name, _)| is_text(name));
        texts.map(|(name, bytes)| (name.clone(), String::from_utf8_lossy(bytes).into_owned())).collect()
    }

    /// Replaces the files that are named in `texts`.
    fn replace(&mut self, mut texts: BTreeMap<String, String>) {
        for (name, bytes) in &mut self.all {
            if let Some(text) = texts.remove(name) {
                *bytes = text.into_bytes();
            }
        }
    }
}

/// Draws the requested chart for its camera with `changes` of its keys, and returns the files.
fn draw_chart(request: &ChartRequest, changes: &[String], folder: &Path) -> Result<ChartFiles, Error> {
    let camera = ChartCamera::load(&request.camera, changes)?;
    let body = &camera.body;
    let ray = |at: DVec2| {
        let (front, _) = body.truth_ray(at)?;
        Some(RasterRay { origin_m: front.truth_origin_m(), direction: front.ray.direction })
    };
    let size_px = DVec2::new(body.raster.width() as f64, body.raster.height() as f64);
    let ray_camera = RayCamera { size_px, ray: &ray };
    let light_meter = LightMeter::new(body);
    let electrons = |radiance: &_| light_meter.as_ref().map_or_else(Vec::new, |meter| meter.electrons(radiance));
    let meter = light_meter.as_ref().zip(body.sensor.as_ref()).map(|(meter, sensor)| CameraResponse {
        exposure_s: sensor.parameters().exposure.exposure_s,
        longest_s: sensor.parameters().exposure.frame_period_s,
        saturation_e: meter.saturation_e(),
        electrons: &electrons,
    });
    // An exposure time of zero cannot be metered.
    let meter = meter.filter(|meter| meter.exposure_s > 0.0);
    let footprint_m = footprint(request, &camera, &ray_camera)?;
    let drawing = request.chart.draw(&footprint_m, request.seed).map_err(chart_error)?;
    let light = request.light(meter.as_ref(), LUMINANCE_CD_M2).map_err(chart_error)?;
    let exposures_s = request.exposures_s(&light, &drawing, meter.as_ref()).map_err(chart_error)?;
    let mut stations = camera_stations(footprint_m.distance_m, request.views, &exposures_s, request.dark);
    if request.hand_held {
        stations = stations.into_iter().zip(0..).map(|(station, nth)| station.hand_held(request.seed, nth)).collect();
    }
    let base = camera.base(folder)?;
    let files = ChartSpecification {
        chart: &request.chart,
        drawing: &drawing,
        footprint: footprint_m,
        ray_camera: &ray_camera,
        response: meter.as_ref(),
        light: &light,
        stations: &stations,
        camera: &base,
        remove: camera.removed_keys(),
        unit_seed: camera.default_unit(&stations),
        seed: request.seed,
        changes: &Changes(&request.set).job_changes(),
    };
    chart_files(&files, &camera, request.png_dpi)
}

/// Converts an error of a chart, with the argument that caused it.
pub fn chart_error(error: ChartError) -> Error {
    match error {
        ChartError::Option { option, .. } => Error::argument(option, error.to_string()),
        ChartError::Camera(message) => Error::coded(ErrorCode::UnusableLens, message),
    }
}

/// The area that the camera sees at the requested distance, or at the distance of the requested width.
fn footprint(request: &ChartRequest, camera: &ChartCamera, ray_camera: &RayCamera<'_>) -> Result<Footprint, Error> {
    let legal = |option: &'static str, value: f64| match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err(chart_error(ChartError::option(option, value, "expected a number above 0"))),
    };
    let focused = camera.body.lens.focus_distance_m().filter(|m| m.is_finite());
    let mut distance_m = match request.distance_m {
        Some(distance_m) => legal("distance_m", distance_m)?,
        None => focused.unwrap_or(DISTANCE_M),
    };
    if let Some(width_mm) = request.width_mm {
        let width_mm = legal("width_mm", width_mm)?;
        // The width is nearly proportional to the distance.
        for _ in 0..8 {
            distance_m *= width_mm / ray_camera.footprint(distance_m).map_err(chart_error)?.outer_mm.x;
        }
    }
    ray_camera.footprint(distance_m).map_err(chart_error)
}

fn chart_files(
    request: &ChartSpecification<'_>,
    camera: &ChartCamera,
    png_dpi: Option<f64>,
) -> Result<ChartFiles, Error> {
    let print = png_dpi.map(|dpi| chart_image(request.drawing, dpi)).transpose().map_err(chart_error)?;
    let print = print.map(|plane| encode_display(&plane, &Encoding::Srgb)).transpose().map_err(Error::run)?;
    let reference = camera.reference_camera().map(|(name, text)| (name, text.as_bytes().to_vec()));
    let mut all: Vec<(String, Vec<u8>)> = reference.into_iter().collect();
    for file in files(request) {
        all.push((file.name, bytes(file.contents)?));
    }
    all.extend(print.map(|bytes| ("chart.png".to_owned(), bytes)));
    let camera_files = request.stations.iter().map(camera_file).collect::<BTreeSet<_>>().into_iter().collect();
    Ok(ChartFiles { all, camera_files })
}

fn bytes(contents: Contents) -> Result<Vec<u8>, Error> {
    match contents {
        Contents::Text(text) => Ok(text.into_bytes()),
        Contents::Grey16(width, height, values) => {
            let samples = values.into_iter().map(u32::from).collect();
            let plane: Plane<DigitalNumber> = Plane::from_samples(width, height, samples).expect("one value per texel");
            encode_raw16(&plane).map_err(Error::run)
        }
    }
}
