//! Side-car JSON: the facts of a result in a separate file next to it.
//!
//! Keys are sorted, so that the same facts give the same bytes. JSON has no NaN or infinity: such a number becomes `null`. A caller omits the key of an absent
//! number.

use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::Error;
use crate::source::{decode_text, read_description_bytes};

/// Reads a side-car, up to the size limit of descriptions.
///
/// # Errors
/// If it cannot be read, is larger, or is not JSON.
pub fn read(file: &Path) -> Result<Value, Error> {
    let bytes = read_description_bytes(file, "side-car")?;
    serde_json::from_str(decode_text(file, &bytes)?)
        .map_err(|cause| Error::new(file, format!("not JSON ({cause}); remove it, or render again")))
}

/// Encodes `facts` as indented JSON with sorted keys and a newline at the end.
pub fn encode(facts: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let mut bytes = serde_json::to_vec_pretty(&sorted(serde_json::to_value(facts)?))?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn sorted(value: Value) -> Value {
    match value {
        Value::Object(object) => {
            let mut entries: Vec<(String, Value)> = object.into_iter().map(|(k, v)| (k, sorted(v))).collect();
            entries.sort_by(|a, b| a.0.cmp(&b.0));
            Value::Object(Map::from_iter(entries))
        }
        Value::Array(items) => Value::Array(items.into_iter().map(sorted).collect()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn keys_are_sorted_at_every_depth() {
        let inner: HashMap<&str, u32> = ["z", "a", "m", "k"].into_iter().zip(1..).collect();
        let outer = HashMap::from([("second", inner.clone()), ("first", inner)]);
        let text = String::from_utf8(encode(&outer).expect("plain numbers")).expect("JSON is UTF-8");
        let squeezed: String = text.split_whitespace().collect();
        assert_eq!(squeezed, r#"{"first":{"a":2,"k":4,"m":3,"z":1},"second":{"a":2,"k":4,"m":3,"z":1}}"#);
        assert!(text.ends_with("}\n"));
    }
}
