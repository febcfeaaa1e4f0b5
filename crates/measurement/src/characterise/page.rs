//! The report as one self-contained page: a table of results, unknown quantities, and every measurement with its curves.

use std::fmt::Write as _;

use etendue_io::escape::escaped;

use super::parameter::{Findings, ImageKind, Parameter, PartialReport};
use super::{camera::CameraFile, folder::Laboratory};
use crate::page::{REPORT_STYLE, curves, details, html_page, notes};
use crate::report::{Estimate, with_uncertainty};

pub(super) fn page(laboratory: &Laboratory, findings: &Findings, camera: &CameraFile) -> String {
    let name = laboratory.camera.name.clone().unwrap_or_else(|| "Camera".to_owned());
    let mut body = format!("<div class=\"report\">\n<h1>{}</h1>\n", escaped(&name));
    body += &head(laboratory);
    body += &navigation(findings);
    body += &parameters(findings);
    body += &not_known(findings, camera);
    findings.parts.iter().enumerate().for_each(|(i, part)| body += &measurement(i, part));
    let _ = writeln!(
        body,
        "<section id=\"file\"><h2>Camera file</h2><pre>{}</pre></section>\n</div>",
        escaped(&camera.text)
    );
    html_page(&format!("{name} – characterisation"), REPORT_STYLE, &body)
}

/// Summary of the inputs.
fn head(laboratory: &Laboratory) -> String {
    let [width, height] = laboratory.camera.size_px;
    let count = |kind: &ImageKind| laboratory.shots(*kind).len();
    let kinds = ImageKind::ALL.iter().filter(|kind| count(kind) > 0);
    let used = kinds.map(|kind| format!("{} × {}/", count(kind), kind.folder())).collect::<Vec<_>>().join(", ");
    let filters = laboratory.camera.cfa.clone().unwrap_or_else(|| "unknown filters".to_owned());
    format!("<p class=\"quiet\">{width} × {height} px, {}. Measured by: {used}.</p>\n", escaped(&filters))
}

fn navigation(findings: &Findings) -> String {
    let link = |(i, part): (usize, &PartialReport)| format!("<a href=\"#part-{i}\">{}</a>", escaped(part.title));
    let parts: Vec<String> = findings.parts.iter().enumerate().map(link).collect();
    format!(
        "<nav><a href=\"#parameters\">Parameters</a> <a href=\"#not-known\">Not known</a> {} <a href=\"#file\">Camera file</a></nav>\n",
        parts.join(" ")
    )
}

/// Value ± expanded uncertainty (k = 2), to two digits of the uncertainty.
fn expanded(e: Estimate) -> String {
    with_uncertainty(Estimate::new(e.value, 2.0 * e.standard_uncertainty))
}

fn parameters(findings: &Findings) -> String {
    let mut html =
        "<section id=\"parameters\"><h2>Parameters</h2>\n<p>± is the expanded uncertainty: an interval of about 95 % \
                    (k = 2). What each omits is stated at its measurement.</p>\n<table><thead><tr><th>quantity</th><th \
                    class=\"number\">value ± U</th><th>unit</th><th class=\"number\">U, \
                    %</th><th>from</th><th>key</th></tr></thead>\n"
            .to_owned();
    for section in ["lens", "effects", "sensor", "isp"] {
        let section_parameters = findings.parameters.iter().filter(|p| p.key.split('.').next() == Some(section));
        let rows: String = section_parameters.map(parameter).collect();
        if !rows.is_empty() {
            let _ = writeln!(
                html,
                "<tbody><tr class=\"group\"><th colspan=\"6\">{}</th></tr>\n{rows}</tbody>",
                group(section)
            );
        }
    }
    html + "</table></section>\n"
}

fn group(section: &str) -> &'static str {
    match section {
        "lens" => "Lens",
        "effects" => "Point spread",
        "sensor" => "Sensor",
        _ => "Processing",
    }
}

fn parameter(p: &Parameter) -> String {
    let percent = 200.0 * p.value.standard_uncertainty / p.value.value.abs();
    let percent = if percent < 100.0 && percent > 0.0 { format!("{percent:.2}") } else { "–".to_owned() };
    format!(
        "<tr><td>{}</td><td class=\"number\">{}</td><td>{}</td><td class=\"number\">{percent}</td><td>{}/</td><td><code>{}</code></td></tr>\n",
        escaped(&p.label),
        escaped(&expanded(p.value)),
        escaped(p.unit),
        p.image_kind.folder(),
        escaped(&p.key)
    )
}

fn not_known(findings: &Findings, camera: &CameraFile) -> String {
    let row =
        |quantity: &str, reason: &str| format!("<tr><td>{}</td><td>{}</td></tr>\n", escaped(quantity), escaped(reason));
    let mut rows: String = findings.unknown.iter().map(|u| row(&u.quantity, &u.reason)).collect();
    if !camera.placeholders.is_empty() {
        let reason = "required keys of a camera file that no image determines: placeholders, to be replaced by hand or by a base";
        rows += &row(&camera.placeholders.join(", "), reason);
    }
    if rows.is_empty() {
        rows = row("–", "every quantity was determined");
    }
    format!(
        "<section id=\"not-known\"><h2>Not known</h2>\n<table><thead><tr><th>what</th><th>why, and what would determine \
         it</th></tr></thead><tbody>\n{rows}</tbody></table></section>\n"
    )
}

fn measurement(index: usize, part: &PartialReport) -> String {
    let report = &part.report;
    let mut html = format!(
        "<section id=\"part-{index}\"><h2>{}</h2>\n<p>From the images in {}/: {}.</p>\n",
        escaped(part.title),
        part.image_kind.folder(),
        escaped(report.method())
    );
    html += &curves(report);
    html += &notes(report);
    let _ = writeln!(html, "<details><summary>All figures</summary>\n{}</details></section>", details(report));
    html
}
