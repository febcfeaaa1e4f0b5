//! YAML (and so JSON) as a tree whose nodes know their line.
//!
//! Aliases and tags are not supported. No supported program writes them except OpenCV's `!!opencv-matrix`, which adds nothing to its keys. Of several documents
//! the first is read. OpenCV's own header `%YAML:1.0`, which is not YAML, is ignored.

use std::{borrow::Cow, collections::BTreeSet, path::Path};

use saphyr_parser::{Event, Parser, ScalarStyle, Span, StrInput};

use crate::{Error, ErrorCode, Problem};

/// Node of the tree.
#[derive(Debug)]
pub(crate) struct TreeNode {
    /// Line, counted from 1.
    pub(crate) line: usize,
    value: NodeValue,
}

#[derive(Debug)]
pub(crate) enum NodeValue {
    Scalar(String),
    List(Vec<TreeNode>),
    Map(Vec<(String, TreeNode)>),
}

/// Maximum depth, beyond that of any real file.
pub(crate) const MAX_DEPTH: usize = 32;
/// Maximum number of commas and brackets, beyond that of any real file: each value takes up to 800 bytes while it is read.
pub(crate) const MAX_VALUES: usize = 1 << 21;

/// Reads the first document of a text; its root is a map.
pub(crate) fn parse(text: &str) -> TreeResult<TreeNode> {
    first_document(text).map(|(root, _)| root)
}

/// Reads the first document of a text, and returns true beside it if another one follows.
pub(crate) fn first_document(text: &str) -> TreeResult<(TreeNode, bool)> {
    let values = text.bytes().filter(|byte| matches!(byte, b',' | b'[' | b'{')).count();
    if values > MAX_VALUES {
        return Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            0,
            format!("contains {values} commas and brackets; at most {MAX_VALUES} are supported"),
        ));
    }
    let header = if text.starts_with("%YAML") { text.find('\n').unwrap_or(text.len()) } else { 0 };
    let text = as_document(&text[header..]);
    let mut events = Events { parser: Parser::new_from_str(&text) };
    loop {
        match events.next()? {
            (Event::StreamStart | Event::DocumentStart(_), _) => {}
            (Event::StreamEnd, _) => {
                return Err(TreeError::coded(ErrorCode::Empty, 0, "is empty; expected keys with values"));
            }
            (event, span) => {
                let root = events.node(event, span, 0)?;
                return match root.value {
                    NodeValue::Map(_) => Ok((root, events.has_another())),
                    _ => Err(TreeError::at(root.line, "expected keys with values (key: value)")),
                };
            }
        }
    }
}

/// Returns the document with a document mark before an initial brace or bracket, on the same line: otherwise it could be a key, and the scanner would keep all
/// its tokens until the end, some 400 bytes per byte. Other forms of the problem, such as after a comment, are bounded by [`MAX_VALUES`].
fn as_document(text: &str) -> Cow<'_, str> {
    let start = text.len() - text.trim_start().len();
    if text[start..].starts_with(['{', '[']) {
        let lines = "\n".repeat(text[..start].matches('\n').count());
        Cow::Owned(format!("{lines}--- {}", &text[start..]))
    } else {
        Cow::Borrowed(text)
    }
}

struct Events<'a> {
    parser: Parser<'a, StrInput<'a>>,
}

impl<'a> Events<'a> {
    fn next(&mut self) -> TreeResult<(Event<'a>, Span)> {
        match self.parser.next_event() {
            Some(Ok(event)) => Ok(event),
            Some(Err(cause)) => {
                Err(TreeError::at(cause.marker().line(), format!("not YAML or JSON: {}", cause.info())))
            }
            None => Err(TreeError::at(0, "not YAML or JSON: the file ends too early")),
        }
    }

    /// Returns true if a document with content, or text that is no YAML, follows the document that has been read.
    fn has_another(&mut self) -> bool {
        loop {
            match self.next() {
                Ok((Event::DocumentEnd | Event::DocumentStart(_), _)) => {}
                // A final "---" makes an empty document.
                Ok((Event::Scalar(text, ScalarStyle::Plain, ..), _)) if plain(&text, ScalarStyle::Plain).is_empty() => {
                }
                Ok((Event::StreamEnd, _)) => return false,
                _ => return true,
            }
        }
    }

    fn node(&mut self, event: Event<'a>, span: Span, depth: usize) -> TreeResult<TreeNode> {
        let line = span.start.line();
        if depth > MAX_DEPTH {
            return Err(TreeError::at(
                line,
                format!("nested more than {MAX_DEPTH} levels deep, which is not supported"),
            ));
        }
        let value = match event {
            Event::Scalar(text, style, ..) => NodeValue::Scalar(plain(&text, style)),
            Event::SequenceStart(..) => NodeValue::List(self.list(depth)?),
            Event::MappingStart(..) => NodeValue::Map(self.map(depth)?),
            Event::Alias(_) => {
                return Err(TreeError::coded(
                    ErrorCode::UnsupportedFile,
                    line,
                    "aliases (*name) are not supported: write the value itself",
                ));
            }
            _ => return Err(TreeError::at(line, "expected a value")),
        };
        Ok(TreeNode { line, value })
    }

