//! Elements and their places.

use std::path::{Path, PathBuf};
use std::{cell::Cell, rc::Rc};

use etendue_io::{Error, Problem};

/// Place of an element.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct MitsubaPlace {
    pub file: Rc<Path>,
    /// The line, counted from 1.
    pub line: usize,
}

/// An element of a scene file: `<shape type="sphere" id="ball"> … </shape>`.
#[derive(Clone, Debug)]
pub struct MitsubaElement {
    /// Name: `shape`, `float` and so on, one of the format's.
    pub tag: &'static str,
    /// Attributes in order.
    pub attributes: Vec<(Box<str>, Box<str>)>,
    /// Child elements.
    pub children: Vec<MitsubaElement>,
    pub place: MitsubaPlace,
    /// Unique number in the order of the files, from 0.
    pub number: usize,
    /// True once it has been used.
    pub used: Cell<bool>,
}

/// Scene file with all included files.
#[derive(Clone, Debug)]
pub struct MitsubaScene {
    /// Root, a `<scene>`.
    pub root: MitsubaElement,
    /// Search folders for files that elements name, in order.
    pub folders: Vec<PathBuf>,
}

impl MitsubaElement {
    /// Value of an attribute.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(own, _)| &**own == name).map(|(_, value)| &**value)
    }

    /// Name among the parameters of its parent; empty if it has none.
    #[must_use]
    pub fn name(&self) -> &str {
        self.attribute("name").unwrap_or_default()
    }

    /// Type; empty if it has none.
    #[must_use]
    pub fn kind(&self) -> &str {
        self.attribute("type").unwrap_or_default()
    }

    /// Returns an error at this place.
    #[must_use]
    pub fn error(&self, what: impl Into<Problem>) -> Error {
        Error::at(&self.place.file, self.place.line, what)
    }
}

/// Offsets of line starts, bytes.
pub(super) struct Lines(Vec<usize>);

impl Lines {
    pub(super) fn new(text: &str) -> Self {
        Self(text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1).collect())
    }

    /// The line of a byte, counted from 1.
    pub(super) fn line(&self, at: usize) -> usize {
        self.0.partition_point(|begin| *begin <= at) + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_their_lines() {
        let lines = Lines::new("ab\n\nc");
        assert_eq!([0, 2, 3, 4].map(|at| lines.line(at)), [1, 1, 2, 3]);
    }
}
