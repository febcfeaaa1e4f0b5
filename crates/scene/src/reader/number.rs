//! Numbers: finite, within bounds, alone or in vectors.

use serde_json::{Value as Json, json};

use super::rule::{Rule, ValueKind};
use crate::document::{Node, Value};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::written::{Item, Value as WrittenValue};
use etendue_core::ExactTime;

/// A finite number; `unit` appears in errors of a missing or wrong value ("" for a pure number).
pub(crate) const fn number(unit: &'static str) -> NumberRule {
    NumberRule { unit, low: None, high: None }
}

/// See [`number`].
#[derive(Clone, Copy)]
pub(crate) struct NumberRule {
    unit: &'static str,
    low: Option<NumberBound>,
    high: Option<NumberBound>,
}

#[derive(Clone, Copy)]
struct NumberBound {
    value: f64,
    included: bool,
}

impl NumberRule {
    /// Sets a lower bound, excluding `value`.
    pub(crate) const fn above(self, value: f64) -> Self {
        Self { low: Some(NumberBound { value, included: false }), ..self }
    }
    /// Sets a lower bound, including `value`.
    pub(crate) const fn at_least(self, value: f64) -> Self {
        Self { low: Some(NumberBound { value, included: true }), ..self }
    }
    /// Sets an upper bound, including `value`.
    pub(crate) const fn at_most(self, value: f64) -> Self {
        Self { high: Some(NumberBound { value, included: true }), ..self }
    }

    fn admits(&self, v: f64) -> bool {
        let low = self.low.is_none_or(|b| v > b.value || (b.included && v == b.value));
        let high = self.high.is_none_or(|b| v < b.value || (b.included && v == b.value));
        v.is_finite() && low && high
    }

    /// The kind of number, after its article: "number above 0 (mm)".
    fn words(&self) -> String {
        let low = self.low.map(|b| format!("{} {}", if b.included { "of at least" } else { "above" }, b.value));
        let high = self.high.map(|b| format!("at most {}", b.value));
        let bounds: Vec<_> = low.into_iter().chain(high).collect();
        let unit = if self.unit.is_empty() { String::new() } else { format!(" ({})", self.unit) };
        let kind = if bounds.is_empty() { "finite number" } else { "number" };
        [kind.to_owned(), bounds.join(" and ")].join(" ").trim_end().to_owned() + &unit
    }
}

