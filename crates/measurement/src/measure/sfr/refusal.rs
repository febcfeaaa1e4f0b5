//! Why an edge was not measured.

use super::request::SfrRequest;
use crate::measure::picture_input::refused;
use crate::measure::truth::place::Sought;
use etendue_io::failure::Error;
use etendue_metrology::sfr::SfrError;

/// An edge that cannot be measured, by its picture and its place.
pub(super) fn failure(request: &SfrRequest, sought: &Sought, error: &SfrError) -> Error {
    let hint = shading_hint(request, error);
    refused(&request.picture, format!("edge at {},{}: {error}{hint}", sought.at[0], sought.at[1]))
}

/// What else may be tried where sides that are not even are taken for no edge.
pub(super) fn shading_hint(request: &SfrRequest, error: &SfrError) -> &'static str {
    match error {
        SfrError::NoEdge(_) if request.shading_degree == 0 => {
            "; where light falls off along the surfaces, `shading_degree` 1 takes that off"
        }
        _ => "",
    }
}
