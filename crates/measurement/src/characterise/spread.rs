//! Point spread: blur of slanted edges beyond the pixel aperture.

use etendue_io::failure::Error;
use etendue_metrology::sfr::{Blur, Orientation, Sfr, blur};

use super::parameter::{Findings, ImageKind};
use super::{folder::Laboratory, shot::LaboratoryImage};
use crate::measure::sfr::responses;
use crate::measure::{MeasurementInput, Selection, SfrRequest, SignalLevels, TruthInput};
use crate::report::{Estimate, Report};

const QUANTITY: &str = "point spread";
/// Reach of the profile's fine detail, in pixels of one colour.
const REACH_PX: f64 = 6.0;

/// Blur along rows (from edges near columns) and along columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub(super) along_rows: Option<Blur>,
    pub(super) along_columns: Option<Blur>,
}

pub(super) fn measure(laboratory: &Laboratory, findings: &mut Findings) -> Result<Option<Spread>, Error> {
    let shots = laboratory.shots(ImageKind::Edges);
    if shots.is_empty() {
        findings.missing(QUANTITY, ImageKind::Edges);
        return Ok(None);
    }
    let (mut all, mut first) = (Vec::new(), None);
    for shot in shots {
        let result = responses(&request(laboratory, shot));
        let Some((report, edges)) = findings.record(QUANTITY, result)? else { return Ok(None) };
        all.extend(edges);
        first.get_or_insert(report);
    }
    let Some(report) = first else { return Ok(None) };
    let blurs_along = |orientation: Orientation| {
        let edges: Vec<&Sfr> = all.iter().filter(|edge| edge.orientation == orientation).collect();
        blur(&edges)
    };
    let spread =
        Spread { along_rows: blurs_along(Orientation::Vertical), along_columns: blurs_along(Orientation::Horizontal) };
    spread.report_results(report, findings);
    Ok(Some(spread))
}

fn request(laboratory: &Laboratory, shot: &LaboratoryImage) -> SfrRequest {
    let camera = &laboratory.camera;
    let mosaic = shot.is_raw() && camera.is_mosaic();
    let regions = laboratory.stated.edges.iter().flat_map(|edges| &edges.regions_px);
    let edges: Vec<[usize; 4]> = regions.map(|region| region.value.map(|n| n as usize)).collect();
    let truth = laboratory.truth(ImageKind::Edges).filter(|_| edges.is_empty());
    let input = MeasurementInput {
        selection: Selection {
            channel: camera.channel().filter(|_| mosaic),
            cfa: camera.stated_cfa.clone().filter(|_| mosaic),
            ..Selection::default()
        },
        levels: SignalLevels::default(),
        truth: TruthInput { truth, camera: None },
    };
    let reach = if mosaic { 2.0 * REACH_PX } else { REACH_PX };
    let pixel_pitch_um = camera.pixel_pitch_um;
    SfrRequest {
        edges,
        edge_degree: 2,
        shading_degree: 1,
        reach_px: Some(reach),
        pixel_pitch_um,
        input,
        ..SfrRequest::new(&shot.file)
    }
}

/// True if a blur differs significantly from zero: more than two standard uncertainties above 0.
pub(super) fn is_significant(e: Estimate) -> bool {
    e.value > 2.0 * e.standard_uncertainty
}

impl Spread {
    /// Blurs with their names.
    fn blurs(&self) -> [(&'static str, &'static str, Option<Blur>); 2] {
        [("horizontal", "along rows", self.along_rows), ("vertical", "along columns", self.along_columns)]
    }

    fn report_results(&self, mut report: Report, findings: &mut Findings) {
        for (key, along, blur) in self.blurs() {
            let Some(blur) = blur else {
                let quantity = format!("point spread {along}");
                findings.unknown(
                    &quantity,
                    "fewer than three edges in edges/ cross this direction, or they do not determine it",
                );
                continue;
            };
            let (variance, exchange) = (format!("effects.psf.variance_{key}_px2"), format!("sensor.crosstalk.{key}"));
            findings.add_parameter(
                ImageKind::Edges,
                &variance,
                &format!("variance of the spread {along}"),
                "px²",
                blur.variance_px2,
            );
            findings.add_parameter(
                ImageKind::Edges,
                &exchange,
                &format!("exchange with neighbours {along}"),
                "",
                blur.exchange,
            );
            report.fact(
                &format!("misfit_{key}"),
                &format!("largest residual of the response {along}, after spread and exchange"),
                "",
                blur.misfit,
            );
        }
        findings.part("Response of slanted edges", ImageKind::Edges, report);
        findings.unknown(
            "point spread apart from exchange between pixels across corners",
            "edges near rows and columns determine only sums over columns and rows of neighbours",
        );
    }
}
