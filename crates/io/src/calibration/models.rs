//! Models that several formats share, from their coefficients, with errors at the line of the coefficients.

use etendue_projection::model::{KannalaBrandt, ModelError, Perspective, Unified};
use etendue_projection::{Model, plane::DistortionTerms};

use super::{TreeError, TreeResult};

/// Perspective camera with 0, 4, 5, 8, 12 or 14 coefficients in the order of OpenCV.
pub(super) fn perspective(line: usize, k: &[f64]) -> TreeResult<Model> {
    Perspective::from_opencv(k).map(Model::Perspective).map_err(invalid_model(line))
}

/// Polynomial fisheye with k₁ … k₄.
pub(super) fn fisheye(line: usize, k: &[f64]) -> TreeResult<Model> {
    let k = k
        .try_into()
        .map_err(|_| TreeError::at(line, format!("the number of values is {}; expected k1, k2, k3, k4", k.len())))?;
    KannalaBrandt::new(k).map(Model::KannalaBrandt).map_err(invalid_model(line))
}

/// Unified camera with ξ, k₁, k₂, p₁, p₂.
pub(super) fn unified(xi: f64, [k1, k2, p1, p2]: [f64; 4]) -> Result<Model, ModelError> {
    let terms = DistortionTerms { numerator: [k1, k2, 0.0, 0.0], tangential: [p1, p2], ..Default::default() };
    Unified::new(xi, terms).map(Model::Unified)
}

/// Error of a model, reported at the line of its coefficients.
pub(super) fn invalid_model(line: usize) -> impl Fn(ModelError) -> TreeError {
    move |cause| TreeError::at(line, cause.to_string())
}
