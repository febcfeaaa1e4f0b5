//! `measure ptc`: photon transfer after EMVA 1288, from the images of a descriptor to a report.

mod plots;
mod reading;
mod report;
mod request;

use std::sync::atomic::AtomicUsize;

use etendue_core::observer::Observer;
use etendue_io::emva_descriptor::{EmvaDescriptor, read_emva_descriptor};
use etendue_io::{failure::Error, photograph::SourcedEncoding};
use etendue_metrology::photon_transfer::Figures;

use super::{pictures::ImageProgress, readings::Selection};
use crate::report::Report;
use reading::GroupReader;

pub use request::PtcRequest;

pub(crate) use reading::{FrameGroup, groups, measure_groups};
pub(crate) use report::report;
pub(crate) use request::PtcResults;

/// Photon transfer after EMVA 1288 release 4.0 linear. Runs on the caller's thread pool.
///
/// # Errors
/// If the descriptor or an image cannot be used, or the series does not determine the results.
pub fn ptc(request: &PtcRequest, observer: &dyn Observer) -> Result<Report, Error> {
    let descriptor = read_emva_descriptor(&request.descriptor).map_err(Error::input)?;
    let results = measure(request, &descriptor, observer)?;
    let mut report = report(request, &results);
    report.encoding(&stated(&request.selection, &descriptor)?);
    Ok(report)
}

/// Encoding of a descriptor's images, from the first of them.
fn stated(selection: &Selection, descriptor: &EmvaDescriptor) -> Result<SourcedEncoding, Error> {
    let first = descriptor.levels.iter().find_map(|level| level.files.first()).expect("a descriptor has images");
    let photograph = selection.encoding.photograph(first)?;
    Ok(selection.encoding.raw(first, photograph)?.stated)
}

/// The figures of the curve, and the encoding of the images.
pub(crate) fn measured(request: &PtcRequest, observer: &dyn Observer) -> Result<(Figures, SourcedEncoding), Error> {
    let descriptor = read_emva_descriptor(&request.descriptor).map_err(Error::input)?;
    Ok((measure(request, &descriptor, observer)?.figures, stated(&request.selection, &descriptor)?))
}

fn measure(request: &PtcRequest, descriptor: &EmvaDescriptor, observer: &dyn Observer) -> Result<PtcResults, Error> {
    let total = descriptor.levels.iter().map(|level| level.files.len()).sum();
    let progress = ImageProgress { heading: "photon transfer", done: AtomicUsize::new(0), total, observer };
    GroupReader { selection: &request.selection, descriptor, pictures: progress }.results()
}
