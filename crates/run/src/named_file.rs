//! Files that the user names one by one: plots, previews, camera files.

use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{Existing, OutputFolder};
use std::path::Path;

/// Writes a file and the folders that lead to it; never half of it.
///
/// # Errors
/// Where it cannot be written, or is there and must not be replaced.
pub fn write_file(path: &Path, bytes: &[u8], existing: Existing) -> Result<(), Error> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| {
        Error::coded(ErrorCode::InvalidArgument, format!("{}: expected the name of a file", path.display()))
    })?;
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut folder = OutputFolder::open_beside(parent, existing).map_err(Error::input)?;
    folder.write(name, bytes).map_err(Error::input)?;
    folder.commit().map_err(|error| Error::Run(error.to_string())).map(|_| ())
}
