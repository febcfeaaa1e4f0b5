//! Captured frame.

use crate::samples::plane;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyList};
use std::sync::Arc;

/// Captured frame of a camera.
#[pyclass(frozen, module = "etendue")]
pub(crate) struct Frame {
    number: u32,
    frame: Arc<etendue::Frame>,
}

impl Frame {
    pub(crate) fn new(number: u32, frame: Arc<etendue::Frame>) -> Self {
        Self { number, frame }
    }
}

#[pymethods]
impl Frame {
    /// Frame number.
    #[getter]
    fn number(&self) -> u32 {
        self.number
    }

    /// Digital numbers, DN: uint32, (height, width).
    #[getter]
    pub(crate) fn raw<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plane(py, &self.frame.raw.plane, Arc::clone(&self.frame) as _)
    }

    /// Bits per digital number.
    #[getter]
    fn bits(&self) -> u32 {
        self.frame.raw.bits
    }

    /// Digital number at zero charge.
    #[getter]
    fn black_level_dn(&self) -> f64 {
        self.frame.raw.black_level_dn
    }

    /// Digital number of a saturated pixel.
    #[getter]
    fn white_level_dn(&self) -> f64 {
        self.frame.raw.white_level_dn
    }

    /// Image as its file encodes it, before rounding to bits, 0 to 1: float32, (height, width, 3). None if the camera makes none.
    #[getter]
    pub(crate) fn picture<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let image = self.frame.picture.as_ref();
        image.map(|image| plane(py, &image.display, Arc::clone(&self.frame) as _)).transpose()
    }

    /// The same image in linear sRGB, not clipped: float32, (height, width, 3). None if the camera makes none.
    #[getter]
    fn linear_picture<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let image = self.frame.picture.as_ref();
        image.map(|image| plane(py, &image.linear, Arc::clone(&self.frame) as _)).transpose()
    }

    fn __len__(&self) -> usize {
        self.keys().len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.keys())?.try_iter()
    }

    fn __contains__(&self, name: &Bound<'_, PyAny>) -> bool {
        name.extract::<String>().is_ok_and(|name| self.keys().contains(&name.as_str()))
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let value = self.get(py, name, None)?;
        value.ok_or_else(|| {
            PyKeyError::new_err(format!("unknown array {name:?}; available: {}", self.keys().join(", ")))
        })
    }

    /// Names of the arrays of the frame: raw, and image and linear_picture if the camera makes images.
    fn keys(&self) -> Vec<&'static str> {
        let all = ["raw", "picture", "linear_picture"];
        all[..if self.frame.picture.is_some() { 3 } else { 1 }].to_vec()
    }

    /// The arrays, in the order of `keys`.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        self.keys().into_iter().map(|name| self.__getitem__(py, name)).collect()
    }

    /// Names and arrays, as `keys` and `values`.
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Vec<(&'static str, Bound<'py, PyAny>)>> {
        Ok(self.keys().into_iter().zip(self.values(py)?).collect())
    }

    /// The array of a name, or `default` if there is none.
    #[pyo3(signature = (name, default = None))]
    fn get<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        default: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let value = match name {
            "raw" => Some(self.raw(py)?),
            "picture" => self.picture(py)?,
            "linear_picture" => self.linear_picture(py)?,
            _ => None,
        };
        Ok(value.or(default))
    }

    fn __repr__(&self) -> String {
        let plane = &self.frame.raw.plane;
        format!(
            "<etendue.Frame {}: {} × {} px, {} bits>",
            self.number,
            plane.width(),
            plane.height(),
            self.frame.raw.bits
        )
    }
}
