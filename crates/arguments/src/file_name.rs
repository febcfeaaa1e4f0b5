//! File names that the user gives one at a time.

use std::path::PathBuf;

/// Parses the name of a plot: it can replace only an earlier drawing.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn svg(text: &str) -> Result<PathBuf, String> {
    ending(text, "svg")
}

/// Parses the name of a page.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn html(text: &str) -> Result<PathBuf, String> {
    ending(text, "html")
}

/// Parses the name of an image.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn png(text: &str) -> Result<PathBuf, String> {
    ending(text, "png")
}

/// Parses the name of a camera file.
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
