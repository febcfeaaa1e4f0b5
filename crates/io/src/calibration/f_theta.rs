//! NVIDIA's f-theta cameras, JSON: rig files of DriveWorks and camera models of NCore.
//!
//! | DriveWorks (properties of a sensor) | NCore | is |
//! | --- | --- | --- |
//! | Model = "ftheta" | – | the model; any other is refused |
//! | width, height | resolution | image size, px |
//! | cx, cy | principal_point | the principal point; the centre of the top-left pixel is (0, 0) |
//! | polynomial-type | reference_poly | direction of the polynomial |
//! | polynomial, or bw-poly (pixel distance to angle) | pixeldist_to_angle_poly, angle_to_pixeldist_poly | c₀ … (px, rad), c₀ = 0 |
//! | linear-c, linear-d, linear-e | linear_cde | x′ = c x + d y, y′ = e x + y; 1, 0, 0 where absent or all 0 |
//! | – | max_angle | the field angle up to which it holds, rad; up to 180° where absent |
//!
//! The properties may stand at the root, under `properties`, or in `rig.sensors` with a `name`; NCore's parameters at the root or under
//! `camera_model_parameters`. Of NCore's two polynomials the one that `reference_poly` names is read; the other is a fit to its inverse, and the exact inverse
//! is used. A second distortion by a windscreen (`external_distortion_parameters`) is refused.

use core::f64::consts::PI;

use etendue_projection::model::{FTheta, FThetaSense};
use etendue_projection::{Calibration, CameraMatrix, Model, plane::Affine};

use super::yaml::{self, TreeNode};
use super::{ErrorCode, ReaderResult, TreeError, TreeResult, camera_error, models::invalid_model, passed_over};

const DRIVE_WORKS: [&str; 11] = [
    "Model",
    "width",
    "height",
    "cx",
    "cy",
    "polynomial",
    "polynomial-type",
    "bw-poly",
    "linear-c",
    "linear-d",
    "linear-e",
];
const NCORE: [&str; 6] =
    ["resolution", "principal_point", "reference_poly", "max_angle", "linear_cde", "external_distortion_parameters"];
const POLYNOMIALS: [&str; 2] = ["pixeldist_to_angle_poly", "angle_to_pixeldist_poly"];

pub(super) fn read(text: &str, camera: Option<&str>) -> TreeResult<ReaderResult> {
    let root = yaml::parse(text)?;
    if let Some(rig) = root.find("rig") {
        let (name, properties) = sensor(rig, camera)?;
        return Ok(ReaderResult { name, ..drive_works(properties)? });
    }
    let node = root.find("properties").or_else(|| root.find("camera_model_parameters")).unwrap_or(&root);
    if node.find("resolution").is_some() { ncore(node) } else { drive_works(node) }
}

/// Camera of a rig: the named one, or the only f-theta camera.
fn sensor<'a>(rig: &'a TreeNode, camera: Option<&str>) -> TreeResult<(String, &'a TreeNode)> {
    let sensors = rig.key("sensors")?.items().unwrap_or_default();
    let cameras = sensors.iter().filter_map(|sensor| {
        let (name, properties) = (sensor.find("name")?.text().ok()?, sensor.find("properties")?);
        is_f_theta(properties).then_some((name, properties))
    });
    let cameras: Vec<(&str, &TreeNode)> = cameras.collect();
    let names = cameras.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let chosen = match (camera, &cameras[..]) {
        (_, []) => {
            return Err(TreeError::at(rig.line, "contains no f-theta camera (properties with Model = \"ftheta\")"));
        }
        (None, [only]) => Some(only),
        (None, _) => {
            return Err(TreeError::coded(
                ErrorCode::UnknownName,
                rig.line,
                format!("contains the f-theta cameras {names}; select one by its name"),
            ));
        }
        (Some(wanted), _) => cameras.iter().find(|(name, _)| *name == wanted),
    };
    let requested = camera.unwrap_or_default();
    let what = || format!("contains no f-theta camera \"{requested}\"; it contains {names}");
    chosen.map(|(name, properties)| ((*name).to_owned(), *properties)).ok_or_else(|| TreeError::at(rig.line, what()))
}

fn is_f_theta(properties: &TreeNode) -> bool {
    properties.find("Model").and_then(|model| model.text().ok()) == Some("ftheta")
}

/// Parameters that both formats state.
struct Numbers {
    line: usize,
    size_px: [usize; 2],
    centre_px: [f64; 2],
    sense: FThetaSense,
    polynomial: Vec<f64>,
    greatest_angle_rad: f64,
    linear: [f64; 3],
}

