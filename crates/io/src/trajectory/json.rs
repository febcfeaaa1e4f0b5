//! Trajectories as lists of objects.

use std::path::Path;

use serde_json::{Map, Value};

use super::columns::{Columns, Read, is_known};
use crate::Error;
use etendue_core::ExactTime;

pub(super) fn read(file: &Path, text: &str) -> Result<Read, Error> {
    let entries: Vec<Map<String, Value>> = serde_json::from_str(text).map_err(|cause| {
        let what = format!("no list of objects of numbers by name: {cause}");
        if cause.line() > 0 { Error::at(file, cause.line(), what) } else { Error::new(file, what) }
    })?;
    let lines = entry_lines(text);
    let Some(first) = entries.first() else { return Ok((Vec::new(), Vec::new())) };
    let names: Vec<&str> = first.keys().map(String::as_str).collect();
    let columns = Columns::of(&names).map_err(|what| Error::at(file, lines[0], what))?;
    let unread = names.iter().filter(|name| !is_known(name)).map(|name| (*name).to_owned()).collect();
    let read = entries.iter().zip(&lines).map(|(entry, line)| {
        let fault = |what: String| Error::at(file, *line, what);
        if let Some(other) = entry.keys().find(|key| is_known(key) && !names.contains(&key.as_str())) {
            return Err(fault(format!("gives \"{other}\", which the first does not; give it in all or in none")));
        }
        let given = |column: usize| {
            let name = names[column];
            entry.get(name).ok_or_else(|| format!("does not give \"{name}\", which the first does"))
        };
        let wrong = |column: usize, found: &Value| format!("found {found} as \"{}\"; expected a number", names[column]);
        let value = |column: usize| {
            let found = given(column)?;
            found.as_f64().ok_or_else(|| wrong(column, found))
        };
        let exact = |column: usize| {
            let found = given(column)?;
            let read = found
                .as_str()
                .map_or_else(|| found.as_f64().and_then(ExactTime::from_seconds), |text| text.parse().ok());
            read.ok_or_else(|| wrong(column, found))
        };
        Ok((*line, columns.row(value, exact).map_err(fault)?))
    });
    Ok((read.collect::<Result<_, _>>()?, unread))
}

/// The lines, counted from 1, that the entries of the outermost list begin in; the text is valid.
fn entry_lines(text: &str) -> Vec<usize> {
    let (mut lines, mut line, mut depth, mut quoted, mut escaped) = (Vec::new(), 1, 0_u32, false, false);
    for byte in text.bytes() {
        match byte {
            b'\n' => line += 1,
            _ if quoted => {
                quoted = escaped || byte != b'"';
                escaped = !escaped && byte == b'\\';
            }
            b'"' => quoted = true,
            b'{' | b'[' => {
                if depth == 1 {
                    lines.push(line);
                }
                depth += 1;
            }
            b'}' | b']' => depth -= 1,
            _ => {}
        }
    }
    lines
}
