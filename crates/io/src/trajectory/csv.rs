//! Trajectories as tables.

use std::path::Path;

use super::columns::{Columns, Read, is_known};
use crate::table::{number, rows};
use crate::{Error, ErrorCode};

pub(super) fn read(file: &Path, text: &str) -> Result<Read, Error> {
    let mut rows = rows(text);
    let head = rows
        .next()
        .ok_or_else(|| Error::coded(ErrorCode::Empty, file, "holds no row; expected a line of column names first"))?;
    let columns = Columns::of(&head.cells).map_err(|what| Error::at(file, head.line, what))?;
    let unread = head.cells.iter().filter(|name| !is_known(name)).map(|name| (*name).to_owned()).collect();
    let read = rows.map(|row| {
        let cell = |column: usize| {
            let cell = row.cells.get(column).copied();
            cell.ok_or_else(|| format!("the row ends before \"{}\"", head.cells[column]))
        };
        let wrong =
            |column: usize, cell: &str| format!("found \"{cell}\" as \"{}\"; expected a number", head.cells[column]);
        let value =
            |column: usize| number(cell(column)?).ok_or_else(|| wrong(column, cell(column).unwrap_or_default()));
        let exact = |column: usize| cell(column)?.parse().map_err(|_| wrong(column, cell(column).unwrap_or_default()));
        let found = columns.row(value, exact).map_err(|what| Error::at(file, row.line, what))?;
        Ok((row.line, found))
    });
    Ok((read.collect::<Result<_, _>>()?, unread))
}
