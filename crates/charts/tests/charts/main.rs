//! Charts as they are written to files.

mod files;
mod partition;
