//! Extremes of the program's input that only the binary shows: images without content, invalid files, runs that cannot continue. The rows of
//! docs/evidence/extremes.md in addition to those of tests/tests/physics/ranges, each with the message for the user (`just extremes`); variants are in the
//! tests of each part.

mod files;
mod pictures;
mod runs;

use crate::support::{CommandOutput, error_message, text};
use etendue_testkit::page::Row;
use std::path::Path;

/// A run refused with status 2, whose first error is the row's result, without the folders in it.
pub(crate) fn refused(extreme: &str, expected: &str, output: &CommandOutput, folders: &[&Path]) -> Row {
    ended(2, extreme, expected, output, folders)
}

/// The same with another status.
fn ended(status: i32, extreme: &str, expected: &str, output: &CommandOutput, folders: &[&Path]) -> Row {
    let errors: Vec<&str> = output.err.lines().filter_map(error_message).collect();
    Row {
        extreme: extreme.to_owned(),
        expected: format!("status {status}: {expected}"),
        actual: table_text(errors.first().unwrap_or(&output.err.as_str()), folders),
        holds: output.status == status && output.out.is_empty() && !errors.is_empty(),
    }
}

/// A message as shown in a table.
fn table_text(message: &str, folders: &[&Path]) -> String {
    let short = folders
        .iter()
        .fold(message.to_owned(), |shortened, folder| shortened.replace(&format!("{}/", text(folder)), ""));
    let cut = short.char_indices().nth(240).map_or(short.clone(), |(at, _)| format!("{}…", &short[..at]));
    cut.replace('|', "\\|").replace('<', "\\<")
}
