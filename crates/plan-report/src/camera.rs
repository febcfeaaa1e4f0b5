//! A camera of a plan.

use super::effect::EffectReport;
use etendue_core::Shutter;
use etendue_pipeline::Plan;
use etendue_pipeline::plan::{CameraPlan, Settings, TimeDependence};
use etendue_pipeline::render::light_counts;
use etendue_pipeline::report::FrameCost;

/// A camera of a plan.
#[derive(Clone, Debug, serde::Serialize)]
pub struct CameraReport {
    pub name: String,
    /// Index of the camera in the job, from 0.
    pub index: u32,
    /// Camera that provides the light: its own name, or that of the first camera of equal light.
    pub light_of: String,
    /// Columns and rows of the sensor.
    pub sensor_px: [usize; 2],
    /// Pixels per row over those of the sensor as described: 1, or 0.25 with `--scale 1/4`.
    pub scale: f64,
    /// Columns and rows that are rendered: including the margin of effects, or those of the stored radiance.
    pub film_px: [u32; 2],
    /// Time dependence of the light: "none", "lights", "motion".
    pub time: &'static str,
    /// Exposure time of a row, s; 0: instantaneous.
    pub exposure_s: f64,
    /// "global", "rolling", "global_reset".
    pub shutter: &'static str,
    /// Frame period, s; null without a sequence.
    pub frame_period_s: Option<f64>,
    /// Light sources.
    pub lights: LightsReport,
    /// Render settings.
    pub settings: Settings,
    pub lens: LensSummary,
    /// Dynamic range of a frame, dB; null for a camera without electronics.
    pub dynamic_range_db: Option<f64>,
    /// Estimated cost of a frame.
    pub cost: CostReport,
    /// All effects that can cost time or change a frame.
    pub effects: Vec<EffectReport>,
}

/// Number of light sources of each kind.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct LightsReport {
    /// Suns, as discs.
    pub suns: usize,
    /// Lamps without a luminous opening.
    pub lamps: usize,
    /// Luminous openings of lamps.
    pub lamp_openings: usize,
    /// Emissive triangles.
    pub glowing_triangles: usize,
    /// Emissive spheres.
    pub glowing_spheres: usize,
    /// Light from infinity: "sky", "image", "uniform"; null without such light.
    pub surroundings: Option<&'static str>,
}

#[derive(Clone, Debug, serde::Serialize)]
pub struct LensSummary {
    /// Kind of lens, as text.
    pub kind: &'static str,
    /// Focal length, mm; null for a telecentric camera.
    pub focal_length_mm: Option<f64>,
    /// Wavelength of focal length, f-number and focus, nm; null for a lens without dispersion.
    pub first_order_wavelength_nm: Option<f64>,
    /// f-number: focal length over the diameter of the entrance pupil.
    pub f_number: f64,
    /// t-number: f-number of a lossless lens of equal brightness.
    pub t_number: f64,
    /// True if objects at every distance are sharp.
    pub everything_sharp: bool,
    /// Focus distance, m; null for infinity, and if objects at every distance are sharp.
    pub focus_distance_m: Option<f64>,
}

/// Estimated cost of a frame.
#[derive(Clone, Debug, serde::Serialize)]
pub struct CostReport {
    /// Number of paths; a lower bound for noise-limited sampling. 0 if another camera provides the light.
    pub paths: f64,
    /// CPU time of the paths at the rate of the reference street scene, s.
    pub paths_cpu_s: f64,
    /// Work on the finished film.
    pub film_parts: Vec<FilmPart>,
    /// CPU time of the whole frame, s.
    pub cpu_s: f64,
    /// True for noise-limited sampling: the cost may be higher.
    pub is_lower_bound: bool,
    /// Memory of the film, bytes.
    pub film_bytes: f64,
    /// Bytes of the bands in a scratch file on disk; 0 if they are in memory.
    pub film_disk_bytes: f64,
    /// Purpose for which all bands are read into memory at once, which then counts as memory; `None` if they are not.
    pub film_all_bands_for: Option<&'static str>,
}