    fn list(&mut self, depth: usize) -> TreeResult<Vec<TreeNode>> {
        let mut nodes = Vec::new();
        loop {
            match self.next()? {
                (Event::SequenceEnd, _) => return Ok(nodes),
                (event, span) => nodes.push(self.node(event, span, depth + 1)?),
            }
        }
    }

    fn map(&mut self, depth: usize) -> TreeResult<Vec<(String, TreeNode)>> {
        let mut entries: Vec<(String, TreeNode)> = Vec::new();
        let mut known = BTreeSet::new();
        loop {
            let (key, line) = match self.next()? {
                (Event::MappingEnd, _) => return Ok(entries),
                (Event::Scalar(key, ..), span) => (key.into_owned(), span.start.line()),
                (_, span) => return Err(TreeError::at(span.start.line(), "expected a key")),
            };
            if !known.insert(key.clone()) {
                return Err(TreeError::coded(ErrorCode::Duplicate, line, format!("the key {key} appears twice")));
            }
            let (event, span) = self.next()?;
            entries.push((key, self.node(event, span, depth + 1)?));
        }
    }
}

/// Text of a scalar; an empty unquoted one is null.
fn plain(text: &str, style: ScalarStyle) -> String {
    if style == ScalarStyle::Plain && text == "~" { String::new() } else { text.to_owned() }
}

impl TreeNode {
    /// Node with a value and its line.
    pub(crate) fn new(line: usize, value: NodeValue) -> Self {
        Self { line, value }
    }

    /// Value of a key, if present.
    pub(crate) fn find(&self, key: &str) -> Option<&TreeNode> {
        self.entries().iter().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    /// Value of the first of several key names.
    pub(crate) fn any(&self, names: &[&str]) -> TreeResult<&TreeNode> {
        names.iter().find_map(|name| self.find(name)).ok_or_else(|| {
            TreeError::at(self.line, format!("expected the key {}; found {}", names.join(" or "), list(&self.keys())))
        })
    }

    /// Value of a key.
    pub(crate) fn key(&self, key: &str) -> TreeResult<&TreeNode> {
        self.any(&[key])
    }

    /// Keys of a map, as written; none for other nodes.
    pub(crate) fn keys(&self) -> Vec<&str> {
        self.entries().iter().map(|(name, _)| name.as_str()).collect()
    }

    /// Keys that are not among these.
    pub(crate) fn others(&self, known: &[&str]) -> Vec<&str> {
        self.keys().into_iter().filter(|key| !known.contains(key)).collect()
    }

    pub(crate) fn entries(&self) -> &[(String, TreeNode)] {
        match &self.value {
            NodeValue::Map(entries) => entries,
            _ => &[],
        }
    }

    pub(crate) fn text(&self) -> TreeResult<&str> {
        match &self.value {
            NodeValue::Scalar(text) => Ok(text),
            _ => Err(TreeError::at(self.line, "found a list or keys; expected one value")),
        }
    }

    pub(crate) fn number(&self) -> TreeResult<f64> {
        let text = self.text()?;
        let number = text.parse::<f64>().ok().filter(|x| x.is_finite());
        number.ok_or_else(|| TreeError::at(self.line, format!("found \"{text}\"; expected a finite number")))
    }

    /// A number of pixels.
    pub(crate) fn count(&self) -> TreeResult<usize> {
        let text = self.text()?;
        // OpenCV writes a whole number of type double as "640.".
        let count = text.parse::<f64>().ok().filter(|n| (1.0..=1e6).contains(n) && n.fract() == 0.0);
        count.map(|count| count as usize).ok_or_else(|| {
            TreeError::at(self.line, format!("found \"{text}\"; expected a number of pixels of at least 1"))
        })
    }

    /// Items of a list; `None` for other nodes.
    pub(crate) fn items(&self) -> Option<&[TreeNode]> {
        match &self.value {
            NodeValue::List(nodes) => Some(nodes),
            _ => None,
        }
    }

    /// All numbers of a list and of nested lists, or the single number.
    pub(crate) fn numbers(&self) -> TreeResult<Vec<f64>> {
        let Some(items) = self.items() else { return Ok(vec![self.number()?]) };
        let rows: Vec<Vec<f64>> = items.iter().map(TreeNode::numbers).collect::<TreeResult<_>>()?;
        Ok(rows.concat())
    }

    /// All numbers, or none for an empty value.
    pub(crate) fn numbers_or_none(&self) -> TreeResult<Vec<f64>> {
        if self.text().is_ok_and(str::is_empty) { Ok(Vec::new()) } else { self.numbers() }
    }

    /// List of exactly `N` numbers; `what` names it in messages.
    pub(crate) fn exactly<const N: usize>(&self, what: &str) -> TreeResult<[f64; N]> {
        let numbers = self.numbers()?;
        let count = numbers.len();
        numbers
            .try_into()
            .map_err(|_| TreeError::at(self.line, format!("the number of values is {count}; expected {N}: {what}")))
    }
}

/// Names joined for a sentence.
pub(crate) fn list(names: &[&str]) -> String {
    const SHOWN: usize = 24;
    let more = if names.len() > SHOWN { ", …" } else { "" };
    if names.is_empty() { "no keys".to_owned() } else { names[..names.len().min(SHOWN)].join(", ") + more }
}

/// Problem and its line (from 1; 0 for the whole file).
#[derive(Debug)]
pub(crate) struct TreeError {
    pub(crate) line: usize,
    pub(crate) what: String,
    code: ErrorCode,
}

pub(crate) type TreeResult<T> = Result<T, TreeError>;

impl TreeError {
    pub(crate) fn at(line: usize, what: impl Into<Problem>) -> Self {
        let Problem { code, words } = what.into();
        Self { line, what: words, code }
    }

