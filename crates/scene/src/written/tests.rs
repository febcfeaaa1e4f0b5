//! Writing and reading back every key, for tables generated from the format's own schema.

use std::path::Path;
use std::sync::Arc;

use serde_json::{Map, Value as Json, json};

use super::{File, Item, Table};
use crate::document::{Entry, Node, Table as Tree, Value, parse};
use crate::fault::DescriptionErrors;
use crate::place::Place;
use crate::reader::{Record, Rule as _, record};
use crate::record::{DataSheet, Job};

/// Large enough for every variant of the format to occur.
const SAMPLES: usize = 60;

#[test]
fn every_key_that_is_read_is_written_and_read_back() {
    check::<Job>();
    check::<DataSheet>();
}

fn check<T: Record>() {
    let schema = record::<T>().schema();
    for turn in 0..SAMPLES {
        let sample = value_from_schema(&schema, turn);
        let first = read::<T>(&node(&sample)).written();
        assert_eq!(differences("", &first.to_json(), &sample), "", "sample {turn}: what is written is what was read");
        let text = File::new(first.clone()).to_string();
        let tree = parse(&Arc::from(Path::new("job.toml")), &text, &mut DescriptionErrors::none());
        let Value::Table(mut tree) = tree.value else { panic!("a table") };
        tree.remove("format").expect("every file says its format");
        let repeated = read::<T>(&at_home(Value::Table(tree))).written();
        assert!(repeated == first, "sample {turn} is another after it was written:\n{text}");
    }
}

