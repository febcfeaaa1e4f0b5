//! A reader, with what is needed to enter it.

use std::fmt::Display;
use std::path::Path;

/// A reader, with what is needed to enter it.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name on the command line, and of its folder in `fuzz/found`.
    pub name: &'static str,
    /// The name of the file that it reads.
    pub file: &'static str,
    /// Writes the files that the reader finds beside it into a folder; gives valid inputs.
    pub prepare: fn(&Path) -> Vec<Vec<u8>>,
    /// Reads; what it says in words.
    pub read: fn(&Path) -> String,
    /// Words that the reader knows and the seeds lack.
    pub words: &'static [&'static str],
    /// Whether it takes text.
    pub is_text: bool,
    /// Memory that it may hold for each byte of the input, bytes.
    pub times: u64,
    /// Memory that it may hold beside, bytes.
    pub constant_bytes: u64,
}

impl Target {
    /// Memory that it may hold at a time for an input of this length, bytes.
    #[must_use]
    pub fn max_bytes(&self, length: usize) -> u64 {
        self.times * length as u64 + self.constant_bytes
    }
}

/// What a byte of a text may take as a tree with the place of every value (TOML, YAML, JSON), bytes: such files are limited to 16 MiB.
pub(super) const TREE: u64 = 256;
/// The same of YAML and of JSON that is read as such: braces that may be a key are scanned to their end before anything is read.
pub(super) const SCANNED: u64 = 400;
/// As a list of records of a lens or a lamp, whose files are limited likewise.
pub(super) const RECORDS: u64 = 64;
/// As numbers of a table or a mesh while they are brought into their form; vectors that grow are counted with what they grow from.
pub(super) const NUMBERS: u64 = 25;

/// What a reader said, in words.
pub(super) fn result_text<T, E: Display>(result: Result<T, E>) -> String {
    match result {
        Ok(_) => "read".to_owned(),
        Err(error) => error.to_string(),
    }
}