    pub(crate) fn coded(code: ErrorCode, line: usize, what: impl Into<String>) -> Self {
        Self::at(line, Problem::new(code, what))
    }

    /// The same error with a remedy at its end.
    pub(crate) fn with_remedy(self, remedy: &str) -> Self {
        Self { what: format!("{}; {remedy}", self.what), ..self }
    }

    pub(crate) fn in_file(self, file: &Path) -> Error {
        let what = Problem::new(self.code, self.what);
        if self.line == 0 { Error::new(file, what) } else { Error::at(file, self.line, what) }
    }
}

/// Note on keys that do not describe the camera.
pub(crate) fn passed_over(keys: &[&str]) -> Vec<String> {
    if keys.is_empty() { Vec::new() } else { vec![format!("ignored: {}", keys.join(", "))] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opencv_s_header_and_tags_are_read_and_lines_are_counted_from_one() {
        let text = "%YAML:1.0\n---\n# remark\nK: !!opencv-matrix\n   rows: 1\n   data: [ 1., 2.5e-1,\n       -3 ]\nname: \"a: b\"\n";
        let root = parse(text).expect("YAML");
        let matrix = root.key("K").expect("there");
        assert_eq!(matrix.key("data").expect("there").numbers().expect("numbers"), [1.0, 0.25, -3.0]);
        assert_eq!(root.key("name").expect("there").text().expect("text"), "a: b");
        assert_eq!((matrix.key("data").expect("there").line, root.key("name").expect("there").line), (6, 8));
    }

    #[test]
    fn json_is_read_as_well() {
        let root = parse("{\n\t\"a\":1,\n    \"b\": [[1, 2], [3, 4.0]]\n}\n").expect("JSON");
        assert_eq!(root.key("b").expect("there").numbers().expect("numbers"), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(root.key("a").expect("there").count().expect("count"), 1);
    }

    #[test]
    fn lines_of_json_are_those_of_the_file() {
        let root = parse("\n\n {\"a\": 1,\n\"b\":\n[1,\n2]\n}\n").expect("JSON");
        assert_eq!((root.line, root.key("a").expect("there").line, root.key("b").expect("there").line), (3, 3, 5));
        assert_eq!(root.keys(), ["a", "b"]);
        let tight = parse("{\n\"a\": [1,\n2],\n\t\"b\": \"x\"\n}").expect("JSON without indentation, and with tabs");
        assert_eq!(tight.key("a").expect("there").numbers().expect("numbers"), [1.0, 2.0]);
        assert_eq!((tight.key("b").expect("there").line, parse("{\n\"a\":\n\"x\"\n}").expect("JSON").line), (4, 1));
        assert_eq!(parse("{\"a\": 1,\n\"a\": 2}").expect_err("twice").line, 2);
        assert!(parse("[1, 2]").expect_err("a list").what.contains("keys"));
        let many = format!("{{\"a\": [{}0]}}", "0,".repeat(MAX_VALUES));
        assert!(parse(&many).expect_err("too many").what.contains("at most 2097152"));
    }

    #[test]
    fn faults_name_their_line() {
        let error = |text: &str| parse(text).expect_err("wrong");
        assert_eq!(error("a: 1\nb: [1, 2\nc: 3\n").what.split(':').next(), Some("not YAML or JSON"));
        assert_eq!(error("a: 1\na: 2\n").line, 2);
        assert!(error("a: &x 1\nb: *x\n").what.contains("alias"));
        assert!(error("- 1\n").what.contains("keys"));
        assert!(error(&"[".repeat(5000)).line > 0 || !error(&"[".repeat(5000)).what.is_empty());
        let root = parse("a: .nan\nb: 1e999\nc: inf\nd: 0x10\n").expect("YAML");
        assert!(["a", "b", "c", "d"].iter().all(|key| root.key(key).expect("there").number().is_err()));
    }
}
