//! Results of a job.

use crate::camera::Camera;
use crate::watch::run;
use etendue::ExistingFiles;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyList};
use std::path::PathBuf;
use std::sync::Arc;

/// Results of all cameras of a job: their light is kept in memory; frames and ground truth are computed on request.
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
    /// All cameras, those of equal light consecutively; if light depends on time, one entry per frame.
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
        self.names().len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.names())?.try_iter()
    }

    fn __contains__(&self, name: &Bound<'_, PyAny>) -> bool {
        name.extract::<String>().is_ok_and(|name| self.names().contains(&name))
    }

    /// Names of the cameras, as `names`.
    fn keys(&self) -> Vec<String> {
        self.names()
    }

    /// The camera of each name; if light depends on time, that of the first frame: `cameras` has all.
    fn values(&self, py: Python<'_>) -> PyResult<Vec<Py<Camera>>> {
        self.names().iter().map(|name| self.camera(py, name, None)).collect()
    }

    /// Names and cameras, as `keys` and `values`.
    fn items(&self, py: Python<'_>) -> PyResult<Vec<(String, Py<Camera>)>> {
        Ok(self.names().into_iter().zip(self.values(py)?).collect())
    }

    /// The camera of a name, or `default` if there is none.
    #[pyo3(signature = (name, default = None))]
    fn get(&self, py: Python<'_>, name: &str, default: Option<Py<PyAny>>) -> PyResult<Option<Py<PyAny>>> {
        if self.names().iter().any(|known| known == name) {
            return Ok(Some(self.camera(py, name, None)?.into_any()));
        }
        Ok(default)
    }

    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<Camera>> {
        self.camera(py, name, None)
    }

    /// A camera by its name; if light depends on time, of one frame: the first unless another is named.
    #[pyo3(signature = (name, frame = None))]
    fn camera(&self, py: Python<'_>, name: &str, frame: Option<u32>) -> PyResult<Py<Camera>> {
        let matches = |camera: &etendue::CameraResults| {
            camera.name() == name && frame.is_none_or(|frame| camera.frame_numbers().contains(&frame))
        };
        let place = self.results.cameras().iter().position(matches).ok_or_else(|| {
            let frame = frame.map(|frame| format!(" with frame {frame}")).unwrap_or_default();
            PyKeyError::new_err(format!("there is no camera {name:?}{frame}; available: {}", self.names().join(", ")))
        })?;
        Ok(self.cameras[place].clone_ref(py))
    }

    /// Writes the files of `etendue render`, byte for byte; returns their paths.
    #[pyo3(signature = (folder, *, overwrite = false))]
    fn save(&self, py: Python<'_>, folder: PathBuf, overwrite: bool) -> PyResult<Vec<PathBuf>> {
        run(py, self.threads, None, |watch| self.results.save(&folder, existing(overwrite), watch))
    }

    fn __repr__(&self) -> String {
        format!("<etendue.Results of {}>", self.names().join(", "))
    }
}

/// Treatment of files of an earlier run.
pub(crate) fn existing(overwrite: bool) -> ExistingFiles {
    if overwrite { ExistingFiles::Replace } else { ExistingFiles::Refuse }
}
