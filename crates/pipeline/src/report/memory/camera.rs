//! The memory of a camera in each stage of its work.

use super::frame::FrameMemory;
use super::scene::ViewMemory;
use crate::plan::{CameraPlan, Plan, Route, TimeDependence};
use crate::render::truth::TruthRows;
use crate::render::{identity_coverage, motion};
use crate::sizes::film::has_variance;
use crate::sizes::tile::Shard;
use etendue_optics::DepthOfField;

/// Memory of the rows of an EXR file that wait to be written, bytes: up to [`ROWS_WAITING_BYTES`] of rows wait in `etendue_io`, and their compressed data
/// takes no more.
const WRITING_BYTES: f64 = 2.0 * ROWS_WAITING_BYTES as f64;
/// Maximum size of rows that wait to be compressed, bytes.
pub const ROWS_WAITING_BYTES: usize = 32 << 20;
/// Planes of distances and depths at the pupil: those of the threads and the merged ones.
const PUPIL_PLANES: f64 = 4.0;
/// Size of a sample of a plane, bytes.
const SAMPLE: f64 = size_of::<f32>() as f64;

/// A stage of a camera's work and its memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageMemory {
    /// The work of the stage, worded to follow "while".
    pub stage: &'static str,
    pub bytes: f64,
}

/// The memory of a camera, bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraMemory {
    /// Memory of its film alone.
    pub film: f64,
    /// Memory of each stage, with everything stored during it.
    pub stages: Vec<StageMemory>,
}

impl CameraMemory {
    pub(super) fn new(plan: &Plan, camera: &CameraPlan, view: &ViewMemory, threads: usize) -> Self {
        let sizes = Sizes::new(plan, camera);
        let frame = FrameMemory::new(camera);
        // A sensor with a state keeps the frame while the other files are made.
        let remembers = camera.body.sensor.as_ref().is_some_and(|sensor| sensor.has_memory());
        let remembered_frame = if remembers && camera.time != TimeDependence::None { frame.stored } else { 0.0 };
        let light = sizes.light() + remembered_frame + sizes.shared_films();
        let distances = if sizes.is_at_pupil { light + view.stage_bytes(PUPIL_PLANES * sizes.film_plane) } else { 0.0 };
        let stages = [
            ("its light is rendered", view.stage_bytes(sizes.films())),
            ("its film is converted to light on the sensor", sizes.conversion(threads)),
            ("distances at its pupil are computed", distances),
            ("its spectral files are written", light + sizes.spectra_files()),
            ("its frames are computed and written", light + frame.peak),
            ("its ground truth is computed and written", light + view.stage_bytes(sizes.ground_truth())),
            ("its weather layers are computed and written", light + view.stage_bytes(sizes.weather())),
            ("its motion and disparity are computed and written", light + view.stage_bytes(sizes.motion())),
            ("its Cryptomatte is computed and written", light + view.stage_bytes(sizes.cryptomatte())),
        ];
        let stages = stages.map(|(stage, bytes)| StageMemory { stage, bytes }).to_vec();
        Self { film: sizes.film, stages }
    }

    /// Returns the stage with the highest memory.
    #[must_use]
    pub fn peak_stage(&self) -> StageMemory {
        let peak = self.stages.iter().copied().max_by(|a, b| a.bytes.total_cmp(&b.bytes));
        peak.unwrap_or(StageMemory { stage: "nothing is done", bytes: 0.0 })
    }
}

/// Sizes that several stages use.
struct Sizes<'a> {
    camera: &'a CameraPlan,
    /// Size of a plane of the film, bytes.
    film_plane: f64,
    /// Size of a plane of the image, bytes.
    plane: f64,
    /// Number of bands in memory.
    bands: f64,
    /// Size of the film in memory, bytes.
    film: f64,
    /// Number of captures with different light, each with its film.
    captures: f64,
    is_at_pupil: bool,
    /// Number of cameras that share the light.
    group: usize,
}

impl<'a> Sizes<'a> {
    fn new(plan: &Plan, camera: &'a CameraPlan) -> Self {
        let (width, height) = camera.film_size();
        let raster = &camera.body.raster;
        let film = plan.film_bytes(camera);
        let in_memory = plan.scratch(camera).is_none() || film.all_bands_for.is_some();
        let captures = match camera.time {
            TimeDependence::None => 1,
            TimeDependence::Lights | TimeDependence::Motion => camera.body.exposure.distinct_captures().len(),
        };
        let bands = camera.settings.bands.filter(|_| in_memory).map_or(0, |bands| bands.count());
        Self {
            camera,
            film_plane: SAMPLE * f64::from(width) * f64::from(height),
            plane: SAMPLE * raster.width() as f64 * raster.height() as f64,
            bands: bands as f64,
            film: film.memory,
            captures: captures as f64,
            is_at_pupil: matches!(camera.settings.route, Route::Pupil(_)),
            group: plan.cameras.iter().filter(|other| other.light == camera.light).count(),
        }
    }

    /// Returns the memory of the films during rendering: those of the captures so far, and in further passes that of the previous passes.
    fn films(&self) -> f64 {
        let passes = if self.camera.pass_count() > 1 { 2.0 } else { 1.0 };
        self.film * (self.captures - 1.0 + passes)
    }

    /// Returns the memory of the films while they are converted: the camera's own, and a copy for later cameras that share them.
    fn films_in_conversion(&self) -> f64 {
        let copies = if self.group > 1 { 2.0 } else { 1.0 };
        // A run in passes makes images from a copy of the film so far.
        let refined = if self.camera.pass_count() > 1 { 1.0 } else { 0.0 };
        self.film * self.captures * (copies + refined)
    }

