//! The contract of a rule, and combinations of rules.

use std::marker::PhantomData;

use serde_json::{Value as Json, json};

use super::table::{Reader, Record, record_schema};
use crate::document::{Node, Value};
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::written::{Item, Table, Value as Said};

/// Kind of a TOML value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Flag,
    Number,
    Text,
    Moment,
    List,
    Table,
    Foreign,
}

impl Kind {
    pub(crate) fn of(node: &Node) -> Self {
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
    fn takes(&self, kind: Kind) -> bool;
    /// The expected value, in words: "a number above 0".
    fn expected(&self) -> String;
    /// The JSON Schema of the value.
    fn schema(&self) -> Json;
    /// Reads the value; returns `None` after reporting at least one error.
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<Self::Out>;
    /// Converts the value to the form that [`Rule::read`] reads back; `None` if another rule reads such values.
    fn write(&self, value: &Self::Out) -> Option<Item>;

    /// Error code of a node that is not as the rule expects.
    fn code(&self, node: &Node) -> ErrorCode {
        match Kind::of(node) {
            Kind::Number if self.takes(Kind::Number) => ErrorCode::OutOfRange,
            _ => ErrorCode::WrongType,
        }
    }

    /// Reports that the node is not as the rule expects.
    fn refuse<T>(&self, node: &Node, faults: &mut Faults) -> Option<T> {
        if matches!(node.value, Value::Unreadable) {
            return None;
        }
        let expected = self.expected();
        faults.add(self.code(node), &node.place, format!("found {}", node.describe()), format!("give {expected}"));
        None
    }
}

/// Adaptors of rules.
pub(crate) trait RuleExt: Rule + Sized {
    /// The rule with another result; `back` returns the original value, `None` for a result of another origin.
    fn map<T>(self, f: fn(Self::Out) -> T, back: fn(&T) -> Option<Self::Out>) -> Mapped<Self, T> {
        Mapped { rule: self, f, back }
    }
}

impl<R: Rule> RuleExt for R {}

/// See [`RuleExt::map`].
pub(crate) struct Mapped<R: Rule, T> {
    rule: R,
    f: fn(R::Out) -> T,
    back: fn(&T) -> Option<R::Out>,
}

impl<R: Rule, T> Rule for Mapped<R, T> {
    type Out = T;
    fn takes(&self, kind: Kind) -> bool {
        self.rule.takes(kind)
    }
    fn expected(&self) -> String {
        self.rule.expected()
    }
    fn schema(&self) -> Json {
        self.rule.schema()
    }
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<T> {
        self.rule.read(node, faults).map(self.f)
    }
    fn write(&self, value: &T) -> Option<Item> {
        self.rule.write(&(self.back)(value)?)
    }
}

/// One of two rules, by the kind of the value.
pub(crate) fn either<A: Rule, B: Rule<Out = A::Out>>(a: A, b: B) -> Either<A, B> {
    Either { a, b }
}

/// See [`either`].
pub(crate) struct Either<A, B> {
    a: A,
    b: B,
}

impl<A: Rule, B: Rule<Out = A::Out>> Rule for Either<A, B> {
    type Out = A::Out;
    fn takes(&self, kind: Kind) -> bool {
        self.a.takes(kind) || self.b.takes(kind)
    }
    fn expected(&self) -> String {
        format!("{}, or {}", self.a.expected(), self.b.expected())
    }
    fn schema(&self) -> Json {
        json!({ "anyOf": [self.a.schema(), self.b.schema()] })
    }
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<A::Out> {
        let kind = Kind::of(node);
        match (self.a.takes(kind), self.b.takes(kind)) {
            (true, _) => self.a.read(node, faults),
            (_, true) => self.b.read(node, faults),
            _ => self.refuse(node, faults),
        }
    }
    fn write(&self, value: &A::Out) -> Option<Item> {
        // A table instead of a value.
        self.a.write(value).or_else(|| self.b.write(value)).map(Item::in_line)
    }
}

/// A list of at least `least` values. Wrong entries are reported and omitted.
pub(crate) fn list<R: Rule>(rule: R, least: usize) -> List<R> {
    List { rule, least }
}

/// See [`list`].
pub(crate) struct List<R> {
    rule: R,
    least: usize,
}

impl<R: Rule> Rule for List<R> {
    type Out = Vec<R::Out>;
    fn takes(&self, kind: Kind) -> bool {
        kind == Kind::List
    }
    fn expected(&self) -> String {
        let least = if self.least == 0 { String::new() } else { format!(" of {} or more", self.least) };
        format!("a list{least}, each {}", self.rule.expected())
    }
    fn schema(&self) -> Json {
        json!({ "type": "array", "items": self.rule.schema(), "minItems": self.least })
    }
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<Self::Out> {
        if Kind::of(node) == Kind::Table && self.rule.takes(Kind::Table) {
            faults.add(
                ErrorCode::WrongType,
                &node.place,
                "found one table",
                "give a list of tables: use double brackets, [[ ]]",
            );
            return None;
        }
        if !self.takes(Kind::of(node)) || node.as_list().len() < self.least {
            return self.refuse(node, faults);
        }
        Some(node.as_list().iter().filter_map(|n| self.rule.read(n, faults)).collect())
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        Some(value.iter().map(|v| self.rule.write(v)).collect::<Option<Vec<_>>>()?.into())
    }
}

/// A list of exactly `N` values.
pub(crate) fn exactly<R: Rule, const N: usize>(rule: R) -> Exactly<R, N> {
    Exactly { rule }
}

/// See [`exactly`].
pub(crate) struct Exactly<R, const N: usize> {
    rule: R,
}

impl<R: Rule, const N: usize> Rule for Exactly<R, N> {
    type Out = Placed<[R::Out; N]>;
    fn takes(&self, kind: Kind) -> bool {
        kind == Kind::List
    }
    fn expected(&self) -> String {
        format!("a list of {N}, each {}", self.rule.expected())
    }
    fn schema(&self) -> Json {
        json!({ "type": "array", "items": self.rule.schema(), "minItems": N, "maxItems": N })
    }
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<Self::Out> {
        if !self.takes(Kind::of(node)) || node.as_list().len() != N {
            return self.refuse(node, faults);
        }
        let read: Vec<_> = node.as_list().iter().filter_map(|n| self.rule.read(n, faults)).collect();
        Some(Placed::new(read.try_into().ok()?, node.place.clone()))
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        let list = value.value.iter().map(|v| self.rule.write(v)).collect::<Option<_>>()?;
        Some(Item::at(&value.place, Said::List(list)))
    }
}

/// A table of entries under user-chosen names.
pub(crate) fn keyed_by_name<R: Rule>(rule: R) -> ByName<R> {
    ByName { rule }
}

/// See [`keyed_by_name`].
pub(crate) struct ByName<R> {
    rule: R,
}

impl<R: Rule> Rule for ByName<R> {
    type Out = Vec<(Placed<String>, R::Out)>;
    fn takes(&self, kind: Kind) -> bool {
        kind == Kind::Table
    }
    fn expected(&self) -> String {
        format!("a table of names, each with {}", self.rule.expected())
    }
    fn schema(&self) -> Json {
        json!({ "type": "object", "additionalProperties": self.rule.schema() })
    }
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<Self::Out> {
        let Some(table) = node.as_table() else { return self.refuse(node, faults) };
        let read = table.entries.iter().filter_map(|entry| {
            let value = self.rule.read(&entry.node, faults)?;
            Some((Placed::new(entry.key.clone(), entry.place.clone()), value))
        });
        Some(read.collect())
    }
    fn write(&self, value: &Self::Out) -> Option<Item> {
        let mut table = Table::new().in_line();
        for (name, v) in value {
            table.stand(&name.place);
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
    fn takes(&self, kind: Kind) -> bool {
        kind == Kind::Table
    }
    fn expected(&self) -> String {
        format!("a table with the keys {}", super::word::quoted(&T::keys()))
    }
    fn schema(&self) -> Json {
        record_schema(&T::forms())
    }
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<T> {
        if node.as_list().iter().any(|entry| entry.as_table().is_some()) {
            faults.add(
                ErrorCode::WrongType,
                &node.place,
                "found a list of tables",
                "give one table: use single brackets, [ ]",
            );
            return None;
        }
        let Some(table) = node.as_table() else { return self.refuse(node, faults) };
        let mut reader = Reader::new(table, &node.place);
        let read = T::read_keys(&mut reader, faults);
        reader.finish::<T>(faults);
        read
    }
    fn write(&self, value: &T) -> Option<Item> {
        Some(value.written().into())
    }
}
