//! docs/evidence/validation.md.

use crate::bounds::unit;
use crate::comparison::{Reached, rounded};

/// A part of a camera's report.
pub(crate) struct Section {
    pub(crate) title: &'static str,
    pub(crate) body: String,
    pub(crate) reached: Vec<Reached>,
}

/// What was found of a camera.
pub(crate) struct Report {
    pub(crate) camera: &'static str,
    pub(crate) sections: Vec<Section>,
}

impl Report {
    pub(crate) fn reached(&self) -> impl Iterator<Item = &Reached> {
        self.sections.iter().flat_map(|section| &section.reached)
    }
}

const INTRODUCTION: &str = "# Recovery of declared parameters

Written by `just validate`: charts are rendered with reference cameras (`charts/*/camera.toml`), the pictures are measured, and what is found is
laid beside what the camera file declares. Errors are measured less declared; E_n after ISO 13528, |E_n| > 1 is a difference. Of about
twenty quantities that agree one is expected to differ by chance.

The bounds are kept where the error is within them; where they say \"or 3 u\", within three standard uncertainties is enough (|E_n| ≤ 1.5).
`just validate` fails where one is broken (**bold** here).

What a laboratory sees to, the bench does: the distance of the dots is no near multiple of a pixel or of the mosaic's tile (else errors of neighbours are
alike, drift slowly over the field and pass for a shifted centre of distortion); pixels at the border, which have fewer neighbours to exchange light with, are no part of photon
transfer; its exposures are too short for dark current to add to the offsets' pattern; flat fields are measured above the reading that the dark
current leaves; edges are those of a mean of many frames over a flat field (no noise, no PRNU, no DSNU), and their sides' fall-off is taken off. Responses are means of all
edges over the field; of mosaics those of the green raw readings.

Diffraction is described in a file of its own beside each camera, for the second of the two responses; edges lie 5° from rows and columns, and along the diagonals the film of whole
pixels loses up to 0.06 of a spread about as wide as a pixel (crates/optics/src/effects/band.rs).
";

/// The whole page.
pub(crate) fn page(reports: &[Report]) -> String {
    let mut text = format!("{INTRODUCTION}\n{}", summary(reports));
    for report in reports {
        text += &format!("\n## {}\n", report.camera);
        for section in &report.sections {
            text += &format!("\n### {}\n{}", section.title, section.body);
        }
    }
    text
}

/// A line a quantity, a column a camera.
fn summary(reports: &[Report]) -> String {
    let mut quantities: Vec<&Reached> = Vec::new();
    for reached in reports.iter().flat_map(Report::reached) {
        if !quantities.iter().any(|q| q.quantity == reached.quantity) {
            quantities.push(reached);
        }
    }
    let heads: String = reports.iter().map(|r| format!(" {} |", r.camera)).collect();
    let mut text = format!("| quantity | bound |{heads}\n| --- | --- |{}\n", " --- |".repeat(reports.len()));
    for quantity in quantities {
        let of =
            |report: &Report| report.reached().find(|r| r.quantity == quantity.quantity).map_or("–".to_owned(), cell);
        let cells: String = reports.iter().map(|report| format!(" {} |", of(report))).collect();
        text += &format!("| {} | {} |{cells}\n", quantity.quantity.replace('_', " "), quantity.bound.text());
    }
    text
}

fn cell(reached: &Reached) -> String {
    let error = reached.error.map(|e| format!("{}{}", rounded(Some(e), 3), unit(short(reached.bound.unit))));
    let e_n = reached.e_n.map(|e| format!("E_n {}", rounded(Some(e), 2)));
    let text = [error, e_n].into_iter().flatten().collect::<Vec<_>>().join(", ");
    if reached.holds() { text } else { format!("**{text}**") }
}

/// Of a unit, the sign.
fn short(unit: &str) -> &str {
    unit.split(' ').next().unwrap_or_default()
}
