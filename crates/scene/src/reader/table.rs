//! Records: tables read key by key, so that no key is left over.

use serde_json::{Map, Value as Json, json};

use super::rule::Rule;
use super::word::quoted;
use crate::document::{Node, Table};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Place;
use crate::suggest::nearest;
use crate::written::Table as Written;

/// A struct or an enum of structs whose fields are keys of a table.
pub(crate) trait Record: Clone {
    /// Reads the record's keys; returns `None` after reporting at least one error.
    fn read_keys(reader: &mut Reader<'_>, errors: &mut DescriptionErrors) -> Option<Self>;
    /// Shapes of the table: one for a plain record, one per variant for an enum.
    fn forms() -> Vec<Form>;
    /// Adds the record's keys to a table.
    fn write_keys(&self, table: &mut Written);

    /// The record, completed by the keys of `base`. A table whose keys depend on each other is not merged.
    fn over(&self, _base: &Self) -> Self {
        self.clone()
    }

    /// The record as a table.
    fn written(&self) -> Written {
        let mut table = Written::new();
        self.write_keys(&mut table);
        table
    }

    /// Every key of every form, each once.
    fn keys() -> Vec<&'static str> {
        keys_of(&Self::forms())
    }
}

/// Every key of the forms, each once.
fn keys_of<'f>(forms: impl IntoIterator<Item = &'f Form>) -> Vec<&'static str> {
    let mut keys = Vec::new();
    for key in forms.into_iter().flat_map(|f| &f.keys).map(|k| k.name) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

impl<T: Record> Record for Box<T> {
    fn read_keys(reader: &mut Reader<'_>, errors: &mut DescriptionErrors) -> Option<Self> {
        T::read_keys(reader, errors).map(Self::new)
    }
    fn forms() -> Vec<Form> {
        T::forms()
    }
    fn write_keys(&self, table: &mut Written) {
        T::write_keys(self, table);
    }
    fn over(&self, base: &Self) -> Self {
        Self::new(T::over(self, base))
    }
}

/// One shape of a table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Form {
    pub(crate) keys: Vec<Key>,
    /// Keys of which exactly one is given, or at most one.
    exclusive_keys: Vec<ExclusiveKeys>,
    /// Keys that are given together or not at all.
    groups: Vec<KeyGroup>,
    /// Key that every table of this form has, if no value distinguishes the form.
    only_with: Option<&'static str>,
}

/// Keys that exclude each other.
#[derive(Clone, Debug)]
struct ExclusiveKeys {
    keys: Vec<&'static str>,
    /// True if one of them must be given.
    is_required: bool,
}

/// Keys that need other keys: none is given without all of these.
#[derive(Clone, Debug)]
struct KeyGroup {
    keys: Vec<&'static str>,
    needed: Vec<&'static str>,
}

/// One key of a form.
#[derive(Clone, Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) required: bool,
    pub(crate) description: String,
    pub(crate) schema: Json,
}

impl Key {
    pub(crate) fn new(name: &'static str, required: bool, description: &str, schema: Json) -> Self {
        Self { name, required, description: description.split_whitespace().collect::<Vec<_>>().join(" "), schema }
    }
}

impl Form {
    /// A form of tables with the key `name`.
    pub(crate) fn only_with(name: &'static str, description: &str, schema: Json) -> Self {
        Self { keys: vec![Key::new(name, true, description, schema)], only_with: Some(name), ..Self::default() }
    }

    /// A form with exactly one of some keys.
    pub(crate) fn one_of(keys: Vec<Key>) -> Self {
        let names = keys.iter().map(|k| k.name).collect();
        let keys = keys.into_iter().map(|k| Key { required: false, ..k }).collect();
        Self { keys, exclusive_keys: vec![ExclusiveKeys { keys: names, is_required: true }], ..Self::default() }
    }

    /// The forms of a table in which all keys of these forms may be absent.
    pub(crate) fn all_or_none(forms: Vec<Self>) -> Vec<Self> {
        match forms.as_slice() {
            [only] if only.groups.is_empty() => only.clone().optional().map_or(forms, |form| vec![form]),
            _ => [vec![Self::default()], forms].concat(),
        }
    }

