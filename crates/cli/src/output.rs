//! Printing: results to stdout, everything else to stderr. All text passes through [`etendue::terminal_text`].

use etendue::{terminal_json, terminal_text};
use std::io::{self, Write as _};

/// Prints results to stdout, as text.
pub fn print(text: &str) {
    write_results(&terminal_text(text));
}

/// Prints results that are one JSON document.
pub fn print_json(document: &str) {
    write_results(&terminal_json(document));
}

/// Prints results. A failed write ends the program as an error, whatever the cause: a full disk, or a reader that closed too early.
fn write_results(text: &str) {
    let mut out = io::stdout().lock();
    if let Err(cause) = out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        print_message(&write_error_message(&cause));
        std::process::exit(1);
    }
}

/// The error message of results that cannot be written.
pub fn write_error_message(cause: &io::Error) -> String {
    format!(
        "error: the results cannot be written to standard output: {cause}; files with their final names are complete\n"
    )
}

/// Prints everything that is no result to stderr.
pub fn print_message(text: &str) {
    // There is no other place to report a failing stderr.
    let _ = io::stderr().lock().write_all(terminal_text(text).as_bytes());
}
