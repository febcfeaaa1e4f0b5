//! The user's browser.

use std::path::Path;
use std::process::{Command, Stdio};

/// Asks the system to open a file in the user's default program; returns true if the request could be made.
pub fn open(file: &Path) -> bool {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let file = file.canonicalize().unwrap_or_else(|_| file.to_path_buf());
    let mut command = Command::new(program);
    command.arg(file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // The process is not waited for: some of these programs run as long as the browser.
    command.spawn().is_ok()
}
