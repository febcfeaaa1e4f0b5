//! Tables of materials: CSV, `#` comments, blank lines and header lines allowed where stated; decimal points.
//!
//! **Refractive indices**: three columns, wavelength in nm (increasing, each once), n (above 0), k (0 or more), separated by commas or blanks; one header line
//! may come first.
//!
//! **Numbers** (tone curves, maps of defects, grids of gains): rows of equal length; one header line may come first.
//!
//! **Coefficients of retro-reflection**: the first row holds the entrance angles β (degrees, increasing, 0 … 90) after one arbitrary word; each further row an
//! observation angle α (degrees, increasing, 0 … 180) and R_A (cd·lx⁻¹·m⁻², 0 or more) for each β:
//!
//! ```text
//! observation_deg \ entrance_deg, 5, 30, 40
//! 0.2,  250, 150, 110
//! 0.33, 180, 100, 95
//! ```

use std::path::Path;

use etendue_scene::asset::{ComplexIndexAsset, NumbersAsset, RetroTableAsset};

use crate::source::{decode_text, read_bytes};
use crate::{Error, ErrorCode, hash};

/// Reads a table of n and k.
///
/// # Errors
/// The first error, with its line.
pub fn read_complex_index(file: &Path) -> Result<ComplexIndexAsset, Error> {
    let bytes = read_bytes(file, "refractive index")?;
    let mut points: Vec<(f64, f64, f64)> = Vec::new();
    for (index, row) in rows(decode_text(file, &bytes)?).enumerate() {
        if index == 0 && row.cells.iter().all(|cell| number(cell).is_none()) {
            continue;
        }
        let point = index_of(&row, points.last().map(|p| p.0)).map_err(|what| Error::at(file, row.line, what))?;
        points.push(point);
    }
    if points.is_empty() {
        return Err(Error::coded(
            ErrorCode::Empty,
            file,
            "contains no row; expected three columns: wavelength in nm, n, k",
        ));
    }
    Ok(ComplexIndexAsset { points, hash: hash::hash_bytes(&bytes) })
}

fn index_of(row: &TableRow<'_>, before: Option<f64>) -> Result<(f64, f64, f64), String> {
    let values = row.numbers()?;
    let [nm, n, k] = values[..] else {
        return Err(format!("the number of columns is {}; expected three: wavelength in nm, n, k", values.len()));
    };
    if let Some(last) = before.filter(|last| nm <= *last) {
        return Err(format!(
            "wavelength {nm} nm follows {last} nm: sort the table by increasing wavelength, each once"
        ));
    }
    let wrong =
        [(nm <= 0.0, "a wavelength in nm above 0", nm), (n <= 0.0, "n above 0", n), (k < 0.0, "k of 0 or more", k)];
    match wrong.into_iter().find(|(is, _, _)| *is) {
        Some((_, expected, actual)) => Err(format!("found {actual}; expected {expected}")),
        None => Ok((nm, n, k)),
    }
}

/// Reads a table of R_A.
///
/// # Errors
/// The first error, with its line.
pub fn read_retro_table(file: &Path) -> Result<RetroTableAsset, Error> {
    let bytes = read_bytes(file, "retroreflection")?;
    let mut rows = rows(decode_text(file, &bytes)?);
    let head = rows.next().filter(|row| row.cells.len() > 1);
    let head =
        head.ok_or_else(|| Error::new(file, "has no row of entrance angles; expected a word and at least one angle"))?;
    let mut table = RetroTableAsset { hash: hash::hash_bytes(&bytes), ..RetroTableAsset::default() };
    for cell in &head.cells[1..] {
        let angle = angle(cell, "entrance", 90.0, table.entrance_deg.last());
        table.entrance_deg.push(angle.map_err(|what| Error::at(file, head.line, what))?);
    }
    for row in rows {
        add_row(&mut table, &row).map_err(|what| Error::at(file, row.line, what))?;
    }
    if table.observation_deg.is_empty() {
        return Err(Error::coded(
            ErrorCode::Empty,
            file,
            "contains no observation angle; expected at least one row after the entrance angles",
        ));
    }
    Ok(table)
}

fn add_row(table: &mut RetroTableAsset, row: &TableRow<'_>) -> Result<(), String> {
    let (count, expected) = (row.cells.len() - 1, table.entrance_deg.len());
    if count != expected {
        return Err(format!(
            "the number of coefficients is {count}; expected {expected}, one for each entrance angle of the first row"
        ));
    }
    let angle = angle(row.cells[0], "observation", 180.0, table.observation_deg.last())?;
    table.observation_deg.push(angle);
    for value in row.numbers()?.into_iter().skip(1) {
        if value < 0.0 {
            return Err(format!("the coefficient is {value}; expected 0 or more"));
        }
        table.coefficients.push(value);
    }
    Ok(())
}

fn angle(cell: &str, which: &str, max: f64, before: Option<&f64>) -> Result<f64, String> {
    let degrees = number(cell).ok_or_else(|| format!("found \"{cell}\"; expected an {which} angle: a number"))?;
    if !(0.0..=max).contains(&degrees) {
        return Err(format!("the {which} angle is {degrees}°; expected 0° to {max}°"));
    }
    match before.filter(|last| degrees <= **last) {
        Some(last) => {
            Err(format!("{which} angle {degrees}° follows {last}°: sort the table by increasing angle, each once"))
        }
        None => Ok(degrees),
    }
}

/// Reads a table of numbers: rows of equal length; one header line may come first.
///
/// # Errors
/// The first error, with its line.
pub fn read_numbers(file: &Path) -> Result<NumbersAsset, Error> {
    let bytes = read_bytes(file, "numbers")?;
    let mut table = NumbersAsset { hash: hash::hash_bytes(&bytes), ..NumbersAsset::default() };
    for (index, row) in rows(decode_text(file, &bytes)?).enumerate() {
        if index == 0 && row.cells.iter().all(|cell| number(cell).is_none()) {
            continue;
        }
        let values = row.numbers().map_err(|what| Error::at(file, row.line, what))?;
        if table.columns != 0 && table.columns != values.len() {
            let what =
                format!("the number of values is {}; expected {} as in the rows before", values.len(), table.columns);
            return Err(Error::at(file, row.line, what));
        }
        table.columns = values.len();
        table.values.extend(values);
    }
    if table.values.is_empty() {
        Err(Error::coded(ErrorCode::Empty, file, "contains no row; expected rows of numbers"))
    } else {
        Ok(table)
    }
}

/// Non-empty row.
pub(crate) struct TableRow<'a> {
    /// Line, counted from 1.
    pub(crate) line: usize,
    pub(crate) cells: Vec<&'a str>,
}

impl TableRow<'_> {
    fn numbers(&self) -> Result<Vec<f64>, String> {
        let parse = |cell: &&str| number(cell).ok_or_else(|| format!("found \"{cell}\"; expected a number"));
        self.cells.iter().map(parse).collect()
    }
}

/// Rows that are not comments. Cells are separated by commas, or else by blanks.
pub(crate) fn rows(text: &str) -> impl Iterator<Item = TableRow<'_>> {
    text.lines().enumerate().filter_map(|(index, line)| {
        let content = line.split('#').next().unwrap_or_default().trim();
        let cells: Vec<&str> = match content.contains(',') {
            true => content.split(',').map(str::trim).collect(),
            false => content.split_whitespace().collect(),
        };
        (!content.is_empty()).then_some(TableRow { line: index + 1, cells })
    })
}

pub(crate) fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|v: &f64| v.is_finite())
}

#[cfg(test)]
mod tests;
