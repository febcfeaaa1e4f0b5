//! Lines of OBJ and MTL files as statements: a keyword and its words, with the line they begin on.
//!
//! The files state no encoding. Each line that is valid UTF-8 is read as such, with the blanks of Unicode. Any other line is read byte by byte (Latin-1): equal
//! bytes give equal names, so that names written in GBK or Shift-JIS match between files. UTF-16 is recognised by its byte-order mark.
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
    /// True if the line is not UTF-8: its blanks are those of ASCII.
    is_bytes: bool,
}

impl<'a> ObjStatement<'a> {
    fn new(line: usize, text: LineText<'a>) -> Self {
        let keyword_end = text.text.find(|c: char| c.is_ascii_whitespace() || (!text.is_bytes && c.is_whitespace()));
        let keyword_end = keyword_end.unwrap_or(text.text.len());
        Self { line, text: text.text, keyword_end, is_bytes: text.is_bytes }
    }

    /// The first word.
    pub(super) fn keyword(&self) -> &str {
        &self.text[..self.keyword_end]
    }

    /// The rest, without blanks at its ends.
    pub(super) fn rest(&self) -> &str {
        let rest = &self.text[self.keyword_end..];
        if self.is_bytes { rest.trim_matches(|c: char| c.is_ascii_whitespace()) } else { rest.trim() }
    }

    /// Words after the keyword.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        self.rest().split_whitespace()
    }
}

/// Text of a line, and true if the line is not UTF-8.
#[derive(Clone, Debug)]
struct LineText<'a> {
    text: Cow<'a, str>,
    is_bytes: bool,
}

impl<'a> LineText<'a> {
    fn new(line: &'a [u8]) -> Self {
        match std::str::from_utf8(line) {
            Ok(text) => Self { text: Cow::Borrowed(trimmed(text)), is_bytes: false },
            Err(_) => {
                let bytes = trimmed_bytes(line);
                // The part without its comment may be UTF-8.
                match std::str::from_utf8(bytes) {
                    Ok(text) => Self { text: Cow::Borrowed(trimmed(text)), is_bytes: false },
                    Err(_) => {
                        Self { text: Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()), is_bytes: true }
                    }
                }
            }
        }
    }

    /// True if the next line continues this one. A backslash after a byte of 128 or more may be the second byte of a character in Shift-JIS, GBK or Big5.
    fn is_continued(&self) -> bool {
        match self.text.strip_suffix('\\') {
            None => false,
            Some(before) => !self.is_bytes || before.chars().next_back().is_none_or(|c| c.is_ascii()),
        }
    }
}

/// A finite number.
pub(super) fn number(word: &str) -> Result<f64, Problem> {
    let value: f64 = word.parse().map_err(|_| format!("`{word}` is not a number"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("`{word}` is not finite; expected a finite number").into()) }
}

/// Content of a file as bytes that contain ASCII: UTF-16 with a byte-order mark becomes UTF-8, and a byte-order mark is removed.
pub(super) fn without_mark(bytes: &[u8]) -> Cow<'_, [u8]> {
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        Cow::Owned(text.into_bytes())
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => Cow::Borrowed(rest),
        _ => Cow::Borrowed(bytes),
    }
}

/// Statements of a file: without comments and empty lines, with continued lines joined.
pub(super) fn statements(bytes: &[u8]) -> impl Iterator<Item = ObjStatement<'_>> {
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut lines = bytes.split(move |byte| *byte == end).map(LineText::new).enumerate();
    std::iter::from_fn(move || {
        loop {
            let (index, first) = lines.next()?;
            let line = match first.is_continued() {
                true => joined(first, &mut lines),
                false => first,
            };
            if !line.text.is_empty() {
                return Some(ObjStatement::new(index + 1, line));
            }
        }
    })
}

/// A line that ends in a backslash, and those that continue it.
fn joined<'a>(first: LineText<'a>, lines: &mut impl Iterator<Item = (usize, LineText<'a>)>) -> LineText<'a> {
    let (mut text, mut is_bytes, mut is_continued) = (first.text.into_owned(), first.is_bytes, true);
    while is_continued {
        text.pop();
        text.push(' ');
        let Some((_, next)) = lines.next() else { break };
        is_continued = next.is_continued();
        is_bytes |= next.is_bytes;
        text.push_str(&next.text);
    }
    text.truncate(text.trim_end().len());
    let text = if text.starts_with(' ') { text.trim_start().to_owned() } else { text };
    LineText { text: Cow::Owned(text), is_bytes }
}

/// Line without blanks at its ends and without a comment. A comment begins with a `#` at the start of a word: names may contain one inside.
fn trimmed(line: &str) -> &str {
    let begins = |&(at, _): &(usize, &str)| at == 0 || line[..at].ends_with(char::is_whitespace);
    let end = line.match_indices('#').find(begins).map_or(line.len(), |(at, _)| at);
    line[..end].trim()
}

/// The same for bytes.
fn trimmed_bytes(line: &[u8]) -> &[u8] {
    let begins = |at: &usize| line[*at] == b'#' && (*at == 0 || line[*at - 1].is_ascii_whitespace());
    let end = (0..line.len()).find(begins).unwrap_or(line.len());
    line[..end].trim_ascii()
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
        statements(text.as_bytes()).map(|s| (s.line, s.keyword().to_owned(), s.rest().to_owned())).collect()
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

    #[test]
    fn lines_that_are_not_utf8_are_read_byte_by_byte() {
        let names = |bytes: &[u8]| -> Vec<String> { statements(bytes).map(|s| s.rest().to_owned()).collect() };
        assert_eq!(names(b"usemtl Geh\xe4use\nusemtl Geh\xc3\xa4use\n"), ["Geh\u{e4}use"; 2], "Latin-1, UTF-8");
        assert_eq!(names(b"usemtl Geh\xc3\xa4use # Ma\xdfe\n"), ["Geh\u{e4}use"], "a comment in another encoding");
        // 0x85 and 0xa0 are blanks in Unicode; 0x5c, the last byte of a character in Shift-JIS, is no continuation.
        assert_eq!(names(b"usemtl \xb0\x85\nusemtl \xb0\xa0\n"), ["\u{b0}\u{85}", "\u{b0}\u{a0}"]);
        assert_eq!(names(b"usemtl \x95\x5c\nusemtl b\n"), ["\u{95}\\", "b"]);
        assert_eq!(names(b"f 1 2 \\\n3\n"), ["1 2  3"]);
        assert_eq!(names(b"v 1\rv 2\r"), ["1", "2"], "line ends of old Macintosh files");
        let wide: Vec<u8> =
            [0xfeff].into_iter().chain("usemtl ä\n".encode_utf16()).flat_map(u16::to_le_bytes).collect();
        assert_eq!(names(&without_mark(&wide)), ["ä"]);
    }

    /// A copy of the whole for each line would move 10¹² bytes here.
    #[test]
    fn a_statement_goes_over_many_lines() {
        let text = format!("f{}", " 1\\\n".repeat(1_000_000));
        let actual: Vec<ObjStatement<'_>> = statements(text.as_bytes()).collect();
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