impl Rule for NumberRule {
    type Out = Placed<f64>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Number
    }
    fn expected(&self) -> String {
        format!("a {}", self.words())
    }
    fn schema(&self) -> Json {
        let mut schema = json!({ "type": "number" });
        if let Some(b) = self.low {
            schema[if b.included { "minimum" } else { "exclusiveMinimum" }] = json!(b.value);
        }
        if let Some(b) = self.high {
            schema[if b.included { "maximum" } else { "exclusiveMaximum" }] = json!(b.value);
        }
        if !self.unit.is_empty() {
            schema["unit"] = json!(self.unit);
        }
        schema
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<f64>> {
        match as_f64(node).filter(|v| self.admits(*v)) {
            Some(v) => Some(Placed::new(v, node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<f64>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// A percentile, above 1 and at most 100. A smaller number is refused, because it reads as a fraction and would silently mean something else.
pub(crate) const fn percentile() -> PercentileRule {
    PercentileRule(
        NumberRule { unit: "", low: Some(NumberBound { value: 1.0, included: false }), high: None }.at_most(100.0),
    )
}

/// See [`percentile`].
#[derive(Clone, Copy)]
pub(crate) struct PercentileRule(NumberRule);

impl Rule for PercentileRule {
    type Out = Placed<f64>;
    fn accepts(&self, kind: ValueKind) -> bool {
        self.0.accepts(kind)
    }
    fn expected(&self) -> String {
        "a percentile above 1 and at most 100".to_owned()
    }
    fn schema(&self) -> Json {
        self.0.schema()
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<f64>> {
        match as_f64(node).filter(|v| *v > 0.0 && *v <= 1.0) {
            Some(fraction) => {
                let percent = (fraction * 1e8).round() / 1e6;
                let problem = format!("found {fraction}, which looks like a fraction; percentiles are from 0 to 100");
                errors.add(
                    ErrorCode::OutOfRange,
                    &node.place,
                    problem,
                    format!("for that fraction give {percent}, else a percentile above 1"),
                );
                None
            }
            None => self.0.read(node, errors),
        }
    }
    fn write(&self, value: &Placed<f64>) -> Option<Item> {
        self.0.write(value)
    }
}

/// Returns the number, if a double holds it exactly.
fn as_f64(node: &Node) -> Option<f64> {
    match node.value {
        Value::Number(v) => Some(v),
        #[allow(
            clippy::cast_precision_loss,
            reason = "an integer of more than 53 bits rounds as its decimal text would"
        )]
        Value::Whole(v) => Some(v as f64),
        _ => None,
    }
}

/// A time in seconds, as a number or as text, which is exact far from zero.
pub(crate) const fn time() -> ExactTimeRule {
    ExactTimeRule
}

/// See [`time`].
#[derive(Clone, Copy)]
pub(crate) struct ExactTimeRule;

impl Rule for ExactTimeRule {
    type Out = Placed<ExactTime>;
    fn accepts(&self, kind: ValueKind) -> bool {
        matches!(kind, ValueKind::Number | ValueKind::Text)
    }
    fn expected(&self) -> String {
        "a time (s) from -1e15 to 1e15, as a number or as text, \"1700000000.0000001\"".to_owned()
    }
    fn schema(&self) -> Json {
        let digits = json!({ "type": "string", "examples": ["1700000000.0000001"] });
        json!({ "anyOf": [number("s").schema(), digits] })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Self::Out> {
        let read = match &node.value {
            Value::Text(text) => text.parse().ok(),
            _ => as_f64(node).and_then(ExactTime::from_seconds),
        };
        match read {
            Some(time) => Some(Placed::new(time, node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        let written = match value.value.is_number() {
            true => WrittenValue::Number(value.value.seconds()),
            false => WrittenValue::Text(value.value.to_string()),
        };
        Some(Item::at(&value.place, written))
    }
}

/// A whole number from `low` to `high`.
pub(crate) const fn integer(low: u64, high: u64) -> IntegerRule {
    IntegerRule { low, high }
}

/// See [`integer`].
#[derive(Clone, Copy)]
pub(crate) struct IntegerRule {
    low: u64,
    high: u64,
}

impl Rule for IntegerRule {
    type Out = Placed<u64>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Number
    }
    fn expected(&self) -> String {
        format!("a whole number from {} to {}", self.low, self.high)
    }
    fn schema(&self) -> Json {
        json!({ "type": "integer", "minimum": self.low, "maximum": self.high })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<u64>> {
        match as_u64(node).filter(|v| (self.low..=self.high).contains(v)) {
            Some(v) => Some(Placed::new(v, node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<u64>) -> Option<Item> {
        Some(value.clone().into())
    }
}

/// One of a few whole numbers.
pub(crate) const fn among(values: &'static [u64]) -> OneOfRule {
    OneOfRule { values }
}

/// See [`among`].
#[derive(Clone, Copy)]
pub(crate) struct OneOfRule {
    values: &'static [u64],
}

impl Rule for OneOfRule {
    type Out = Placed<u64>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Number
    }
    fn expected(&self) -> String {
        let values: Vec<_> = self.values.iter().map(u64::to_string).collect();
        format!("one of {}", values.join(", "))
    }
    fn schema(&self) -> Json {
        json!({ "enum": self.values })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<u64>> {
        match as_u64(node).filter(|v| self.values.contains(v)) {
            Some(v) => Some(Placed::new(v, node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<u64>) -> Option<Item> {
        Some(value.clone().into())
    }
}

fn as_u64(node: &Node) -> Option<u64> {
    match node.value {
        Value::Whole(v) => u64::try_from(v).ok(),
        _ => None,
    }
}

/// A list of exactly `N` numbers.
pub(crate) const fn vector<const N: usize>(of: NumberRule) -> VectorRule<N> {
    VectorRule { of }
}

/// See [`vector`].
#[derive(Clone, Copy)]
pub(crate) struct VectorRule<const N: usize> {
    of: NumberRule,
}

impl<const N: usize> Rule for VectorRule<N> {
    type Out = Placed<[f64; N]>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::List
    }
    fn expected(&self) -> String {
        format!("a list of {N} numbers, each a {}", self.of.words())
    }
    fn schema(&self) -> Json {
        json!({ "type": "array", "items": self.of.schema(), "minItems": N, "maxItems": N })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Self::Out> {
        if ValueKind::from_node(node) != ValueKind::List || node.as_list().len() != N {
            return self.refuse(node, errors);
        }
        let read: Vec<f64> = node.as_list().iter().filter_map(|n| self.of.read(n, errors)).map(|v| v.value).collect();
        Some(Placed::new(read.try_into().ok()?, node.place.clone()))
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        Some(value.clone().into())
    }
}
