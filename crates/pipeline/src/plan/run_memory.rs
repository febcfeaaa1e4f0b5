//! The memory that a run takes at most, from the program itself to its files.
//!
//! Cameras follow one another, so that the run takes what all of them share (the program, the scene) and what the largest of them takes. Every term is
//! the size of the numbers that are there at that time: sizes of types, times pixels, bands and products. Left out: what is small beside a picture
//! (lists of lights, side-cars), the directions that path guiding learns, and what reading the files of a scene takes before the run.

use super::camera_memory::CameraMemory;
use super::texture_use::TextureUse;
use super::view_memory::ViewMemory;
use crate::plan::{Plan, TimeDependence};

/// Of the program before a job is read, bytes: its pages that are used, tables of spectra and the stacks of its threads. `etendue plan` of an
/// empty scene has 31 MB (VmHWM, x86-64, two threads).
const PROGRAM_BYTES: f64 = 36e6;
/// Threads of a plan for people, which no machine decides.
const PLANNED_THREADS: usize = 4;

/// The memory of a run, bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct RunMemory {
    /// Of the program before a job is read.
    pub program: f64,
    /// Of meshes, their trees and textures.
    pub scene: f64,
    /// Of each camera at most, by its name.
    pub cameras: Vec<(String, CameraMemory)>,
    /// Of films that are held beside that of the camera.
    pub held_films: f64,
}

impl RunMemory {
    /// Of a run that takes as many threads.
    #[must_use]
    pub fn new(plan: &Plan, threads: usize) -> Self {
        let view = ViewMemory::new(&plan.world);
        let of_camera = |camera| CameraMemory::new(plan, camera, &view, threads);
        let world = plan.world.bytes() as f64;
        Self {
            program: PROGRAM_BYTES,
            scene: world + TextureUse::of(&plan.material_table).memory_bytes() as f64,
            cameras: plan.cameras.iter().map(|camera| (camera.name.clone(), of_camera(camera))).collect(),
            held_films: 0.0,
        }
    }

    /// As a plan states it.
    #[must_use]
    pub fn planned(plan: &Plan) -> Self {
        Self::new(plan, PLANNED_THREADS)
    }

    /// The same with the films of all cameras held together, of this many moments of each whose light depends on time.
    #[must_use]
    pub fn holding_films(self, plan: &Plan, moments: usize) -> Self {
        let films = plan.by_light().into_iter().map(|group| {
            let count = if group[0].time == TimeDependence::None { 1 } else { moments };
            count as f64 * plan.film_bytes(group[0]).memory
        });
        Self { held_films: films.sum(), ..self }
    }

    /// The camera that takes most.
    #[must_use]
    pub fn largest(&self) -> Option<&(String, CameraMemory)> {
        self.cameras.iter().max_by(|(_, a), (_, b)| a.most().bytes.total_cmp(&b.most().bytes))
    }

    /// What is taken beyond the program itself, at most.
    #[must_use]
    pub fn beyond_program(&self) -> f64 {
        self.scene + self.held_films + self.largest().map_or(0.0, |(_, camera)| camera.most().bytes)
    }

    /// All of it.
    #[must_use]
    pub fn bytes(&self) -> f64 {
        self.program + self.beyond_program()
    }

    /// The parts, in words.
    #[must_use]
    pub fn parts(&self) -> String {
        let mb = |bytes: f64| format!("{:.1} MB", bytes / 1e6);
        let camera = self.largest().map_or_else(String::new, |(name, camera)| {
            let most = camera.most();
            format!(", camera {name} {} while {} (its film {})", mb(most.bytes), most.stage, mb(camera.film))
        });
        let held = if self.held_films > 0.0 {
            format!(", films that are held {}", mb(self.held_films))
        } else {
            String::new()
        };
        format!("program {}, scene {}{held}{camera}", mb(self.program), mb(self.scene))
    }
}