/// Reads a sample. Keys are valid one by one; contradictions between them are ignored.
fn read<T: Record>(tree: &Node) -> T {
    let mut errors = DescriptionErrors::none();
    let read = record::<T>().read(tree, &mut errors);
    read.unwrap_or_else(|| {
        panic!("{}", errors.as_slice().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    })
}

/// A value that the schema admits, different in each turn.
fn value_from_schema(schema: &Json, turn: usize) -> Json {
    if let Some(options) = schema["oneOf"].as_array().or(schema["anyOf"].as_array()) {
        let options: Vec<_> = options.iter().filter(|option| !is_of_files(option)).collect();
        return value_from_schema(options[turn % options.len()], turn / options.len() + turn);
    }
    if let Some(words) = schema["enum"].as_array() {
        return words[turn % words.len()].clone();
    }
    if let Some(word) = schema.get("const") {
        return word.clone();
    }
    match schema["type"].as_str().expect("a type") {
        "object" => table_from_schema(schema, turn),
        "array" => {
            let min_items = schema["minItems"].as_u64().unwrap_or(0);
            let count = schema["maxItems"].as_u64().unwrap_or(min_items.max(1) + turn as u64 % 2);
            (0..count as usize).map(|i| value_from_schema(&schema["items"], turn + i)).collect()
        }
        "number" => json!(number(schema, turn)),
        "integer" => {
            let (low, high) =
                (schema["minimum"].as_u64().expect("a bound"), schema["maximum"].as_u64().expect("a bound"));
            json!((low + turn as u64).min(high))
        }
        "boolean" => json!(turn.is_multiple_of(2)),
        "string" => json!(text(schema)),
        other => panic!("no sample of a {other}"),
    }
}

/// True for text that is replaced before records are read: the name of a file or of a preset.
fn is_of_files(option: &Json) -> bool {
    let is_file = |schema: &Json| schema["pattern"] == "\\.(toml)$";
    let keys = &option["properties"];
    is_file(option) || is_file(&keys["file"]) || keys.get("preset").is_some()
}

fn table_from_schema(schema: &Json, turn: usize) -> Json {
    if let Some(entry) = schema.get("additionalProperties").filter(|entry| entry.is_object()) {
        return json!({ "a name": value_from_schema(entry, turn), "b": value_from_schema(entry, turn + 1) });
    }
    let mut table: Map<String, Json> = Map::new();
    for (index, (key, schema)) in schema["properties"].as_object().expect("keys").iter().enumerate() {
        table.insert(key.clone(), value_from_schema(schema, turn + index));
    }
    for choice in schema["allOf"].as_array().into_iter().flatten() {
        let options = choice["oneOf"].as_array().expect("options");
        let keys: Vec<_> = options.iter().filter_map(|option| option["required"][0].as_str()).collect();
        for key in keys.iter().enumerate().filter(|(index, _)| *index != turn % keys.len()).map(|(_, key)| key) {
            table.remove(*key);
        }
    }
    // These keys are refused by a check, and no record contains them.
    for (key, owner) in [("peak", "camera"), ("scale", "texture")] {
        if ["srgb", "spectrum", "named", "channels"].iter().any(|k| table.contains_key(*k))
            && !table.contains_key(owner)
        {
            table.remove(key);
        }
    }
    Json::Object(table)
}

/// A number within the bounds that is not round.
fn number(schema: &Json, turn: usize) -> f64 {
    let low = schema["minimum"].as_f64().or(schema["exclusiveMinimum"].as_f64());
    let high = schema["maximum"].as_f64().or(schema["exclusiveMaximum"].as_f64());
    let fraction = 1.0 / (turn as f64 + 1.7);
    match (low, high) {
        (Some(low), Some(high)) => low + (high - low) * fraction,
        (Some(low), None) => low + fraction * [1e-9_f64, 1.0, 1e22][turn % 3].max(low.abs() * 1e-3),
        (None, high) => high.unwrap_or(0.5) - fraction * [1e-7, 1.0, 1e17][turn % 3],
    }
}

fn text(schema: &Json) -> String {
    if let Some(example) = schema["examples"][0].as_str() {
        return example.to_owned();
    }
    match schema["pattern"].as_str() {
        Some(ending) if ending.starts_with("\\.(") => {
            format!(
                "a folder/f\u{e9}.{}",
                ending.trim_start_matches("\\.(").split(['|', ')']).next().unwrap_or_default()
            )
        }
        Some(_) => "a-name_1".to_owned(),
        None => "a \"text\" of two\nlines, \\ and \u{b5}".to_owned(),
    }
}

fn node(json: &Json) -> Node {
    at_home(match json {
        Json::Bool(flag) => Value::Flag(*flag),
        Json::Number(number) => {
            number.as_i64().map_or_else(|| Value::Number(number.as_f64().expect("finite")), Value::Whole)
        }
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(list) => Value::List(list.iter().map(node).collect()),
        Json::Object(table) => {
            let entry = |(key, value): (&String, &Json)| {
                let node = node(value);
                Entry { key: key.clone(), place: node.place.clone(), node }
            };
            Value::Table(Tree { entries: table.iter().map(entry).collect() })
        }
        Json::Null => panic!("TOML has no null"),
    })
}

fn at_home(value: Value) -> Node {
    Node { place: Place::file_head(Path::new("job.toml")), value }
}

/// Differences between two values, one line each.
fn differences(key: &str, a: &Json, b: &Json) -> String {
    match (a, b) {
        (Json::Object(a), Json::Object(b)) => {
            let keys: std::collections::BTreeSet<_> = a.keys().chain(b.keys()).collect();
            let of = |table: &Map<String, Json>, key: &str| table.get(key).cloned().unwrap_or_default();
            keys.into_iter().map(|k| differences(&format!("{key}.{k}"), &of(a, k), &of(b, k))).collect()
        }
        (Json::Array(a), Json::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().map(|(i, (a, b))| differences(&format!("{key}[{i}]"), a, b)).collect()
        }
        (Json::Number(a), Json::Number(b)) if a.as_f64() == b.as_f64() => String::new(),
        (a, b) if a == b => String::new(),
        (a, b) => format!("{key}: {a}, not {b}\n"),
    }
}

/// The bytes that a hash covers of a table.
fn bytes(table: &Table) -> Vec<u8> {
    let mut bytes = Vec::new();
    table.feed(&|path| path.to_string_lossy().into_owned().into_bytes(), &mut |part| bytes.extend_from_slice(part));
    bytes
}

fn table(json: &Json) -> Table {
    let mut table = Table::new();
    for (key, value) in json.as_object().expect("a table") {
        table.put(key, item(value));
    }
    table
}

fn item(json: &Json) -> Item {
    match json {
        Json::Bool(flag) => (*flag).into(),
        Json::Number(number) => number.as_u64().map_or_else(|| number.as_f64().expect("finite").into(), Item::from),
        Json::String(text) => text.as_str().into(),
        Json::Array(list) => list.iter().map(item).collect::<Vec<_>>().into(),
        Json::Object(_) => table(json).into(),
        Json::Null => panic!("TOML has no null"),
    }
}

/// The value with its part `which` changed.
fn changed(json: &Json, which: &mut usize) -> Json {
    match json {
        Json::Array(list) => list.iter().map(|entry| changed(entry, which)).collect(),
        Json::Object(table) => table.iter().map(|(key, value)| (key.clone(), changed(value, which))).collect(),
        leaf => {
            let is_target = *which == 0;
            *which = which.wrapping_sub(1);
            if is_target { json!("another") } else { leaf.clone() }
        }
    }
}

#[test]
fn every_value_of_every_key_changes_the_bytes() {
    let schema = record::<Job>().schema();
    let of = |json: &Json| bytes(&table(json));
    for turn in 0..12 {
        let sample = value_from_schema(&schema, turn);
        let all_bytes = of(&sample);
        let mut known = std::collections::BTreeSet::from([all_bytes.clone()]);
        for leaf in 0.. {
            let mut which = leaf;
            let other = changed(&sample, &mut which);
            if other == sample {
                break;
            }
            assert!(known.insert(of(&other)), "part {leaf} of sample {turn}");
        }
        assert!(known.len() > 100 && all_bytes == of(&sample), "equal tables have equal bytes");
    }
}

#[test]
fn comments_stand_where_they_belong() {
    let dark = Table::new().with("temperature_c", -0.0).with("doubling_k", 1e-7);
    let lamp = Table::new().with("name", "a \"lamp\"").with("at", [Table::new().with("x m", 1.0), Table::new()]);
    let table =
        Table::new().with("sensor", Table::new().with("dark", dark).with("bits", 12_u64)).with("lights", [lamp]);
    let file = File::new(table).head("A file.\nOf two lines.").above("lights.a \"lamp\"", "Bright.");
    let file =
        file.above("sensor.dark", "Cold.").beside("sensor.bits", "of the converter").above("sensor.none", "Nothing.");
    let text = "# A file.\n# Of two lines.\nformat = 1\n\n[sensor]\nbits = 12 # of the converter\n\n# Cold.\n[sensor.dark]\n\
                temperature_c = -0.0\ndoubling_k = 1e-7\n\n# Bright.\n[[lights]]\nname = \"a \\\"lamp\\\"\"\nat = [\n  { \"x m\" = 1 },\n  \
                {},\n]\n";
    assert_eq!(file.to_string(), text);
}

#[test]
fn keys_have_the_places_of_the_file() {
    let text = "format = 1\n[sensor]\nbits = 12\n[sensor.dark]\nhot = { fraction = 0.1, mean_e_s = 1 }\n[[sensor.lag]]\nfraction = 0.2\n";
    let tree = parse(&Arc::from(Path::new("camera.toml")), text, &mut DescriptionErrors::none());
    let sensor = tree.as_table().and_then(|tree| tree.get("sensor")).expect("the sensor");
    let mut table = Table::new();
    let dark = record::<crate::record::sensor::charge::Dark>();
    let read = sensor.as_table().and_then(|sensor| dark.read(sensor.get("dark")?, &mut DescriptionErrors::none()));
    table.put("dark", dark.write(&read.expect("faulty, but read")).expect("written"));
    let line = |key: &str| table.place_of(key).and_then(Place::line_column).map(|(line, _)| line);
    assert_eq!([line("dark"), line("dark.spread"), line("dark.hot"), line("lag")], [Some(4), Some(4), Some(5), None]);
}

#[test]
fn a_path_has_slashes_on_every_system() {
    let path: std::path::PathBuf = ["spectra", "a\"b.csv"].iter().collect();
    let file = File::new(Table::new().with("reflectance", path));
    assert_eq!(file.to_string(), "format = 1\nreflectance = \"spectra/a\\\"b.csv\"\n");
}

#[cfg(unix)]
#[test]
fn a_path_that_is_not_utf_8_is_not_written_as_another() {
    use std::fmt::Write as _;
    use std::os::unix::ffi::OsStrExt as _;
    let path = Path::new(std::ffi::OsStr::from_bytes(b"a\xff.csv"));
    let list = [Table::new().with("inner", Table::new().with("file", path))];
    for table in [Table::new().with("file", path), Table::new().with("list", list)] {
        assert!(write!(String::new(), "{}", File::new(table)).is_err());
    }
}
