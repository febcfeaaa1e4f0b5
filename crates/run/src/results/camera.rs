//! Results of one camera in memory.

use super::frames::{encode_picture, frames};
use crate::job_request::RenderOptions;
use crate::rig;
use etendue_core::quantity::{Display, MeanElectrons};
use etendue_core::{CameraPose, ExactTime, Plane};
use etendue_io::failure::Error;
use etendue_io::jpeg::encode_jpeg;
use etendue_pipeline::film::Film;
use etendue_pipeline::photograph::{Frame, Light, capture, capture_with_breakdown};
use etendue_pipeline::plan::{CameraPlan, Plan, TimeDependence};
use etendue_pipeline::pupil_depth::{PupilDepth, pupil_depth};
use etendue_pipeline::rays::{RayTable, ray_table};
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_pipeline::sampling::SamplingPlanes;
use etendue_pipeline::truth::{GroundTruth, ground_truth};
use etendue_sensor::{FrameAddress, Sensor, SensorState};
use etendue_tracer::accel::Simd;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// Results of one camera: of all frames if its light is constant, otherwise of one frame. The light is stored; frames, ground truth and rays are computed on
/// request.
#[derive(Clone, Debug)]
pub struct CameraResults {
    pub(super) plan: Arc<Plan>,
    /// Index of the camera in the plan.
    camera: usize,
    pub(super) light: Light,
    pub(super) sampling: Option<SamplingPlanes>,
    pub(super) depth: Option<PupilDepth>,
    pub(super) undistorted: Option<RectifiedCamera>,
    pub(super) frames: Range<u32>,
    /// State of the sensor before the first of these frames.
    state: SensorState,
    /// The frame, if it has its own light and the sensor keeps a state: later frames depend on it.
    cached_frame: Option<FrameWithState>,
    pub(super) simd: Simd,
}

/// State of a sensor, and the first frame that contributed to it.
#[derive(Clone, Debug, Default)]
pub(crate) struct SensorHistory {
    pub(crate) state: SensorState,
    pub(crate) since: u32,
}

/// A rendered frame, and the state of the sensor after it.
#[derive(Clone, Debug)]
struct FrameWithState {
    frame: Frame,
    state_after: SensorHistory,
}

impl CameraResults {
    /// Computes all results of a camera of the plan from its films, one for each capture with a different exposure. Runs on the caller's thread pool.
    pub(crate) fn from_films(
        plan: &Arc<Plan>,
        camera: &CameraPlan,
        films: Vec<Film>,
        before: SensorHistory,
        options: &RenderOptions,
    ) -> Result<Self, Error> {
        let place = plan.cameras.iter().position(|c| c.name == camera.name).expect("a camera of the plan");
        let depth = pupil_depth(plan, camera, options.frames.start, options.simd);
        let sampling = films.first().filter(|_| camera.products.sampling).map(|film| SamplingPlanes::new(camera, film));
        let light = Light::from_captures(camera, films, depth.as_ref())
            .map_err(|error| Error::Run(format!("camera {}: {error}", camera.name)))?;
        let undistorted = camera.products.undistorted;
        let undistorted = undistorted.map(|scale| {
            RectifiedCamera::new(&camera.body, scale).expect("a compiled plan's camera has its rectified twin")
        });
        let (frames, simd) = (options.frames.clone(), options.simd);
        let (plan, SensorHistory { state, since }) = (Arc::clone(plan), before);
        let remembered = None;
        let mut results = Self {
            plan,
            camera: place,
            light,
            sampling,
            depth,
            undistorted,
            frames,
            state,
            cached_frame: remembered,
            simd,
        };
        if results.has_own_light() {
            results.cached_frame = results.remembered_frame(since);
        }
        Ok(results)
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

    /// Spectral radiance, irradiance and mean electrons, as far as the job requests them.
    #[must_use]
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// Sampling of each pixel in the first capture; `None` if the job does not request it.
    #[must_use]
    pub fn sampling(&self) -> Option<&SamplingPlanes> {
        self.sampling.as_ref()
    }

    /// Mean electrons of each pixel; `None` for a camera without electronics.
    #[must_use]
    pub fn electrons(&self) -> Option<&Plane<MeanElectrons>> {
        self.light.electrons.as_ref()
    }

    /// The run's frames in order, with the state of the sensor carried from one to the next: raw, and developed image if the camera has processing. Empty for
    /// a camera without electronics.
    pub fn frames(&self) -> impl Iterator<Item = Frame> + '_ {
        self.numbered_frames().map(|(_, frame)| frame.into_owned())
    }

