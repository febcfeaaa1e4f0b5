//! One camera's results in memory.

use super::frames::frames;
use crate::error::Error;
use crate::render_options::RenderOptions;
use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_pipeline::film::Film;
use etendue_pipeline::photograph::{Frame, Light};
use etendue_pipeline::plan::{CameraPlan, Plan};
use etendue_pipeline::pupil_depth::{PupilDepth, pupil_depth};
use etendue_pipeline::rays::{RayTable, ray_table};
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_pipeline::truth::{GroundTruth, ground_truth};
use etendue_sensor::FrameAddress;
use etendue_tracer::accel::Simd;
use std::ops::Range;
use std::sync::Arc;

/// The results of one camera. Its light is held; frames, ground truth and rays are computed when they are asked for.
#[derive(Clone, Debug)]
pub struct CameraResults {
    pub(super) plan: Arc<Plan>,
    /// Its place among the plan's cameras.
    camera: usize,
    pub(super) light: Light,
    pub(super) depth: Option<PupilDepth>,
    pub(super) undistorted: Option<RectifiedCamera>,
    pub(super) frames: Range<u32>,
    pub(super) simd: Simd,
}

impl CameraResults {
    /// Everything that a camera of the plan delivers of its film. Runs on the caller's thread pool.
    pub(crate) fn of_film(
        plan: &Arc<Plan>,
        camera: &CameraPlan,
        film: Film,
        options: &RenderOptions,
    ) -> Result<Self, Error> {
        let place = plan.cameras.iter().position(|c| c.name == camera.name).expect("a camera of the plan");
        let depth = pupil_depth(plan, camera, options.simd);
        let light = Light::of_film(camera, film, depth.as_ref())
            .map_err(|error| Error::Run(format!("camera {}: {error}", camera.name)))?;
        let undistorted = camera.products.undistorted;
        let undistorted = undistorted.map(|scale| {
            RectifiedCamera::of(&camera.body, scale).expect("a compiled plan's camera has its rectified twin")
        });
        let (frames, simd) = (options.frames.clone(), options.simd);
        Ok(Self { plan: Arc::clone(plan), camera: place, light, depth, undistorted, frames, simd })
    }

    /// The camera in the plan.
    #[must_use]
    pub fn camera(&self) -> &CameraPlan {
        &self.plan.cameras[self.camera]
    }

    /// The camera's name in its job.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.camera().name
    }

    /// Spectral radiance, irradiance and mean electrons, as far as the job asks for them.
    #[must_use]
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// Mean electrons of each pixel; `None` where the camera has no electronics.
    #[must_use]
    pub fn electrons(&self) -> Option<&Plane<MeanElectrons>> {
        self.light.electrons.as_ref()
    }

    /// The photographs of the run's frames, one after the other as the sensor's state runs through them: raw, and picture where
    /// the camera processes it; nothing where the camera has no electronics.
    pub fn frames(&self) -> impl Iterator<Item = Frame> + '_ {
        let electrons = self.electrons();
        let signal_breakdown = self.camera().products.signal_breakdown;
        let frames = electrons.map(|electrons| {
            let address = |frame| self.address(frame);
            frames(&self.camera().body, electrons, self.frames.clone(), address, signal_breakdown)
        });
        frames.into_iter().flatten().map(|(_, frame)| frame)
    }

    /// Depth, normals, positions and identities along the principal rays of the pixels' centres. Traced anew at each call, on
    /// the caller's thread pool.
    #[must_use]
    pub fn ground_truth(&self) -> GroundTruth {
        ground_truth(&self.plan, self.camera(), self.simd)
    }

    /// The origin and direction of each pixel's ray.
    #[must_use]
    pub fn rays(&self) -> RayTable {
        ray_table(&self.camera().body)
    }

    /// Where a frame of the camera stands among all.
    pub(super) fn address(&self, frame: u32) -> FrameAddress {
        let camera = self.camera();
        FrameAddress { seed: camera.settings.seed, camera: camera.index, frame, capture: 0 }
    }
}
