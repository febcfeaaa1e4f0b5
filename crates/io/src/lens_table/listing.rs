//! Lines of text with tables of numbers between them.

use std::path::Path;

use crate::{Error, ErrorCode, Problem};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FieldUnit {
    /// Angles from the axis in front of the lens.
    Degrees,
    /// Distances from the axis in the image.
    Millimetres,
}

/// Parsed text of a file.
pub(super) struct Listing<'a> {
    file: &'a Path,
    /// Non-empty lines before the first table, with their numbers from 1.
    pub(super) head: Vec<(usize, &'a str)>,
    /// Tables, at least one.
    pub(super) tables: Vec<ListingTable<'a>>,
}

/// Consecutive rows of numbers.
pub(super) struct ListingTable<'a> {
    /// Lines between the previous table and this one.
    pub(super) above: Vec<(usize, &'a str)>,
    pub(super) rows: Vec<ListingRow>,
}

/// A row of numbers.
pub(super) struct ListingRow {
    pub(super) line: usize,
    pub(super) numbers: Vec<f64>,
}

impl<'a> Listing<'a> {
    pub(super) fn read(file: &'a Path, text: &'a str) -> Result<Self, Error> {
        let mut tables: Vec<ListingTable<'a>> = Vec::new();
        let (mut above, mut in_table) = (Vec::new(), false);
        for (index, line) in text.lines().enumerate() {
            let (number, line) = (index + 1, line.trim());
            if line.is_empty() {
                continue;
            }
            match numbers(line) {
                None => {
                    above.push((number, line));
                    in_table = false;
                }
                Some(numbers) => {
                    if !in_table {
                        tables.push(ListingTable { above: std::mem::take(&mut above), rows: Vec::new() });
                        in_table = true;
                    }
                    let rows = &mut tables.last_mut().expect("one was begun").rows;
                    if let Some(first) = rows.first().filter(|first| first.numbers.len() != numbers.len()) {
                        let (count, before) = (numbers.len(), first.numbers.len());
                        let message =
                            format!("the number of values is {count}; expected {before} as in the rows before");
                        return Err(Error::at(file, number, message));
                    }
                    if let Some(wrong) = numbers.iter().find(|number| !number.is_finite()) {
                        return Err(Error::at(file, number, format!("found {wrong}; expected finite numbers")));
                    }
                    rows.push(ListingRow { line: number, numbers });
                }
            }
        }
        let head = tables.first().map(|table| table.above.clone());
        let head = head.ok_or_else(|| {
            Error::coded(
                ErrorCode::Empty,
                file,
                "contains no row of numbers (with decimal points, at least two per row); expected a table exported \
                by Zemax as text",
            )
        })?;
        Ok(Self { file, head, tables })
    }

    pub(super) fn error(&self, line: usize, what: impl Into<Problem>) -> Error {
        if line == 0 { Error::new(self.file, what) } else { Error::at(self.file, line, what) }
    }

    /// Returns true if a line of the header contains a word, in lower case.
    pub(super) fn header_contains(&self, word: &str) -> bool {
        self.head.iter().any(|(_, line)| line.to_lowercase().contains(word))
    }

    /// Number after a colon or an equals sign in a line above a table, else of the header, that contains these words in lower case.
    pub(super) fn stated(&self, table: &ListingTable<'_>, words: &str) -> Option<f64> {
        let value = |line: &str| {
            let (name, value) = line.split_once([':', '='])?;
            let number = value.split_whitespace().next().filter(|_| name.to_lowercase().contains(words))?;
            number.parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0)
        };
        table.above.iter().chain(&self.head).find_map(|(_, line)| value(line))
    }

    /// Rows of a table by absolute distance from the axis, whichever side the fields lie on: the first is the axis, and distances increase.
    pub(super) fn rows_from_axis<'t>(&self, table: &'t ListingTable<'_>) -> Result<Vec<(f64, &'t ListingRow)>, Error> {
        let side = table.rows.iter().map(|row| row.numbers[0]).find(|field| *field != 0.0).map_or(1.0, f64::signum);
        let mut ordered: Vec<(f64, &ListingRow)> = Vec::new();
        for row in &table.rows {
            let field = row.numbers[0] * side;
            let wrong = match ordered.last() {
                None if field != 0.0 => format!("the first field is {field}; expected 0, the axis"),
                Some((before, _)) if field <= *before => {
                    format!("the field {field} follows {before}; expected increasing distances from the axis")
                }
                _ => {
                    ordered.push((field, row));
                    continue;
                }
            };
            return Err(self.error(row.line, wrong));
        }
        Ok(ordered)
    }

    /// Unit of the fields of a table, whose titles are directly above it.
    pub(super) fn unit_of(&self, table: &ListingTable<'_>) -> Result<FieldUnit, Error> {
        let titles = table.above.last().copied();
        let stated = self.head.iter().copied().filter(|(_, line)| line.to_lowercase().starts_with("field"));
        for (number, line) in stated.chain(titles) {
            let line = line.to_lowercase();
            if line.contains("object height") {
                let problem = "the fields are object heights, which do not determine a direction or image position; export with fields as angles or \
                    image heights";
                return Err(self.error(number, problem));
            }
            let has = |words: &[&str]| words.iter().any(|word| line.contains(word));
            if has(&["deg"]) {
                return Ok(FieldUnit::Degrees);
            }
            if has(&["inch", "centimet", "(cm", "(in)", "in inch", "(m)"]) {
                return Err(
                    self.error(number, "the fields are neither in degrees nor in mm; export with lens units of mm")
                );
            }
            if has(&["millimet", "(mm", "in mm"]) {
                return Ok(FieldUnit::Millimetres);
            }
        }
        Err(self.error(
            titles.map_or(0, |(number, _)| number),
            "the header does not state the unit of the fields; expected a line such as \"Field values are in degrees\" or \"... in millimeters\"",
        ))
    }
}

/// Wavelength, nm, in a line that begins with these words: its first number, in micrometres.
pub(super) fn wavelength_nm(lines: &[(usize, &str)]) -> Option<f64> {
    const NM_PER_UM: f64 = 1000.0;
    let about = lines.iter().filter(|(_, line)| line.to_lowercase().contains("wavelength"));
    // In "Wavelength 2: 0.5876 µm" the first number is an index.
    let stated = |line: &str| line.split_once([':', '=']).map_or(line, |(_, stated)| stated).to_owned();
    let number = |line: &str| stated(line).split([' ', '\t']).find_map(|word| word.parse::<f64>().ok());
    about.filter_map(|(_, line)| number(line)).map(|um| um * NM_PER_UM).find(|nm| (100.0..20_000.0).contains(nm))
}

/// Numbers of a line that holds nothing else, at least two; a percent sign may follow each.
fn numbers(line: &str) -> Option<Vec<f64>> {
    let words = line.split_whitespace().filter(|word| *word != "%");
    let numbers: Option<Vec<f64>> = words.map(|word| word.trim_end_matches('%').parse().ok()).collect();
    numbers.filter(|numbers| numbers.len() >= 2)
}
