//! Tests that need files which may be missing: they pass, report it, and are counted.

use std::{io::Write as _, path::Path};

/// Environment variable with the name of the file to which a skipped test adds a line; CI counts and prints them.
const LIST: &str = "ETENDUE_SKIPPED";

/// True if all files or folders exist. Otherwise the test is skipped, which is reported on stderr and in the list that CI prints.
///
/// # Panics
/// If the list cannot be written.
#[must_use]
pub fn all_here(test: &str, needed: &[&Path]) -> bool {
    let Some(missing) = needed.iter().find(|path| !path.exists()) else { return true };
    skipped(test, &format!("{} is not here", missing.display()));
    false
}

/// Reports on stderr and in the list that CI prints that a test is skipped, and the reason.
///
/// # Panics
/// If the list cannot be written.
pub fn skipped(test: &str, reason: &str) {
    let line = format!("skipped: {test}: {reason}\n");
    // Cargo shows the output of a test on request (--nocapture).
    std::io::stderr().write_all(line.as_bytes()).expect("stderr");
    if let Some(list) = std::env::var_os(LIST) {
        let file = std::fs::OpenOptions::new().append(true).create(true).open(list);
        file.and_then(|mut file| file.write_all(line.as_bytes())).expect("the list of skipped tests");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_there_is_not_skipped() {
        assert!(all_here("itself", &[Path::new(env!("CARGO_MANIFEST_DIR"))]));
    }
}