    /// The form, optional as a whole; `None` where choices and other keys are required together.
    fn optional(mut self) -> Option<Self> {
        let needed: Vec<_> = self.keys.iter().filter(|k| k.required).map(|k| k.name).collect();
        match self.exclusive_keys.as_mut_slice() {
            [] => {
                let keys = self.keys.iter().map(|k| k.name).collect();
                self.keys.iter_mut().for_each(|k| k.required = false);
                self.groups.push(KeyGroup { keys, needed });
            }
            [only] if only.keys.len() == self.keys.len() => only.is_required = false,
            _ => return None,
        }
        Some(self)
    }

    /// The form with an optional key of another form; with either schema if it has the key already.
    pub(crate) fn or_with(mut self, key: &Key) -> Self {
        match self.keys.iter_mut().find(|k| k.name == key.name) {
            None => self.keys.push(Key { required: false, ..key.clone() }),
            Some(known) if known.schema == key.schema => {}
            Some(known) => {
                let options = known.schema["anyOf"].as_array().cloned();
                let mut options = options.unwrap_or_else(|| vec![known.schema.clone()]);
                if !options.contains(&key.schema) {
                    options.push(key.schema.clone());
                    known.schema = json!({ "anyOf": options });
                }
            }
        }
        self
    }

    /// The form with an additional key.
    pub(crate) fn with(mut self, key: Key) -> Self {
        self.keys.push(key);
        self
    }

    /// Every form joined to every one of `others`.
    pub(crate) fn product(forms: &[Self], others: &[Self]) -> Vec<Self> {
        let combined = |a: &Self, b: &Self| Self {
            keys: a.keys.iter().chain(&b.keys).cloned().collect(),
            exclusive_keys: a.exclusive_keys.iter().chain(&b.exclusive_keys).cloned().collect(),
            groups: a.groups.iter().chain(&b.groups).cloned().collect(),
            only_with: a.only_with.or(b.only_with),
        };
        forms.iter().flat_map(|a| others.iter().map(move |b| combined(a, b))).collect()
    }

    fn has(&self, key: &str) -> bool {
        self.keys.iter().any(|k| k.name == key)
    }

    /// True if the words that distinguish this form are those of the table.
    fn fits(&self, table: &Table) -> bool {
        let marks = self.keys.iter().filter_map(|k| Some((k.name, k.schema.get("const")?.as_str())));
        let marked = marks.into_iter().all(|(key, word)| table.get(key).and_then(Node::as_text) == word);
        marked && self.only_with.is_none_or(|key| table.get(key).is_some())
    }

    /// The distinction of the form, in words: `type = "sun"`.
    fn mark(&self) -> Option<String> {
        let key = self.keys.iter().find(|k| k.schema.get("const").is_some())?;
        Some(format!("{} = {}", key.name, key.schema["const"]))
    }
}

/// The JSON Schema of a table that has one of `forms`.
pub(crate) fn record_schema(forms: &[Form]) -> Json {
    match forms {
        [only] => form_schema(only),
        _ => json!({ "oneOf": forms.iter().map(form_schema).collect::<Vec<_>>() }),
    }
}

fn form_schema(form: &Form) -> Json {
    let properties: Map<String, Json> = form.keys.iter().map(|k| (k.name.to_owned(), described(k))).collect();
    let required: Vec<_> = form.keys.iter().filter(|k| k.required).map(|k| k.name).collect();
    let mut schema =
        json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false });
    if !form.exclusive_keys.is_empty() {
        schema["allOf"] = form.exclusive_keys.iter().map(choice_schema).collect();
    }
    for group in &form.groups {
        for key in &group.keys {
            schema["dependentRequired"][key] = json!(group.needed);
        }
    }
    schema
}

fn choice_schema(choice: &ExclusiveKeys) -> Json {
    let exclusive: Vec<_> = choice.keys.iter().map(|key| json!({ "required": [key] })).collect();
    let none = (!choice.is_required).then(|| json!({ "not": { "anyOf": exclusive } }));
    json!({ "oneOf": exclusive.iter().cloned().chain(none).collect::<Vec<_>>() })
}

fn described(key: &Key) -> Json {
    let mut schema = key.schema.clone();
    if !key.description.is_empty() {
        schema["description"] = json!(key.description);
    }
    schema
}

