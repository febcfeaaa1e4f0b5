//! CIE 1976 L*a*b* (CIE 15:2018).

use etendue_core::maths;

/// A colour in CIE 1976 L*a*b*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab {
    /// Lightness, 0 to 100.
    pub l: f64,
    /// Red against green.
    pub a: f64,
    /// Yellow against blue.
    pub b: f64,
}

/// L*a*b* of tristimulus values against a white of the same scale.
#[must_use]
pub fn lab(xyz: [f64; 3], white: [f64; 3]) -> Lab {
    let [x, y, z] = core::array::from_fn(|c| response(xyz[c] / white[c]));
    Lab { l: 116.0 * y - 16.0, a: 500.0 * (x - y), b: 200.0 * (y - z) }
}

/// The cube root, continued by its tangent line below (6/29)³.
fn response(t: f64) -> f64 {
    if t > 216.0 / 24389.0 { maths::f64::cbrt(t) } else { t * (841.0 / 108.0) + 4.0 / 29.0 }
}
