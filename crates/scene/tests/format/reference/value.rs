//! Permitted values of a key, in words.

use serde_json::Value as Json;

use super::page::Pages;
use super::section::{File, is_table};

/// Describes the value by its schema; tables are links from a page to their sections.
pub(super) fn value(schema: &Json, pages: &Pages, from: Option<File>) -> String {
    let describe = |schema: &Json| value(schema, pages, from);
    if let Some(options) = schema["anyOf"].as_array() {
        return options.iter().map(describe).collect::<Vec<_>>().join(", or ");
    }
    if let Some(words) = schema["enum"].as_array() {
        return words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ");
    }
    match schema["type"].as_str() {
        Some("array") if is_table(&schema["items"]) => {
            format!("list of tables: {}", pages.link(&schema["items"], from))
        }
        Some("array") => list(schema, &describe(&schema["items"])),
        Some("boolean") => "`true`, `false`".to_owned(),
        Some("string") => string(schema),
        Some("integer") => format!("integer {}", bounds(schema)),
        Some("number") => number(schema),
        _ if schema["additionalProperties"].is_object() => {
            format!("table of {}", describe(&schema["additionalProperties"]))
        }
        _ if is_table(schema) => format!("table: {}", pages.link(schema, from)),
        _ => format!("`{}`", schema["const"]),
    }
}

/// `list of 3 × number`; alternatives of an entry are in brackets.
fn list(schema: &Json, entry: &str) -> String {
    let count = schema["maxItems"].as_u64().map_or(String::new(), |n| format!("{n} × "));
    match schema["items"].get("anyOf") {
        Some(_) => format!("list of {count}({entry})"),
        None => format!("list of {count}{entry}"),
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
