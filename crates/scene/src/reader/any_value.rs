//! Values of any kind, to be read by another key.

use serde_json::{Value as Json, json};

use super::rule::{Rule, ValueKind};
use crate::document::{Node, Value};
use crate::fault::DescriptionErrors;
use crate::written::{Item, Table, Value as WrittenValue};

/// The rule of a value of another file's key, which checks its kind and range.
pub(crate) const fn any_value() -> AnyValueRule {
    AnyValueRule
}

/// Returns a value unchanged, whatever its key; `None` if it is not a value of the format.
pub(crate) fn unread_item(node: &Node) -> Option<Item> {
    AnyValueRule.read(node, &mut DescriptionErrors::none())
}

/// See [`any_value`].
pub(crate) struct AnyValueRule;

impl Rule for AnyValueRule {
    type Out = Item;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind != ValueKind::Foreign
    }
    fn expected(&self) -> String {
        "a value that the key accepts".to_owned()
    }
    fn schema(&self) -> Json {
        json!({})
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Item> {
        let value = match &node.value {
            Value::Flag(flag) => WrittenValue::Flag(*flag),
            Value::Whole(number) => {
                u64::try_from(*number).map_or(WrittenValue::Number(*number as f64), WrittenValue::Whole)
            }
            Value::Number(number) if number.is_finite() => WrittenValue::Number(*number),
            Value::Text(text) => WrittenValue::Text(text.clone()),
            Value::Moment(text) => WrittenValue::Moment(text.clone()),
            Value::List(list) => {
                WrittenValue::List(list.iter().map(|entry| self.read(entry, errors)).collect::<Option<_>>()?)
            }
            Value::Table(table) => {
                let mut written = Table::new().in_line();
                for entry in &table.entries {
                    written.put(&entry.key, self.read(&entry.node, errors)?);
                }
                WrittenValue::Table(written)
            }
            Value::Number(_) | Value::Foreign(_) | Value::Unreadable => return self.refuse(node, errors),
        };
        Some(Item::at(&node.place, value))
    }
    fn write(&self, value: &Item) -> Option<Item> {
        Some(value.clone())
    }
}
