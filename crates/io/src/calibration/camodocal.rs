//! camodocal's camera files, YAML, which VINS-Mono, VINS-Fusion and KITTI-360 use.
//!
//! | model_type | parameters |
//! | --- | --- |
//! | PINHOLE | projection fx, fy, cx, cy; distortion k1, k2, p1, p2 |
//! | PINHOLE_FULL | the same, and k3 … k6 |
//! | MEI | mirror xi; projection gamma1, gamma2, u0, v0; distortion k1, k2, p1, p2 |
//! | KANNALA_BRANDT | projection mu, mv, u0, v0 and k2 … k5, of which some programs make distortion parameters: r = θ + k2 θ³ + … |
//! | SCARAMUZZA | poly p0, p1, …; inv_poly; affine ac, ad, ae, cx, cy: u = ac x + ad y + cx, v = ae x + y + cy |
//!
//! A parameter that is not stated is 0, as in camodocal. The centre of the top-left pixel is (0, 0).

use etendue_projection::{Calibration, CameraMatrix, Model};

use super::models::{fisheye, invalid_model, perspective, unified};
use super::ocam;
use super::yaml::{self, TreeNode};
use super::{ErrorCode, ReaderResult, TreeError, TreeResult, camera_error, passed_over};

const KNOWN: [&str; 4] = ["model_type", "camera_name", "image_width", "image_height"];
const PROJECTION: &str = "projection_parameters";
const DISTORTION: &str = "distortion_parameters";
const MIRROR: &str = "mirror_parameters";

pub(super) fn read(text: &str) -> TreeResult<ReaderResult> {
    let root = yaml::parse(text)?;
    let model_type = root.key("model_type")?;
    let size_px = [root.key("image_width")?.count()?, root.key("image_height")?.count()?];
    let name = root.find("camera_name").map_or(Ok(""), TreeNode::text)?;
    let camera = match model_type.text()?.to_ascii_uppercase().as_str() {
        "PINHOLE" => pinhole(&root, &["k1", "k2", "p1", "p2"])?,
        "PINHOLE_FULL" => pinhole(&root, &["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"])?,
        "MEI" => mei(&root)?,
        "KANNALA_BRANDT" => kannala_brandt(&root)?,
        "SCARAMUZZA" => scaramuzza(&root, size_px)?,
        other => {
            return Err(TreeError::coded(
                ErrorCode::UnsupportedFile,
                model_type.line,
                format!(
                    "unknown model type {other}; expected PINHOLE, PINHOLE_FULL, MEI, KANNALA_BRANDT or SCARAMUZZA"
                ),
            ));
        }
    };
    let CamodocalCamera { model, matrix, sections, note } = camera;
    let calibration = Calibration::new(model, matrix.from_opencv(), size_px).map_err(camera_error(model_type.line))?;
    let mut notes = passed_over(&root.others(&[&KNOWN[..], sections].concat()));
    notes.extend(note);
    Ok(ReaderResult::new(name, calibration, notes))
}

/// A camera, and the sections of the file that describe it.
struct CamodocalCamera {
    model: Model,
    matrix: CameraMatrix,
    sections: &'static [&'static str],
    note: Option<String>,
}

/// The section of a file, with all its keys known.
fn section<'a>(root: &'a TreeNode, name: &str, known: &[&str]) -> TreeResult<&'a TreeNode> {
    let section = root.key(name)?;
    if section.entries().is_empty() && !section.text().is_ok_and(str::is_empty) {
        return Err(TreeError::at(section.line, format!("expected keys with values: {}", known.join(", "))));
    }
    match section.others(known).first() {
        None => Ok(section),
        Some(other) => Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            section.line,
            format!("{name} contains {other}, which is not supported; expected {}", known.join(", ")),
        )),
    }
}

fn or_zero(section: &TreeNode, name: &str) -> TreeResult<f64> {
    section.find(name).map_or(Ok(0.0), TreeNode::number)
}

