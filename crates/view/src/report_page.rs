//! The report of a measurement as one page: what was found, tables, plots, notes.

use crate::html::document;
use etendue::Error;
use etendue::escaped;
use etendue::report::{Cell, Report, Table};
use serde_json::Value;
use std::fmt::Write as _;

const STYLE: [&str; 2] = [include_str!("../page/style.css"), include_str!("../page/report.css")];
/// Rows of a table on the page; JSON has all of them.
const MAX_ROWS: usize = 500;

/// The page of a report, in the look of the pages of results.
///
/// # Errors
/// Where a plot cannot be drawn.
pub fn report_page(report: &Report) -> Result<String, Error> {
    let mut body = format!(
        "<div class=\"report\">\n<h1>{}</h1>\n<p class=\"quiet\">{}</p>\n",
        escaped(report.kind()),
        escaped(report.method())
    );
    settings(&mut body, report);
    figures(&mut body, report);
    if report.has_plots() {
        let _ = writeln!(body, "<section>\n<h2>Curves</h2>\n{}</section>", report.svg()?);
    }
    for table in report.tables() {
        self::table(&mut body, table);
    }
    if !report.notes().is_empty() {
        let notes: String = report.notes().iter().map(|note| format!("<li>{}</li>\n", escaped(note))).collect();
        let _ = writeln!(body, "<section>\n<h2>Notes</h2>\n<ul>\n{notes}</ul>\n</section>");
    }
    body += "</div>\n";
    Ok(document(report.kind(), &STYLE.concat(), &body))
}

/// What was chosen, and how light was found from the numbers of the pictures.
fn settings(body: &mut String, report: &Report) {
    let told = report.json();
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let chosen =
        told["settings"].as_object().into_iter().flatten().map(|(key, value)| (key.replace('_', " "), text(value)));
    let encodings = told["encodings"].as_array().into_iter().flatten();
    let encodings =
        encodings.map(|e| ("encoding".to_owned(), format!("{} ({})", text(&e["encoding"]), text(&e["reason"]))));
    let rows: String = chosen
        .chain(encodings)
        .map(|(key, value)| format!("<tr><th>{}</th><td>{}</td></tr>\n", escaped(&key), escaped(&value)))
        .collect();
    if !rows.is_empty() {
        let _ = writeln!(body, "<section>\n<h2>Settings</h2>\n<table>\n<tbody>\n{rows}</tbody>\n</table>\n</section>");
    }
}

fn figures(body: &mut String, report: &Report) {
    if report.figures().is_empty() {
        return;
    }
    *body += "<section>\n<h2>Figures</h2>\n<table>\n<thead><tr><th>figure</th><th class=\"number\">value ± standard uncertainty</th><th>unit</th></tr></thead>\n<tbody>\n";
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
    *body += "</tbody>\n</table>\n</section>\n";
}

fn table(body: &mut String, table: &Table) {
    let class = |column: usize| table.rows.first().and_then(|row| row.get(column)).map_or("", class);
    let heading =
        |(column, (_, heading)): (usize, &(&str, &str))| format!("<th{}>{}</th>", class(column), escaped(heading));
    let heads: String = table.columns.iter().enumerate().map(heading).collect();
    let _ = writeln!(
        body,
        "<section>\n<h2>{}</h2>\n<table>\n<thead><tr>{heads}</tr></thead>\n<tbody>",
        escaped(&table.key.replace('_', " "))
    );
    for row in table.rows.iter().take(MAX_ROWS) {
        let cells: String = row.iter().map(cell).collect();
        let _ = writeln!(body, "<tr>{cells}</tr>");
    }
    *body += "</tbody>\n</table>\n";
    if let Some(more) = table.rows.len().checked_sub(MAX_ROWS).filter(|more| *more > 0) {
        let _ = writeln!(body, "<p class=\"quiet\">and {more} rows more, which --json has</p>");
    }
    *body += "</section>\n";
}

fn cell(cell: &Cell) -> String {
    format!("<td{}>{}</td>", class(cell), escaped(&cell.text()))
}

/// Numbers stand to the right.
fn class(cell: &Cell) -> &'static str {
    if matches!(cell, Cell::Text(_) | Cell::Nothing) { "" } else { " class=\"number\"" }
}
