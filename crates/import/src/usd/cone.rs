//! The cone of a light: UsdLux's ShapingAPI.

use super::access::number;
use crate::syntax::usd::UsdPrim;

/// Angles of the cone of a light from its axis, degrees: where it begins to fall, and where it ends; `None` of one that shines all round.
pub(super) fn cone_of(prim: &UsdPrim) -> Option<[f64; 2]> {
    let outer_deg = number(prim, "inputs:shaping:cone:angle", 90.0);
    let softness = number(prim, "inputs:shaping:cone:softness", 0.0).clamp(0.0, 1.0);
    (prim.has_schema("ShapingAPI") && outer_deg > 0.0 && outer_deg < 90.0)
        .then_some([outer_deg * (1.0 - softness), outer_deg])
}
