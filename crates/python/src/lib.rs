//! Étendue in Python: the library `etendue` behind classes whose planes are NumPy arrays, and the verbs of the command line as functions.
//!
//! Long tasks run on a separate thread, with Python's lock released: the calling thread waits, passes on progress and messages, and checks for signals, so that
//! Ctrl-C cancels ([`watch`]). The Python part of the API is in `python/etendue`.

mod camera;
mod error;
mod frame;
mod held;
mod job;
mod meshes;
mod results;
mod samples;
mod toml;
mod verbs;
mod watch;

use pyo3::prelude::*;

/// Classes and functions for `import etendue`.
#[pymodule]
fn _etendue(module: &Bound<'_, PyModule>) -> PyResult<()> {
    etendue_cli::silence_decoder_panics();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<job::Job>()?;
    module.add_class::<results::Results>()?;
    module.add_class::<camera::Camera>()?;
    module.add_class::<frame::Frame>()?;
    module.add_function(wrap_pyfunction!(verbs::call, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::catalogue, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::main, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::set_limit, module)?)?;
    module.add_function(wrap_pyfunction!(toml::to_toml, module)?)
}
