//! A table as JSON, for side-cars.

use serde_json::Value as Json;

use super::{Item, Table, Value};

impl Table {
    /// The same keys and values as a JSON object.
    #[must_use]
    pub fn to_json(&self) -> Json {
        self.entries().map(|(key, item)| (key.to_owned(), item.to_json())).collect()
    }
}

impl Item {
    fn to_json(&self) -> Json {
        match &self.value {
            Value::Flag(flag) => Json::from(*flag),
            Value::Whole(number) => Json::from(*number),
            Value::Number(number) => Json::from(*number),
            Value::Text(text) | Value::Moment(text) => Json::from(text.as_str()),
            Value::Path(path) => Json::from(path.to_string_lossy()),
            Value::List(list) => list.iter().map(Self::to_json).collect(),
            Value::Table(table) => table.to_json(),
        }
    }
}
