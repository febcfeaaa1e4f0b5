//! Charts as written to files.

mod files;
mod partition;
