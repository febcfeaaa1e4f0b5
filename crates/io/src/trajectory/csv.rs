//! Trajectories as tables.

use std::path::Path;

use super::columns::{Columns, Read, is_known};
use crate::Error;
use crate::table::{number, rows};

pub(super) fn read(file: &Path, text: &str) -> Result<Read, Error> {
    let mut rows = rows(text);
    let head = rows.next().ok_or_else(|| Error::new(file, "holds no row; expected a line of column names first"))?;
    let columns = Columns::of(&head.cells).map_err(|what| Error::at(file, head.line, what))?;
    let unread = head.cells.iter().filter(|name| !is_known(name)).map(|name| (*name).to_owned()).collect();
    let read = rows.map(|row| {
        let value = |column: usize| {
            let name = head.cells[column];
            let cell = row.cells.get(column).ok_or_else(|| format!("the row ends before \"{name}\""))?;
            number(cell).ok_or_else(|| format!("found \"{cell}\" as \"{name}\"; expected a number"))
        };
        let found = columns.row(value).map_err(|what| Error::at(file, row.line, what))?;
        Ok((row.line, found))
    });
    Ok((read.collect::<Result<_, _>>()?, unread))
}