/// A table being read; it tracks the keys that were read.
pub(crate) struct Reader<'t> {
    table: &'t Table,
    place: &'t Place,
    is_read: Vec<bool>,
    /// The table's kind is unknown, so its other keys cannot be checked.
    unknown_kind: bool,
}

impl<'t> Reader<'t> {
    pub(crate) fn new(table: &'t Table, place: &'t Place) -> Self {
        Self { table, place, is_read: vec![false; table.entries.len()], unknown_kind: false }
    }

    /// Place of the table.
    pub(crate) fn place(&self) -> &'t Place {
        self.place
    }

    /// Place of the key, if given.
    pub(crate) fn place_of(&self, key: &str) -> Option<&'t Place> {
        self.table.entries.iter().find(|e| e.key == key).map(|e| &e.place)
    }

    /// Returns the value of `key` and marks it as read.
    pub(crate) fn take(&mut self, key: &str) -> Option<&'t Node> {
        let index = self.table.entries.iter().position(|e| e.key == key)?;
        self.is_read[index] = true;
        Some(&self.table.entries[index].node)
    }

    /// Marks every key as read, for a table of unknown kind.
    pub(crate) fn mark_all_read(&mut self) {
        self.unknown_kind = true;
    }

    /// Reads the value of `key` by `rule`; reports an error if it is missing.
    pub(crate) fn required<R: Rule>(&mut self, key: &str, rule: &R, errors: &mut DescriptionErrors) -> Option<R::Out> {
        match self.take(key) {
            Some(node) => rule.read(node, errors),
            None => {
                let remedy = format!("add it: {}", rule.expected());
                errors.add_missing(self.place, key, remedy);
                None
            }
        }
    }

    /// Reads the value of `key` by `rule`, if given; the outer `None` follows an error.
    pub(crate) fn optional<R: Rule>(
        &mut self,
        key: &str,
        rule: &R,
        errors: &mut DescriptionErrors,
    ) -> Option<Option<R::Out>> {
        self.take(key).map_or(Some(None), |node| rule.read(node, errors).map(Some))
    }

    /// Reports every key that was not read.
    pub(crate) fn finish<T: Record>(self, errors: &mut DescriptionErrors) {
        if self.unknown_kind || self.is_read.iter().all(|t| *t) {
            return;
        }
        let forms = T::forms();
        for (entry, _) in self.table.entries.iter().zip(&self.is_read).filter(|(_, is_read)| !**is_read) {
            let owners: Vec<_> = forms.iter().filter(|f| f.has(&entry.key)).filter_map(Form::mark).collect();
            if owners.is_empty() {
                let (problem, remedy, suggestion) = stray(&entry.key, &forms, self.table);
                errors.add(ErrorCode::UnknownKey, &entry.place, problem, remedy);
                suggestion.iter().for_each(|key| errors.remove_missing(self.place, key));
                continue;
            }
            let problem = format!("\"{}\" has no effect here, it belongs to {}", entry.key, owners.join(" or "));
            let choice_value =
                owners.iter().filter_map(|mark| mark.split_once(" = ")).find_map(|(tag, _)| self.table.get(tag));
            errors.add_without_effect(
                ErrorCode::NoEffect,
                &entry.key,
                &entry.place,
                choice_value.map(|node| &node.place),
                problem,
                "remove it",
            );
        }
    }
}

/// Former names of keys, and their names today.
const RENAMED: [(&str, &str); 1] = [("share", "fraction")];

/// Returns problem and remedy of a key that belongs to no form, and the key that was probably meant.
fn stray(key: &str, forms: &[Form], table: &Table) -> (String, String, Option<String>) {
    let keys = keys_of(forms.iter().filter(|f| f.fits(table)));
    let renamed = RENAMED.into_iter().find(|(former, name)| *former == key && keys.contains(name));
    if let Some((_, name)) = renamed {
        return (format!("\"{key}\" is now \"{name}\""), format!("write \"{name}\""), Some(name.to_owned()));
    }
    let suggestion = nearest(key, &keys);
    let remedy = match suggestion {
        Some(word) => format!("did you mean \"{word}\"?"),
        None => format!("remove it; the keys are {}", quoted(&keys)),
    };
    (format!("unknown key \"{key}\""), remedy, suggestion.map(str::to_owned))
}
