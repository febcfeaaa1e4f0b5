//! How the loader reads: it opens no file itself.

use std::path::Path;

use crate::fault::Problem;

/// Reads the text of a file; the error says in a few words why it cannot, and behind a semicolon what to do, where that is not to correct the path.
pub type ReadText<'r> = dyn Fn(&Path) -> Result<String, Problem> + 'r;
