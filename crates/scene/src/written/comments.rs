//! Comments of a file that is written.

use std::collections::BTreeMap;
use std::fmt;

/// Comments by the dotted keys that they belong to.
#[derive(Clone, Debug, Default)]
pub(super) struct Comments {
    /// Above keys and sections.
    pub(super) above: BTreeMap<String, String>,
    /// At the end of the lines of keys.
    pub(super) trailing: BTreeMap<String, String>,
}

/// Writes the lines of a comment. A control character would end it, and is replaced by a space.
pub(super) fn write_comment(f: &mut fmt::Formatter<'_>, comment: Option<&String>) -> fmt::Result {
    for line in comment.into_iter().flat_map(|comment| comment.split('\n')) {
        let line: String = line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        writeln!(f, "{}", format!("# {line}").trim_end())?;
    }
    Ok(())
}
