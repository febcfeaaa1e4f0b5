//! The schema and the parser accept the same descriptions.

use etendue_scene::{ErrorCode, FileKind, schema};
use serde_json::{Map, Value as Json, json};

use crate::files::{DescriptionFiles, load};

/// Returns the cause if `value` does not fit `schema`, for the keywords that our schemas use.
fn misfit(value: &Json, schema: &Json, path: &str) -> Option<String> {
    let of = |key: &str| schema.get(key);
    let fail = |why: &str| Some(format!("{path}: {value} {why} the schema"));
    if let Some(condition) = of("if") {
        let branch = if misfit(value, condition, path).is_none() { "then" } else { "else" };
        return misfit(value, &schema[branch], path);
    }
    if of("not").is_some_and(|not| misfit(value, not, path).is_none()) {
        return fail("is excluded by");
    }
    if let Some(problem) =
        of("allOf").and_then(Json::as_array).into_iter().flatten().find_map(|s| misfit(value, s, path))
    {
        return Some(problem);
    }
    if let Some(options) = of("anyOf").or(of("oneOf")).and_then(Json::as_array) {
        let fits = options.iter().filter(|o| misfit(value, o, path).is_none()).count();
        let exact = of("oneOf").is_none() || fits == 1;
        return if fits > 0 && exact { None } else { fail(&format!("fits {fits} of")) };
    }
    if of("const").is_some_and(|c| c != value) {
        return fail("is not");
    }
    if of("enum").and_then(Json::as_array).is_some_and(|list| !list.contains(value)) {
        return fail("is not in");
    }
    let typed = match of("type").and_then(Json::as_str) {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("boolean") => value.is_boolean(),
        Some("integer") => value.is_u64(),
        Some("number") => value.is_number(),
        _ => true,
    };
    if !typed {
        return fail("is not of the type of");
    }
    match value {
        Json::Number(n) => (!in_bounds(n.as_f64()?, schema)).then(|| fail("is outside of")).flatten(),
        Json::Array(list) => list.iter().find_map(|v| misfit(v, of("items")?, path)),
        Json::Object(table) => misfit_table(table, schema, path),
        _ => None,
    }
}

fn in_bounds(v: f64, schema: &Json) -> bool {
    let bound = |key: &str| schema.get(key).and_then(Json::as_f64);
    bound("minimum").is_none_or(|b| v >= b)
        && bound("maximum").is_none_or(|b| v <= b)
        && bound("exclusiveMinimum").is_none_or(|b| v > b)
}

fn misfit_table(table: &Map<String, Json>, schema: &Json, path: &str) -> Option<String> {
    let properties = schema.get("properties").and_then(Json::as_object);
    let missing = schema.get("required").and_then(Json::as_array).into_iter().flatten();
    if let Some(key) = missing.filter_map(Json::as_str).find(|k| !table.contains_key(*k)) {
        return Some(format!("{path}: {key} is missing"));
    }
    let dependent = schema.get("dependentRequired").and_then(Json::as_object).into_iter().flatten();
    for (key, needed) in dependent.filter(|(key, _)| table.contains_key(*key)) {
        if let Some(lacks) = words(needed).find(|k| !table.contains_key(*k)) {
            return Some(format!("{path}: {key} is given without {lacks}"));
        }
    }
    table.iter().find_map(|(key, value)| {
        let path = format!("{path}.{key}");
        match (properties.and_then(|p| p.get(key)), &schema["additionalProperties"]) {
            (Some(schema), _) => misfit(value, schema, &path),
            (None, Json::Bool(false)) => Some(format!("{path} is no key")),
            (None, schema) => misfit(value, schema, &path),
        }
    })
}

/// The texts of a list.
fn words(list: &Json) -> impl Iterator<Item = &str> {
    list.as_array().into_iter().flatten().filter_map(Json::as_str)
}

/// The keys of every choice of a table's schema, and whether all of them may be absent.
fn choices(schema: &Json) -> Vec<(Vec<&str>, bool)> {
    let all = schema["allOf"].as_array().into_iter().flatten();
    all.map(|s| {
        let options = s["oneOf"].as_array().map_or(&[][..], Vec::as_slice);
        let named = options.iter().flat_map(|o| words(&o["required"])).collect();
        (named, options.iter().any(|o| o.get("not").is_some()))
    })
    .collect()
}

#[test]
fn the_example_fits_the_schema() {
    let files = DescriptionFiles::from_example();
    for (name, kind) in
        [("job.toml", FileKind::Job), ("scene.toml", FileKind::Scene), ("camera.toml", FileKind::Camera)]
    {
        let value: Json = toml::from_str(&files.text(name)).expect("TOML");
        assert_eq!(misfit(&value, &schema(kind), name), None);
    }
}

#[test]
fn what_the_parser_refuses_does_not_fit_the_schema() {
    let camera = DescriptionFiles::from_example().text("camera.toml");
    for (old, new) in [
        ("f_number", "f_nmuber"),
        ("width_px = 640", "width_px = 0"),
        ("focal_length_mm = 6.0", "focal_length_mm = 0.0"),
        ("cfa = \"rggb\"", "cfa = \"rgbg\""),
        ("format = 1", "format = 2"),
        ("exposure_s = 0.002", ""),
        ("type = \"thin\"", "type = \"pinhole\""),
    ] {
        let value: Json = toml::from_str(&camera.replacen(old, new, 1)).expect("TOML");
        assert!(misfit(&value, &schema(FileKind::Camera), "").is_some(), "{new}");
    }
}