fn drive_works(node: &TreeNode) -> TreeResult<ReaderResult> {
    let model = node.key("Model")?;
    if !is_f_theta(node) {
        return Err(TreeError::coded(ErrorCode::UnsupportedFile, model.line, "expected the model \"ftheta\""));
    }
    let or_zero = |key: &str| node.find(key).map_or(Ok(0.0), TreeNode::number);
    let (sense, polynomial) = match node.find("polynomial") {
        Some(polynomial) => (sense(node.key("polynomial-type")?)?, polynomial),
        None => (FThetaSense::RadiusToAngle, node.any(&["polynomial", "bw-poly"])?),
    };
    let numbers = Numbers {
        line: polynomial.line,
        size_px: [node.key("width")?.count()?, node.key("height")?.count()?],
        centre_px: [node.key("cx")?.number()?, node.key("cy")?.number()?],
        sense,
        polynomial: words(polynomial)?,
        greatest_angle_rad: PI,
        linear: [or_zero("linear-c")?, or_zero("linear-d")?, or_zero("linear-e")?],
    };
    reader_result(numbers, passed_over(&node.others(&DRIVE_WORKS)))
}

fn ncore(node: &TreeNode) -> TreeResult<ReaderResult> {
    if let Some(external) = node.find("external_distortion_parameters")
        && external.text().ok().is_none_or(|text| !matches!(text, "" | "null"))
    {
        return Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            external.line,
            "distortion by a windscreen is not supported; expected null",
        ));
    }
    let [width, height] = node.key("resolution")?.items().unwrap_or_default() else {
        return Err(TreeError::at(node.key("resolution")?.line, "expected [width, height]"));
    };
    let sense = sense(node.key("reference_poly")?)?;
    let read = POLYNOMIALS[usize::from(sense == FThetaSense::AngleToRadius)];
    let polynomial = node.key(read)?;
    let numbers = Numbers {
        line: polynomial.line,
        size_px: [width.count()?, height.count()?],
        centre_px: node.key("principal_point")?.exactly("u, v")?,
        sense,
        polynomial: polynomial.numbers()?,
        greatest_angle_rad: node.find("max_angle").map_or(Ok(PI), TreeNode::number)?,
        linear: node.find("linear_cde").map_or(Ok([0.0; 3]), |node| node.exactly("c, d, e"))?,
    };
    reader_result(numbers, passed_over(&node.others(&[&NCORE[..], &[read]].concat())))
}

fn sense(node: &TreeNode) -> TreeResult<FThetaSense> {
    match node.text()? {
        "pixeldistance-to-angle" | "PIXELDIST_TO_ANGLE" => Ok(FThetaSense::RadiusToAngle),
        "angle-to-pixeldistance" | "ANGLE_TO_PIXELDIST" => Ok(FThetaSense::AngleToRadius),
        other => {
            let known = "pixeldistance-to-angle, angle-to-pixeldistance, PIXELDIST_TO_ANGLE, ANGLE_TO_PIXELDIST";
            Err(TreeError::coded(
                ErrorCode::UnsupportedFile,
                node.line,
                format!("unknown polynomial type {other}; expected one of {known}"),
            ))
        }
    }
}

/// Numbers of a list, or of one text.
fn words(node: &TreeNode) -> TreeResult<Vec<f64>> {
    let Ok(text) = node.text() else { return node.numbers() };
    let number = |word: &str| {
        let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
        number.ok_or_else(|| {
            TreeError::at(node.line, format!("found \"{word}\"; expected a coefficient of the polynomial, a number"))
        })
    };
    text.split_whitespace().map(number).collect()
}

fn reader_result(numbers: Numbers, notes: Vec<String>) -> TreeResult<ReaderResult> {
    let Numbers { line, size_px, centre_px: [cx, cy], sense, polynomial, greatest_angle_rad, linear } = numbers;
    let [c, d, e] = if linear == [0.0; 3] { [1.0, 0.0, 0.0] } else { linear };
    if c <= 0.0 {
        return Err(TreeError::at(line, format!("the linear term c is {c}; expected a positive number")));
    }
    // (c x + d y, e x + y) stretches columns; `Affine` stretches rows: c goes into the unit of the radius.
    let stretch = Affine { c: 1.0 / c, d: e / c, e: d / c };
    let model =
        FTheta::new(sense, enlarged(sense, polynomial, c), greatest_angle_rad, stretch).map_err(invalid_model(line))?;
    let matrix = CameraMatrix { fx: 1.0, fy: 1.0, skew: 0.0, cx, cy }.from_opencv();
    let calibration = Calibration::new(Model::FTheta(model), matrix, size_px).map_err(camera_error(line))?;
    Ok(ReaderResult::new("", calibration, notes))
}

/// Polynomial of a radius that is `ratio` times as large.
fn enlarged(sense: FThetaSense, polynomial: Vec<f64>, ratio: f64) -> Vec<f64> {
    let factors = std::iter::successors(Some(1.0), |factor| Some(factor / ratio));
    match sense {
        FThetaSense::AngleToRadius => polynomial.into_iter().map(|c| c * ratio).collect(),
        FThetaSense::RadiusToAngle => polynomial.into_iter().zip(factors).map(|(c, factor)| c * factor).collect(),
    }
}
