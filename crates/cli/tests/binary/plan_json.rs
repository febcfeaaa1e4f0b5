//! `etendue plan --json`: one document, with an explanation of every key.

use crate::support::{etendue, root, small};
use serde_json::Value;
use std::collections::BTreeSet;

fn plan(arguments: &[&str]) -> Value {
    let all = [&["plan"], arguments, &["--json"]].concat();
    let output = etendue(all).ok();
    serde_json::from_str(&output.out).expect("one JSON document on stdout")
}

fn keys(value: &Value, keys_in_use: &mut BTreeSet<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| {
            keys_in_use.insert(key.clone());
            keys(value, keys_in_use);
        }),
        Value::Array(list) => list.iter().for_each(|value| keys(value, keys_in_use)),
        _ => {}
    }
}

/// Effect of the first camera with this id.
fn effect<'p>(plan: &'p Value, id: &str) -> &'p Value {
    let effects = plan["cameras"][0]["effects"].as_array().expect("a list");
    effects.iter().find(|effect| effect["id"] == id).expect("every plan lists all effects")
}

#[test]
fn every_key_is_in_the_documentation() {
    let page = std::fs::read_to_string(root().join("docs/plan.md")).expect("the page");
    let mut keys_in_use = BTreeSet::new();
    for job in [small().as_str(), "scenes/cornell/cornell.toml", "scenes/lenses/ghosts.toml"] {
        keys(&plan(&[job]), &mut keys_in_use);
    }
    assert!(keys_in_use.len() > 60, "{keys_in_use:?}");
    let missing: Vec<_> = keys_in_use.iter().filter(|key| !page.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "docs/plan.md does not explain {missing:?}");
}

#[test]
fn the_document_says_what_the_text_says() {
    let job = "scenes/lenses/ghosts.toml";
    let (text, json) = (etendue(["plan", job, "--camera", "bare"]).ok().out, plan(&[job, "--camera", "bare"]));
    let hash = json["hash"].as_str().expect("a text");
    assert!(text.starts_with(&format!("plan {}\n", &hash[..16])) && hash.len() == 64);
    assert_eq!(json["cameras"].as_array().map(Vec::len), Some(1));
    let ghosts = effect(&json, "ghosts");
    assert_eq!(ghosts["status"], "required");
    assert!(ghosts["cpu_s"].as_f64().is_some_and(|s| s > 1.0));
    assert_eq!(
        ghosts["if_dropped"]["set"],
        serde_json::json!(["cameras.bare.effects=null", "cameras.bare.output.ghosts=false"])
    );
    assert!(text.lines().any(|line| line.trim_start().starts_with("ghosts ") && line.contains("saves")), "{text}");
    // The parts of a frame add up to the whole.
    let cost = &json["cameras"][0]["cost"];
    let parts: f64 = cost["film_parts"].as_array().expect("a list").iter().filter_map(|p| p["cpu_s"].as_f64()).sum();
    let total = cost["paths_cpu_s"].as_f64().expect("a number") + parts;
    assert!((total / cost["cpu_s"].as_f64().expect("a number") - 1.0).abs() < 1e-9);
}

#[test]
fn what_the_keys_of_the_document_drop_is_skipped() {
    let job = "scenes/lenses/night-flare.toml";
    let set = plan(&[job]);
    let set = effect(&set, "veiling_glare")["if_dropped"]["set"][0].as_str().expect("a change").to_owned();
    let without = plan(&[job, "--set", &set]);
    assert_eq!(effect(&without, "veiling_glare")["status"], "skipped");
    assert!(effect(&without, "veiling_glare")["if_dropped"].is_null());
    assert_eq!(effect(&without, "point_spread")["status"], "required");
}

#[test]
fn equal_notes_are_reported_once_with_their_number() {
    let job = "scenes/street/street.toml";
    let json = plan(&[job]);
    let remarks = json["remarks"].as_array().expect("a list");
    let signs = remarks.iter().find(|r| r["about"].as_array().is_some_and(|a| a.len() == 8)).expect("of eight signs");
    assert_eq!((&signs["count"], &signs["weight"]), (&8.into(), &"note".into()));
    let text = etendue(["plan", job]).ok().out;
    let lines: Vec<_> = text.lines().filter(|line| line.contains("R_A is constant below")).collect();
    assert!(lines.len() == 1 && lines[0].ends_with("(8 times)"), "{lines:?}");
}
