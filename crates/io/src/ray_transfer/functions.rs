//! Ray-transfer functions of one wavelength.

use etendue_scene::asset::{PassAsset, TermAsset, TransferAsset};

use crate::ErrorCode;
use crate::tree::{TreeError, TreeNode, TreeResult, passed_over};

/// Maximum power, and maximum number of terms of a polynomial.
const MAX_POWER: u8 = 32;
const MAX_TERMS: usize = 20_000;

const OUTPUTS: [&[&str]; 6] =
    [&["outx"], &["outy"], &["outz"], &["outdx", "outu"], &["outdy", "outv"], &["outdz", "outw"]];

/// Keys of the functions that are used.
const USED: [&str; 7] =
    ["wavelength_nm", "passnopass", "raypass", "circleRadii", "circleSensitivities", "circlePlaneZ", "poly"];

/// Functions, and the ignored keys.
pub(super) fn read(node: &TreeNode, output_offset_mm: f64, with_dz: bool) -> TreeResult<(TransferAsset, Vec<String>)> {
    let wavelength = node.key("wavelength_nm")?;
    let wavelength_nm = wavelength.number()?;
    if wavelength_nm <= 0.0 {
        return Err(TreeError::at(
            wavelength.line,
            format!("found {wavelength_nm}; expected a wavelength in nm above 0"),
        ));
    }
    let (pass_plane_mm, pass) = pass(node)?;
    let mut by_output: [Option<Vec<TermAsset>>; 6] = Default::default();
    let poly = node.key("poly")?;
    for item in poly.items().unwrap_or(std::slice::from_ref(poly)) {
        let name = item.key("outputname")?;
        let text = name.text()?;
        let Some(which) = OUTPUTS.iter().position(|names| names.contains(&text)) else {
            let known = OUTPUTS.concat().join(", ");
            return Err(TreeError::coded(
                ErrorCode::UnsupportedFile,
                name.line,
                format!("unknown output \"{text}\"; expected one of {known}"),
            ));
        };
        if by_output[which].replace(terms(item)?).is_some() {
            return Err(TreeError::coded(
                ErrorCode::Duplicate,
                name.line,
                format!("the output \"{text}\" is defined twice"),
            ));
        }
    }
    let [x, y, z, dx, dy, dz] = by_output;
    let needed = |terms: Option<Vec<TermAsset>>, name: &str| {
        terms.ok_or_else(|| TreeError::at(poly.line, format!("lacks the polynomial \"{name}\"")))
    };
    let plane = vec![TermAsset { coefficient: output_offset_mm, powers: [0; 3] }];
    let outputs =
        [needed(x, "outx")?, needed(y, "outy")?, z.unwrap_or(plane), needed(dx, "outdx")?, needed(dy, "outdy")?];
    let forwards = if with_dz { Some(needed(dz, "outdz")?) } else { None };
    let transfer = TransferAsset { wavelength_nm, pass, pass_plane_mm, outputs, forwards };
    Ok((transfer, passed_over(&node.others(&USED))))
}

fn terms(item: &TreeNode) -> TreeResult<Vec<TermAsset>> {
    let coefficients = item.key("coeff")?.numbers()?;
    let powers = [
        powers(item.key("termr")?)?,
        powers(item.any(&["termdx", "termu"])?)?,
        powers(item.any(&["termdy", "termv"])?)?,
    ];
    let counts = [coefficients.len(), powers[0].len(), powers[1].len(), powers[2].len()];
    if counts.iter().any(|count| *count != counts[0]) {
        let [c, r, dx, dy] = counts;
        let message = format!(
            "the numbers of coefficients ({c}) and of powers of r, dx and dy ({r}, {dx}, {dy}) differ; expected equal numbers"
        );
        return Err(TreeError::at(item.line, message));
    }
    if counts[0] > MAX_TERMS {
        return Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            item.line,
            format!("found {} terms; at most {MAX_TERMS} are supported", counts[0]),
        ));
    }
    let term = |(i, coefficient): (usize, f64)| TermAsset { coefficient, powers: [0, 1, 2].map(|k| powers[k][i]) };
    Ok(coefficients.into_iter().enumerate().map(term).collect())
}

