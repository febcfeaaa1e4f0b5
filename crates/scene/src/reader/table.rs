//! Records: tables read key by key, so that no key is left over.

use serde_json::{Map, Value as Json, json};

use super::rule::Rule;
use super::word::quoted;
use crate::document::{Node, Table};
use crate::fault::{ErrorCode, Faults};
use crate::place::Place;
use crate::suggest::nearest;
use crate::written::Table as Written;

/// A struct or an enum of structs whose fields are keys of a table.
pub(crate) trait Record: Clone {
    /// Reads the record's keys; returns `None` after reporting at least one error.
    fn read_keys(reader: &mut Reader<'_>, faults: &mut Faults) -> Option<Self>;
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
    fn read_keys(reader: &mut Reader<'_>, faults: &mut Faults) -> Option<Self> {
        T::read_keys(reader, faults).map(Self::new)
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
    choices: Vec<Choice>,
    /// Keys that are given together or not at all.
    groups: Vec<Group>,
    /// Key that every table of this form has, if no value distinguishes the form.
    only_with: Option<&'static str>,
}

/// Keys that exclude each other.
#[derive(Clone, Debug)]
struct Choice {
    keys: Vec<&'static str>,
    /// True if one of them must be given.
    must: bool,
}

/// Keys that need other keys: none is given without all of these.
#[derive(Clone, Debug)]
struct Group {
    keys: Vec<&'static str>,
    needed: Vec<&'static str>,
}

/// One key of a form.
#[derive(Clone, Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) required: bool,
    pub(crate) about: String,
    pub(crate) schema: Json,
}

impl Key {
    pub(crate) fn new(name: &'static str, required: bool, about: &str, schema: Json) -> Self {
        Self { name, required, about: about.split_whitespace().collect::<Vec<_>>().join(" "), schema }
    }
}

impl Form {
    /// A form of tables with the key `name`.
    pub(crate) fn only_with(name: &'static str, about: &str, schema: Json) -> Self {
        Self { keys: vec![Key::new(name, true, about, schema)], only_with: Some(name), ..Self::default() }
    }

    /// A form with exactly one of some keys.
    pub(crate) fn one_of(keys: Vec<Key>) -> Self {
        let names = keys.iter().map(|k| k.name).collect();
        let keys = keys.into_iter().map(|k| Key { required: false, ..k }).collect();
        Self { keys, choices: vec![Choice { keys: names, must: true }], ..Self::default() }
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
        match self.choices.as_mut_slice() {
            [] => {
                let keys = self.keys.iter().map(|k| k.name).collect();
                self.keys.iter_mut().for_each(|k| k.required = false);
                self.groups.push(Group { keys, needed });
            }
            [only] if only.keys.len() == self.keys.len() => only.must = false,
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
        let joined = |a: &Self, b: &Self| Self {
            keys: a.keys.iter().chain(&b.keys).cloned().collect(),
            choices: a.choices.iter().chain(&b.choices).cloned().collect(),
            groups: a.groups.iter().chain(&b.groups).cloned().collect(),
            only_with: a.only_with.or(b.only_with),
        };
        forms.iter().flat_map(|a| others.iter().map(move |b| joined(a, b))).collect()
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
    if !form.choices.is_empty() {
        schema["allOf"] = form.choices.iter().map(choice_schema).collect();
    }
    for group in &form.groups {
        for key in &group.keys {
            schema["dependentRequired"][key] = json!(group.needed);
        }
    }
    schema
}

fn choice_schema(choice: &Choice) -> Json {
    let given: Vec<_> = choice.keys.iter().map(|key| json!({ "required": [key] })).collect();
    let none = (!choice.must).then(|| json!({ "not": { "anyOf": given } }));
    json!({ "oneOf": given.iter().cloned().chain(none).collect::<Vec<_>>() })
}

fn described(key: &Key) -> Json {
    let mut schema = key.schema.clone();
    if !key.about.is_empty() {
        schema["description"] = json!(key.about);
    }
    schema
}

/// A table being read; it tracks the keys that were read.
pub(crate) struct Reader<'t> {
    table: &'t Table,
    place: &'t Place,
    taken: Vec<bool>,
    /// The table's kind is unknown, so its other keys cannot be checked.
    lost: bool,
}

impl<'t> Reader<'t> {
    pub(crate) fn new(table: &'t Table, place: &'t Place) -> Self {
        Self { table, place, taken: vec![false; table.entries.len()], lost: false }
    }

    /// Place of the table.
    pub(crate) fn place(&self) -> &'t Place {
        self.place
    }

    /// Place of the key, if given.
    pub(crate) fn given(&self, key: &str) -> Option<&'t Place> {
        self.table.entries.iter().find(|e| e.key == key).map(|e| &e.place)
    }

    /// Returns the value of `key` and marks it as read.
    pub(crate) fn take(&mut self, key: &str) -> Option<&'t Node> {
        let index = self.table.entries.iter().position(|e| e.key == key)?;
        self.taken[index] = true;
        Some(&self.table.entries[index].node)
    }

    /// Marks every key as read, for a table of unknown kind.
    pub(crate) fn give_up(&mut self) {
        self.lost = true;
    }

    /// Reads the value of `key` by `rule`; reports an error if it is missing.
    pub(crate) fn required<R: Rule>(&mut self, key: &str, rule: &R, faults: &mut Faults) -> Option<R::Out> {
        match self.take(key) {
            Some(node) => rule.read(node, faults),
            None => {
                let remedy = format!("add it: {}", rule.expected());
                faults.add_missing(self.place, key, remedy);
                None
            }
        }
    }

    /// Reads the value of `key` by `rule`, if given; the outer `None` follows an error.
    pub(crate) fn optional<R: Rule>(&mut self, key: &str, rule: &R, faults: &mut Faults) -> Option<Option<R::Out>> {
        self.take(key).map_or(Some(None), |node| rule.read(node, faults).map(Some))
    }

    /// Reports every key that was not read.
    pub(crate) fn finish<T: Record>(self, faults: &mut Faults) {
        if self.lost || self.taken.iter().all(|t| *t) {
            return;
        }
        let forms = T::forms();
        for (entry, _) in self.table.entries.iter().zip(&self.taken).filter(|(_, taken)| !**taken) {
            let owners: Vec<_> = forms.iter().filter(|f| f.has(&entry.key)).filter_map(Form::mark).collect();
            if owners.is_empty() {
                let (problem, remedy, meant) = stray(&entry.key, &forms, self.table);
                faults.add(ErrorCode::UnknownKey, &entry.place, problem, remedy);
                meant.iter().for_each(|key| faults.take_back_missing(self.place, key));
                continue;
            }
            let problem = format!("\"{}\" has no effect here, it belongs to {}", entry.key, owners.join(" or "));
            let told = owners.iter().filter_map(|mark| mark.split_once(" = ")).find_map(|(tag, _)| self.table.get(tag));
            faults.add_idle(
                ErrorCode::NoEffect,
                &entry.key,
                &entry.place,
                told.map(|node| &node.place),
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
    let meant = nearest(key, &keys);
    let remedy = match meant {
        Some(word) => format!("did you mean \"{word}\"?"),
        None => format!("remove it; the keys are {}", quoted(&keys)),
    };
    (format!("unknown key \"{key}\""), remedy, meant.map(str::to_owned))
}