/// Camera matrix of four required keys of the projection.
fn matrix(projection: &TreeNode, [fx, fy, cx, cy]: [&str; 4]) -> TreeResult<CameraMatrix> {
    let number = |name: &str| projection.key(name)?.number();
    Ok(CameraMatrix { fx: number(fx)?, fy: number(fy)?, skew: 0.0, cx: number(cx)?, cy: number(cy)? })
}

fn pinhole(root: &TreeNode, names: &[&str]) -> TreeResult<CamodocalCamera> {
    let keys = ["fx", "fy", "cx", "cy"];
    let matrix = matrix(section(root, PROJECTION, &keys)?, keys)?;
    let distortion = section(root, DISTORTION, names)?;
    let k = names.iter().map(|name| or_zero(distortion, name)).collect::<TreeResult<Vec<f64>>>()?;
    let model = perspective(distortion.line, &k)?;
    Ok(CamodocalCamera { model, matrix, sections: &[PROJECTION, DISTORTION], note: None })
}

fn mei(root: &TreeNode) -> TreeResult<CamodocalCamera> {
    let keys = ["gamma1", "gamma2", "u0", "v0"];
    let matrix = matrix(section(root, PROJECTION, &keys)?, keys)?;
    let xi = section(root, MIRROR, &["xi"])?.key("xi")?;
    let distortion = section(root, DISTORTION, &["k1", "k2", "p1", "p2"])?;
    let k = |name: &str| or_zero(distortion, name);
    let model = unified(xi.number()?, [k("k1")?, k("k2")?, k("p1")?, k("p2")?]).map_err(invalid_model(xi.line))?;
    Ok(CamodocalCamera { model, matrix, sections: &[PROJECTION, DISTORTION, MIRROR], note: None })
}

fn kannala_brandt(root: &TreeNode) -> TreeResult<CamodocalCamera> {
    let (keys, names) = (["mu", "mv", "u0", "v0"], ["k2", "k3", "k4", "k5"]);
    let projection = section(root, PROJECTION, &[keys, names].concat())?;
    let matrix = matrix(projection, keys)?;
    let distortion = match root.find(DISTORTION) {
        Some(_) => section(root, DISTORTION, &names)?,
        None => projection,
    };
    let k = |name: &str| or_zero(if distortion.find(name).is_some() { distortion } else { projection }, name);
    let model = fisheye(distortion.line, &[k("k2")?, k("k3")?, k("k4")?, k("k5")?])?;
    Ok(CamodocalCamera { model, matrix, sections: &[PROJECTION, DISTORTION], note: None })
}

fn scaramuzza(root: &TreeNode, size_px: [usize; 2]) -> TreeResult<CamodocalCamera> {
    let poly = root.key("poly_parameters")?;
    let direct = polynomial(poly)?;
    let inverse = root.find("inv_poly_parameters").map_or(Ok(Vec::new()), polynomial)?;
    let affine = section(root, "affine_parameters", &["ac", "ad", "ae", "cx", "cy"])?;
    let number = |name: &str| affine.key(name)?.number();
    let stretch = [number("ac")?, number("ad")?, number("ae")?];
    let model = ocam::column_first(direct.clone(), stretch, poly.line)?;
    let matrix = CameraMatrix { fx: 1.0, fy: 1.0, skew: 0.0, cx: number("cx")?, cy: number("cy")? };
    let sections = &["poly_parameters", "inv_poly_parameters", "affine_parameters"];
    Ok(CamodocalCamera { model, matrix, sections, note: ocam::note(&direct, &inverse, size_px) })
}

/// p0, p1, … in their order, without zeros at the end.
fn polynomial(section: &TreeNode) -> TreeResult<Vec<f64>> {
    let count = section.entries().len();
    let mut coefficients: Vec<f64> =
        (0..count).map(|i| section.key(&format!("p{i}"))?.number()).collect::<TreeResult<_>>()?;
    while coefficients.last() == Some(&0.0) {
        coefficients.pop();
    }
    Ok(coefficients)
}
