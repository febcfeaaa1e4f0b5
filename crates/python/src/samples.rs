//! Planes as NumPy arrays that share their memory: rows from the top, pixels from the left.
//!
//! NumPy reads the address by its array interface (version 3, <https://numpy.org/doc/stable/reference/arrays.interface.html>) and keeps the object that
//! provides it, which owns the samples. Arrays are read-only: files are written from the same memory.

use etendue_core::Plane;
use etendue_core::quantity::Quantity;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

/// Type of a plane's sample for NumPy.
pub(crate) trait Sample: Copy + Send + Sync + 'static {
    /// `f4`, `u4`.
    const TYPE: &'static str;
    /// Numbers per sample, if more than one.
    const NUMBERS: Option<usize> = None;
}

impl Sample for f32 {
    const TYPE: &'static str = "f4";
}

impl Sample for u32 {
    const TYPE: &'static str = "u4";
}

impl<const N: usize> Sample for [f32; N] {
    const TYPE: &'static str = "f4";
    const NUMBERS: Option<usize> = Some(N);
}

/// Samples that live as long as any array of them.
#[pyclass(frozen, module = "etendue._etendue")]
pub(crate) struct Samples {
    address: usize,
    shape: Vec<usize>,
    type_of_number: &'static str,
    _owner: Arc<dyn Send + Sync>,
}

#[pymethods]
impl Samples {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let order = if cfg!(target_endian = "little") { '<' } else { '>' };
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        interface.set_item("typestr", format!("{order}{}", self.type_of_number))?;
        interface.set_item("data", (self.address, true))?;
        Ok(interface)
    }
}

/// An array of `shape` over samples that `owner` holds, at a fixed address and unchanged during its lifetime.
fn array<'py, T: Sample>(
    py: Python<'py>,
    samples: &[T],
    mut shape: Vec<usize>,
    owner: Arc<dyn Send + Sync>,
) -> PyResult<Bound<'py, PyAny>> {
    debug_assert_eq!(samples.len(), shape.iter().product::<usize>());
    shape.extend(T::NUMBERS);
    let samples = Samples { address: samples.as_ptr() as usize, shape, type_of_number: T::TYPE, _owner: owner };
    py.import("numpy")?.call_method1("asarray", (samples,))
}

/// A plane as an array of height × width, or × numbers of a sample.
pub(crate) fn plane<'py, Q>(
    py: Python<'py>,
    plane: &Plane<Q>,
    owner: Arc<dyn Send + Sync>,
) -> PyResult<Bound<'py, PyAny>>
where
    Q: Quantity,
    Q::Sample: Sample,
{
    array(py, plane.samples(), vec![plane.height(), plane.width()], owner)
}

/// Bands of a cube in one contiguous block.
pub(crate) struct Cube {
    pub(crate) shape: [usize; 3],
    pub(crate) samples: Vec<f32>,
}

/// A cube as an array of bands × height × width.
pub(crate) fn cube<'py>(py: Python<'py>, cube: &Arc<Cube>) -> PyResult<Bound<'py, PyAny>> {
    array(py, &cube.samples, cube.shape.to_vec(), Arc::clone(cube) as Arc<dyn Send + Sync>)
}
