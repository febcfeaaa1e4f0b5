//! Words, quoted texts and brackets of a file, and directives with their parameters.

use std::{cell::Cell, path::Path};

/// Token of a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// Unquoted word: a directive, a number, true, false.
    Word(&'a str),
    /// Quoted text, unchanged.
    Text(&'a str),
    /// `[`
    Open,
    /// `]`
    Close,
}

/// Tokens of a text, with one token of look-ahead.
#[derive(Debug)]
pub(super) struct Tokens<'a> {
    rest: &'a str,
    line: usize,
    peeked: Option<(usize, Token<'a>)>,
}

/// Error with its line.
pub(super) type SyntaxError = (usize, String);

/// Returns true for a character that ends a word.
fn ends_word(c: char) -> bool {
    c.is_ascii_whitespace() || matches!(c, '"' | '[' | ']' | '#')
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1, peeked: None }
    }

    /// Current line.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// Returns the next token and its line without taking it; `None` at the end.
    pub(super) fn peek(&mut self) -> Result<Option<(usize, Token<'a>)>, SyntaxError> {
        if self.peeked.is_none() {
            self.peeked = self.read()?;
        }
        Ok(self.peeked)
    }

    /// Takes the next token and its line; `None` at the end.
    pub(super) fn take(&mut self) -> Result<Option<(usize, Token<'a>)>, SyntaxError> {
        match self.peeked.take() {
            Some(token) => Ok(Some(token)),
            None => self.read(),
        }
    }

    fn read(&mut self) -> Result<Option<(usize, Token<'a>)>, SyntaxError> {
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
                let end = end.ok_or_else(|| (line, "a quoted string is not closed on its line".to_owned()))?;
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

/// Place of a directive.
#[derive(Clone, Copy, Debug)]
pub struct PbrtPlace<'a> {
    pub file: &'a Path,
    /// The line, counted from 1.
    pub line: usize,
}

/// Directive of a scene file. Includes are resolved before directives are passed on.
#[derive(Clone, Debug, PartialEq)]
pub enum PbrtDirective {
    /// Without arguments: `WorldBegin`, `AttributeBegin` and similar.
    Plain(&'static str),
    /// `Translate`, `Scale`, `Rotate`, `LookAt`, `Transform`, `ConcatTransform`, `TransformTimes`, with as many numbers as each has.
    Numbers(&'static str, Vec<f64>),
    /// With a name: `NamedMaterial`, `ObjectBegin` and similar.
    Named(&'static str, String),
    /// `MediumInterface`: inside and outside, empty for none.
    MediumInterface([String; 2]),
    /// With a type and parameters: `Shape "sphere" …` and similar.
    Typed(&'static str, String, Vec<PbrtParameter>),
    /// `Texture`: name, type of values, class.
    Texture([String; 3], Vec<PbrtParameter>),
    /// `Option`.
    Setting(PbrtParameter),
    /// `Include` or `Import`; the caller receives the file that is read only if its name is spelt differently.
    Include(String),
}

/// Parameter: `"float radius" 3`.
#[derive(Clone, Debug)]
pub struct PbrtParameter {
    /// Type of its values: `float`, `rgb` and so on.
    pub kind: String,
    pub name: String,
    pub values: PbrtValues,
    /// True once it has been used.
    pub used: Cell<bool>,
}

impl PartialEq for PbrtParameter {
    fn eq(&self, other: &Self) -> bool {
        (&self.kind, &self.name, &self.values) == (&other.kind, &other.name, &other.values)
    }
}

/// Values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum PbrtValues {
    /// Finite numbers.
    Numbers(Vec<f64>),
    Texts(Vec<String>),
    /// Booleans.
    Flags(Vec<bool>),
}
