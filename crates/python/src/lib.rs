//! Étendue in Python: the library `etendue` behind classes whose planes are NumPy arrays, and the verbs of the command line as functions.
//!
//! What takes long runs on a thread of its own, with Python's lock released: the calling thread waits for it, hands progress and messages over, and
//! looks for signals, so that Ctrl-C cancels ([`watch`]). The words of the API are in `python/etendue`.

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

/// What `import etendue` takes its classes and functions from.
#[pymodule]
fn _etendue(module: &Bound<'_, PyModule>) -> PyResult<()> {
    etendue_cli::quieten_decoders();
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
