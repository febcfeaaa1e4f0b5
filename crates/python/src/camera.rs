//! Results of one camera.

use crate::frame::Frame;
use crate::held::{LazyValue, full_cube};
use crate::samples::{self, Cube, Sample, plane};
use crate::watch::run;
use etendue::{CameraResults, GroundTruth, Light, MotionTruth, RayTable};
use etendue_core::quantity::{Disparity, Identity, Quantity};
use etendue_core::{Plane, StoredCube};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyRange};
use std::sync::Arc;

/// Results of one camera.
#[pyclass(frozen, module = "etendue")]
pub(crate) struct Camera {
    results: Arc<etendue::Results>,
    place: usize,
    threads: Option<u32>,
    radiance: LazyValue<Cube>,
    radiance_variance: LazyValue<Cube>,
    irradiance: LazyValue<Cube>,
    ghosts: LazyValue<Cube>,
    truth: LazyValue<GroundTruth>,
    motion: LazyValue<MotionTruth>,
    rays: LazyValue<RayTable>,
    disparity: LazyValue<Option<(Plane<Disparity>, Plane<Identity>)>>,
    frame: LazyValue<Option<Frame>>,
}

impl Camera {
    pub(crate) fn new(results: Arc<etendue::Results>, place: usize, threads: Option<u32>) -> Self {
        Self {
            results,
            place,
            threads,
            radiance: LazyValue::default(),
            radiance_variance: LazyValue::default(),
            irradiance: LazyValue::default(),
            ghosts: LazyValue::default(),
            truth: LazyValue::default(),
            motion: LazyValue::default(),
            rays: LazyValue::default(),
            disparity: LazyValue::default(),
            frame: LazyValue::default(),
        }
    }

    fn camera(&self) -> &CameraResults {
        &self.results.cameras()[self.place]
    }

    fn owner(&self) -> Arc<dyn Send + Sync> {
        Arc::clone(&self.results) as _
    }

    fn truth(&self, py: Python<'_>) -> PyResult<Arc<GroundTruth>> {
        self.truth.get(py, self.threads, || Ok(self.camera().ground_truth()))
    }

    fn motion(&self, py: Python<'_>) -> PyResult<Arc<MotionTruth>> {
        self.motion.get(py, self.threads, || Ok(self.camera().motion_truth()))
    }

    /// Plane of the ground truth.
    fn truth_plane<'py, Q>(
        &self,
        py: Python<'py>,
        plane_of: fn(&GroundTruth) -> &Plane<Q>,
    ) -> PyResult<Bound<'py, PyAny>>
    where
        Q: Quantity,
        Q::Sample: Sample,
    {
        let truth = self.truth(py)?;
        plane(py, plane_of(&truth), Arc::clone(&truth) as _)
    }

    /// Plane that not every ground truth has.
    fn optional_truth<'py, Q>(
        &self,
        py: Python<'py>,
        plane_of: fn(&GroundTruth) -> Option<&Plane<Q>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>>
    where
        Q: Quantity,
        Q::Sample: Sample,
    {
        let truth = self.truth(py)?;
        plane_of(&truth).map(|value| plane(py, value, Arc::clone(&truth) as _)).transpose()
    }

    /// First of the frames.
    fn first(&self, py: Python<'_>) -> PyResult<Arc<Option<Frame>>> {
        let number = self.camera().frame_numbers().start;
        self.frame.get(py, self.threads, || {
            Ok(self.camera().frames().next().map(|frame| Frame::new(number, Arc::new(frame))))
        })
    }

    /// Cube that the job may not request.
    fn cube<'py, Q: Quantity<Sample = f32>>(
        &self,
        py: Python<'py>,
        lazy: &LazyValue<Cube>,
        cube_of: fn(&Light) -> Option<&StoredCube<Q>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(cube_source) = cube_of(self.camera().light()) else { return Ok(None) };
        let cube = lazy.get(py, self.threads, || full_cube(cube_source))?;
        samples::cube(py, &cube).map(Some)
    }
}

#[pymethods]
impl Camera {
    /// Name of the camera in its job.
    #[getter]
    fn name(&self) -> &str {
        self.camera().name()
    }

    /// Numbers of the frames of these results: one if light depends on time.
    #[getter]
    fn frame_numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyRange>> {
        let frames = self.camera().frame_numbers();
        PyRange::new(py, frames.start as isize, frames.end as isize)
    }

