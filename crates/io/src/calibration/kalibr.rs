//! Kalibr's camera chain (`camchain.yaml`): cameras by name (`cam0`, `cam1`, …). And `sensor.yaml` of EuRoC's format of data sets (ASL), which has one camera
//! in other keys.
//!
//! | camera_model | intrinsics | distortion_model |
//! | --- | --- | --- |
//! | pinhole | fu, fv, pu, pv | radtan (k1, k2, p1, p2), equidistant (k1 … k4), fov (ω), none |
//! | omni | ξ, fu, fv, pu, pv | radtan, none |
//! | eucm | α, β, fu, fv, pu, pv | none |
//! | ds | ξ, α, fu, fv, pu, pv | none |
//!
//! Kalibr's command line calls equidistant `equi`, and EuRoC's files call radtan `radial-tangential`; both are read in both. Some programs state the camera's
//! model and that of the distortion as one: `pinhole-equi`.

use etendue_projection::model::{DoubleSphere, ExtendedUnified, FieldOfView, Perspective};
use etendue_projection::{Calibration, CameraMatrix, Model};

use super::models::{fisheye, invalid_model, perspective, unified};
use super::yaml::{self, TreeNode};
use super::{ErrorCode, ReaderResult, TreeError, TreeResult, camera_error, passed_over, reader_result};

const KNOWN: [&str; 5] = ["camera_model", "intrinsics", "distortion_model", "distortion_coeffs", "resolution"];
const COEFFICIENTS: [&str; 2] = ["distortion_coeffs", "distortion_coefficients"];

pub(super) fn read(text: &str, requested: Option<&str>) -> TreeResult<ReaderResult> {
    let root = yaml::parse(text)?;
    // A chain may state other facts beside its cameras.
    let is_camera = |node: &TreeNode| node.find("camera_model").is_some() || node.find("intrinsics").is_some();
    let has_cameras = root.entries().iter().any(|(_, node)| is_camera(node));
    let cameras: Vec<(&str, &TreeNode)> = root
        .entries()
        .iter()
        .filter(|(_, node)| is_camera(node) || !has_cameras)
        .map(|(name, node)| (name.as_str(), node))
        .collect();
    let names: Vec<&str> = cameras.iter().map(|(name, _)| *name).collect();
    let (name, node) = cameras[reader_result::choose(&names, requested)?];
    let notes = passed_over(&node.others(&KNOWN));
    Ok(ReaderResult::new(name, camera(node)?, notes))
}

/// Reads EuRoC's `sensor.yaml`.
pub(super) fn read_euroc(text: &str) -> TreeResult<ReaderResult> {
    let root = yaml::parse(text)?;
    if let Some(sensor) = root.find("sensor_type")
        && sensor.text()? != "camera"
    {
        let what = format!("the sensor is of type \"{}\"; expected \"camera\"", sensor.text()?);
        return Err(TreeError::coded(ErrorCode::UnsupportedFile, sensor.line, what));
    }
    let known = [&KNOWN[..], &["sensor_type", "distortion_coefficients"]].concat();
    Ok(ReaderResult::new("", camera(&root)?, passed_over(&root.others(&known))))
}

fn camera(node: &TreeNode) -> TreeResult<Calibration> {
    let (model, focal_and_centre) = model(node)?;
    let [fx, fy, cx, cy] = focal_and_centre;
    let matrix = CameraMatrix { fx, fy, skew: 0.0, cx, cy }.from_opencv();
    Calibration::new(model, matrix, resolution(node)?).map_err(camera_error(node.line))
}

fn resolution(node: &TreeNode) -> TreeResult<[usize; 2]> {
    let resolution = node.key("resolution")?;
    match resolution.items() {
        Some([width, height]) => Ok([width.count()?, height.count()?]),
        None if !resolution.entries().is_empty() => {
            Ok([resolution.key("width")?.count()?, resolution.key("height")?.count()?])
        }
        _ => Err(TreeError::at(resolution.line, "expected [width, height]")),
    }
}

