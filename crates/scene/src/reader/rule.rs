//! The contract of a rule, and combinations of rules.

use std::marker::PhantomData;

use serde_json::{Value as Json, json};

use super::table::{Reader, Record, record_schema};
use crate::document::{Node, Value};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::written::{Item, Table, Value as WrittenValue};

/// Kind of a TOML value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ValueKind {
    Flag,
    Number,
    Text,
    Moment,
    List,
    Table,
    Foreign,
}

impl ValueKind {
    pub(crate) fn from_node(node: &Node) -> Self {
        match node.value {
            Value::Flag(_) => Self::Flag,
            Value::Whole(_) | Value::Number(_) => Self::Number,
            Value::Text(_) => Self::Text,
            Value::Moment(_) => Self::Moment,
            Value::List(_) => Self::List,
            Value::Table(_) => Self::Table,
            Value::Foreign(_) | Value::Unreadable => Self::Foreign,
        }
    }
}

/// A rule that reads one value.
pub(crate) trait Rule {
    /// Type of the result.
    type Out;
    /// True if the rule can read values of this kind.
    fn accepts(&self, kind: ValueKind) -> bool;
    /// The expected value, in words: "a number above 0".
    fn expected(&self) -> String;
    /// The JSON Schema of the value.
    fn schema(&self) -> Json;
    /// Reads the value; returns `None` after reporting at least one error.
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Self::Out>;
    /// Converts the value to the form that [`Rule::read`] reads back; `None` if another rule reads such values.
    fn write(&self, value: &Self::Out) -> Option<Item>;

    /// Error code of a node that is not as the rule expects.
    fn code(&self, node: &Node) -> ErrorCode {
        match ValueKind::from_node(node) {
            ValueKind::Number if self.accepts(ValueKind::Number) => ErrorCode::OutOfRange,
            _ => ErrorCode::WrongType,
        }
    }