    /// The frames with their numbers; a frame that was computed before is reused.
    pub(super) fn numbered_frames(&self) -> impl Iterator<Item = (u32, Cow<'_, Frame>)> + '_ {
        let signal_breakdown = self.camera().products.signal_breakdown;
        let known = self.cached_frame.as_ref().map(|known| (self.frames.start, Cow::Borrowed(&known.frame)));
        let light = self.light.captures().filter(|_| known.is_none());
        let computed = light.map(|light| {
            let (address, state) = (|frame| self.address(frame), self.state.clone());
            frames(&self.camera().body, light, self.frames.clone(), state, address, signal_breakdown)
        });
        known.into_iter().chain(computed.into_iter().flatten())
    }

    /// The first frame's image as shown on a display, 0 to 1; `None` for a camera without processing.
    #[must_use]
    pub fn display_image(&self) -> Option<Plane<Display>> {
        self.frames().next()?.picture.map(|developed| developed.display)
    }

    /// The file of a frame's image as `render` writes it (extension and bytes); `None` for a camera without processing.
    ///
    /// # Errors
    /// The image cannot be encoded.
    pub fn image_file(&self, frame: &Frame) -> Option<Result<(&'static str, Vec<u8>), Error>> {
        let (image, development) = frame.picture.as_ref().zip(self.camera().body.development.as_ref())?;
        let bytes =
            encode_picture(&image.display, development).map_err(|error| Error::Run(format!("picture: {error}")));
        Some(bytes.map(|bytes| (development.format.extension(), bytes)))
    }

    /// Pose of the camera at the middle of a frame's first exposure, and that time, s, as in `frame.NNNN.json`.
    #[must_use]
    pub fn pose(&self, frame: u32) -> (CameraPose, ExactTime) {
        let camera = self.camera();
        (rig::pose(camera, frame), camera.timing.frame_middle(frame))
    }

    /// The plan that contains the camera.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Numbers of the run's frames that these results cover: a single one where light depends on time.
    #[must_use]
    pub fn frame_numbers(&self) -> Range<u32> {
        self.frames.clone()
    }

    /// Depth, normals, positions and identities of the first frame along the principal rays of the pixel centres. Traced at each call, on the caller's thread
    /// pool.
    #[must_use]
    pub fn ground_truth(&self) -> GroundTruth {
        ground_truth(&self.plan, self.camera(), self.frames.start, self.simd)
    }

    /// The origin and direction of each pixel's ray.
    #[must_use]
    pub fn rays(&self) -> RayTable {
        ray_table(&self.camera().body)
    }

    /// Returns true if each frame has its own light and files.
    pub(crate) fn has_own_light(&self) -> bool {
        self.camera().time != TimeDependence::None
    }

    /// State of the sensor after a frame with its own light; `None` for a sensor without a state.
    pub(crate) fn state_after(&self) -> Option<&SensorHistory> {
        self.cached_frame.as_ref().map(|known| &known.state_after)
    }

    /// Computes the frame if the sensor keeps a state.
    fn remembered_frame(&self, since: u32) -> Option<FrameWithState> {
        let camera = self.camera();
        let light = self.light.captures().filter(|_| camera.body.sensor.as_ref().is_some_and(Sensor::has_memory))?;
        let step = if camera.products.signal_breakdown { capture_with_breakdown } else { capture };
        let (state, frame) = step(&camera.body, self.state.clone(), light, self.address(self.frames.start))?;
        Some(FrameWithState { frame, state_after: SensorHistory { state, since } })
    }

    /// Address of a frame of the camera among all frames.
    pub(super) fn address(&self, frame: u32) -> FrameAddress {
        let camera = self.camera();
        FrameAddress { seed: camera.settings.seed, camera: camera.index, frame, capture: 0 }
    }
}

/// Encodes a display image as a JPEG of quality 1 to 100.
///
/// # Errors
/// It cannot be encoded.
pub fn display_jpeg(image: &Plane<Display>, quality: u8) -> Result<Vec<u8>, Error> {
    encode_jpeg(image, quality).map_err(|error| Error::Run(error.to_string()))
}
