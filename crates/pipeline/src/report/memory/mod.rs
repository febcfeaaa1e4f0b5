//! The peak memory of a run, from the program itself to its files.
//!
//! Cameras are rendered one after another: a run takes the memory that all of them share (the program, the scene) and that of the largest of them. Every term is
//! the size of the data at that time: sizes of types, times pixels, bands and products. Omitted: data that is small compared with an image
//! (lists of lights, side-cars), the directions that path guiding learns, and the memory for reading the files of a scene before the run.

mod camera;
mod film;
mod frame;
mod scene;

pub use camera::{CameraMemory, ROWS_WAITING_BYTES, StageMemory};
pub use film::FilmBytes;
pub(super) use scene::TextureUse;

use crate::plan::{Plan, TimeDependence};
use scene::ViewMemory;

/// Memory of the program before a job is read, bytes: its resident pages, tables of spectra and the stacks of its threads. `etendue plan` of an
/// empty scene takes 31 MB (VmHWM, x86-64, two threads).
const PROGRAM_BYTES: f64 = 36e6;
/// Memory of freed blocks that the C library retains, bytes: glibc retains blocks of up to 32 MiB (M_MMAP_THRESHOLD_MAX), and runs of several cameras were
/// observed to retain up to two of them, or half of a camera's memory.
const RETAINED_BYTES: f64 = (64 << 20) as f64;
const RETAINED_FRACTION: f64 = 0.5;
/// Number of threads that a plan assumes, the same on all machines.
const PLANNED_THREADS: usize = 4;

/// The memory of a run, bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct RunMemory {
    /// Memory of the program before a job is read.
    pub program: f64,
    /// Memory of meshes, their acceleration structures and textures.
    pub scene: f64,
    /// Memory of each camera, with its name.
    pub cameras: Vec<(String, CameraMemory)>,
    /// Memory of films that are stored in addition to that of the camera.
    pub stored_films: f64,
}

impl RunMemory {
    /// Returns the memory of a run with this number of threads.
    #[must_use]
    pub fn new(plan: &Plan, threads: usize) -> Self {
        let view = ViewMemory::new(&plan.world);
        let of_camera = |camera| CameraMemory::new(plan, camera, &view, threads);
        let world = plan.world.bytes() as f64;
        Self {
            program: PROGRAM_BYTES,
            scene: world + TextureUse::from_materials(&plan.material_table).memory_bytes() as f64,
            cameras: plan.cameras.iter().map(|camera| (camera.name.clone(), of_camera(camera))).collect(),
            stored_films: 0.0,
        }
    }

    /// Returns the memory as a plan states it.
    #[must_use]
    pub fn from_plan(plan: &Plan) -> Self {
        Self::new(plan, PLANNED_THREADS)
    }

    /// Adds the films of all cameras, which are in memory together, with this number of time points of each camera whose light depends on time.
    #[must_use]
    pub fn holding_films(self, plan: &Plan, moments: usize) -> Self {
        let films = plan.by_light().into_iter().map(|group| {
            let count = if group[0].time == TimeDependence::None { 1 } else { moments };
            count as f64 * plan.film_bytes(group[0]).memory
        });
        Self { stored_films: films.sum(), ..self }
    }

    /// Returns the memory of a run that renders films and computes nothing from them.
    #[must_use]
    pub fn films_only(mut self) -> Self {
        self.cameras.iter_mut().for_each(|(_, camera)| camera.stages.truncate(1));
        self
    }

    /// Returns the camera with the highest memory.
    #[must_use]
    pub fn largest_camera(&self) -> Option<&(String, CameraMemory)> {
        self.cameras.iter().max_by(|(_, a), (_, b)| a.peak_stage().bytes.total_cmp(&b.peak_stage().bytes))
    }

    /// Returns the peak memory without the program itself.
    #[must_use]
    pub fn beyond_program(&self) -> f64 {
        // The film of the largest camera is one of the stored ones.
        let camera = self
            .largest_camera()
            .map_or(0.0, |(_, camera)| camera.peak_stage().bytes - camera.film.min(self.stored_films));
        self.scene + self.stored_films + camera + (RETAINED_FRACTION * camera).min(RETAINED_BYTES)
    }

    /// Returns the peak memory of the whole run.
    #[must_use]
    pub fn bytes(&self) -> f64 {
        self.program + self.beyond_program()
    }

    /// Returns a description of the parts.
    #[must_use]
    pub fn parts(&self) -> String {
        let mb = |bytes: f64| format!("{:.1} MB", bytes / 1e6);
        let camera = self.largest_camera().map_or_else(String::new, |(name, camera)| {
            let peak = camera.peak_stage();
            format!(", camera {name} {} while {} (its film {})", mb(peak.bytes), peak.stage, mb(camera.film))
        });
        let stored =
            if self.stored_films > 0.0 { format!(", stored films {}", mb(self.stored_films)) } else { String::new() };
        format!("program {}, scene {}{stored}{camera}", mb(self.program), mb(self.scene))
    }
}