    /// Reports that the node is not as the rule expects.
    fn refuse<T>(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<T> {
        if matches!(node.value, Value::Unreadable) {
            return None;
        }
        let expected = self.expected();
        errors.add(self.code(node), &node.place, format!("found {}", node.describe()), format!("give {expected}"));
        None
    }
}

/// Adaptors of rules.
pub(crate) trait RuleExt: Rule + Sized {
    /// The rule with another result; `back` returns the original value, `None` for a result of another origin.
    fn map<T>(self, f: fn(Self::Out) -> T, back: fn(&T) -> Option<Self::Out>) -> MappedRule<Self, T> {
        MappedRule { rule: self, f, back }
    }
}

impl<R: Rule> RuleExt for R {}

/// See [`RuleExt::map`].
pub(crate) struct MappedRule<R: Rule, T> {
    rule: R,
    f: fn(R::Out) -> T,
    back: fn(&T) -> Option<R::Out>,
}

impl<R: Rule, T> Rule for MappedRule<R, T> {
    type Out = T;
    fn accepts(&self, kind: ValueKind) -> bool {
        self.rule.accepts(kind)
    }
    fn expected(&self) -> String {
        self.rule.expected()
    }
    fn schema(&self) -> Json {
        self.rule.schema()
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<T> {
        self.rule.read(node, errors).map(self.f)
    }
    fn write(&self, value: &T) -> Option<Item> {
        self.rule.write(&(self.back)(value)?)
    }
}

/// One of two rules, by the kind of the value.
pub(crate) fn either<A: Rule, B: Rule<Out = A::Out>>(a: A, b: B) -> EitherRule<A, B> {
    EitherRule { a, b }
}

/// See [`either`].
pub(crate) struct EitherRule<A, B> {
    a: A,
    b: B,
}

impl<A: Rule, B: Rule<Out = A::Out>> Rule for EitherRule<A, B> {
    type Out = A::Out;
    fn accepts(&self, kind: ValueKind) -> bool {
        self.a.accepts(kind) || self.b.accepts(kind)
    }
    fn expected(&self) -> String {
        format!("{}, or {}", self.a.expected(), self.b.expected())
    }
    fn schema(&self) -> Json {
        json!({ "anyOf": [self.a.schema(), self.b.schema()] })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<A::Out> {
        let kind = ValueKind::from_node(node);
        match (self.a.accepts(kind), self.b.accepts(kind)) {
            (true, _) => self.a.read(node, errors),
            (_, true) => self.b.read(node, errors),
            _ => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &A::Out) -> Option<Item> {
        // A table instead of a value.
        self.a.write(value).or_else(|| self.b.write(value)).map(Item::inline)
    }
}

/// A list of at least `least` values. Wrong entries are reported and omitted.
pub(crate) fn list<R: Rule>(rule: R, min_length: usize) -> ListRule<R> {
    ListRule { rule, min_length }
}

/// See [`list`].
pub(crate) struct ListRule<R> {
    rule: R,
    min_length: usize,
}

impl<R: Rule> Rule for ListRule<R> {
    type Out = Vec<R::Out>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::List
    }
    fn expected(&self) -> String {
        let min_length = if self.min_length == 0 { String::new() } else { format!(" of {} or more", self.min_length) };
        format!("a list{min_length}, each {}", self.rule.expected())
    }
    fn schema(&self) -> Json {
        json!({ "type": "array", "items": self.rule.schema(), "minItems": self.min_length })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Self::Out> {
        if ValueKind::from_node(node) == ValueKind::Table && self.rule.accepts(ValueKind::Table) {
            errors.add(
                ErrorCode::WrongType,
                &node.place,
                "found one table",
                "give a list of tables: use double brackets, [[ ]]",
            );
            return None;
        }
        if !self.accepts(ValueKind::from_node(node)) || node.as_list().len() < self.min_length {
            return self.refuse(node, errors);
        }
        Some(node.as_list().iter().filter_map(|n| self.rule.read(n, errors)).collect())
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        Some(value.iter().map(|v| self.rule.write(v)).collect::<Option<Vec<_>>>()?.into())
    }
}

/// A list of exactly `N` values.
pub(crate) fn exactly<R: Rule, const N: usize>(rule: R) -> ArrayRule<R, N> {
    ArrayRule { rule }
}

/// See [`exactly`].
pub(crate) struct ArrayRule<R, const N: usize> {
    rule: R,
}

impl<R: Rule, const N: usize> Rule for ArrayRule<R, N> {
    type Out = Placed<[R::Out; N]>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::List
    }
    fn expected(&self) -> String {
        format!("a list of {N}, each {}", self.rule.expected())
    }
    fn schema(&self) -> Json {
        json!({ "type": "array", "items": self.rule.schema(), "minItems": N, "maxItems": N })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Self::Out> {
        if !self.accepts(ValueKind::from_node(node)) || node.as_list().len() != N {
            return self.refuse(node, errors);
        }
        let read: Vec<_> = node.as_list().iter().filter_map(|n| self.rule.read(n, errors)).collect();
        Some(Placed::new(read.try_into().ok()?, node.place.clone()))
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        let list = value.value.iter().map(|v| self.rule.write(v)).collect::<Option<_>>()?;
        Some(Item::at(&value.place, WrittenValue::List(list)))
    }
}

/// A table of entries under user-chosen names.
pub(crate) fn keyed_by_name<R: Rule>(rule: R) -> NamedTableRule<R> {
    NamedTableRule { rule }
}

/// See [`keyed_by_name`].
pub(crate) struct NamedTableRule<R> {
    rule: R,
}

impl<R: Rule> Rule for NamedTableRule<R> {
    type Out = Vec<(Placed<String>, R::Out)>;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Table
    }
    fn expected(&self) -> String {
        format!("a table of names, each with {}", self.rule.expected())
    }
    fn schema(&self) -> Json {
        json!({ "type": "object", "additionalProperties": self.rule.schema() })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Self::Out> {
        let Some(table) = node.as_table() else { return self.refuse(node, errors) };
        let read = table.entries.iter().filter_map(|entry| {
            let value = self.rule.read(&entry.node, errors)?;
            Some((Placed::new(entry.key.clone(), entry.place.clone()), value))
        });
        Some(read.collect())
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        let mut table = Table::new().in_line();
        for (name, v) in value {
            table.set_place(&name.place);
            table.put(name, self.rule.write(v)?);
        }
        Some(table.into())
    }
}

/// A table that is the record `T`.
pub(crate) fn record<T: Record>() -> RecordRule<T> {
    RecordRule(PhantomData)
}

/// See [`record`].
pub(crate) struct RecordRule<T>(PhantomData<T>);

impl<T: Record> Rule for RecordRule<T> {
    type Out = T;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Table
    }
    fn expected(&self) -> String {
        format!("a table with the keys {}", super::word::quoted(&T::keys()))
    }
    fn schema(&self) -> Json {
        record_schema(&T::forms())
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<T> {
        if node.as_list().iter().any(|entry| entry.as_table().is_some()) {
            errors.add(
                ErrorCode::WrongType,
                &node.place,
                "found a list of tables",
                "give one table: use single brackets, [ ]",
            );
            return None;
        }
        let Some(table) = node.as_table() else { return self.refuse(node, errors) };
        let mut reader = Reader::new(table, &node.place);
        let read = T::read_keys(&mut reader, errors);
        reader.finish::<T>(errors);
        read
    }
    fn write(&self, value: &T) -> Option<Item> {
        Some(value.written().into())
    }
}
