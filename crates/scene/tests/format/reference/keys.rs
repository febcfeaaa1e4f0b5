//! The keys of a table, and whether they are required.

use serde_json::Value as Json;

/// The forms of a table, grouped by mark.
pub(super) fn groups(schema: &Json) -> Vec<Vec<Json>> {
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

/// The key and word that distinguish a form, and its description.
pub(super) fn mark(form: &Json) -> Option<(String, String, String)> {
    let (key, schema) = form["properties"].as_object()?.iter().find(|(_, s)| s.get("const").is_some())?;
    Some((key.clone(), schema["const"].as_str()?.to_owned(), schema["description"].as_str().unwrap_or("").to_owned()))
}

/// The keys of all forms, each once, except the mark; required keys first.
pub(super) fn keys_of(forms: &[Json]) -> Vec<(String, Json)> {
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

/// True if a list of keys in a schema contains the key.
fn lists(list: &Json, key: &str) -> bool {
    list.as_array().is_some_and(|list| list.iter().any(|k| k == key))
}

/// True if exactly one of some keys, this one among them, is required.
fn is_one_of(form: &Json, key: &str) -> bool {
    let choices = form["allOf"].as_array().into_iter().flatten();
    let is_required =
        choices.filter_map(|c| c["oneOf"].as_array()).filter(|o| o.iter().all(|o| o.get("not").is_none()));
    is_required.flatten().any(|option| lists(&option["required"], key))
}

/// Requirement of the key: in all forms, in some of them or instead of others, with others, or never.
pub(super) fn must(key: &str, forms: &[Json]) -> &'static str {
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
