//! A photograph.

use crate::samples::plane;
use pyo3::prelude::*;
use std::sync::Arc;

/// A photograph of a camera.
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
    /// The frame's number.
    #[getter]
    fn number(&self) -> u32 {
        self.number
    }

    /// Digital numbers, DN: uint32, (height, width).
    #[getter]
    pub(crate) fn raw<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plane(py, &self.frame.raw.plane, Arc::clone(&self.frame) as _)
    }

    /// Bits of a digital number.
    #[getter]
    fn bits(&self) -> u32 {
        self.frame.raw.bits
    }

    /// The digital number of no charge.
    #[getter]
    fn black_level_dn(&self) -> f64 {
        self.frame.raw.black_level_dn
    }

    /// The digital number of a saturated pixel.
    #[getter]
    fn white_level_dn(&self) -> f64 {
        self.frame.raw.white_level_dn
    }

    /// The picture as its file encodes it, before it is rounded to bits, 0 to 1: float32, (height, width, 3). None where the camera makes none.
    #[getter]
    pub(crate) fn picture<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let picture = self.frame.picture.as_ref();
        picture.map(|picture| plane(py, &picture.display, Arc::clone(&self.frame) as _)).transpose()
    }

    /// The same in linear sRGB, not clipped: float32, (height, width, 3). None where the camera makes none.
    #[getter]
    fn linear_picture<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let picture = self.frame.picture.as_ref();
        picture.map(|picture| plane(py, &picture.linear, Arc::clone(&self.frame) as _)).transpose()
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
