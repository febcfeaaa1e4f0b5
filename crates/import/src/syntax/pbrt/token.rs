//! Words, quoted texts and brackets of a file, and directives with their parameters.

use std::{cell::Cell, path::Path};

/// A token of a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// What stands without quotes: a directive, a number, true, false.
    Word(&'a str),
    /// What stands between quotes, as it is there.
    Text(&'a str),
    /// `[`
    Open,
    /// `]`
    Close,
}

/// The tokens of a text, one looked at before it is taken.
#[derive(Debug)]
pub(super) struct Tokens<'a> {
    rest: &'a str,
    line: usize,
    peeked: Option<(usize, Token<'a>)>,
}

/// A fault with its line.
pub(super) type Fault = (usize, String);

/// What ends a word.
fn ends_word(c: char) -> bool {
    c.is_ascii_whitespace() || matches!(c, '"' | '[' | ']' | '#')
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1, peeked: None }
    }

    /// The line that reading has come to.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The next token and its line, which stays the next; `None` at the end.
    pub(super) fn peek(&mut self) -> Result<Option<(usize, Token<'a>)>, Fault> {
        if self.peeked.is_none() {
            self.peeked = self.read()?;
        }
        Ok(self.peeked)
    }

    /// The next token and its line; `None` at the end.
    pub(super) fn take(&mut self) -> Result<Option<(usize, Token<'a>)>, Fault> {
        match self.peeked.take() {
            Some(token) => Ok(Some(token)),
            None => self.read(),
        }
    }

    fn read(&mut self) -> Result<Option<(usize, Token<'a>)>, Fault> {
        self.pass_blanks();
        let line = self.line;
        let Some(first) = self.rest.chars().next() else { return Ok(None) };
        let token = match first {
            '[' | ']' => {
                self.rest = &self.rest[1..];
                if first == '[' { Token::Open } else { Token::Close }
            }
            '"' => {
                let inside = &self.rest[1..];
                let end = inside.find(['"', '\n']).filter(|end| inside[*end..].starts_with('"'));
                let end = end.ok_or_else(|| (line, "a quoted text without its end on the same line".to_owned()))?;
                self.rest = &inside[end + 1..];
                Token::Text(&inside[..end])
            }
            _ => {
                let end = self.rest.find(ends_word).unwrap_or(self.rest.len());
                let (word, rest) = self.rest.split_at(end);
                self.rest = rest;
                Token::Word(word)
            }
        };
        Ok(Some((line, token)))
    }

    fn pass_blanks(&mut self) {
        loop {
            let blanks = self.rest.len() - self.rest.trim_ascii_start().len();
            self.line += self.rest[..blanks].bytes().filter(|b| *b == b'\n').count();
            self.rest = &self.rest[blanks..];
            if !self.rest.starts_with('#') {
                return;
            }
            self.rest = &self.rest[self.rest.find('\n').unwrap_or(self.rest.len())..];
        }
    }
}

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
