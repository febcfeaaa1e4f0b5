//! Texts, paths, flags, and words from a closed list.

use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use etendue_core::Word;
use serde_json::{Value as Json, json};

use super::rule::{Rule, ValueKind};
use crate::document::{Node, Value};
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::Placed;
use crate::suggest::nearest;
use crate::written::{Item, Value as WrittenValue};

/// `"a", "b", "c"`.
pub(crate) fn quoted<S: AsRef<str>>(words: &[S]) -> String {
    words.iter().map(|w| format!("\"{}\"", w.as_ref())).collect::<Vec<_>>().join(", ")
}

/// `true` or `false`.
pub(crate) const fn flag() -> FlagRule {
    FlagRule
}

/// See [`flag`].
pub(crate) struct FlagRule;

impl Rule for FlagRule {
    type Out = Placed<bool>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Flag
    }
    fn expected(&self) -> String {
        "true or false".to_owned()
    }
    fn schema(&self) -> Json {
        json!({ "type": "boolean" })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<bool>> {
        match node.value {
            Value::Flag(v) => Some(Placed::new(v, node.place.clone())),
            _ => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<bool>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// A non-empty text; `what` describes it: "the name of a material".
pub(crate) const fn text(what: &'static str) -> TextRule {
    TextRule { what }
}

/// See [`text`].
#[derive(Clone, Copy)]
pub(crate) struct TextRule {
    what: &'static str,
}

impl Rule for TextRule {
    type Out = Placed<String>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Text
    }
    fn expected(&self) -> String {
        format!("{} (a text)", self.what)
    }
    fn schema(&self) -> Json {
        json!({ "type": "string", "minLength": 1 })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<String>> {
        match node.as_text().filter(|t| !t.is_empty()) {
            Some(v) => Some(Placed::new(v.to_owned(), node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<String>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// A name that the scene defines elsewhere.
pub(crate) const fn name_of(named: NameKind) -> NameRule {
    NameRule { kind: named }
}

/// See [`name_of`].
#[derive(Clone, Copy)]
pub(crate) struct NameRule {
    kind: NameKind,
}

impl Rule for NameRule {
    type Out = Placed<String>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Text
    }
    fn expected(&self) -> String {
        format!("the name of a {} (a text)", self.kind.word())
    }
    fn schema(&self) -> Json {
        json!({ "type": "string", "minLength": 1 })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<String>> {
        let Some(text) = node.as_text().filter(|t| !t.is_empty()) else { return self.refuse(node, errors) };
        let name = Placed::new(text.to_owned(), node.place.clone());
        errors.record_use(self.kind, name.clone());
        Some(name)
    }
    fn write(&self, value: &Placed<String>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// A text that can be part of a file name on every system: 1 to [`MAX_FILE_NAME`] letters, digits, `-` and `_`, and no word that a system reserves
/// for a device.
pub(crate) const fn file_name(what: &'static str) -> FileNameRule {
    FileNameRule { what }
}

/// Maximum number of characters: file names, of at most 255 bytes, hold more than this one.
const MAX_FILE_NAME: usize = 100;

/// True if a system (Windows) reserves a name for a device, in any spelling.
fn is_device(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let is_numbered = |port: &str| matches!(name.strip_prefix(port).map(str::as_bytes), Some([b'0'..=b'9']));
    ["con", "prn", "aux", "nul"].contains(&name.as_str()) || is_numbered("com") || is_numbered("lpt")
}

/// See [`file_name`].
#[derive(Clone, Copy)]
pub(crate) struct FileNameRule {
    what: &'static str,
}

impl Rule for FileNameRule {
    type Out = Placed<String>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Text
    }
    fn expected(&self) -> String {
        format!("{} ({MAX_FILE_NAME} letters, digits, - and _ at most, no device such as CON)", self.what)
    }
    fn schema(&self) -> Json {
        json!({ "type": "string", "maxLength": MAX_FILE_NAME, "pattern": "^[A-Za-z0-9_-]+$" })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<String>> {
        let is_plain = |t: &str| t.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
        let is_legal = |t: &&str| (1..=MAX_FILE_NAME).contains(&t.len()) && is_plain(t) && !is_device(t);
        match node.as_text().filter(is_legal) {
            Some(v) => Some(Placed::new(v.to_owned(), node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<String>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// The path of a file with one of these extensions, resolved relative to the file that names it.
pub(crate) const fn path(extensions: &'static [&'static str]) -> FilePathRule {
    FilePathRule { extensions }
}

/// See [`path`].
#[derive(Clone, Copy)]
pub(crate) struct FilePathRule {
    extensions: &'static [&'static str],
}

impl FilePathRule {
    fn admits(&self, text: &str) -> bool {
        let extension = Path::new(text).extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
        self.extensions.contains(&extension.as_str())
    }
}

impl Rule for FilePathRule {
    type Out = Placed<PathBuf>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Text
    }
    fn expected(&self) -> String {
        format!("the path of a file (.{})", self.extensions.join(", ."))
    }
    fn schema(&self) -> Json {
        json!({ "type": "string", "pattern": format!("\\.({})$", self.extensions.join("|")) })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<PathBuf>> {
        match node.as_text().filter(|t| self.admits(t)) {
            Some(t) => Some(Placed::new(node.place.resolve(Path::new(t)), node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn code(&self, node: &Node) -> ErrorCode {
        if node.as_text().is_some() { ErrorCode::UnsupportedFile } else { ErrorCode::WrongType }
    }
    fn write(&self, value: &Placed<PathBuf>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// One of the names of a data library; `what` describes it: "an illuminant".
pub(crate) fn known(what: &'static str, names: &[&'static str]) -> KnownNameRule {
    KnownNameRule { what, names: names.to_vec() }
}

/// See [`known`].
pub(crate) struct KnownNameRule {
    what: &'static str,
    names: Vec<&'static str>,
}

impl Rule for KnownNameRule {
    type Out = Placed<String>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Text
    }
    fn expected(&self) -> String {
        format!("{}, {}", self.what, one_of(&self.names))
    }
    fn schema(&self) -> Json {
        json!({ "enum": self.names })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<String>> {
        let name = word(node, &self.names, errors)?;
        Some(Placed::new(name.to_owned(), node.place.clone()))
    }
    fn write(&self, value: &Placed<String>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// One of the words of `C`.
pub(crate) const fn choice<C: Word>() -> ChoiceRule<C> {
    ChoiceRule(PhantomData)
}

/// See [`choice`].
pub(crate) struct ChoiceRule<C>(PhantomData<C>);

impl<C: Word> Rule for ChoiceRule<C> {
    type Out = Placed<C>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Text
    }
    fn expected(&self) -> String {
        one_of(&C::words())
    }
    fn schema(&self) -> Json {
        json!({ "enum": C::words() })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<C>> {
        let word = word(node, &C::words(), errors)?;
        C::from_word(word).map(|value| Placed::new(value, node.place.clone()))
    }
    fn write(&self, value: &Placed<C>) -> Option<Item> {
        Some(Item::at(&value.place, WrittenValue::Text(value.value.word().to_owned())))
    }
}

/// `"a"`, or `one of "a", "b"`.
pub(crate) fn one_of(words: &[&str]) -> String {
    if words.len() == 1 { quoted(words) } else { format!("one of {}", quoted(words)) }
}

/// Returns the text of the node, which must be one of `words`.
pub(crate) fn word<'n>(node: &'n Node, words: &[&str], errors: &mut DescriptionErrors) -> Option<&'n str> {
    let text = node.as_text();
    if let Some(text) = text.filter(|t| words.contains(t)) {
        return Some(text);
    }
    if matches!(node.value, Value::Unreadable) {
        return None;
    }
    let code = if text.is_some() { ErrorCode::UnknownWord } else { ErrorCode::WrongType };
    errors.add(code, &node.place, format!("found {}", node.describe()), remedy(text, words));
    None
}

/// Remedy: the nearest word comes first, as lists may be long.
fn remedy(text: Option<&str>, words: &[&str]) -> String {
    match text.and_then(|t| nearest(t, words)) {
        Some(likely) => format!("did you mean \"{likely}\"? Give {}", one_of(words)),
        None => format!("give {}", one_of(words)),
    }
}
