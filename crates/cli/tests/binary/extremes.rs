//! The ends of what the program can be given that only the binary shows: pictures that show nothing, files that are none, runs that cannot go on. The rows
//! of docs/extremes.md beside those of tests/tests/physics/ranges, each with the message that a user gets (`just extremes`); variants stand in the tests of each part.

mod files;
mod pictures;
mod runs;

use crate::support::{Ran, error_message, text};
use etendue_testkit::page::Row;
use std::path::Path;

/// A run that is refused with status 2, the first error of which is the row's figure; the folders in it are left out.
pub(crate) fn refused(extreme: &str, expected: &str, ran: &Ran, folders: &[&Path]) -> Row {
    ended(2, extreme, expected, ran, folders)
}

/// The same with another status.
fn ended(status: i32, extreme: &str, expected: &str, ran: &Ran, folders: &[&Path]) -> Row {
    let errors: Vec<&str> = ran.err.lines().filter_map(error_message).collect();
    Row {
        extreme: extreme.to_owned(),
        expected: format!("status {status}: {expected}"),
        found: told(errors.first().unwrap_or(&ran.err.as_str()), folders),
        holds: ran.status == status && ran.out.is_empty() && !errors.is_empty(),
    }
}

/// A message as it stands in a table.
fn told(message: &str, folders: &[&Path]) -> String {
    let short = folders.iter().fold(message.to_owned(), |told, folder| told.replace(&format!("{}/", text(folder)), ""));
    let cut = short.char_indices().nth(240).map_or(short.clone(), |(at, _)| format!("{}…", &short[..at]));
    cut.replace('|', "\\|").replace('<', "\\<")
}