fn powers(node: &TreeNode) -> TreeResult<Vec<u8>> {
    let power = |value: f64| {
        let is_valid = value.fract() == 0.0 && (0.0..=f64::from(MAX_POWER)).contains(&value);
        let message = || format!("found the power {value}; expected a whole number from 0 to {MAX_POWER}");
        if is_valid { Ok(value as u8) } else { Err(TreeError::at(node.line, message())) }
    };
    node.numbers()?.into_iter().map(power).collect()
}

/// Plane of the ray-pass function, and the region.
fn pass(node: &TreeNode) -> TreeResult<(f64, PassAsset)> {
    let Some(pass) = node.find("raypass").or_else(|| node.find("passnopass")) else {
        let (radii, sensitivities) = (node.key("circleRadii")?, node.key("circleSensitivities")?);
        return Ok((node.key("circlePlaneZ")?.number()?, circles(radii, sensitivities)?));
    };
    let plane_mm = pass.key("intersectPlaneDistance")?.number()?;
    let method = pass.key("method")?;
    match method.text()? {
        "minimalellipse" => Ok((plane_mm, ellipses(pass)?)),
        "circles" => Ok((plane_mm, circles(pass.key("radii")?, pass.key("sensitivities")?)?)),
        other => Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            method.line,
            format!("unknown method \"{other}\"; expected \"minimalellipse\" or \"circles\""),
        )),
    }
}

/// Maximum ellipses or circles per wavelength: some ten times the number in real files.
const MAX_REGIONS: usize = 4096;

fn ellipses(pass: &TreeNode) -> TreeResult<PassAsset> {
    let list = |key: &str| pass.key(key)?.numbers();
    let positions = pass.key("positions")?;
    let heights = positions.numbers()?;
    let [radii_x, radii_y] = [list("radiiX")?, list("radiiY")?];
    let [centres_x, centres_y] = [list("centersX")?, list("centersY")?];
    if [&radii_x, &radii_y, &centres_x, &centres_y].iter().any(|other| other.len() != heights.len()) {
        return Err(TreeError::at(
            positions.line,
            "the numbers of positions, radii and centres differ; expected equal numbers",
        ));
    }
    if heights.len() > MAX_REGIONS {
        return Err(TreeError::at(
            positions.line,
            format!("found {} positions; expected at most {MAX_REGIONS}", heights.len()),
        ));
    }
    let rising = heights.windows(2).all(|pair| pair[1] > pair[0]);
    if heights.first() != Some(&0.0) || !rising {
        return Err(TreeError::at(positions.line, "expected positions that increase from 0"));
    }
    let legal = radii_x.iter().chain(&radii_y).all(|r| *r >= 0.0) && radii_x[0] > 0.0 && radii_y[0] > 0.0;
    if !legal {
        return Err(TreeError::at(pass.key("radiiX")?.line, "expected radii of 0 or more, the first above 0"));
    }
    let ellipse = |(i, height): (usize, f64)| (height, [centres_x[i], centres_y[i]], [radii_x[i], radii_y[i]]);
    Ok(PassAsset::Ellipses(heights.into_iter().enumerate().map(ellipse).collect()))
}

fn circles(radii: &TreeNode, sensitivities: &TreeNode) -> TreeResult<PassAsset> {
    let (values, centres) = (radii.numbers()?, sensitivities.numbers()?);
    if values.len() > MAX_REGIONS {
        return Err(TreeError::at(
            radii.line,
            format!("found {} circles; expected at most {MAX_REGIONS}", values.len()),
        ));
    }
    if values.len() != centres.len() || values.is_empty() || values.iter().any(|r| *r <= 0.0) {
        return Err(TreeError::at(radii.line, "expected radii above 0, and the same number of sensitivities"));
    }
    Ok(PassAsset::Circles(values.into_iter().zip(centres).collect()))
}
