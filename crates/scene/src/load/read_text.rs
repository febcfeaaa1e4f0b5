//! Access of the loader to files: it opens none itself.

use std::path::Path;

use crate::fault::Problem;

/// Reads the text of a file. The error states the cause in a few words, and after a semicolon the remedy, unless that is to correct the path.
pub type ReadText<'r> = dyn Fn(&Path) -> Result<String, Problem> + 'r;
