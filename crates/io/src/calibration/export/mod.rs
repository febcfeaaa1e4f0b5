//! Writers of calibrated cameras and their poses in the formats of other programs: the inverse of the readers in the parent module.
//!
//! | format | file | models | centre of the top-left pixel |
//! | --- | --- | --- | --- |
//! | [`ros`] | `camera_info` YAML | perspective with up to 14 coefficients, fisheye of four | (0, 0) |
//! | [`ros`] | transforms YAML, the fields of `geometry_msgs/TransformStamped` | – | – |
//! | [`kalibr`] | camchain YAML | pinhole with radtan, equidistant, fov; omni; eucm; ds | (0, 0) |
//! | [`colmap`] | `cameras.txt`, `images.txt`, `points3D.txt` | perspective with up to eight coefficients, fisheyes, fov, division, eucm | (0.5, 0.5) |
//!
//! Each writes the camera exactly, or refuses it with the reason: nothing is fitted. Camera frames are x right, y down, z forward in all three. None of them
//! has a maximum field angle, so it is not written.

pub mod colmap;
pub mod kalibr;
pub mod ros;

use etendue_projection::{Calibration, DistortionDirection, Model, model::Ideal, plane::DistortionTerms};
use glam::{DMat3, DQuat};

/// Camera with its name.
#[derive(Clone, Copy, Debug)]
pub struct NamedCamera<'a> {
    pub name: &'a str,
    /// Its projection.
    pub calibration: &'a Calibration,
}

/// Reason for which a format cannot represent a camera: the rest of a sentence that begins with the camera.
pub type ExportError = String;

/// Refusal of a camera whose model a format does not have.
fn no_model(format: &str, model: &Model) -> ExportError {
    match model {
        Model::Perspective(_) => format!("{format} has no perspective model with this number of coefficients"),
        _ => format!("{format} has no model for its projection"),
    }
}

/// Refuses a skew, which a format does not support.
fn without_skew(format: &str, calibration: &Calibration) -> Result<(), ExportError> {
    match calibration.matrix().skew {
        0.0 => Ok(()),
        skew => Err(format!("{format} cannot represent the skew of {skew} px in its camera matrix")),
    }
}

/// k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆ s₁ s₂ s₃ s₄ τx τy of a perspective camera; `None` if OpenCV has no such model.
fn perspective(model: &Model) -> Option<[f64; 14]> {
    match model {
        Model::Ideal(Ideal::Rectilinear) => Some([0.0; 14]),
        Model::Radial(radial) if radial.sense() == DistortionDirection::IdealToObserved => {
            let ([k1, k2], unit) = (radial.coefficients(), radial.unit_mm());
            let mut c = [0.0; 14];
            (c[0], c[1]) = (k1 / (unit * unit), k2 / (unit * unit * unit * unit));
            Some(c)
        }
        Model::Perspective(camera) => {
            let DistortionTerms { numerator, denominator, tangential, prism } = camera.distortion().terms();
            let ([k1, k2, k3, k_more], [k4, k5, k6]) = (numerator, denominator);
            let ([p1, p2], [s1, s2, s3, s4]) = (tangential, prism);
            let [tau_x, tau_y] = camera.tilt().map_or([0.0; 2], |tilt| tilt.angles_rad());
            (k_more == 0.0).then_some([k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y])
        }
        _ => None,
    }
}

/// k₁ … k₄ of a polynomial fisheye; `None` for other models, or more coefficients.
fn fisheye(model: &Model) -> Option<[f64; 4]> {
    match model {
        Model::Ideal(Ideal::Equidistant) => Some([0.0; 4]),
        Model::KannalaBrandt(camera) => match camera.coefficients() {
            [k1, k2, k3, k4, 0.0, 0.0] => Some([k1, k2, k3, k4]),
            _ => None,
        },
        _ => None,
    }
}

/// Smallest of the counts that holds all nonzero coefficients; `None` if none does.
fn shortest(coefficients: &[f64], counts: &[usize]) -> Option<usize> {
    counts.iter().copied().find(|count| coefficients[*count..].iter().all(|c| *c == 0.0))
}

/// Decimal text of a number that reads back to the same number, always with a decimal point: YAML 1.1 reads `1e-7` as text.
fn number(value: f64) -> String {
    let text = format!("{value}");
    if text.contains('.') { text } else { format!("{text}.0") }
}

/// `[1.0, 2.0]`.
fn list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(", "))
}

/// Text in double quotes, with quotes and backslashes escaped.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.escape_default())
}

/// Quaternion w, x, y, z of a rotation, w not below 0.
fn quaternion(rotation: &DMat3) -> [f64; 4] {
    let [x, y, z, w] = DQuat::from_mat3(rotation).to_array();
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    [w, x, y, z].map(|q| sign * q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point_and_come_back() {
        for value in [0.0, -0.0, 1.0, 1e-7, -2.5e20, 0.1, f64::MIN_POSITIVE] {
            let text = number(value);
            assert!(text.contains('.') && !text.contains('e'), "{text}");
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()), "{text}");
        }
        assert_eq!(list(&[1.0, -0.5]), "[1.0, -0.5]");
        assert_eq!(quoted("a \"b\""), "\"a \\\"b\\\"\"");
    }
}