/// A part of the work on the film.
#[derive(Clone, Debug, serde::Serialize)]
pub struct FilmPart {
    /// Name, as text.
    pub name: &'static str,
    /// CPU time, s.
    pub cpu_s: f64,
    /// Condition under which the figure holds, as text; null if the plan determines it.
    pub holds_for: Option<&'static str>,
}

impl CameraReport {
    pub(super) fn new(plan: &Plan, camera: &CameraPlan) -> Self {
        let cost = FrameCost::new(plan, camera);
        let raster = &camera.body.raster;
        let effects = plan.effects(camera).into_iter().map(|effect| EffectReport::new(effect, cost.cpu_s()));
        let (width, height) = camera.film_size();
        Self {
            name: camera.name.clone(),
            index: camera.index,
            light_of: camera.light.camera.clone(),
            sensor_px: [raster.width(), raster.height()],
            scale: 1.0 / camera.body.scale as f64,
            film_px: [width, height],
            time: match camera.time {
                TimeDependence::None => "none",
                TimeDependence::Lights => "lights",
                TimeDependence::Motion => "motion",
            },
            exposure_s: camera.body.exposure.exposure_s,
            shutter: match camera.body.exposure.shutter {
                Shutter::Global => "global",
                Shutter::Rolling(_) => "rolling",
                Shutter::GlobalReset(_) => "global_reset",
            },
            frame_period_s: camera.timing.period_s,
            lights: LightsReport::new(plan, camera),
            settings: camera.settings,
            lens: LensSummary::new(camera),
            dynamic_range_db: camera
                .body
                .sensor
                .as_ref()
                .map(|sensor| sensor.dynamic_range().db())
                .filter(|db| db.is_finite()),
            effects: effects.collect(),
            cost: CostReport::new(cost),
        }
    }
}

impl LightsReport {
    fn new(plan: &Plan, camera: &CameraPlan) -> Self {
        let counts = light_counts(plan, camera);
        let kinds = [(counts.sky, "sky"), (counts.image_environment, "image"), (counts.uniform_environment, "uniform")];
        Self {
            suns: counts.suns,
            lamps: counts.lamps,
            lamp_openings: counts.openings,
            glowing_triangles: counts.triangles,
            glowing_spheres: counts.spheres,
            surroundings: kinds.into_iter().find_map(|(is_there, kind)| is_there.then_some(kind)),
        }
    }
}

impl LensSummary {
    fn new(camera: &CameraPlan) -> Self {
        let lens = &camera.body.lens;
        let focus_m = lens.focus_distance_m();
        Self {
            kind: lens.kind(),
            focal_length_mm: Some(lens.focal_length_mm()).filter(|mm| mm.is_finite()),
            first_order_wavelength_nm: lens.first_order_nm(),
            f_number: lens.f_number(),
            t_number: lens.t_number(),
            everything_sharp: focus_m.is_none(),
            focus_distance_m: focus_m.filter(|m| m.is_finite()),
        }
    }
}

impl CostReport {
    fn new(cost: FrameCost) -> Self {
        let parts = cost.parts.iter().filter(|part| part.cpu_s > 0.0).map(|part| FilmPart {
            name: part.name,
            cpu_s: part.cpu_s,
            holds_for: Some(part.holds_for).filter(|words| !words.is_empty()),
        });
        Self {
            paths: cost.paths,
            paths_cpu_s: cost.paths_cpu_s,
            film_parts: parts.collect(),
            cpu_s: cost.cpu_s(),
            is_lower_bound: cost.is_lower_bound,
            film_bytes: cost.film.memory,
            film_disk_bytes: cost.film.disk,
            film_all_bands_for: cost.film.all_bands_for,
        }
    }
}
