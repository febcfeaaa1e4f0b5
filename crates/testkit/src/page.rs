//! The page of extremes: docs/extremes.md, a section an area, whose rows are made by tests of several crates.

use std::{fmt::Write as _, path::PathBuf, sync::Mutex};

/// One extreme, and how it went.
#[derive(Clone, Debug)]
pub struct Row {
    /// What is asked of the program.
    pub extreme: String,
    /// What a user expects, and why.
    pub expected: String,
    /// What is found.
    pub found: String,
    /// Whether that is as expected.
    pub holds: bool,
}

impl Row {
    /// A number that is expected to be at most `bound`, told with two digits.
    #[must_use]
    pub fn at_most(extreme: &str, expected: &str, found: f64, bound: f64) -> Self {
        let (extreme, expected) = (extreme.to_owned(), expected.to_owned());
        Self { extreme, expected, found: figure(found), holds: found <= bound }
    }
}

/// The greatest of numbers; not a number where one of them is none, which no bound admits.
pub fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |worst: f64, value| if worst.is_nan() || value <= worst { worst } else { value })
}

/// Two digits.
#[must_use]
pub fn figure(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (0.01..1000.0).contains(&size) => {
            let decimals = if size >= 10.0 {
                0
            } else if size >= 1.0 {
                1
            } else if size >= 0.1 {
                2
            } else {
                3
            };
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.1e}"),
    }
}

/// One at a time writes the page.
static PAGE: Mutex<()> = Mutex::new(());

/// Checks an area's rows, and that the page has them; writes them where the tests are told to (`ETENDUE_BLESS=1`).
///
/// # Panics
/// Where a row does not hold, or the page has other ones.
pub fn check(area: &str, about: &str, rows: &[Row]) {
    let failed: Vec<_> = rows.iter().filter(|row| !row.holds).collect();
    assert!(failed.is_empty(), "{area}: {failed:#?}");
    let mut section = format!("## {area}\n\n{about}\n\n| extreme | expected | found |\n| --- | --- | --- |\n");
    for Row { extreme, expected, found, .. } in rows {
        let _ = writeln!(section, "| {extreme} | {expected} | {found} |");
    }
    let _only = PAGE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/extremes.md"));
    let page = std::fs::read_to_string(&path).unwrap_or_default();
    if std::env::var_os("ETENDUE_BLESS").is_some_and(|value| value == "1") {
        std::fs::write(&path, replaced(&page, area, &section)).expect("the page can be written");
    } else {
        let is_there = page.contains(&section);
        assert!(is_there, "{area}: docs/extremes.md differs; `just extremes` writes it. Now:\n{section}");
    }
}

/// The page with another text of one section, which is added where it is new.
fn replaced(page: &str, area: &str, section: &str) -> String {
    let head = format!("## {area}\n");
    let Some(from) = page.find(&head) else { return format!("{}\n\n{section}", page.trim_end()) };
    let rest = &page[from + head.len()..];
    let next = rest.find("\n## ").map_or("", |at| &rest[at..]);
    format!("{}{}\n{}", &page[..from], section.trim_end(), next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_the_worst() {
        assert_eq!(worst([1.0, 3.0, 2.0]), 3.0);
        assert!(worst([1.0, f64::NAN, 2.0]).is_nan() && worst([f64::NAN]).is_nan());
    }

    #[test]
    fn sections_are_replaced_in_place() {
        let page = "# Page\n\ntext\n\n## one\n\nold\n\n## two\n\nkept\n";
        assert_eq!(replaced(page, "one", "## one\n\nnew\n"), "# Page\n\ntext\n\n## one\n\nnew\n\n## two\n\nkept\n");
        assert_eq!(replaced(page, "two", "## two\n\nnew\n"), "# Page\n\ntext\n\n## one\n\nold\n\n## two\n\nnew\n");
        assert_eq!(replaced("# Page\n", "one", "## one\n\nnew\n"), "# Page\n\n## one\n\nnew\n");
        assert_eq!([0.0, 0.123, 5.55, 0.0123, 4321.0].map(figure), ["0", "0.12", "5.5", "0.012", "4.3e3"]);
    }
}