    /// Centres of the bands of radiance and irradiance, nm: a list, or None if there is neither.
    #[getter]
    fn wavelengths_nm(&self) -> Option<Vec<f64>> {
        let light = self.camera().light();
        let bands = light.radiance.as_ref().map(|radiance| radiance.mean.bands());
        let bands = bands.or_else(|| light.irradiance.as_ref().map(StoredCube::bands))?;
        Some((0..bands.count()).map(|i| bands.centre_nm(i)).collect())
    }

    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹: float32, (bands, height, width). None if the job does not request it.
    #[getter]
    fn radiance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.cube(py, &self.radiance, |light| light.radiance.as_ref().map(|radiance| &radiance.mean))
    }

    /// Variance of the mean radiance, in its unit squared: float32, (bands, height, width). None if there is no radiance.
    #[getter]
    fn radiance_variance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.cube(py, &self.radiance_variance, |light| light.radiance.as_ref().map(|radiance| &radiance.variance))
    }

    /// Spectral irradiance on the sensor plane, W·m⁻²·nm⁻¹: float32, (bands, height, width). None if the job does not request it.
    #[getter]
    fn irradiance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.cube(py, &self.irradiance, |light| light.irradiance.as_ref())
    }

    /// Irradiance of the ghosts, W·m⁻²·nm⁻¹: float32, (bands, height, width). None if the camera has none.
    #[getter]
    fn ghosts<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.cube(py, &self.ghosts, |light| light.ghosts.as_ref())
    }

    /// Mean electrons of each pixel, e⁻: float32, (height, width). None if the camera has no electronics.
    #[getter]
    fn electrons<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let electrons = self.camera().electrons();
        electrons.map(|electrons| plane(py, electrons, self.owner())).transpose()
    }

    /// Captured frames; none if the camera has no electronics. The sensor is simulated at every call, with the same bits.
    fn frames(&self, py: Python<'_>) -> PyResult<Vec<Frame>> {
        let numbers = self.camera().frame_numbers();
        let frames = run(py, self.threads, None, |_| Ok(self.camera().frames().map(Arc::new).collect::<Vec<_>>()))?;
        Ok(numbers.zip(frames).map(|(number, frame)| Frame::new(number, frame)).collect())
    }

    /// Digital numbers of the first frame, DN: uint32, (height, width). None if the camera has no electronics.
    #[getter]
    fn raw<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.first(py)?.as_ref().as_ref().map(|frame| frame.raw(py)).transpose()
    }

    /// Image of the first frame, encoded, 0 to 1: float32, (height, width, 3). None if the camera makes none.
    #[getter]
    fn picture<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(self.first(py)?.as_ref().as_ref().map(|frame| frame.picture(py)).transpose()?.flatten())
    }

    /// Distance along the camera's axis, m: float32, (height, width); +inf for the sky, NaN without a ray.
    #[getter]
    fn depth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.truth_plane(py, |truth| &truth.depth)
    }

    /// Distance along each pixel's ray, m: float32, (height, width); +inf for the sky, NaN without a ray.
    #[getter]
    fn distance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.truth_plane(py, |truth| &truth.distance)
    }

    /// Unit shading normals in the world: float32, (height, width, 3); zero for the sky.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.truth_plane(py, |truth| &truth.normal)
    }

    /// Positions in the world, m: float32, (height, width, 3); zero for the sky.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.truth_plane(py, |truth| &truth.position)
    }

    /// Rounding remainder of the positions, m: float32, (height, width, 3). None except for cameras far from the world's origin.
    #[getter]
    fn positions_low<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.optional_truth(py, |truth| truth.position_low.as_ref())
    }

    /// Positions in the camera's frame, m: float32, (height, width, 3); zero for the sky. None if the job does not request them.
    #[getter]
    fn camera_space_positions<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.optional_truth(py, |truth| truth.camera_space_position.as_ref())
    }

    /// Ids of instances: uint32, (height, width); 0 is the background.
    #[getter]
    fn instance_ids<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.truth_plane(py, |truth| &truth.instance)
    }

    /// Ids of classes: uint32, (height, width); 0 is the background and objects without a class.
    #[getter]
    fn semantic_ids<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.truth_plane(py, |truth| &truth.semantic)
    }

    /// Indices in the plan's list of materials, from 1: uint32, (height, width); 0 is the background.
    #[getter]
    fn material_ids<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.truth_plane(py, |truth| &truth.material)
    }

    /// Optical flow to the next frame, px: float32, (height, width, 2); NaN where there is no image.
    #[getter]
    fn flow<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let motion = self.motion(py)?;
        plane(py, &motion.neighbours[0].flow, Arc::clone(&motion) as _)
    }

    /// Motion ground truth (docs/ground-truth.md): a dict of "forward" and "backward" (None before frame 0), each with "flow", px, (height, width, 2),
    /// "visibility", (height, width), and "scene_flow", m, (height, width, 3); "motion_vector", px/s, (height, width, 2); "velocity", m/s, (height, width, 3);
    /// "time", s, (height, width).
    fn motion_truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let motion = self.motion(py)?;
        let dict = PyDict::new(py);
        dict.set_item("forward", neighbour(py, &motion, 0)?)?;
        dict.set_item("backward", neighbour(py, &motion, 1)?)?;
        dict.set_item("motion_vector", plane(py, &motion.motion_vector, Arc::clone(&motion) as _)?)?;
        dict.set_item("velocity", plane(py, &motion.velocity, Arc::clone(&motion) as _)?)?;
        dict.set_item("time", plane(py, &motion.time, Arc::clone(&motion) as _)?)?;
        Ok(dict)
    }

    /// Disparity to the camera that the job's `disparity_to` names, px: float32, (height, width). None if it names none.
    #[getter]
    fn disparity<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let disparity_planes = self.disparity.get(py, self.threads, || Ok(self.camera().disparity()))?;
        disparity_planes
            .as_ref()
            .as_ref()
            .map(|(disparity, _)| plane(py, disparity, Arc::clone(&disparity_planes) as _))
            .transpose()
    }

    /// Visibility of each point in that camera: uint32, (height, width), the numbers of docs/ground-truth.md. None if the job names none.
    #[getter]
    fn disparity_visibility<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let disparity = self.disparity.get(py, self.threads, || Ok(self.camera().disparity()))?;
        disparity.as_ref().as_ref().map(|(_, visible)| plane(py, visible, Arc::clone(&disparity) as _)).transpose()
    }

    /// Boxes of the objects, as in `boxes.json`.
    #[getter]
    fn boxes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = run(py, self.threads, None, |_| Ok(self.camera().boxes_json().to_string()))?;
        py.import("json")?.call_method1("loads", (text,))
    }

    /// Ray of each pixel in the camera's frame: a dict of "origin", m, and "direction", float32, (height, width, 3); "ray", uint32, (height, width): 0 none, 1
    /// the principal ray, 2 one through the centroid of the open pupil; "path", m, for a camera with a mirror.
    #[getter]
    fn rays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rays = self.rays.get(py, self.threads, || Ok(self.camera().rays()))?;
        let dict = PyDict::new(py);
        dict.set_item("origin", plane(py, &rays.origin, Arc::clone(&rays) as _)?)?;
        dict.set_item("direction", plane(py, &rays.direction, Arc::clone(&rays) as _)?)?;
        dict.set_item("ray", plane(py, &rays.ray, Arc::clone(&rays) as _)?)?;
        let path = rays.path.as_ref().map(|path| plane(py, path, Arc::clone(&rays) as _));
        path.transpose()?.map_or(Ok(()), |path| dict.set_item("path", path))?;
        Ok(dict)
    }

    fn __repr__(&self) -> String {
        let raster = &self.camera().camera().body.raster;
        format!("<etendue.Camera {}: {} × {} px>", self.name(), raster.width(), raster.height())
    }
}

/// Motion to a neighbouring frame; `None` if there is none.
fn neighbour<'py>(py: Python<'py>, motion: &Arc<MotionTruth>, place: usize) -> PyResult<Option<Bound<'py, PyDict>>> {
    let Some(displacement) = motion.neighbours.get(place) else { return Ok(None) };
    let dict = PyDict::new(py);
    dict.set_item("flow", plane(py, &displacement.flow, Arc::clone(motion) as _)?)?;
    dict.set_item("visibility", plane(py, &displacement.visibility, Arc::clone(motion) as _)?)?;
    dict.set_item("scene_flow", plane(py, &displacement.scene_flow, Arc::clone(motion) as _)?)?;
    Ok(Some(dict))
}
