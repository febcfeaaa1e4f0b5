//! Directives and their parameters.

use std::cell::Cell;
use std::path::Path;

/// Where a directive stands.
#[derive(Clone, Copy, Debug)]
pub struct PbrtPlace<'a> {
    /// The file.
    pub file: &'a Path,
    /// The line, counted from 1.
    pub line: usize,
}

/// A directive of a scene file. Files are included before they are given to anyone.
#[derive(Clone, Debug, PartialEq)]
pub enum PbrtDirective {
    /// One without arguments: `WorldBegin`, `AttributeBegin` and their like.
    Plain(&'static str),
    /// `Translate`, `Scale`, `Rotate`, `LookAt`, `Transform`, `ConcatTransform`, `TransformTimes`, with as many numbers as each has.
    Numbers(&'static str, Vec<f64>),
    /// One with a name: `NamedMaterial`, `ObjectBegin` and their like.
    Named(&'static str, String),
    /// `MediumInterface`: inside and outside, empty for none.
    MediumInterface([String; 2]),
    /// One with a type and parameters: `Shape "sphere" …` and their like.
    Typed(&'static str, String, Vec<PbrtParameter>),
    /// `Texture`: name, what its values are, its type.
    Texture([String; 3], Vec<PbrtParameter>),
    /// `Option`.
    Setting(PbrtParameter),
    /// `Include` or `Import`.
    Include(String),
}

/// A parameter: `"float radius" 3`.
#[derive(Clone, Debug)]
pub struct PbrtParameter {
    /// The type of its values: `float`, `rgb` and so on.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// Its values.
    pub values: PbrtValues,
    /// Whether anyone has looked at it.
    pub used: Cell<bool>,
}

impl PartialEq for PbrtParameter {
    fn eq(&self, other: &Self) -> bool {
        (&self.kind, &self.name, &self.values) == (&other.kind, &other.name, &other.values)
    }
}

/// The values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum PbrtValues {
    /// Finite numbers.
    Numbers(Vec<f64>),
    /// Texts.
    Texts(Vec<String>),
    /// Truths.
    Flags(Vec<bool>),
}
