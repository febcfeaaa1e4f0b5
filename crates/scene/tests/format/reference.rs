//! The reference on the page is the schema, in words.

use etendue_scene::{FileKind, schema};
use serde_json::Value as Json;

use crate::files::{DOC, doc};

const HEAD: &str =
    "<!-- reference: made of the schema by the tests of crates/scene; ETENDUE_BLESS=1 writes it anew -->\n";
const END: &str = "<!-- end of reference -->\n";

/// Sections to write and sections written: a table that is used twice is told once.
#[derive(Default)]
struct Page {
    /// Title and schema of every table, in the order in which they are met.
    tables: Vec<(String, Json)>,
}

impl Page {
    /// The title of a table's section.
    fn title(&mut self, title: &str, schema: &Json) -> String {
        let schema = plain(schema);
        if let Some((known, _)) = self.tables.iter().find(|(_, s)| *s == schema) {
            return known.clone();
        }
        self.tables.push((title.to_owned(), schema));
        title.to_owned()
    }

    fn write(mut self) -> String {
        let mut text = String::new();
        let mut next = 0;
        while let Some((title, schema)) = self.tables.get(next).cloned() {
            for group in groups(&schema) {
                text += &self.section(&title, &group);
            }
            next += 1;
        }
        text
    }

    /// One table of keys: all forms that bear the same mark.
    fn section(&mut self, title: &str, forms: &[Json]) -> String {
        let mark = mark(&forms[0]);
        let told = mark.as_ref().map_or(String::new(), |(key, word, _)| format!(", `{key} = \"{word}\"`"));
        let about = mark.as_ref().map_or(String::new(), |(_, _, about)| format!("{about}\n\n"));
        let mut text = format!("### {title}{told}\n\n{about}");
        let keys = keys_of(forms);
        if keys.is_empty() {
            return text + "No keys of its own.\n\n";
        }
        text += "| key | must | value | meaning |\n| --- | --- | --- | --- |\n";
        for (key, schema) in keys {
            let value = self.value(&schema, title, &key);
            let about = schema["description"].as_str().unwrap_or("");
            text += &format!("| `{key}` | {} | {value} | {about} |\n", must(&key, forms));
        }
        text + "\n"
    }

    fn value(&mut self, schema: &Json, title: &str, key: &str) -> String {
        if let Some(options) = schema["anyOf"].as_array() {
            return options.iter().map(|o| self.value(o, title, key)).collect::<Vec<_>>().join(", or ");
        }
        if let Some(words) = schema["enum"].as_array() {
            return words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ");
        }
        match schema["type"].as_str() {
            Some("array") => self.list(schema, title, key),
            Some("boolean") => "`true`, `false`".to_owned(),
            Some("string") => string(schema),
            Some("integer") => format!("integer {}", bounds(schema)),
            Some("number") => number(schema),
            _ if schema.get("additionalProperties").is_some_and(Json::is_object) => {
                format!("table of {}", self.value(&schema["additionalProperties"], title, key))
            }
            _ if is_table(schema) => format!("table: {}", self.title(&child(title, key, "[", "]"), schema)),
            _ => format!("`{}`", schema["const"]),
        }
    }

    fn list(&mut self, schema: &Json, title: &str, key: &str) -> String {
        let items = &schema["items"];
        if is_table(items) {
            return format!("list of tables: {}", self.title(&child(title, key, "[[", "]]"), items));
        }
        let count = schema["maxItems"].as_u64().map_or(String::new(), |n| format!("{n} × "));
        format!("list of {count}{}", self.value(items, title, key))
    }
}

/// The schema without what only the head of a file has.
fn plain(schema: &Json) -> Json {
    let mut schema = schema.clone();
    if let Some(table) = schema.as_object_mut() {
        ["$schema", "title", "description"].iter().for_each(|k| {
            table.remove(*k);
        });
        table.get_mut("properties").and_then(Json::as_object_mut).map(|p| p.remove("format"));
        table.get_mut("required").and_then(Json::as_array_mut).iter_mut().for_each(|r| r.retain(|k| k != "format"));
    }
    schema
}

fn is_table(schema: &Json) -> bool {
    schema.get("properties").is_some() || schema.get("oneOf").is_some()
}

/// `Scene [[objects]]`, `Scene [[objects]].[shape]`.
fn child(title: &str, key: &str, open: &str, close: &str) -> String {
    let (kind, path) = title.split_once(' ').map_or((title, String::new()), |(k, p)| (k, p.replace('`', "") + "."));
    format!("{kind} `{path}{open}{key}{close}`")
}

/// The forms of a table, those with the same mark together.
fn groups(schema: &Json) -> Vec<Vec<Json>> {
    let forms = schema["oneOf"].as_array().cloned().unwrap_or_else(|| vec![schema.clone()]);
    let mut groups: Vec<Vec<Json>> = Vec::new();
    for form in forms {
        match groups.iter_mut().find(|g| mark(&g[0]) == mark(&form)) {
            Some(group) => group.push(form),
            None => groups.push(vec![form]),
        }
    }
    groups
}