    /// Returns the memory of the films that are stored for later cameras with the same light.
    fn shared_films(&self) -> f64 {
        if self.group > 1 { self.film * self.captures } else { 0.0 }
    }

    fn ghost_count(&self) -> f64 {
        f64::from(u8::from(self.camera.body.effects.ghosts().is_some()))
    }

    /// Returns the memory of the light while files are made: radiance and irradiance with variances, ghosts, electrons of each capture, distances at the pupil.
    fn light(&self) -> f64 {
        let products = &self.camera.products;
        let electrons = if self.camera.body.sensor.is_some() { self.captures } else { 0.0 };
        let electrons = self.plane * (electrons + f64::from(u8::from(self.camera.settings.accumulates_electrons)));
        let sampling = if products.sampling { 3.0 * self.plane } else { 0.0 };
        electrons + sampling + self.spectra()
    }

    /// Returns the memory of the spectra of a capture.
    fn spectra(&self) -> f64 {
        let irradiance = self.bands * self.plane * (1.0 + self.ghost_count());
        if self.is_at_pupil {
            return irradiance + (2.0 * self.bands + 2.0) * self.film_plane;
        }
        let radiance = if self.camera.products.needs_radiance() { 2.0 * self.bands * self.plane } else { 0.0 };
        radiance + irradiance + self.bands * self.plane
    }

    /// Returns the memory while films are converted to light on the sensor: the films, the products and the effects.
    fn conversion(&self, threads: usize) -> f64 {
        let is_requested = self.camera.products.needs_radiance() || self.is_at_pupil;
        let radiance = if is_requested { 2.0 * self.bands * self.film_plane } else { 0.0 };
        let blurred = match self.camera.depth_of_field {
            DepthOfField::None => 0.0,
            DepthOfField::Physical | DepthOfField::Fast(_) => 2.0 * self.bands * self.film_plane,
        };
        let ghosts = self.ghost_count() * self.bands * (self.film_plane + self.plane);
        let effects = if self.camera.body.effects.is_idle() { 0.0 } else { 2.0 * self.bands * self.plane };
        let through_lens = if self.is_at_pupil { self.bands * self.film_plane } else { 0.0 };
        let total = radiance + blurred + ghosts + effects + through_lens + self.plane;
        self.films_in_conversion() + total + (self.captures - 1.0) * self.spectra() + self.convolution(threads)
    }

    /// Returns the memory of point spread and glare for the bands that are processed in parallel: light and its variance before and after in 64 bits, and three
    /// complex grids of the film with the margin of the kernel.
    fn convolution(&self, threads: usize) -> f64 {
        let effects = &self.camera.body.effects;
        if effects.is_idle() {
            return 0.0;
        }
        let [x, y] = effects.margin_px().map(|margin| margin as f64);
        let (width, height) = self.camera.film_size();
        let grid = (f64::from(width) + x) * (f64::from(height) + y) * size_of::<[f64; 2]>() as f64;
        let side_by_side = self.bands.max(1.0).min(threads as f64);
        side_by_side * (4.0 * 2.0 * self.film_plane + 3.0 * grid) + grid
    }

    fn spectra_files(&self) -> f64 {
        let products = &self.camera.products;
        let planes = self.bands * if products.variance { 2.0 } else { 1.0 };
        let written = products.radiance || products.irradiance || products.ghosts || products.electrons;
        if written { self.writing(planes.max(1.0)) } else { 0.0 }
    }

    /// Returns the memory while an EXR file of `planes` planes is written.
    fn writing(&self, planes: f64) -> f64 {
        WRITING_BYTES.min(2.0 * planes * self.plane)
    }

    fn ground_truth(&self) -> f64 {
        let products = &self.camera.products;
        let needs = products.ground_truth || products.depth_png_per_m.is_some() || products.annotations.boxes;
        if !needs {
            return 0.0;
        }
        let planes = TruthRows::bytes(self.camera);
        let depth = if products.depth_png_per_m.is_some() { self.plane } else { 0.0 };
        planes + TruthRows::strip_bytes(self.camera) + depth + self.writing(planes / self.plane)
    }

    /// Returns the memory of two films of one band, and of the film of the airlight in all bands and its radiance.
    fn weather(&self) -> f64 {
        if !self.camera.products.weather {
            return 0.0;
        }
        let (width, height) = self.camera.film_size();
        let (width, height) = (width as usize, height as usize);
        let film = self.camera.film_layout().bytes(width, height);
        let variance = has_variance(self.camera.settings.replicates, Shard::WHOLE);
        let bands = self.camera.settings.bands.map_or(1, |bands| bands.count()) as f64;
        film.max(self.film_plane * 2.0 * bands) + self.film_plane * (bands * if variance { 2.0 } else { 1.0 } + 4.0)
    }

    fn motion(&self) -> f64 {
        let annotations = &self.camera.products.annotations;
        let neighbours = if annotations.needs_neighbours() { 2 } else { usize::from(annotations.disparity.is_some()) };
        let bytes = motion::bytes_of_pixel(neighbours) * self.plane / SAMPLE;
        if neighbours == 0 { 0.0 } else { bytes + self.writing(bytes / self.plane) }
    }

    fn cryptomatte(&self) -> f64 {
        if !self.camera.products.annotations.cryptomatte {
            return 0.0;
        }
        identity_coverage::BYTES_OF_PIXEL * self.plane / SAMPLE + WRITING_BYTES
    }
}
