//! Points of a chart from a list (CSV), in place of a picture.
//!
//! The first line names the columns, in any order: `column` and `row`, whole numbers from 0, the point's place on the chart in steps;
//! `x_px` and `y_px`, where it is seen, raster coordinates (pixel centres at + 0.5); `uncertainty_px`, the standard uncertainty of each of
//! these, may be left out (0). Lines that begin with # and empty ones are skipped.

use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::text_of;
use etendue_metrology::target::{Grid, Node};
use glam::DVec2;
use std::collections::BTreeMap;
use std::path::Path;

const COLUMNS: [&str; 5] = ["column", "row", "x_px", "y_px", "uncertainty_px"];
const NEEDED: usize = 4;
/// Charts of more columns or rows are taken for a slip.
const MOST: f64 = 10_000.0;

/// Whether a file is a list of points.
pub(crate) fn is_list(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
}

/// The points of a list.
pub(crate) fn read(file: &Path) -> Result<Grid, Error> {
    let text = text_of(file)?;
    let refused = |line: usize, what: String| {
        Error::coded(ErrorCode::MalformedFile, format!("{}:{}: {what}", file.display(), line + 1))
    };
    let lines = text.lines().enumerate().map(|(i, line)| (i, line.trim_start_matches('\u{feff}').trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let expected =
        format!("expected a line that names the columns: {} (uncertainty_px may be left out)", COLUMNS.join(","));
    let (first, heading) = lines.next().ok_or_else(|| refused(0, expected.clone()))?;
    let places = places(heading).ok_or_else(|| refused(first, format!("{expected}, not '{heading}'")))?;
    let mut nodes: BTreeMap<[usize; 2], (usize, Node)> = BTreeMap::new();
    for (i, line) in lines {
        let node = node(line, &places.0, places.1).map_err(|what| refused(i, what))?;
        let [column, row] = node.index;
        if let Some((other, _)) = nodes.insert([row, column], (i, node)) {
            return Err(refused(i, format!("column {column}, row {row} is in line {} already", other + 1)));
        }
    }
    let size = [0, 1].map(|axis| nodes.values().map(|(_, n)| n.index[axis] + 1).max().unwrap_or(0));
    Ok(Grid { nodes: nodes.into_values().map(|(_, node)| node).collect(), size, disc_radius_steps: None })
}

/// Where in a line each of the columns stands, and how many there are.
fn places(heading: &str) -> Option<(Vec<Option<usize>>, usize)> {
    let names: Vec<&str> = heading.split(',').map(str::trim).collect();
    let place = |wanted: &&str| names.iter().position(|name| name == wanted);
    let places: Vec<Option<usize>> = COLUMNS.iter().map(place).collect();
    let whole = places[..NEEDED].iter().all(Option::is_some) && names.iter().all(|name| COLUMNS.contains(name));
    (whole && places.iter().flatten().count() == names.len()).then_some((places, names.len()))
}

fn node(line: &str, places: &[Option<usize>], count: usize) -> Result<Node, String> {
    let words: Vec<&str> = line.split(',').map(str::trim).collect();
    if words.len() != count {
        return Err(format!("expected {count} numbers as the first line has names, not '{line}'"));
    }
    let number = |k: usize| {
        let Some(place) = places[k] else { return Ok(0.0) };
        let number = words[place].parse::<f64>().ok().filter(|v| v.is_finite());
        number.ok_or_else(|| format!("{}: expected a number, not '{}'", COLUMNS[k], words[place]))
    };
    let index = |k: usize| {
        let index = number(k)?;
        let whole = index.fract() == 0.0 && (0.0..MOST).contains(&index);
        if whole {
            Ok(index as usize)
        } else {
            Err(format!("{}: expected a whole number from 0, not {index}", COLUMNS[k]))
        }
    };
    let uncertainty_px = number(4)?;
    if uncertainty_px < 0.0 {
        return Err(format!("uncertainty_px: expected a number from 0, not {uncertainty_px}"));
    }
    Ok(Node { index: [index(0)?, index(1)?], at: DVec2::new(number(2)?, number(3)?), uncertainty_px })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> Result<Grid, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("points.csv");
        std::fs::write(&file, text).expect("written");
        read(&file).map_err(|failure| match failure {
            Error::Input(faults) => faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "),
            Error::Run(_) => "a failed run".to_owned(),
        })
    }

    #[test]
    fn points_are_read_by_the_names_of_their_columns() {
        let grid = told("# seen\nx_px,y_px,row,column\n10.5,20.25,0,1\n\n1,2,3,0\n").expect("two points");
        assert_eq!((grid.size, grid.nodes.len()), ([2, 4], 2));
        let first = Node { index: [1, 0], at: DVec2::new(10.5, 20.25), uncertainty_px: 0.0 };
        assert_eq!(grid.node([1, 0]), Some(&first));
    }

    #[test]
    fn wrong_lines_are_told_by_their_number() {
        let head = "column,row,x_px,y_px,uncertainty_px\n";
        for (text, line, part) in [
            (String::new(), 1, "names the columns"),
            ("column,row,x,y\n".to_owned(), 1, "x_px"),
            (format!("{head}0,0,1,2\n"), 2, "expected 5 numbers"),
            (format!("{head}0,0,1,2,0\n0.5,0,1,2,0\n"), 3, "whole number"),
            (format!("{head}0,0,1,nan,0\n"), 2, "y_px: expected a number"),
            (format!("{head}0,0,1,2,-1\n"), 2, "uncertainty_px"),
            (format!("{head}0,0,1,2,0\n1,0,1,2,0\n0,0,3,2,0\n"), 4, "line 2 already"),
        ] {
            let error = told(&text).expect_err("refused");
            assert!(error.contains(&format!("points.csv:{line}: ")) && error.contains(part), "{error}");
        }
    }
}
