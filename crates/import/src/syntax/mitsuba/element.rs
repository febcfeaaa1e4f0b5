//! Elements and where they stand.

use std::path::{Path, PathBuf};
use std::{cell::Cell, rc::Rc};

use etendue_io::{Error, Problem};

/// Where an element stands.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct MitsubaPlace {
    /// The file.
    pub file: Rc<Path>,
    /// The line, counted from 1.
    pub line: usize,
}

/// An element of a scene file: `<shape type="sphere" id="ball"> … </shape>`.
#[derive(Clone, Debug)]
pub struct MitsubaElement {
    /// Its name: `shape`, `float` and so on, one of the format's.
    pub tag: &'static str,
    /// Its attributes in their order.
    pub attributes: Vec<(Box<str>, Box<str>)>,
    /// The elements within it.
    pub children: Vec<MitsubaElement>,
    /// Where it stands.
    pub place: MitsubaPlace,
    /// Its number in the order of the files, from 0: each once.
    pub number: usize,
    /// Whether anyone has looked at it.
    pub used: Cell<bool>,
}

/// A scene file with all that it includes.
#[derive(Clone, Debug)]
pub struct MitsubaScene {
    /// Its root, a `<scene>`.
    pub root: MitsubaElement,
    /// The folders in which files are sought that its elements name, in this order.
    pub folders: Vec<PathBuf>,
}

impl MitsubaElement {
    /// The value of an attribute.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(own, _)| &**own == name).map(|(_, value)| &**value)
    }

    /// What it is called among its parent's parameters; empty where it has no name.
    #[must_use]
    pub fn name(&self) -> &str {
        self.attribute("name").unwrap_or_default()
    }

    /// Its type; empty where it has none.
    #[must_use]
    pub fn kind(&self) -> &str {
        self.attribute("type").unwrap_or_default()
    }

    /// A fault that stands here.
    #[must_use]
    pub fn fault(&self, what: impl Into<Problem>) -> Error {
        Error::at(&self.place.file, self.place.line, what)
    }
}

/// Where lines begin, bytes.
pub(super) struct Lines(Vec<usize>);

impl Lines {
    pub(super) fn of(text: &str) -> Self {
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
        let lines = Lines::of("ab\n\nc");
        assert_eq!([0, 2, 3, 4].map(|at| lines.line(at)), [1, 1, 2, 3]);
    }
}
