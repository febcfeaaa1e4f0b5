//! Reading of records: one statement of a key gives its type, its check, its documentation and its schema.
//!
//! A [`Rule`] reads one value and states the expected one. A [`Record`] is a struct of keys, written with `record!`; `variants!` writes an enum
//! distinguished by the word of one key, `keyed!` an enum distinguished by which key is given. Every key that no record reads is an error.

mod any_value;
pub(crate) mod macros;
mod number;
mod rule;
mod table;
mod word;

pub(crate) use any_value::{any_value, unread_item};
pub(crate) use etendue_core::words;
pub(crate) use macros::{keyed, record, variant, variants};
pub(crate) use number::{NumberRule, among, integer, number, percentile, time, vector};
pub(crate) use rule::{Rule, RuleExt, ValueKind, either, exactly, keyed_by_name, list, record};
pub(crate) use table::{Form, Key, Reader, Record};
pub(crate) use word::{KnownNameRule, choice, file_name, flag, known, name_of, path, text, word};
