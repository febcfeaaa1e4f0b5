//! Names of files that the user gives one by one.

use std::path::PathBuf;

/// The name of a plot: nothing but an earlier drawing can be replaced by it.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn svg(text: &str) -> Result<PathBuf, String> {
    ending(text, "svg")
}

/// The name of a page.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn html(text: &str) -> Result<PathBuf, String> {
    ending(text, "html")
}

/// The name of a picture.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn png(text: &str) -> Result<PathBuf, String> {
    ending(text, "png")
}

/// The name of a camera file.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn toml(text: &str) -> Result<PathBuf, String> {
    ending(text, "toml")
}

fn ending(text: &str, extension: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension)) {
        true => Ok(path),
        false => Err(format!("expected a file name that ends in .{extension}")),
    }
}
