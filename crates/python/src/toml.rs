//! Conversion of Python values to TOML.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use std::fmt::Write as _;
use std::path::PathBuf;

/// A value as TOML writes it on one line: numbers, texts, bools, paths, lists, dicts and NumPy arrays.
#[pyfunction]
pub(crate) fn to_toml(value: &Bound<'_, PyAny>) -> PyResult<String> {
    let mut text = String::new();
    write(&mut text, value, "", MAX_DEPTH)?;
    Ok(text)
}

/// Maximum nesting depth of values: stops at a list that contains itself.
const MAX_DEPTH: usize = 64;

/// A mapping as a dict; `None` for other values.
pub(crate) fn mapping<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyDict>>> {
    if let Ok(dict) = value.cast::<PyDict>() {
        return Ok(Some(dict.clone()));
    }
    let Ok(mapping) = value.cast::<PyMapping>() else { return Ok(None) };
    let dict = PyDict::new(value.py());
    dict.update(mapping)?;
    Ok(Some(dict))
}

/// A file of the keys of a mapping, one per line.
pub(crate) fn file(keys: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut text = String::new();
    for (key, value) in keys {
        let key = key_of(&key, "")?;
        text.push_str(&quoted(&key));
        text.push_str(" = ");
        write(&mut text, &value, &key, MAX_DEPTH)?;
        text.push('\n');
    }
    Ok(text)
}

/// Changes of keys, `key=value` each: from a mapping, where None removes the key, or from a list of such texts.
pub(crate) fn changes(set: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<String>> {
    let Some(set) = set else { return Ok(Vec::new()) };
    let Some(keys) = mapping(set)? else {
        let message = "set: expected a dict of keys to values, or a list of str \"key=value\"";
        return match set.is_instance_of::<PyString>() {
            true => Err(PyTypeError::new_err(message)),
            false => set.extract().map_err(|_| PyTypeError::new_err(message)),
        };
    };
    let change = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key = key_of(&key, "")?;
        let mut text = format!("{key}=");
        match value.is_none() {
            true => text.push_str("null"),
            false => write(&mut text, &value, &key, MAX_DEPTH)?,
        }
        Ok(text)
    };
    keys.iter().map(change).collect()
}

fn key_of(key: &Bound<'_, PyAny>, within: &str) -> PyResult<String> {
    key.extract().map_err(|_| PyTypeError::new_err(format!("{}: expected a str as key", named(within))))
}

fn named(key: &str) -> &str {
    if key.is_empty() { "the description" } else { key }
}

fn write(text: &mut String, value: &Bound<'_, PyAny>, key: &str, depth: usize) -> PyResult<()> {
    let Some(depth) = depth.checked_sub(1) else {
        return Err(PyValueError::new_err(format!("{}: values are nested more than {MAX_DEPTH} deep", named(key))));
    };
    if let Ok(value) = value.cast::<PyBool>() {
        text.push_str(if value.is_true() { "true" } else { "false" });
    } else if value.is_instance_of::<PyInt>() {
        // An enumeration's number, not its name.
        let message =
            |_| PyValueError::new_err(format!("{}: a whole number of a description must fit into 64 bits", named(key)));
        text.push_str(&value.extract::<i64>().map_err(message)?.to_string());
    } else if let Ok(value) = value.cast::<PyFloat>() {
        let _ = write!(text, "{}", number(value.value()));
    } else if let Ok(value) = value.cast::<PyString>() {
        text.push_str(&quoted(&value.to_cow()?));
    } else if let Some(value) = mapping(value)? {
        write_table(text, &value, key, depth)?;
    } else if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        write_list(text, value, key, depth)?;
    } else if value.hasattr("tolist")? {
        write(text, &value.call_method0("tolist")?, key, depth)?;
    } else if let Some(path) = value.hasattr("__fspath__")?.then(|| value.extract::<PathBuf>()).transpose()? {
        let path = path
            .to_str()
            .ok_or_else(|| PyValueError::new_err(format!("{}: the path is not valid Unicode", named(key))))?;
        text.push_str(&quoted(path));
    } else {
        let message = format!(
            "{}: a {} is not a value of a description: expected a number, str, bool, list, dict, path or array",
            named(key),
            value.get_type().name()?
        );
        return Err(PyTypeError::new_err(message));
    }
    Ok(())
}

fn write_table(text: &mut String, table: &Bound<'_, PyDict>, key: &str, depth: usize) -> PyResult<()> {
    text.push_str("{ ");
    for (i, (name, value)) in table.iter().enumerate() {
        let name = key_of(&name, key)?;
        let within = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
        let _ = write!(text, "{}{} = ", if i == 0 { "" } else { ", " }, quoted(&name));
        write(text, &value, &within, depth)?;
    }
    text.push_str(" }");
    Ok(())
}

fn write_list(text: &mut String, list: &Bound<'_, PyAny>, key: &str, depth: usize) -> PyResult<()> {
    text.push('[');
    for (i, value) in list.try_iter()?.enumerate() {
        text.push_str(if i == 0 { "" } else { ", " });
        write(text, &value?, &format!("{key}[{i}]"), depth)?;
    }
    text.push(']');
    Ok(())
}

/// A float keeps its decimal point, so that it does not become an integer.
fn number(value: f64) -> String {
    match value {
        _ if value.is_nan() => "nan".to_owned(),
        f64::INFINITY => "inf".to_owned(),
        f64::NEG_INFINITY => "-inf".to_owned(),
        _ => format!("{value:?}"),
    }
}

/// A basic string, with the characters escaped that TOML does not allow.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
