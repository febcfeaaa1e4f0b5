//! Results of a job.

use crate::camera::Camera;
use crate::watch::run;
use etendue::Existing;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// The results of all cameras of a job: their light is held; frames and ground truth are made when they are asked for.
#[pyclass(frozen, module = "etendue")]
pub(crate) struct Results {
    results: Arc<etendue::Results>,
    threads: Option<u32>,
    cameras: Vec<Py<Camera>>,
}

impl Results {
    pub(crate) fn new(py: Python<'_>, results: etendue::Results, threads: Option<u32>) -> PyResult<Self> {
        let results = Arc::new(results);
        let camera = |place| Py::new(py, Camera::new(Arc::clone(&results), place, threads));
        let cameras = (0..results.cameras().len()).map(camera).collect::<PyResult<_>>()?;
        Ok(Self { results, threads, cameras })
    }
}

#[pymethods]
impl Results {
    /// The cameras, those of equal light one after the other; where light depends on time, once for each frame.
    #[getter]
    fn cameras(&self, py: Python<'_>) -> Vec<Py<Camera>> {
        self.cameras.iter().map(|camera| camera.clone_ref(py)).collect()
    }

    /// Names of the cameras, each once.
    #[getter]
    fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for camera in self.results.cameras() {
            if !names.iter().any(|name| name == camera.name()) {
                names.push(camera.name().to_owned());
            }
        }
        names
    }

    fn __len__(&self) -> usize {
        self.cameras.len()
    }

    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<Camera>> {
        self.camera(py, name, None)
    }

    /// A camera by its name; where light depends on time, of one frame: the first unless another is named.
    #[pyo3(signature = (name, frame = None))]
    fn camera(&self, py: Python<'_>, name: &str, frame: Option<u32>) -> PyResult<Py<Camera>> {
        let of = |camera: &etendue::CameraResults| {
            camera.name() == name && frame.is_none_or(|frame| camera.frame_numbers().contains(&frame))
        };
        let place = self.results.cameras().iter().position(of).ok_or_else(|| {
            let frame = frame.map(|frame| format!(" with frame {frame}")).unwrap_or_default();
            PyKeyError::new_err(format!("no camera {name:?}{frame}; there are {}", self.names().join(", ")))
        })?;
        Ok(self.cameras[place].clone_ref(py))
    }

    /// Writes the files of `etendue render`, the same bytes; answers with their paths.
    #[pyo3(signature = (folder, *, overwrite = false))]
    fn save(&self, py: Python<'_>, folder: PathBuf, overwrite: bool) -> PyResult<Vec<PathBuf>> {
        run(py, self.threads, None, |watch| self.results.save(&folder, existing(overwrite), watch))
    }

    fn __repr__(&self) -> String {
        format!("<etendue.Results of {}>", self.names().join(", "))
    }
}

/// What happens to files of an earlier run.
pub(crate) fn existing(overwrite: bool) -> Existing {
    if overwrite { Existing::Replace } else { Existing::Refuse }
}
