//! Kalibr's camera chain (`camchain.yaml`): cameras by name (`cam0`, `cam1`, …).
//!
//! | camera_model | intrinsics | distortion_model |
//! | --- | --- | --- |
//! | pinhole | fu, fv, pu, pv | radtan (k1, k2, p1, p2), equi (k1 … k4), fov (ω), none |
//! | omni | ξ, fu, fv, pu, pv | radtan, none |
//! | eucm | α, β, fu, fv, pu, pv | none |
//! | ds | ξ, α, fu, fv, pu, pv | none |

use etendue_projection::model::{DoubleSphere, ExtendedUnified, FieldOfView, Perspective};
use etendue_projection::{Calibration, CameraMatrix, Model};

use super::opencv::{fisheye, unified, wrong};
use super::yaml::{self, TreeNode, list};
use super::{ErrorCode, ReaderResult, TreeError, TreeResult, camera_error, passed_over};

const KNOWN: [&str; 5] = ["camera_model", "intrinsics", "distortion_model", "distortion_coeffs", "resolution"];

pub(super) fn read(text: &str, camera: Option<&str>) -> TreeResult<ReaderResult> {
    let root = yaml::parse(text)?;
    let (name, node) = chosen(&root, camera)?;
    let resolution = node.key("resolution")?;
    let size_px = match resolution.items() {
        Some([width, height]) => [width.count()?, height.count()?],
        _ => return Err(TreeError::at(resolution.line, "expected [width, height]")),
    };
    let (model, focal_and_centre) = model(node)?;
    let [fx, fy, cx, cy] = focal_and_centre;
    let matrix = CameraMatrix { fx, fy, skew: 0.0, cx, cy }.from_opencv();
    let calibration = Calibration::new(model, matrix, size_px).map_err(camera_error(node.line))?;
    Ok(ReaderResult { name: name.to_owned(), calibration, notes: passed_over(&node.others(&KNOWN)) })
}

fn chosen<'a>(root: &'a TreeNode, camera: Option<&str>) -> TreeResult<(&'a str, &'a TreeNode)> {
    let names = root.keys();
    match (root.entries(), camera) {
        (entries, Some(requested)) => {
            entries.iter().find(|(name, _)| name == requested).map(|(name, node)| (name.as_str(), node)).ok_or_else(
                || {
                    TreeError::coded(
                        ErrorCode::UnknownName,
                        0,
                        format!("contains no camera \"{requested}\"; it contains {}", list(&names)),
                    )
                },
            )
        }
        ([(name, node)], None) => Ok((name, node)),
        _ => Err(TreeError::coded(
            ErrorCode::UnknownName,
            0,
            format!("contains the cameras {}; select one by its name", list(&names)),
        )),
    }
}

/// The model, and fx, fy, cx, cy.
fn model(node: &TreeNode) -> TreeResult<(Model, [f64; 4])> {
    let camera = node.key("camera_model")?;
    let intrinsics = node.key("intrinsics")?;
    match camera.text()? {
        "pinhole" => Ok((pinhole(node)?, intrinsics.exactly("fu, fv, pu, pv")?)),
        "omni" => {
            let [xi, rest @ ..] = intrinsics.exactly::<5>("xi, fu, fv, pu, pv")?;
            Ok((omni(node, xi)?, rest))
        }
        "eucm" => {
            let [alpha, beta, rest @ ..] = intrinsics.exactly::<6>("alpha, beta, fu, fv, pu, pv")?;
            no_distortion(node)?;
            let model = ExtendedUnified::new(alpha, beta).map_err(wrong(intrinsics.line))?;
            Ok((Model::ExtendedUnified(model), rest))
        }
        "ds" => {
            let [xi, alpha, rest @ ..] = intrinsics.exactly::<6>("xi, alpha, fu, fv, pu, pv")?;
            no_distortion(node)?;
            let model = DoubleSphere::new(xi, alpha).map_err(wrong(intrinsics.line))?;
            Ok((Model::DoubleSphere(model), rest))
        }
        other => Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            camera.line,
            format!("unknown camera model \"{other}\"; expected \"pinhole\", \"omni\", \"eucm\" or \"ds\""),
        )),
    }
}

fn pinhole(node: &TreeNode) -> TreeResult<Model> {
    let name = node.key("distortion_model")?;
    match name.text()? {
        "radtan" => {
            let coefficients = node.key("distortion_coeffs")?;
            let k: [f64; 4] = coefficients.exactly("k1, k2, p1, p2")?;
            Perspective::from_opencv(&k).map(Model::Perspective).map_err(wrong(coefficients.line))
        }
        "equi" => {
            let coefficients = node.key("distortion_coeffs")?;
            fisheye(coefficients.line, &coefficients.numbers()?)
        }
        "fov" => {
            let coefficients = node.key("distortion_coeffs")?;
            let [omega] = coefficients.exactly("omega")?;
            FieldOfView::new(omega).map(Model::FieldOfView).map_err(wrong(coefficients.line))
        }
        "none" => no_distortion(node).map(|()| Model::Perspective(Perspective::pinhole())),
        other => Err(unknown(name, other, "for \"pinhole\", expected \"radtan\", \"equi\", \"fov\" or \"none\"")),
    }
}

fn omni(node: &TreeNode, xi: f64) -> TreeResult<Model> {
    let name = node.key("distortion_model")?;
    let k = match name.text()? {
        "radtan" => node.key("distortion_coeffs")?.exactly("k1, k2, p1, p2")?,
        "none" => no_distortion(node).map(|()| [0.0; 4])?,
        other => return Err(unknown(name, other, "for \"omni\", expected \"radtan\" or \"none\"")),
    };
    unified(xi, k).map_err(wrong(node.key("intrinsics")?.line))
}

/// Refuses any distortion except `none`, and coefficients of `none`.
fn no_distortion(node: &TreeNode) -> TreeResult<()> {
    let name = node.key("distortion_model")?;
    let stated = name.text()?;
    if stated != "none" {
        return Err(unknown(name, stated, "for this camera model, expected \"none\""));
    }
    match node.find("distortion_coeffs") {
        Some(list) if !list.numbers()?.is_empty() => Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            list.line,
            "the distortion model \"none\" has no coefficients; expected []",
        )),
        _ => Ok(()),
    }
}

fn unknown(name: &TreeNode, stated: &str, known: &str) -> TreeError {
    TreeError::coded(
        ErrorCode::UnsupportedFile,
        name.line,
        format!("the distortion model \"{stated}\" is not supported; {known}"),
    )
}
