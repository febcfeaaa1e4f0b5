//! Every key of a sensor's electronics has a row in the table of `[sensor] scale`: a new key needs a decision.

use crate::root;

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The keys of the record, by the lines of its `record!`.
fn keys(source: &str) -> Vec<&str> {
    let (_, record) = source.split_once("pub struct Electronics {").expect("the record");
    let record = record.split("\n    }").next().unwrap_or(record);
    let is_key =
        |line: &&str| ["required ", "optional ", "many "].iter().any(|word| line.trim_start().starts_with(word));
    record.lines().filter(is_key).filter_map(|line| line.split_whitespace().nth(1)?.strip_suffix(':')).collect()
}

#[test]
fn every_key_of_the_sensor_has_a_scale() {
    let page = read("docs/sensor.md");
    let (_, section) = page.split_once("\n## Scale\n").expect("the section");
    let section = section.split("\n## ").next().unwrap_or(section);
    let source = read("crates/scene/src/record/sensor/electronics.rs");
    let keys = keys(&source);
    assert!(keys.len() > 25, "{keys:?}");
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words: Vec<&str> = section.split(|c| !is_part(c)).collect();
    let missing: Vec<&&str> = keys.iter().filter(|key| !words.contains(key)).collect();
    assert!(missing.is_empty(), "docs/sensor.md, Scale: no row has {missing:?}");
}
