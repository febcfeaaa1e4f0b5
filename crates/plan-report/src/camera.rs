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
    /// Its name.
    pub name: String,
    /// Its place in the job, from 0.
    pub index: u32,
    /// The camera whose light it has: its own name, or that of the first camera of equal light.
    pub light_of: String,
    /// Columns and rows of the sensor.
    pub sensor_px: [usize; 2],
    /// Number of pixels in a row over that of the sensor as described: 1, or 0.25 with `--scale 1/4`.
    pub scale: f64,
    /// Columns and rows that are rendered: with the margin of effects, or of the stored radiance.
    pub film_px: [u32; 2],
    /// How its light depends on time: "none", "lights", "motion".
    pub time: &'static str,
    /// Exposure time of a row, s; 0: one moment.
    pub exposure_s: f64,
    /// "global", "rolling", "global_reset".
    pub shutter: &'static str,
    /// From frame to frame, s; null without a sequence.
    pub frame_period_s: Option<f64>,
    /// What shines.
    pub lights: LightsReport,
    /// How its light is found.
    pub settings: Settings,
    /// Its lens.
    pub lens: LensSummary,
    /// Dynamic range of a frame, dB; null without electronics.
    pub dynamic_range_db: Option<f64>,
    /// What a frame is foretold to take.
    pub cost: CostReport,
    /// Everything that can cost or change a frame.
    pub effects: Vec<EffectReport>,
}

/// What shines: how many of each kind.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct LightsReport {
    /// Discs of suns.
    pub suns: usize,
    /// Lamps without an opening.
    pub lamps: usize,
    /// Luminous openings of lamps.
    pub lamp_openings: usize,
    /// Glowing triangles.
    pub glowing_triangles: usize,
    /// Glowing spheres.
    pub glowing_spheres: usize,
    /// "sky", "image", "uniform"; null where nothing shines from infinitely far.
    pub surroundings: Option<&'static str>,
}

/// A lens.
#[derive(Clone, Debug, serde::Serialize)]
pub struct LensSummary {
    /// What it is, in words.
    pub kind: &'static str,
    /// Focal length, mm; null for a telecentric camera.
    pub focal_length_mm: Option<f64>,
    /// The wavelength of focal length, f-number and focus, nm; null where the lens has no dispersion of its own.
    pub first_order_wavelength_nm: Option<f64>,
    /// Focal length over the pupil's diameter.
    pub f_number: f64,
    /// The f-number of a lens that loses no light and is as bright.
    pub t_number: f64,
    /// Whether everything is sharp.
    pub everything_sharp: bool,
    /// Distance of the plane in focus, m; null for infinity, and where everything is sharp.
    pub focus_distance_m: Option<f64>,
}

/// What a frame is foretold to take.
#[derive(Clone, Debug, serde::Serialize)]
pub struct CostReport {
    /// Paths; where noise decides, the fewest. 0 where another camera's light serves.
    pub paths: f64,
    /// Processor time of the paths at the street's rate, s.
    pub paths_cpu_s: f64,
    /// What is done on the finished film.
    pub film_parts: Vec<FilmPart>,
    /// Processor time of the whole frame, s.
    pub cpu_s: f64,
    /// Whether noise decides the samples, so that it may be more.
    pub is_lower_bound: bool,
    /// Memory of the film, bytes.
    pub film_bytes: f64,
    /// Its bands in a scratch file on the disk, bytes; 0 where they are in memory.
    pub film_disk_bytes: f64,
    /// For what these are read into memory all at once, which then counts as memory; `None` where they are not.
    pub film_all_bands_for: Option<&'static str>,
}

/// A part of what is done on the film.
#[derive(Clone, Debug, serde::Serialize)]
pub struct FilmPart {
    /// What it is, in words.
    pub name: &'static str,
    /// Processor time, s.
    pub cpu_s: f64,
    /// What the figure holds for, in words; null where the plan decides it.
    pub holds_for: Option<&'static str>,
}

impl CameraReport {
    pub(super) fn of(plan: &Plan, camera: &CameraPlan) -> Self {
        let cost = FrameCost::of(plan, camera);
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
            lights: LightsReport::of(plan, camera),
            settings: camera.settings,
            lens: LensSummary::of(camera),
            dynamic_range_db: camera
                .body
                .sensor
                .as_ref()
                .map(|sensor| sensor.dynamic_range().db())
                .filter(|db| db.is_finite()),
            effects: effects.collect(),
            cost: CostReport::of(cost),
        }
    }
}

impl LightsReport {
    fn of(plan: &Plan, camera: &CameraPlan) -> Self {
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
    fn of(camera: &CameraPlan) -> Self {
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
    fn of(cost: FrameCost) -> Self {
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
