//! Pages that a browser opens from the file system: the common style of reports and results, and the report of a measurement.

use std::fmt::Write as _;

use etendue_io::escape::escaped;
use serde_json::Value;

use crate::plot::svg;
use crate::report::{Cell, Report, Table};

/// Style of all pages: colours (light or dark by the system setting), text and tables.
pub const PAGE_STYLE: &str = include_str!("page/style.css");

/// Marker near the beginning of every page of this program.
pub const PAGE_GENERATOR: &str = "<meta name=\"generator\" content=\"etendue ";

/// A page from its title, style and body. Neither `style`, which follows [`PAGE_STYLE`], nor `body` is escaped.
#[must_use]
pub fn html_page(title: &str, style: &str, body: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{PAGE_GENERATOR}{version}\">\n<title>{}</title>\n\
         <style>\n{PAGE_STYLE}{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title)
    )
}

pub(crate) const REPORT_STYLE: &str = include_str!("page/report.css");
/// Maximum rows of a table on the page; JSON has all of them.
const MAX_ROWS: usize = 500;

/// The page of a report, in the style of the pages of results.
#[must_use]
pub fn report_page(report: &Report) -> String {
    let section = |title: &str, inside: String| match inside.as_str() {
        "" => inside,
        _ => format!("<section>\n<h2>{title}</h2>\n{inside}</section>\n"),
    };
    let mut body = format!(
        "<div class=\"report\">\n<h1>{}</h1>\n<p class=\"quiet\">{}</p>\n",
        escaped(report.kind()),
        escaped(report.method())
    );
    body += &section("Settings", settings(report));
    body += &section("Figures", figures(report));
    body += &section("Curves", curves(report));
    report.tables().for_each(|t| body += &section(&escaped(&heading(t)), table(t)));
    body += &section("Notes", notes(report));
    html_page(report.kind(), REPORT_STYLE, &format!("{body}</div>\n"))
}

/// Settings, figures and tables of a report that is part of a page.
pub(crate) fn details(report: &Report) -> String {
    let tables: String = report.tables().map(|t| format!("<h3>{}</h3>\n{}", escaped(&heading(t)), table(t))).collect();
    format!("{}{}{tables}", settings(report), figures(report))
}

/// All plots of a report; empty if none.
pub(crate) fn curves(report: &Report) -> String {
    let figures: String =
        report.plots().iter().map(|plot| format!("<figure>{}</figure>\n", svg(std::slice::from_ref(plot)))).collect();
    if figures.is_empty() { figures } else { format!("<div class=\"plots\">\n{figures}</div>\n") }
}

/// The notes of a report as a list; empty if none.
pub(crate) fn notes(report: &Report) -> String {
    let notes: String = report.notes().iter().map(|note| format!("<li>{}</li>\n", escaped(note))).collect();
    if notes.is_empty() { notes } else { format!("<ul>\n{notes}</ul>\n") }
}

fn heading(table: &Table) -> String {
    table.key.replace('_', " ")
}

/// Settings, and the conversion from the images' numbers to light.
fn settings(report: &Report) -> String {
    let json = report.json();
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let chosen =
        json["settings"].as_object().into_iter().flatten().map(|(key, value)| (key.replace('_', " "), text(value)));
    let encodings = json["encodings"].as_array().into_iter().flatten();
    let encodings =
        encodings.map(|e| ("encoding".to_owned(), format!("{} ({})", text(&e["encoding"]), text(&e["reason"]))));
    let rows: String = chosen
        .chain(encodings)
        .map(|(key, value)| format!("<tr><th>{}</th><td>{}</td></tr>\n", escaped(&key), escaped(&value)))
        .collect();
    if rows.is_empty() { rows } else { format!("<table>\n<tbody>\n{rows}</tbody>\n</table>\n") }
}

fn figures(report: &Report) -> String {
    if report.figures().is_empty() {
        return String::new();
    }
    let mut body = "<table>\n<thead><tr><th>figure</th><th class=\"number\">value ± standard uncertainty</th><th>unit</th></tr></thead>\n<tbody>\n"
        .to_owned();
    for figure in report.figures() {
        let value = Cell::Estimate(figure.value).text();
        let _ = writeln!(
            body,
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td>{}</td></tr>",
            escaped(&figure.label),
            escaped(&value),
            escaped(figure.unit)
        );
    }
    body + "</tbody>\n</table>\n"
}

fn table(table: &Table) -> String {
    let class = |column: usize| table.rows.first().and_then(|row| row.get(column)).map_or("", class);
    let heading =
        |(column, (_, heading)): (usize, &(&str, &str))| format!("<th{}>{}</th>", class(column), escaped(heading));
    let heads: String = table.columns.iter().enumerate().map(heading).collect();
    let mut body = format!("<table>\n<thead><tr>{heads}</tr></thead>\n<tbody>\n");
    for row in table.rows.iter().take(MAX_ROWS) {
        let cells: String = row.iter().map(cell).collect();
        let _ = writeln!(body, "<tr>{cells}</tr>");
    }
    body += "</tbody>\n</table>\n";
    if let Some(more) = table.rows.len().checked_sub(MAX_ROWS).filter(|more| *more > 0) {
        let _ = writeln!(body, "<p class=\"quiet\">and {more} more rows, in the output of `json`</p>");
    }
    body
}

fn cell(cell: &Cell) -> String {
    format!("<td{}>{}</td>", class(cell), escaped(&cell.text()))
}

/// Aligns numbers to the right.
fn class(cell: &Cell) -> &'static str {
    if matches!(cell, Cell::Text(_) | Cell::Nothing) { "" } else { " class=\"number\"" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_text() {
        assert!(html_page("<x>", "", "").contains("<title>&lt;x&gt;</title>"));
    }
}
