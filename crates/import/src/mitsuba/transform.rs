//! Transforms, step by step, and uses of textures.

use etendue_core::maths::f64 as maths;
use etendue_io::Error;
use glam::{DAffine3, DMat3, DMat4, DVec3};

use super::access::{attribute_number, find, numbers_of, triple_of};
use crate::syntax::mitsuba::MitsubaElement;

/// Transform of a parameter; the identity if it is absent.
pub(super) fn transform_of(element: &MitsubaElement, name: &str) -> Result<DAffine3, Error> {
    let Some(parameter) = find(element, name) else { return Ok(DAffine3::IDENTITY) };
    if parameter.tag != "transform" {
        return Err(parameter.error(format!("\"{name}\": expected <transform>")));
    }
    let mut composed = DAffine3::IDENTITY;
    for step in &parameter.children {
        // Each acts in the space that the previous ones lead to.
        composed = step_transform(step)? * composed;
    }
    if !composed.is_finite() || composed.matrix3.determinant() == 0.0 {
        return Err(parameter.error("the transform is singular; correct its numbers"));
    }
    Ok(composed)
}

fn step_transform(step: &MitsubaElement) -> Result<DAffine3, Error> {
    let known: &[&str] = match step.tag {
        "rotate" => &["value", "x", "y", "z", "angle"],
        "lookat" => &["origin", "target", "up"],
        "matrix" => &["value"],
        _ => &["value", "x", "y", "z"],
    };
    if let Some((name, _)) = step.attributes.iter().find(|(name, _)| !known.contains(&&**name)) {
        return Err(step.error(format!(
            "unknown attribute \"{name:.40}\" of <{}>; expected {}",
            step.tag,
            known.join(", ")
        )));
    }
    match step.tag {
        "translate" => Ok(DAffine3::from_translation(triple_of(step, 0.0)?)),
        "scale" => Ok(DAffine3::from_scale(triple_of(step, 1.0)?)),
        "rotate" => {
            if step.attribute("angle").is_none() {
                return Err(step.error("<rotate> has no \"angle\""));
            }
            let degrees = attribute_number(step, "angle", 0.0)?;
            let axis =
                triple_of(step, 0.0)?.try_normalize().ok_or_else(|| step.error("the rotation axis has zero length"))?;
            Ok(DAffine3::from_mat3(rotation(degrees, axis)))
        }
        "lookat" => look_at(step),
        "matrix" => matrix(step),
        tag => Err(step.error(format!(
            "unknown element <{tag}> in a transform; expected translate, rotate, scale, lookat or matrix"
        ))),
    }
}

/// Rotation by Rodrigues' formula about a unit axis; degrees.
fn rotation(degrees: f64, axis: DVec3) -> DMat3 {
    let (s, c) = maths::sin_cos(degrees.to_radians());
    let column = |v: DVec3| c * v + s * axis.cross(v) + (1.0 - c) * axis.dot(v) * axis;
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

/// Camera transform: x to the left, y upwards, z forward.
fn look_at(step: &MitsubaElement) -> Result<DAffine3, Error> {
    let three = |name: &str| {
        let text = step.attribute(name).ok_or_else(|| step.error(format!("<lookat> has no \"{name}\"")))?;
        match numbers_of(text).map_err(|problem| step.error(problem))?[..] {
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => Err(step.error(format!("\"{name}\" of <lookat>: expected three numbers"))),
        }
    };
    let (origin, target) = (three("origin")?, three("target")?);
    let ahead = (target - origin)
        .try_normalize()
        .ok_or_else(|| step.error("\"origin\" and \"target\" of <lookat> coincide"))?;
    let up = match step.attribute("up") {
        Some(_) => three("up")?,
        None => ahead.any_orthonormal_vector(),
    };
    let left = up
        .cross(ahead)
        .try_normalize()
        .ok_or_else(|| step.error("\"up\" of <lookat> is parallel to the viewing direction"))?;
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(left, ahead.cross(left), ahead), origin))
}

/// Matrix, row by row.
fn matrix(step: &MitsubaElement) -> Result<DAffine3, Error> {
    let text = step.attribute("value").ok_or_else(|| step.error("<matrix> has no \"value\""))?;
    let numbers = numbers_of(text).map_err(|problem| step.error(problem))?;
    if let Ok(rows) = <[f64; 9]>::try_from(&numbers[..]) {
        return Ok(DAffine3::from_mat3(DMat3::from_cols_array(&rows).transpose()));
    }
    let rows = <[f64; 16]>::try_from(&numbers[..]).map_err(|_| {
        step.error(format!("the number of values in a <matrix> is {}; expected 9 or 16", numbers.len()))
    })?;
    match rows[12..] == [0.0, 0.0, 0.0, 1.0] {
        true => Ok(DAffine3::from_mat4(DMat4::from_cols_array(&rows).transpose())),
        false => Err(step.error("the matrix is not affine; expected 0, 0, 0, 1 as its last row")),
    }
}

/// Use of a texture.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum TextureUsage {
    Colours,
    /// One number per texel, which Mitsuba computes from the colour.
    Numbers,
    /// Numbers as stored, such as normals.
    Data,
}
