//! Transforms: the operations that `xformOpOrder` lists.
//!
//! As in UsdGeomXformable, the first of the list is the outermost; the last one is applied to a point first.

use etendue_core::maths::f64 as maths;
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::access::{tuple, vector};
use crate::syntax::usd::{UsdPrim, UsdValue};

const RESET: &str = "!resetXformStack!";
const INVERSE: &str = "!invert!";

/// Transform from the space of a prim to its parent's; true if it is relative to the world instead, whatever the parent.
pub(super) fn transform_of(prim: &UsdPrim) -> Result<(DAffine3, bool), String> {
    let Some(UsdValue::Texts(order)) = prim.value("xformOpOrder") else { return Ok((DAffine3::IDENTITY, false)) };
    let (mut composed, mut is_reset) = (DAffine3::IDENTITY, false);
    for name in order {
        if name == RESET {
            (composed, is_reset) = (DAffine3::IDENTITY, true);
            continue;
        }
        let (own, is_inverse) = name.strip_prefix(INVERSE).map_or((name.as_str(), false), |own| (own, true));
        let operation = operation(prim, own)?;
        if is_inverse && operation.matrix3.determinant() == 0.0 {
            return Err(format!("{}: \"{name}\" inverts a singular transform", prim.path));
        }
        composed *= if is_inverse { operation.inverse() } else { operation };
    }
    Ok((composed, is_reset))
}

fn operation(prim: &UsdPrim, name: &str) -> Result<DAffine3, String> {
    // `xformOp:rotateXYZ:pivot`.
    let kind = name.split(':').nth(1).unwrap_or_default();
    let turn = |axis: DVec3, degrees: f64| {
        let (sin, cos) = maths::sin_cos(0.5 * degrees.to_radians());
        DMat3::from_quat(DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos))
    };
    let one = || super::access::stated(prim, name);
    let axis = |letter: char| match letter {
        'X' => DVec3::X,
        'Y' => DVec3::Y,
        _ => DVec3::Z,
    };
    let result = match kind {
        "translate" => vector(prim, name).map(DAffine3::from_translation),
        "scale" => vector(prim, name).map(DAffine3::from_scale),
        "translateX" | "translateY" | "translateZ" => {
            one().map(|v| DAffine3::from_translation(v * axis(kind.chars().last().unwrap_or('Z'))))
        }
        "scaleX" | "scaleY" | "scaleZ" => {
            let axis = axis(kind.chars().last().unwrap_or('Z'));
            one().map(|v| DAffine3::from_scale(DVec3::ONE + (v - 1.0) * axis))
        }
        "orient" => {
            tuple::<4>(prim, name).map(|[w, x, y, z]| DAffine3::from_mat3(DMat3::from_quat(rotation([w, x, y, z]))))
        }
        "transform" => tuple::<16>(prim, name).map(|m| from_rows(&m)),
        "rotateX" | "rotateY" | "rotateZ" => {
            one().map(|v| DAffine3::from_mat3(turn(axis(kind.chars().last().unwrap_or('Z')), v)))
        }
        "rotateXYZ" | "rotateXZY" | "rotateYXZ" | "rotateYZX" | "rotateZXY" | "rotateZYX" => {
            vector(prim, name).map(|degrees| {
                // The axis named first is applied first.
                let matrix = kind
                    .chars()
                    .skip(6)
                    .fold(DMat3::IDENTITY, |result, letter| turn(axis(letter), degrees.dot(axis(letter))) * result);
                DAffine3::from_mat3(matrix)
            })
        }
        other => return Err(format!("{}: \"{name}\": unknown transform \"{other}\"", prim.path)),
    };
    // An operation without a value is ignored.
    let result = result.unwrap_or(DAffine3::IDENTITY);
    let size = result.matrix3.to_cols_array().iter().fold(result.translation.length(), |most, v| most.max(v.abs()));
    match size < 1e12 {
        true => Ok(result),
        false => {
            Err(format!("{}: \"{name}\" has an entry of {size:e}; expected lengths and scales below 1e12", prim.path))
        }
    }
}

/// Rotation of a quaternion, its real part first, of any length; the identity for length 0.
pub(super) fn rotation([w, x, y, z]: [f64; 4]) -> DQuat {
    let own = DQuat::from_xyzw(x, y, z, w);
    if own.length() > 1e-12 { own.normalize() } else { DQuat::IDENTITY }
}

/// Matrix for multiplication of row vectors.
fn from_rows(m: &[f64; 16]) -> DAffine3 {
    let row = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
    DAffine3 { matrix3: DMat3::from_cols(row(0), row(4), row(8)), translation: row(12) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::usd::UsdAttribute;

    fn prim(operations: &[(&str, UsdValue)]) -> UsdPrim {
        let order = operations.iter().map(|(name, _)| (*name).to_owned()).collect();
        let all = operations.iter().map(|(name, value)| ((*name).trim_start_matches(INVERSE), value.clone()));
        let all = all.chain([("xformOpOrder", UsdValue::Texts(order))]);
        let attribute = |value| UsdAttribute { value: Some(value), ..UsdAttribute::default() };
        UsdPrim {
            path: "/a".to_owned(),
            kind: "Xform".to_owned(),
            attributes: all.map(|(name, value)| (name.to_owned(), attribute(value))).collect(),
            ..UsdPrim::default()
        }
    }

    /// A pivot: moved there, rotated, and moved back.
    #[test]
    fn the_last_operation_is_the_innermost() {
        let at = UsdValue::Tuple(vec![1.0, 0.0, 0.0]);
        let own = prim(&[
            ("xformOp:translate:pivot", at.clone()),
            ("xformOp:rotateZ", UsdValue::Number(90.0)),
            ("!invert!xformOp:translate:pivot", at),
        ]);
        let (composed, is_reset) = transform_of(&own).expect("a transform");
        assert!((composed.transform_point3(DVec3::new(2.0, 0.0, 5.0)) - DVec3::new(1.0, 1.0, 5.0)).length() < 1e-12);
        assert!(!is_reset);
        let order = prim(&[("xformOp:rotateXYZ", UsdValue::Tuple(vec![90.0, 0.0, 90.0]))]);
        let (composed, _) = transform_of(&order).expect("a transform");
        // About x first: y goes to z and stays there.
        assert!((composed.transform_point3(DVec3::Y) - DVec3::Z).length() < 1e-12);
    }

    #[test]
    fn what_cannot_be_turned_back_is_refused() {
        let flat = UsdValue::Tuple(vec![1.0, 0.0, 1.0]);
        assert!(transform_of(&prim(&[("!invert!xformOp:scale", flat)])).is_err());
        assert!(transform_of(&prim(&[("xformOp:shear", UsdValue::Number(1.0))])).is_err());
    }
}
