//! docs/evidence/validation.md.

use crate::bounds::unit;
use crate::comparison::{BoundResult, rounded};

/// A part of a camera's report.
pub(crate) struct Section {
    pub(crate) title: &'static str,
    pub(crate) body: String,
    pub(crate) reached: Vec<BoundResult>,
}

/// What was found of a camera.
pub(crate) struct RecoveryReport {
    pub(crate) camera: &'static str,
    pub(crate) sections: Vec<Section>,
}

impl RecoveryReport {
    pub(crate) fn reached(&self) -> impl Iterator<Item = &BoundResult> {
        self.sections.iter().flat_map(|section| &section.reached)
    }
}

const INTRODUCTION: &str = "# Recovery of declared parameters

This page compares parameters measured in renders of charts with the declarations of the rendered cameras (`charts/*/camera.toml`), for users who rely on the camera model and on `measure`.

```sh
just validate     # writes this page; fails where a bound is broken
```

- Errors are measured minus declared. E_n follows ISO 13528; |E_n| > 1 is a difference. Of about twenty quantities that agree, one is expected to differ by chance.
- A bound holds where the error is within it, or, with \"or 3 u\", within three standard uncertainties (|E_n| ≤ 1.5). Broken bounds are **bold**.
- The distance of the dots is not near a multiple of a pixel or of the mosaic's tile: otherwise errors of neighbours are correlated and shift the centre of distortion.
- Photon transfer excludes border pixels, which have fewer neighbours for crosstalk, and uses exposures too short for dark current to add to the offset pattern. Flat fields are measured above the dark-current reading.
- Responses are means of all edges over the field, from means of many frames over a flat field (no noise, PRNU or DSNU), corrected for shading; mosaics use green raw values.
- Diffraction is declared in a separate file for the last response. Edges lie 5° from rows and columns; along diagonals the film loses up to 0.06 of a point spread about as wide as a pixel (crates/optics/src/effects/band.rs).
";

/// The whole page.
pub(crate) fn page(reports: &[RecoveryReport]) -> String {
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
fn summary(reports: &[RecoveryReport]) -> String {
    let mut quantities: Vec<&BoundResult> = Vec::new();
    for result in reports.iter().flat_map(RecoveryReport::reached) {
        if !quantities.iter().any(|q| q.quantity == result.quantity) {
            quantities.push(result);
        }
    }
    let heads: String = reports.iter().map(|r| format!(" {} |", r.camera)).collect();
    let mut text = format!("| quantity | bound |{heads}\n| --- | --- |{}\n", " --- |".repeat(reports.len()));
    for quantity in quantities {
        let cell_text = |report: &RecoveryReport| {
            report.reached().find(|r| r.quantity == quantity.quantity).map_or("–".to_owned(), cell)
        };
        let cells: String = reports.iter().map(|report| format!(" {} |", cell_text(report))).collect();
        text += &format!("| {} | {} |{cells}\n", quantity.quantity.replace('_', " "), quantity.bound.text());
    }
    text
}

fn cell(result: &BoundResult) -> String {
    let error = result.error.map(|e| format!("{}{}", rounded(Some(e), 3), unit(short(result.bound.unit))));
    let e_n = result.e_n.map(|e| format!("E_n {}", rounded(Some(e), 2)));
    let text = [error, e_n].into_iter().flatten().collect::<Vec<_>>().join(", ");
    if result.holds() { text } else { format!("**{text}**") }
}

/// Of a unit, the sign.
fn short(unit: &str) -> &str {
    unit.split(' ').next().unwrap_or_default()
}