/// The model, and fx, fy, cx, cy.
fn model(node: &TreeNode) -> TreeResult<(Model, [f64; 4])> {
    let camera = node.key("camera_model")?;
    let intrinsics = node.key("intrinsics")?;
    let name = camera.text()?;
    match name.split('-').next().unwrap_or(name) {
        "pinhole" => Ok((pinhole(node)?, intrinsics.exactly("fu, fv, pu, pv")?)),
        "omni" => {
            let [xi, rest @ ..] = intrinsics.exactly::<5>("xi, fu, fv, pu, pv")?;
            Ok((omni(node, xi)?, rest))
        }
        "eucm" => {
            let [alpha, beta, rest @ ..] = intrinsics.exactly::<6>("alpha, beta, fu, fv, pu, pv")?;
            no_distortion(node)?;
            let model = ExtendedUnified::new(alpha, beta).map_err(invalid_model(intrinsics.line))?;
            Ok((Model::ExtendedUnified(model), rest))
        }
        "ds" => {
            let [xi, alpha, rest @ ..] = intrinsics.exactly::<6>("xi, alpha, fu, fv, pu, pv")?;
            no_distortion(node)?;
            let model = DoubleSphere::new(xi, alpha).map_err(invalid_model(intrinsics.line))?;
            Ok((Model::DoubleSphere(model), rest))
        }
        other => Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            camera.line,
            format!("unknown camera model \"{other}\"; expected \"pinhole\", \"omni\", \"eucm\" or \"ds\""),
        )),
    }
}

/// Name of a distortion and its line.
struct DistortionName<'a> {
    name: &'a str,
    line: usize,
}

/// Name of the distortion, in Kalibr's spelling: that of `distortion_model`, or the second part of `camera_model`.
fn distortion(node: &TreeNode) -> TreeResult<DistortionName<'_>> {
    let camera = node.key("camera_model")?;
    let joined = camera.text()?.split_once('-').map(|(_, distortion)| distortion);
    let spelled = |name| match name {
        "equi" => "equidistant",
        "radial-tangential" | "radial_tangential" => "radtan",
        name => name,
    };
    let (name, line) = match (node.find("distortion_model"), joined) {
        (Some(stated), Some(joined)) if spelled(stated.text()?) != spelled(joined) => {
            let what = format!("the camera model \"{}\" contradicts \"{}\"", camera.text()?, stated.text()?);
            return Err(TreeError::at(stated.line, what));
        }
        (None, Some(joined)) => (joined, camera.line),
        (stated, _) => {
            let stated = stated.map_or_else(|| node.key("distortion_model"), Ok)?;
            (stated.text()?, stated.line)
        }
    };
    Ok(DistortionName { name: spelled(name), line })
}

fn pinhole(node: &TreeNode) -> TreeResult<Model> {
    let distortion = distortion(node)?;
    match distortion.name {
        "radtan" => {
            let coefficients = node.any(&COEFFICIENTS)?;
            let k: [f64; 4] = coefficients.exactly("k1, k2, p1, p2")?;
            perspective(coefficients.line, &k)
        }
        "equidistant" => {
            let coefficients = node.any(&COEFFICIENTS)?;
            fisheye(coefficients.line, &coefficients.numbers()?)
        }
        "fov" => {
            let coefficients = node.any(&COEFFICIENTS)?;
            let [omega] = coefficients.exactly("omega")?;
            FieldOfView::new(omega).map(Model::FieldOfView).map_err(invalid_model(coefficients.line))
        }
        "none" => no_distortion(node).map(|()| Model::Perspective(Perspective::pinhole())),
        _ => Err(unknown(&distortion, "for \"pinhole\", expected \"radtan\", \"equidistant\", \"fov\" or \"none\"")),
    }
}

fn omni(node: &TreeNode, xi: f64) -> TreeResult<Model> {
    let distortion = distortion(node)?;
    let k = match distortion.name {
        "radtan" => node.any(&COEFFICIENTS)?.exactly("k1, k2, p1, p2")?,
        "none" => no_distortion(node).map(|()| [0.0; 4])?,
        _ => return Err(unknown(&distortion, "for \"omni\", expected \"radtan\" or \"none\"")),
    };
    unified(xi, k).map_err(invalid_model(node.key("intrinsics")?.line))
}

/// Refuses any distortion except `none`, and coefficients of `none`.
fn no_distortion(node: &TreeNode) -> TreeResult<()> {
    let distortion = distortion(node)?;
    if distortion.name != "none" {
        return Err(unknown(&distortion, "for this camera model, expected \"none\""));
    }
    match COEFFICIENTS.iter().find_map(|key| node.find(key)) {
        Some(list) if !list.numbers_or_none()?.is_empty() => Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            list.line,
            "the distortion model \"none\" has no coefficients; expected []",
        )),
        _ => Ok(()),
    }
}

fn unknown(distortion: &DistortionName<'_>, known: &str) -> TreeError {
    let what = format!("the distortion model \"{}\" is not supported; {known}", distortion.name);
    TreeError::coded(ErrorCode::UnsupportedFile, distortion.line, what)
}
