//! Calibrated cameras, and where they stand, in the files of other programs: the way back of the readers beside it.
//!
//! | format | file | models | centre of the top-left pixel |
//! | --- | --- | --- | --- |
//! | [`ros`] | `camera_info` YAML | perspective with up to 14 coefficients, fisheye of four | (0, 0) |
//! | [`ros`] | transforms YAML, the fields of `geometry_msgs/TransformStamped` | – | – |
//! | [`kalibr`] | camchain YAML | pinhole with radtan, equi, fov; omni; eucm; ds | (0, 0) |
//! | [`colmap`] | `cameras.txt`, `images.txt`, `points3D.txt` | perspective with up to eight coefficients, fisheyes, fov, division, eucm | (0.5, 0.5) |
//!
//! Each writes exactly what the camera is, or refuses it with the reason: nothing is fitted. Camera frames are x right, y down, z forward in all
//! three. A greatest field angle is beyond all of them and is not written.

pub mod colmap;
pub mod kalibr;
pub mod ros;

use etendue_projection::{Calibration, Model, Sense, model::Ideal, plane::DistortionTerms};
use glam::{DMat3, DQuat};

/// A camera by its name.
#[derive(Clone, Copy, Debug)]
pub struct NamedCamera<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its projection.
    pub calibration: &'a Calibration,
}

/// Why a format cannot say a camera: the rest of a sentence that begins with the camera.
pub type Refusal = String;

/// What a format says of a camera that it has no model of.
fn no_model(format: &str, model: &Model) -> Refusal {
    match model {
        Model::Perspective(_) => format!("{format} has no perspective model of as many coefficients"),
        _ => format!("{format} has no model for its projection"),
    }
}

/// Refuses a skew, which no format has a place for.
fn without_skew(format: &str, calibration: &Calibration) -> Result<(), Refusal> {
    match calibration.matrix().skew {
        0.0 => Ok(()),
        skew => Err(format!("{format} has no place for the skew of {skew} px in its camera matrix")),
    }
}

/// k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆ s₁ s₂ s₃ s₄ τx τy of a perspective camera; `None` where it is none that OpenCV knows.
fn perspective(model: &Model) -> Option<[f64; 14]> {
    match model {
        Model::Ideal(Ideal::Rectilinear) => Some([0.0; 14]),
        Model::Radial(radial) if radial.sense() == Sense::IdealToObserved => {
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

/// k₁ … k₄ of a polynomial fisheye; `None` where it is none, or has more.
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

/// As many of the coefficients as one of these counts holds, the rest being zero; `None` where no count holds them.
fn shortest(coefficients: &[f64], counts: &[usize]) -> Option<usize> {
    counts.iter().copied().find(|count| coefficients[*count..].iter().all(|c| *c == 0.0))
}

/// A number in decimal digits that gives the same number when it is read, always with a point: YAML 1.1 takes `1e-7` for a text.
fn number(value: f64) -> String {
    let text = format!("{value}");
    if text.contains('.') { text } else { format!("{text}.0") }
}

/// `[1.0, 2.0]`.
fn list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(", "))
}

/// A text in double quotes; what would end it is escaped.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.escape_default())
}

/// w, x, y, z of a rotation, w not below 0.
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
