//! Derived results of a camera, computed on first use and then kept: all arrays of one result share it.

use crate::samples::Cube;
use crate::watch::run;
use etendue::Error;
use etendue_core::StoredCube;
use etendue_core::quantity::Quantity;
use pyo3::prelude::*;
use std::sync::{Arc, OnceLock};

/// Value that is computed at most once.
pub(crate) struct LazyValue<T>(OnceLock<Arc<T>>);

impl<T> Default for LazyValue<T> {
    fn default() -> Self {
        Self(OnceLock::new())
    }
}

impl<T: Send + Sync> LazyValue<T> {
    /// Returns the value. If it is missing, `make` computes it on a pool of `threads`. Two concurrent callers may both compute it; one result is kept.
    pub(crate) fn get(
        &self,
        py: Python<'_>,
        threads: Option<u32>,
        make: impl FnOnce() -> Result<T, Error> + Send,
    ) -> PyResult<Arc<T>> {
        if let Some(value) = self.0.get() {
            return Ok(Arc::clone(value));
        }
        let computed = Arc::new(run(py, threads, None, |_| make())?);
        Ok(Arc::clone(self.0.get_or_init(|| computed)))
    }
}

/// Bands of a cube in one contiguous block, wherever they are stored.
pub(crate) fn full_cube<Q: Quantity<Sample = f32>>(cube: &StoredCube<Q>) -> Result<Cube, Error> {
    let shape = [cube.bands().count(), cube.height(), cube.width()];
    let mut samples = Vec::with_capacity(shape.iter().product());
    for band in 0..shape[0] {
        samples.extend_from_slice(cube.plane(band).map_err(Error::run)?.samples());
    }
    Ok(Cube { shape, samples })
}
