//! The user's browser.

use std::path::Path;
use std::process::{Command, Stdio};

/// Asks the system to open a file in the program that the user has chosen for it; whether there was somebody to ask.
pub fn open(file: &Path) -> bool {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let file = file.canonicalize().unwrap_or_else(|_| file.to_path_buf());
    let mut command = Command::new(program);
    command.arg(file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // It is left to itself: some of these programs end with the browser.
    command.spawn().is_ok()
}
