//! Lines of OBJ and MTL files as statements: a keyword and its words, with the line they begin on.
//!
//! Blanks are those of Unicode, as in tobj.
//!
//! Text for tobj: one statement per line, with the line of the file that each comes from.
//!
//! tobj's errors name no line. It reads line by line and stops at the first that it refuses, so the amount of text read identifies that line.

use std::{borrow::Cow, path::Path};

use crate::{Error, Problem};

/// One statement: a line without its comment and outer blanks, never empty.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ObjStatement<'a> {
    /// Line on which it begins, from 1.
    pub(super) line: usize,
    text: Cow<'a, str>,
    /// End of the first word.
    keyword_end: usize,
}

impl<'a> ObjStatement<'a> {
    fn new(line: usize, text: Cow<'a, str>) -> Self {
        let keyword_end = text.find(char::is_whitespace).unwrap_or(text.len());
        Self { line, text, keyword_end }
    }

    /// The first word.
    pub(super) fn keyword(&self) -> &str {
        &self.text[..self.keyword_end]
    }

    /// The rest, without blanks at its ends.
    pub(super) fn rest(&self) -> &str {
        self.text[self.keyword_end..].trim()
    }

    /// Words after the keyword.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        self.rest().split_whitespace()
    }

    /// The words as numbers; an error if one is no number.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, Problem> {
        self.words().map(number).collect()
    }
}

/// A finite number.
pub(super) fn number(word: &str) -> Result<f64, Problem> {
    let value: f64 = word.parse().map_err(|_| format!("`{word}` is not a number"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("`{word}` is not finite; expected a finite number").into()) }
}

/// Statements of `text`: without comments and empty lines, with continued lines joined.
pub(super) fn statements(text: &str) -> impl Iterator<Item = ObjStatement<'_>> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        loop {
            let (index, first) = lines.next()?;
            let first = trimmed(first);
            let text = match first.ends_with('\\') {
                true => Cow::Owned(joined(first, &mut lines)),
                false => Cow::Borrowed(first),
            };
            if !text.is_empty() {
                return Some(ObjStatement::new(index + 1, text));
            }
        }
    })
}

/// A line that ends in a backslash, and those that continue it.
fn joined<'a>(first: &str, lines: &mut impl Iterator<Item = (usize, &'a str)>) -> String {
    let mut text = first.to_owned();
    while text.ends_with('\\') {
        text.pop();
        text.push(' ');
        text.push_str(lines.next().map_or("", |(_, line)| trimmed(line)));
        text.truncate(text.trim_end().len());
    }
    if text.starts_with(' ') { text.trim_start().to_owned() } else { text }
}

/// Line without blanks at its ends and without a comment. A comment begins with a `#` at the start of a word: names may contain one inside.
fn trimmed(line: &str) -> &str {
    let begins = |&(at, _): &(usize, &str)| at == 0 || line[..at].ends_with(char::is_whitespace);
    let end = line.match_indices('#').find(begins).map_or(line.len(), |(at, _)| at);
    line[..end].trim()
}

/// Statements for tobj.
#[derive(Clone, Debug, Default)]
pub(super) struct TobjInput {
    text: String,
    lines: Vec<usize>,
}

impl TobjInput {
    /// Adds a statement of line `line`.
    pub(super) fn push(&mut self, line: usize, statement: &str) {
        self.push_parts(line, &[statement]);
    }

    /// Adds a statement of line `line`, given in parts that are joined by blanks.
    pub(super) fn push_parts(&mut self, line: usize, parts: &[&str]) {
        for part in parts {
            self.text.push_str(part);
            self.text.push(' ');
        }
        self.text.pop();
        self.text.push('\n');
        self.lines.push(line);
    }

    /// Result of `read`, a function of tobj, on the text; its error with the line of `file`.
    pub(super) fn read<T>(
        &self,
        file: &Path,
        read: impl FnOnce(&mut &[u8]) -> Result<T, tobj::LoadError>,
    ) -> Result<T, Error> {
        let mut rest = self.text.as_bytes();
        read(&mut rest).map_err(|cause| {
            let consumed = &self.text[..self.text.len() - rest.len()];
            let (statement, line) = consumed.lines().zip(&self.lines).last().unwrap_or(("", &0));
            Error::at(file, *line, format!("`{statement}` is invalid ({cause}); correct or remove this line"))
        })
    }

    /// Line of the `index`-th face.
    pub(super) fn line_of_face(&self, index: usize) -> usize {
        let faces = self.text.lines().zip(&self.lines).filter(|(statement, _)| statement.starts_with("f "));
        faces.map(|(_, line)| *line).nth(index).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(usize, String, String)> {
        statements(text).map(|s| (s.line, s.keyword().to_owned(), s.rest().to_owned())).collect()
    }

    #[test]
    fn comments_blanks_and_both_line_ends_are_passed_over() {
        let actual = read("# head\r\n\r\n  v 1\t2 3  # tail\r\nusemtl red #5 x\nmap_Kd a#b.png\ng");
        let expected = [(3, "v", "1\t2 3"), (4, "usemtl", "red"), (5, "map_Kd", "a#b.png"), (6, "g", "")];
        assert_eq!(actual, expected.map(|(line, k, r)| (line, k.to_owned(), r.to_owned())));
    }

    #[test]
    fn a_backslash_continues_a_line() {
        let actual = read("f 1 2 \\\n 3 4\\\r\n5\nv 0");
        assert_eq!(actual[0], (1, "f".to_owned(), "1 2  3 4 5".to_owned()));
        assert_eq!(actual[1].0, 4);
        assert_eq!(read("v 1 \\"), [(1, "v".to_owned(), "1".to_owned())]);
    }

    /// A copy of the whole for each line would move 10¹² bytes here.
    #[test]
    fn a_statement_goes_over_many_lines() {
        let text = format!("f{}", " 1\\\n".repeat(1_000_000));
        let actual: Vec<ObjStatement<'_>> = statements(&text).collect();
        assert_eq!((actual.len(), actual[0].words().count()), (1, 1_000_000));
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(number("-1.5e-3"), Ok(-1.5e-3));
        assert_eq!(number("nan"), Err("`nan` is not finite; expected a finite number".into()));
        assert_eq!(number("1e999"), Err("`1e999` is not finite; expected a finite number".into()));
        assert_eq!(number("1,5"), Err("`1,5` is not a number".into()));
    }

    #[test]
    fn what_is_refused_is_named_with_its_line() {
        let mut input = TobjInput::default();
        for (line, statement) in [(2, "newmtl a"), (5, "illum two"), (7, "Kd 1 1 1")] {
            input.push(line, statement);
        }
        let error = input.read(Path::new("a.mtl"), |text| tobj::load_mtl_buf(text)).expect_err("no number");
        assert_eq!(
            error.to_string(),
            "a.mtl:5: `illum two` is invalid (material parse error); correct or remove this line"
        );
    }

    #[test]
    fn faces_are_found_by_their_order() {
        let mut input = TobjInput::default();
        for (line, statement) in [(1, "v 0 0 0"), (4, "f 1 1 1"), (5, "g"), (9, "f 1 1 1")] {
            input.push(line, statement);
        }
        assert_eq!([0, 1].map(|i| input.line_of_face(i)), [4, 9]);
    }
}