/// Values that fit the schema: together they have every key, every variant and every notation of a value.
fn samples(schema: &Json) -> Vec<Json> {
    if let Some(options) = schema.get("anyOf").or(schema.get("oneOf")).and_then(Json::as_array) {
        // The keys that fit a preset depend on the preset, which the schema does not describe.
        return options.iter().filter(|o| !words(&o["required"]).any(|k| k == "preset")).flat_map(samples).collect();
    }
    if let Some(list) = schema.get("enum").and_then(Json::as_array) {
        return list.clone();
    }
    match schema["type"].as_str() {
        Some("object") => table_samples(schema),
        Some("array") => array_samples(schema),
        Some("string") => string_sample(schema).into_iter().collect(),
        Some("boolean") => vec![json!(true)],
        Some("integer") => vec![json!(number_sample(schema).floor() as u64)],
        Some("number") => vec![json!(number_sample(schema))],
        _ => vec![schema["const"].clone()],
    }
}

/// Samples of every key with each of its values in turn; none if a key has none.
fn table_samples(schema: &Json) -> Vec<Json> {
    let Some(properties) = schema.get("properties").and_then(Json::as_object) else {
        return samples(&schema["additionalProperties"]).into_iter().map(|v| json!({ "any": v })).collect();
    };
    let values: Vec<_> = properties.iter().map(|(key, schema)| (key.clone(), samples(schema))).collect();
    if values.iter().any(|(_, v)| v.is_empty()) {
        return Vec::new();
    }
    let choices = choices(schema);
    let turns = |key: &str| choices.iter().find(|(keys, _)| keys.contains(&key)).map_or(1, |(keys, _)| keys.len() + 1);
    let count = values.iter().map(|(key, v)| v.len() * turns(key)).max().unwrap_or(1);
    (0..count).map(|i| Json::Object(table_sample(&values, &choices, i))).collect()
}

/// The `i`th sample: one key of each choice, and one value of each key.
fn table_sample(values: &[(String, Vec<Json>)], choices: &[(Vec<&str>, bool)], i: usize) -> Map<String, Json> {
    let mut sample = Map::new();
    for (key, values) in values {
        let (mut at, mut chosen) = (i, true);
        if let Some((keys, none)) = choices.iter().find(|(keys, _)| keys.contains(&key.as_str())) {
            let turns = keys.len() + usize::from(*none);
            chosen = keys.get(i % turns).is_some_and(|k| k == key);
            at = i / turns;
        }
        if chosen {
            sample.insert(key.clone(), values.get(at).cloned().unwrap_or_else(|| short(&values[values.len() - 1])));
        }
    }
    sample
}

/// A value that another sample shows completely: of a list of tables the first.
fn short(value: &Json) -> Json {
    match value.as_array().map(Vec::as_slice) {
        Some([first, ..]) if first.is_object() => json!([first]),
        _ => value.clone(),
    }
}

fn array_samples(schema: &Json) -> Vec<Json> {
    let items = samples(&schema["items"]);
    let min_items = schema["minItems"].as_u64().unwrap_or(0) as usize;
    let Some(count) = schema["maxItems"].as_u64() else {
        let length = items.len().max(min_items);
        return vec![items.iter().cycle().take(length).cloned().collect()];
    };
    let scaled = |v: &Json, i: u64| match v.as_f64().filter(|_| !v.is_u64()) {
        Some(v) => json!(v * (1.0 + 0.01 * i as f64)),
        None => v.clone(),
    };
    items.iter().map(|v| (0..count).map(|i| scaled(v, i)).collect()).collect()
}

/// A text; `None` for the path of a description, which would be read.
fn string_sample(schema: &Json) -> Option<Json> {
    if let Some(example) = schema["examples"].get(0) {
        return Some(example.clone());
    }
    match schema["pattern"].as_str() {
        Some(pattern) if pattern.contains("toml") => None,
        Some(pattern) if pattern.contains("\\.(") => {
            let extension = pattern.trim_start_matches("\\.(").split(['|', ')']).next()?;
            Some(json!(format!("file.{extension}")))
        }
        _ => Some(json!("name")),
    }
}

fn number_sample(schema: &Json) -> f64 {
    let low = schema["minimum"].as_f64().or(schema["exclusiveMinimum"].as_f64());
    match (low, schema["maximum"].as_f64()) {
        (Some(low), Some(high)) => 0.4 * low + 0.6 * high,
        (Some(low), None) => low + 0.5,
        (None, _) => 0.25,
    }
}

#[test]
fn the_parser_accepts_every_key_of_the_schema() {
    let schema = schema(FileKind::Job)["else"].clone();
    let count_and_samples = samples(&schema);
    let types = |s: &Json| s["scene"]["materials"].as_array().map_or(0, Vec::len);
    assert!(count_and_samples.iter().any(|s| types(s) > 20), "every variant has its sample");
    for sample in count_and_samples {
        assert_eq!(misfit(&sample, &schema, ""), None, "a sample fits");
        let text = toml::to_string(&sample).expect("TOML");
        let Err(errors) = load(&DescriptionFiles::from_job(&text), &[]) else { continue };
        for error in errors.as_slice() {
            // The schema does not describe counts that depend on other keys.
            let is_dependent_count = error.code == ErrorCode::WrongCount;
            let markers = ["unknown key", "\" is missing", "a key is missing", "found "];
            let misread = !is_dependent_count && markers.iter().any(|w| error.problem.contains(w));
            assert!(!misread, "{error}\n{text}");
        }
    }
}
