//! A camera of a plan.

use super::effect::EffectReport;
use etendue_core::Shutter;
use etendue_pipeline::Plan;
use etendue_pipeline::plan::{CameraPlan, Route, SpectralGain, TimeDependence};
use etendue_pipeline::render::light_counts;
use etendue_pipeline::report::FrameCost;
use etendue_tracer::integrator::Level;

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
    pub settings: SettingsReport,
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

/// How the light of a camera is found.
#[derive(Clone, Debug, serde::Serialize)]
pub struct SettingsReport {
    /// "flat", "direct", "path".
    pub integrator: &'static str,
    /// Surfaces that a path meets at most.
    pub max_bounces: u32,
    /// Whether caustics of lamps are followed.
    pub caustics: bool,
    /// Whether lobes are widened that come after wider ones: a bias.
    pub regularize: bool,
    /// Whether matt surfaces draw directions by what paths before the picture have found.
    pub guiding: bool,
    /// How many paths go on, and lights are drawn, at the first surface of a sample.
    pub branches: u32,
    /// Samples a pixel; the most that a pixel gets where noise decides.
    pub spp: u32,
    /// Samples that every pixel gets where noise decides; else null.
    pub min_spp: Option<u32>,
    /// The limit of noise that decides; else null.
    pub noise_threshold: Option<f64>,
    /// Independent replicates.
    pub replicates: u32,
    /// Pixels whose paths share their tails; 1: none do.
    pub pixels_sharing_paths: u32,
    /// What lights are drawn by: "gloss" or "irradiance".
    pub light_sampling: &'static str,
    /// Wavelengths a path.
    pub wavelengths_per_path: u32,
    /// The density by which they are drawn: "uniform", "response", "response_and_source".
    pub wavelength_density: &'static str,
    /// What the spectra of the light's sources in it save, or would; null where no electrons are summed or no source gives any.
    pub spectral_gain: Option<SpectralGainReport>,
    /// "lens" or "pupil".
    pub route: &'static str,
    /// Shortest and longest wavelength, nm.
    pub wavelength_range_nm: [f64; 2],
    /// Spectral bands that are kept; null where none are.
    pub bands: Option<u32>,
    /// Their width, nm; null where none are kept.
    pub band_width_nm: Option<f64>,
    /// Whether pixels sum electrons directly.
    pub sums_electrons: bool,
    /// The seed of all random numbers.
    pub seed: u64,
}

/// Mean squares of a sample's electrons, their wavelengths drawn by the response alone, over those with the sources' spectra: the ratio of the
/// variances of pixels whose samples differ much.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct SpectralGainReport {
    /// In the mean over pixels, sources and surfaces.
    pub mean: f64,
    /// The least.
    pub least: f64,
    /// The greatest.
    pub most: f64,
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
            settings: SettingsReport::of(camera),
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

impl SettingsReport {
    fn of(camera: &CameraPlan) -> Self {
        let s = &camera.settings;
        Self {
            integrator: match s.level {
                Level::Flat => "flat",
                Level::Direct => "direct",
                Level::Path => "path",
            },
            max_bounces: s.max_bounces,
            caustics: s.caustics && s.level == Level::Path,
            regularize: s.regularize,
            guiding: s.guiding,
            branches: s.branches,
            spp: s.spp,
            min_spp: s.adaptive.map(|limit| limit.min_spp),
            noise_threshold: s.adaptive.map(|limit| limit.threshold),
            replicates: s.replicates,
            pixels_sharing_paths: s.blocks.len_px(),
            light_sampling: s.light_sampling.word(),
            wavelengths_per_path: s.wavelengths,
            wavelength_density: s.wavelength_sampling.word(),
            spectral_gain: camera.spectral_gain.map(SpectralGainReport::of),
            route: match s.route {
                Route::Lens => "lens",
                Route::Pupil(_) => "pupil",
            },
            wavelength_range_nm: [s.range.low_nm, s.range.high_nm],
            bands: s.bands.map(|bands| bands.count() as u32),
            band_width_nm: s.bands.map(|bands| bands.width_nm()),
            sums_electrons: s.folded,
            seed: s.seed,
        }
    }
}

impl SpectralGainReport {
    fn of(SpectralGain { mean, least, most }: SpectralGain) -> Self {
        Self { mean, least, most }
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
