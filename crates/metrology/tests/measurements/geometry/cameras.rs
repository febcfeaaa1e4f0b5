//! Cameras for tests.

use etendue_projection::model::{KannalaBrandt, Perspective};
use etendue_projection::{Calibration, CameraMatrix, Model};

pub(crate) fn calibration(model: Model, f: f64, size_px: [usize; 2]) -> Calibration {
    // Off-centre, and not square, so that symmetry cannot hide errors.
    let [cx, cy] = [0.5 * size_px[0] as f64 + 6.3, 0.5 * size_px[1] as f64 - 4.7];
    let matrix = CameraMatrix { fx: f, fy: 1.003 * f, skew: 0.0, cx, cy };
    Calibration::new(model, matrix, size_px).expect("a camera")
}

pub(crate) fn perspective(f: f64, distortion: &[f64], size_px: [usize; 2]) -> Calibration {
    calibration(Model::Perspective(Perspective::from_opencv(distortion).expect("finite")), f, size_px)
}

pub(crate) fn fisheye(f: f64, size_px: [usize; 2]) -> Calibration {
    let k = [0.02, -0.005, 0.001, 0.0];
    calibration(Model::KannalaBrandt(KannalaBrandt::new(k).expect("finite")), f, size_px)
}
