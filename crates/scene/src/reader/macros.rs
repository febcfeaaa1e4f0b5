//! The macros that write records.

/// A struct that is a table. Each field is `kind key: Type = rule;` with its documentation above it; the kinds:
///
/// - `required`: the key must be given;
/// - `optional`: `Option<Type>`;
/// - `many`: `Vec<Type>`, empty where the key is not given (the rule reads the list);
/// - `inside` (no rule): the keys of another record in the same table;
/// - `inline` (no rule): the same, of a record none of whose keys must be given;
/// - `group` (no rule): the same, `None` where none of its keys is given.
///
/// `check(path)` names a function that checks the whole record, called if each of its keys is right.
macro_rules! record {
    (
        $(#[doc = $about:literal])*
        pub struct $name:ident $(check($check:path))? {
            $( $(#[doc = $doc:literal])* $kind:ident $key:ident : $ty:ty $(= $rule:expr)?; )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug)]
        pub struct $name {
            /// Place of the table.
            pub place: $crate::place::Place,
            $( $(#[doc = $doc])* pub $key: $crate::reader::macros::field!(type $kind $ty), )*
        }

        impl $crate::reader::Record for $name {
            fn read_keys(reader: &mut $crate::reader::Reader<'_>, faults: &mut $crate::fault::DescriptionErrors) -> Option<Self> {
                let before = faults.count();
                $( let $key = $crate::reader::macros::field!(read $kind $key, $ty, reader, faults $(, $rule)?); )*
                let record = Self { place: reader.place().clone(), $( $key: $key? ),* };
                if faults.count() == before {
                    $( $check(&record, faults); )?
                }
                Some(record)
            }

            fn forms() -> Vec<$crate::reader::Form> {
                let forms = vec![$crate::reader::Form::default()];
                $(
                    let about = concat!($($doc),*);
                    let forms = $crate::reader::macros::field!(forms $kind $key, $ty, forms, about $(, $rule)?);
                )*
                forms
            }

            fn write_keys(&self, table: &mut $crate::written::Table) {
                table.set_place(&self.place);
                $( $crate::reader::macros::field!(write $kind $key, self, table $(, $rule)?); )*
            }

            fn over(&self, base: &Self) -> Self {
                let _ = base;
                Self { place: self.place.clone(), $( $key: $crate::reader::macros::field!(over $kind $key, self, base) ),* }
            }
        }

        $crate::reader::macros::constructor!($name [] [] $( $kind $key : $ty; )*);
        $crate::reader::macros::as_table!($name);
    };
}

/// The parts of `record!` that depend on the kind of a field.
macro_rules! field {
    (type required $ty:ty) => { $ty };
    (type optional $ty:ty) => { Option<$ty> };
    (type many $ty:ty) => { Vec<$ty> };
    (type inside $ty:ty) => { $ty };
    (type inline $ty:ty) => { $ty };
    (type group $ty:ty) => { Option<$ty> };

    (read required $key:ident, $ty:ty, $reader:ident, $faults:ident, $rule:expr) => {
        $reader.required(stringify!($key), &$rule, $faults)
    };
    (read optional $key:ident, $ty:ty, $reader:ident, $faults:ident, $rule:expr) => {
        $reader.optional(stringify!($key), &$rule, $faults)
    };
    (read many $key:ident, $ty:ty, $reader:ident, $faults:ident, $rule:expr) => {
        $reader.optional(stringify!($key), &$rule, $faults).map(Option::unwrap_or_default)
    };
    (read inside $key:ident, $ty:ty, $reader:ident, $faults:ident) => {
        <$ty as $crate::reader::Record>::read_keys($reader, $faults)
    };
    (read inline $key:ident, $ty:ty, $reader:ident, $faults:ident) => {
        <$ty as $crate::reader::Record>::read_keys($reader, $faults)
    };
    (read group $key:ident, $ty:ty, $reader:ident, $faults:ident) => {
        if <$ty as $crate::reader::Record>::keys().iter().any(|k| $reader.place_of(k).is_some()) {
            <$ty as $crate::reader::Record>::read_keys($reader, $faults).map(Some)
        } else {
            Some(None)
        }
    };

    (write required $key:ident, $record:ident, $table:ident, $rule:expr) => {
        $crate::reader::macros::put($table, stringify!($key), &$rule, &$record.$key);
    };
    (write optional $key:ident, $record:ident, $table:ident, $rule:expr) => {
        if let Some(value) = &$record.$key {
            $crate::reader::macros::put($table, stringify!($key), &$rule, value);
        }
    };
    (write many $key:ident, $record:ident, $table:ident, $rule:expr) => {
        if !$record.$key.is_empty() {
            $crate::reader::macros::put($table, stringify!($key), &$rule, &$record.$key);
        }
    };
    (write inside $key:ident, $record:ident, $table:ident) => {
        $crate::reader::Record::write_keys(&$record.$key, $table);
    };
    (write inline $key:ident, $record:ident, $table:ident) => {
        $crate::reader::Record::write_keys(&$record.$key, $table);
    };
    (write group $key:ident, $record:ident, $table:ident) => {
        if let Some(group) = &$record.$key {
            $crate::reader::Record::write_keys(group, $table);
        }
    };

    (over required $key:ident, $record:ident, $base:ident) => { $record.$key.clone() };
    (over optional $key:ident, $record:ident, $base:ident) => { $record.$key.as_ref().or($base.$key.as_ref()).cloned() };
    (over many $key:ident, $record:ident, $base:ident) => {
        if $record.$key.is_empty() { $base.$key.clone() } else { $record.$key.clone() }
    };
    (over inside $key:ident, $record:ident, $base:ident) => { $crate::reader::Record::over(&$record.$key, &$base.$key) };
    (over inline $key:ident, $record:ident, $base:ident) => { $crate::reader::Record::over(&$record.$key, &$base.$key) };
    (over group $key:ident, $record:ident, $base:ident) => {
        match (&$record.$key, &$base.$key) {
            (Some(own), Some(base)) => Some($crate::reader::Record::over(own, base)),
            (own, base) => own.as_ref().or(base.as_ref()).cloned(),
        }
    };

    (forms required $key:ident, $ty:ty, $forms:ident, $about:ident, $rule:expr) => {
        $crate::reader::macros::with_key::<$ty, _>($forms, stringify!($key), true, $about, &$rule)
    };
    (forms optional $key:ident, $ty:ty, $forms:ident, $about:ident, $rule:expr) => {
        $crate::reader::macros::with_key::<$ty, _>($forms, stringify!($key), false, $about, &$rule)
    };
    (forms many $key:ident, $ty:ty, $forms:ident, $about:ident, $rule:expr) => {
        $crate::reader::macros::with_key::<Vec<$ty>, _>($forms, stringify!($key), false, $about, &$rule)
    };
    (forms inside $key:ident, $ty:ty, $forms:ident, $about:ident) => {{
        let _ = $about;
        $crate::reader::Form::product(&$forms, &<$ty as $crate::reader::Record>::forms())
    }};
    (forms inline $key:ident, $ty:ty, $forms:ident, $about:ident) => {{
        let _ = $about;
        $crate::reader::Form::product(&$forms, &<$ty as $crate::reader::Record>::forms())
    }};
    (forms group $key:ident, $ty:ty, $forms:ident, $about:ident) => {{
        let _ = $about;
        let group = $crate::reader::Form::all_or_none(<$ty as $crate::reader::Record>::forms());
        $crate::reader::Form::product(&$forms, &group)
    }};
}

/// A rule whose values become a variant of an enum, and back:
///
/// - `variant!(rule, Enum::Variant)`: the variant holds the value;
/// - `variant!(rule, Table::Key => Enum::Variant)`: it holds the value of the only key of a table written with `keyed!`;
/// - `variant!(rule, Words::Word == Enum::Variant)`: it is the only word of a `choice!`.
macro_rules! variant {
    ($rule:expr, $name:ident::$variant:ident) => {
        $crate::reader::RuleExt::map($rule, $name::$variant, |value| match value {
            $name::$variant(value) => Some(value.clone()),
            _ => None,
        })
    };
    ($rule:expr, $table:ident::$key:ident => $name:ident::$variant:ident) => {
        $crate::reader::RuleExt::map(
            $rule,
            |$table::$key(value)| $name::$variant(value),
            |value| match value {
                $name::$variant(value) => Some($table::$key(value.clone())),
                _ => None,
            },
        )
    };
    ($rule:expr, $words:ident::$word:ident == $name:ident::$variant:ident) => {
        $crate::reader::RuleExt::map(
            $rule,
            |_| $name::$variant,
            |value| matches!(value, $name::$variant).then(|| $words::$word.into()),
        )
    };
}

/// The constructor of a record from its required keys; if there are none, its default.
macro_rules! constructor {
    ($name:ident [] [$($left:ident)*]) => {
        impl Default for $name {
            /// No key is given, and the place is unknown.
            fn default() -> Self {
                Self { place: $crate::place::Place::unstated(), $( $left: Default::default(), )* }
            }
        }
    };
    ($name:ident [$($needed:ident : $ty:ty,)*] [$($left:ident)*]) => {
        impl $name {
            /// Creates the record from its required keys, without a place; all other keys are absent.
            #[must_use]
            #[allow(clippy::too_many_arguments, reason = "a record has the keys that it has")]
            pub fn new($($needed: impl Into<$ty>),*) -> Self {
                Self {
                    place: $crate::place::Place::unstated(),
                    $( $needed: $needed.into(), )*
                    $( $left: Default::default(), )*
                }
            }
        }
    };
    ($name:ident [$($needed:tt)*] [$($left:ident)*] required $key:ident : $ty:ty; $($rest:tt)*) => {
        $crate::reader::macros::constructor!($name [$($needed)* $key: $ty,] [$($left)*] $($rest)*);
    };
    ($name:ident [$($needed:tt)*] [$($left:ident)*] inside $key:ident : $ty:ty; $($rest:tt)*) => {
        $crate::reader::macros::constructor!($name [$($needed)* $key: $ty,] [$($left)*] $($rest)*);
    };
    ($name:ident [$($needed:tt)*] [$($left:ident)*] $kind:ident $key:ident : $ty:ty; $($rest:tt)*) => {
        $crate::reader::macros::constructor!($name [$($needed)*] [$($left)* $key] $($rest)*);
    };
}

/// Conversion of a record to a table, public.
macro_rules! as_table {
    ($name:ident) => {
        impl $name {
            /// Returns the record as a table of the format: the given keys, in their order.
            #[must_use]
            pub fn to_table(&self) -> $crate::written::Table {
                $crate::reader::Record::written(self)
            }
        }
    };
}

/// An enum distinguished by the word of one key; the variant's record shares the table.
macro_rules! variants {
    (
        $(#[doc = $about:literal])*
        pub enum $name:ident by $by:literal {
            $( $(#[doc = $doc:literal])* $word:literal => $variant:ident($ty:ty), )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug)]
        pub enum $name {
            $( $(#[doc = $doc])* $variant($ty), )*
        }

        impl $crate::reader::Record for $name {
            fn read_keys(reader: &mut $crate::reader::Reader<'_>, faults: &mut $crate::fault::DescriptionErrors) -> Option<Self> {
                match $crate::reader::macros::variant_word(reader, $by, &[$($word),*], faults)? {
                    $( $word => <$ty as $crate::reader::Record>::read_keys(reader, faults).map(Self::$variant), )*
                    _ => None,
                }
            }

            fn forms() -> Vec<$crate::reader::Form> {
                let mut forms = Vec::new();
                $(
                    let word = serde_json::json!({ "const": $word });
                    let key = $crate::reader::Key::new($by, true, concat!($($doc),*), word);
                    let form = $crate::reader::Form::default().with(key);
                    forms.extend($crate::reader::Form::product(&[form], &<$ty as $crate::reader::Record>::forms()));
                )*
                forms
            }

            fn write_keys(&self, table: &mut $crate::written::Table) {
                match self {
                    $( Self::$variant(record) => {
                        table.put($by, $word);
                        $crate::reader::Record::write_keys(record, table);
                    } )*
                }
            }
        }
        $crate::reader::macros::as_table!($name);
    };
}

/// An enum distinguished by which one of its keys is given.
macro_rules! keyed {
    (
        $(#[doc = $about:literal])*
        pub enum $name:ident {
            $( $(#[doc = $doc:literal])* $key:ident => $variant:ident($ty:ty) = $rule:expr; )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug)]
        pub enum $name {
            $( $(#[doc = $doc])* $variant($ty), )*
        }

        impl $crate::reader::Record for $name {
            fn read_keys(reader: &mut $crate::reader::Reader<'_>, faults: &mut $crate::fault::DescriptionErrors) -> Option<Self> {
                match $crate::reader::macros::only_key(reader, &[$(stringify!($key)),*], faults)? {
                    $( stringify!($key) => reader.required(stringify!($key), &$rule, faults).map(Self::$variant), )*
                    _ => None,
                }
            }

            fn forms() -> Vec<$crate::reader::Form> {
                vec![$crate::reader::Form::one_of(vec![
                    $( $crate::reader::macros::key_of::<$ty, _>(stringify!($key), true, concat!($($doc),*), &$rule) ),*
                ])]
            }

            fn write_keys(&self, table: &mut $crate::written::Table) {
                match self {
                    $( Self::$variant(value) => {
                        $crate::reader::macros::put(table, stringify!($key), &$rule, value);
                    } )*
                }
            }
        }
        $crate::reader::macros::as_table!($name);
    };
}

pub(crate) use {as_table, constructor, field, keyed, record, variant, variants};

use super::rule::Rule;
use super::table::{Form, Key, Reader};
use super::word::{one_of, quoted, word};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::written::Table;

/// Adds a key to each form.
pub(crate) fn with_key<T, R: Rule<Out = T>>(
    forms: Vec<Form>,
    name: &'static str,
    is_required: bool,
    description: &str,
    rule: &R,
) -> Vec<Form> {
    let key = key_of(name, is_required, description, rule);
    forms.into_iter().map(|f| f.with(key.clone())).collect()
}

/// A key of a rule's values.
pub(crate) fn key_of<T, R: Rule<Out = T>>(name: &'static str, is_required: bool, description: &str, rule: &R) -> Key {
    Key::new(name, is_required, description, rule.schema())
}

/// Writes a key by its rule. The rule reads every value of its record: one that cannot be written is a bug of the program.
pub(crate) fn put<R: Rule>(table: &mut Table, key: &str, rule: &R, value: &R::Out) {
    let item = rule.write(value);
    table.put(key, item.unwrap_or_else(|| panic!("a defect of the program: no rule of \"{key}\" writes its value")));
}

/// Returns the word that selects the variant of the table.
pub(crate) fn variant_word<'t>(
    reader: &mut Reader<'t>,
    by: &str,
    words: &[&str],
    errors: &mut DescriptionErrors,
) -> Option<&'t str> {
    let variant = match reader.take(by) {
        Some(node) => word(node, words, errors),
        None => {
            let remedy = format!("add it: {}", one_of(words));
            errors.add_missing(reader.place(), by, remedy);
            None
        }
    };
    if variant.is_none() {
        reader.mark_all_read();
    }
    variant
}

/// Returns the one of `keys` that is given.
pub(crate) fn only_key<'k>(
    reader: &mut Reader<'_>,
    keys: &[&'k str],
    errors: &mut DescriptionErrors,
) -> Option<&'k str> {
    let present: Vec<_> = keys.iter().filter(|k| reader.place_of(k).is_some()).copied().collect();
    if let [only] = present.as_slice() {
        return Some(only);
    }
    for key in &present {
        reader.take(key);
    }
    let place = present.last().and_then(|k| reader.place_of(k)).unwrap_or(reader.place());
    let (code, problem) = match present.as_slice() {
        [] => (ErrorCode::MissingKey, "a key is missing".to_owned()),
        _ => (ErrorCode::Contradiction, format!("{} contradict each other", quoted(&present))),
    };
    errors.add(code, place, problem, format!("give exactly one of {}", quoted(keys)));
    None
}