/// The key and word that tell a form from others, and what it is.
fn mark(form: &Json) -> Option<(String, String, String)> {
    let (key, schema) = form["properties"].as_object()?.iter().find(|(_, s)| s.get("const").is_some())?;
    Some((key.clone(), schema["const"].as_str()?.to_owned(), schema["description"].as_str().unwrap_or("").to_owned()))
}

/// The keys of all forms, each once, but the mark: what is needed first.
fn keys_of(forms: &[Json]) -> Vec<(String, Json)> {
    let mut keys: Vec<(String, Json)> = Vec::new();
    for (key, schema) in forms.iter().filter_map(|f| f["properties"].as_object()).flatten() {
        if schema.get("const").is_none() && !keys.iter().any(|(k, _)| k == key) {
            keys.push((key.clone(), schema.clone()));
        }
    }
    let order = |key: &str| ["yes", "one", "set", "no"].iter().position(|m| *m == must(key, forms));
    keys.sort_by(|(a, _), (b, _)| (order(a), a).cmp(&(order(b), b)));
    keys
}

/// Whether a list of keys in a schema has the key.
fn lists(list: &Json, key: &str) -> bool {
    list.as_array().is_some_and(|list| list.iter().any(|k| k == key))
}

/// Whether exactly one of some keys, this one among them, must be given.
fn is_one_of(form: &Json, key: &str) -> bool {
    let choices = form["allOf"].as_array().into_iter().flatten();
    let must = choices.filter_map(|c| c["oneOf"].as_array()).filter(|o| o.iter().all(|o| o.get("not").is_none()));
    must.flatten().any(|option| lists(&option["required"], key))
}

/// Whether the key is needed: in all forms, in some of them or in place of others, with others, or never.
fn must(key: &str, forms: &[Json]) -> &'static str {
    let with = forms.iter().filter(|f| lists(&f["required"], key)).count();
    let needed_by =
        |form: &Json| form["dependentRequired"].as_object().is_some_and(|d| d.values().any(|n| lists(n, key)));
    match with {
        0 if forms.iter().any(|f| is_one_of(f, key)) => "one",
        0 if forms.iter().any(needed_by) => "set",
        0 => "no",
        n if n == forms.len() => "yes",
        _ => "one",
    }
}

fn string(schema: &Json) -> String {
    if let Some(example) = schema["examples"].get(0).and_then(Json::as_str) {
        return format!("text: `{example}`");
    }
    match schema["pattern"].as_str() {
        Some(pattern) if pattern.contains("\\.(") => {
            let list = pattern.trim_start_matches("\\.(").trim_end_matches(")$").replace('|', ", .");
            format!("path of a file (.{list})")
        }
        Some(_) => "text of letters, digits, `-`, `_`".to_owned(),
        None => "text".to_owned(),
    }
}

fn number(schema: &Json) -> String {
    let unit = schema["unit"].as_str().map_or(String::new(), |u| format!(", {u}"));
    format!("number {}", bounds(schema)).trim_end().to_owned() + &unit
}

/// `0 … 1`, `> 0`, `≥ 0`.
fn bounds(schema: &Json) -> String {
    let bound = |key: &str| schema.get(key).map(Json::to_string).map(|t| t.trim_end_matches(".0").to_owned());
    match (bound("minimum"), bound("exclusiveMinimum"), bound("maximum")) {
        (Some(low), _, Some(high)) => format!("{low} … {high}"),
        (Some(low), _, None) => format!("≥ {low}"),
        (None, Some(low), Some(high)) => format!("> {low}, ≤ {high}"),
        (None, Some(low), None) => format!("> {low}"),
        (None, None, high) => high.map_or(String::new(), |h| format!("≤ {h}")),
    }
}

/// The list of ready materials.
fn presets() -> String {
    let mut text =
        "### Presets of `[[materials]]`\n\n| preset | is | says | source |\n| --- | --- | --- | --- |\n".to_owned();
    for preset in etendue_scene::preset::all() {
        let says: Vec<_> = preset.said().map(|said| format!("`{said}`")).collect();
        text += &format!("| `{}` | {} | {} | {} |\n", preset.name, preset.about, says.join(", "), preset.source);
    }
    text + "\n"
}

#[test]
fn the_reference_is_in_step_with_the_schema() {
    let mut page = Page::default();
    let kinds = [
        ("Scene", FileKind::Scene),
        ("Camera", FileKind::Camera),
        ("Job", FileKind::Job),
        ("Data sheet", FileKind::DataSheet),
    ];
    for (title, kind) in kinds {
        // Of scenes and cameras the whole files, not those over a base.
        let schema = schema(kind);
        page.title(title, schema.get("else").unwrap_or(&schema));
    }
    let reference = format!("{HEAD}\n{}{}{END}", page.write(), presets());
    let doc = doc();
    let start = doc.find(HEAD).expect("the reference begins");
    let end = doc.find(END).expect("the reference ends") + END.len();
    if std::env::var_os("ETENDUE_BLESS").is_some_and(|value| value == "1") {
        std::fs::write(DOC, format!("{}{reference}{}", &doc[..start], &doc[end..])).expect("the page is writable");
        return;
    }
    let differs = doc[start..end].lines().zip(reference.lines()).find(|(old, new)| old != new);
    assert!(
        doc[start..end] == reference,
        "run the tests with ETENDUE_BLESS=1; the first line that differs: {differs:?}"
    );
}
