//! `scale`: the same camera with fewer, larger pixels.

use serde_json::{Value as Json, json};

use crate::document::{Node, Value};
use crate::fault::DescriptionErrors;
use crate::place::Placed;
use crate::reader::{Rule, ValueKind};
use crate::written::{Item, Value as WrittenValue};

/// Largest divisor: no image is wider.
const MAX_DIVISOR: u64 = 65_536;

/// Relative tolerance of the reciprocal of a decimal fraction: 0.3333333 is 1/3.
const ROUNDING: f64 = 1e-6;

/// Size of an image over that of the described sensor: 1/divisor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// Pixels of the described sensor along a row and a column of one pixel, 1 or more.
    pub divisor: u64,
}

impl Scale {
    /// Parses a text such as "1/4" or "0.25".
    fn from_text(text: &str) -> Option<Self> {
        match text.split_once('/') {
            Some((one, divisor)) if one.trim() == "1" => Self::from_divisor(divisor.trim().parse().ok()?),
            Some(_) => None,
            None => Self::from_number(text.trim().parse().ok()?),
        }
    }

    fn from_number(number: f64) -> Option<Self> {
        let divisor = (1.0 / number).round();
        let is_reciprocal = divisor >= 1.0 && (divisor * number - 1.0).abs() <= ROUNDING;
        Self::from_divisor(is_reciprocal.then_some(divisor as u64)?)
    }

    fn from_divisor(divisor: u64) -> Option<Self> {
        (1..=MAX_DIVISOR).contains(&divisor).then_some(Self { divisor })
    }
}

impl std::fmt::Display for Scale {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "1/{}", self.divisor)
    }
}

/// The rule of [`Scale`]: "1/4" or 0.25.
pub(super) struct ScaleRule;

impl Rule for ScaleRule {
    type Out = Placed<Scale>;
    fn accepts(&self, kind: ValueKind) -> bool {
        matches!(kind, ValueKind::Number | ValueKind::Text)
    }
    fn expected(&self) -> String {
        format!(
            "\"1/k\" with a whole number k from 1 to {MAX_DIVISOR}, or the same as a decimal fraction: \"1/4\" or 0.25"
        )
    }
    fn schema(&self) -> Json {
        // The form that is written; decimal fractions are also read.
        json!({ "type": "string", "pattern": "^1/[1-9][0-9]*$", "examples": ["1/4"] })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<Scale>> {
        let scale = match &node.value {
            Value::Text(text) => Scale::from_text(text),
            Value::Whole(number) => Scale::from_number(*number as f64),
            Value::Number(number) => Scale::from_number(*number),
            _ => None,
        };
        match scale {
            Some(scale) => Some(Placed::new(scale, node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, scale: &Placed<Scale>) -> Option<Item> {
        Some(Item::at(&scale.place, WrittenValue::Text(scale.value.to_string())))
    }
}

#[cfg(test)]
mod tests {
    use super::Scale;

    #[test]
    fn fractions_and_decimals_are_the_same_scale() {
        for (text, divisor) in
            [("1/4", 4), ("0.25", 4), (" 1 / 3 ", 3), ("0.3333333", 3), ("1", 1), ("1/1", 1), ("0.2", 5)]
        {
            assert_eq!(Scale::from_text(text), Some(Scale { divisor }), "{text}");
        }
        for text in ["2", "0.3", "3/4", "1/0", "-0.25", "0", "nan", "inf", "1/2.5", "1/65537", "half", ""] {
            assert_eq!(Scale::from_text(text), None, "{text}");
        }
    }
}
