//! Colour: XYZ, linear and encoded sRGB, CIE L*a*b*, and colour difference.
//!
//! Linear sRGB has the primaries of IEC 61966-2-1 and, as white, illuminant D65 as this crate tabulates and integrates
//! it ([`D65_WHITE`]), so that a perfect diffuser under D65 is exactly grey; the standard's own white (x = 0.3127,
//! y = 0.3290) differs by less than 3e-4.
//!
//! Linear RGB of other primaries and white.
//!
//! With the columns (x, y, 1 − x − y)/y of red, green and blue as P and the white's as w, XYZ = P diag(P⁻¹ w) rgb: rgb = (1, 1, 1) is the white with
//! Y = 1. Colours are absolute: the white is not adapted to D65.
//!
//! sRGB: primaries and transfer curve of IEC 61966-2-1:1999.
//!
//! Luminance of linear colours and luma of encoded ones, by the weights of ITU-R BT.709 (those of IEC 61966-2-1 too).
//!
//! The standards state four digits. Y of linear sRGB with this crate's own white is the middle row of [`XYZ_FROM_SRGB`]; the difference is below
//! 1e-4.
//!
//! CIE 1976 L*a*b* (CIE 15:2018).
//!
//! The CIEDE2000 colour difference (CIE 142-2001; notation and test pairs of Sharma, Wu & Dalal 2005).

#[cfg(test)]
mod tests;

use core::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use etendue_core::maths::{self, f64 as maths_f64};

type Matrix = [[f64; 3]; 3];

/// Chromaticities x, y of the primaries and of the white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    pub red: [f64; 2],
    pub green: [f64; 2],
    pub blue: [f64; 2],
    pub white: [f64; 2],
}

/// The primaries of ITU-R BT.709 and of sRGB.
pub const REC_709: Primaries =
    Primaries { red: [0.64, 0.33], green: [0.3, 0.6], blue: [0.15, 0.06], white: [0.3127, 0.329] };

impl Primaries {
    /// True if these are equal to `tolerance` in every chromaticity.
    #[must_use]
    pub fn is_close_to(&self, other: &Self, tolerance: f64) -> bool {
        let all = |p: &Self| [p.red, p.green, p.blue, p.white].into_iter().flatten().collect::<Vec<_>>();
        all(self).into_iter().zip(all(other)).all(|(a, b)| (a - b).abs() <= tolerance)
    }

    /// From linear RGB of these primaries to linear sRGB, row by row; `None` if the chromaticities do not form a colour space.
    #[must_use]
    pub fn to_linear_srgb(&self) -> Option<[[f64; 3]; 3]> {
        let [r, g, b, w] =
            [tristimulus(self.red)?, tristimulus(self.green)?, tristimulus(self.blue)?, self.white_xyz()?];
        // Transposed: columns to rows.
        let primaries: Matrix = core::array::from_fn(|i| [r[i], g[i], b[i]]);
        let inverse = inverse(&primaries)?;
        let scale = times(&inverse, w);
        let to_xyz: Matrix = primaries.map(|row| core::array::from_fn(|i| row[i] * scale[i]));
        let all: Matrix = core::array::from_fn(|i| {
            core::array::from_fn(|j| (0..3).map(|k| SRGB_FROM_XYZ[i][k] * to_xyz[k][j]).sum())
        });
        all.iter().flatten().all(|x| x.is_finite()).then_some(all)
    }

    fn white_xyz(&self) -> Option<[f64; 3]> {
        let [x, y] = self.white;
        (y > 0.0).then(|| [x / y, 1.0, (1.0 - x - y) / y])
    }
}

/// (x, y, z) of a primary; its scale follows from the white.
fn tristimulus([x, y]: [f64; 2]) -> Option<[f64; 3]> {
    (x.is_finite() && y.is_finite()).then_some([x, y, 1.0 - x - y])
}

fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// By Cramer's rule; `None` for collinear primaries.
fn inverse(m: &Matrix) -> Option<Matrix> {
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    (determinant.abs() > 1e-9).then(|| core::array::from_fn(|i| core::array::from_fn(|j| cofactor(j, i) / determinant)))
}

/// Tristimulus values of D65, Y = 1, by this crate's tables and grid.
pub const D65_WHITE: [f64; 3] = [0.950_468_573_284_396_8, 1.0, 1.088_829_734_547_443_6];

/// From linear sRGB to XYZ (Y of white 1), row by row.
pub const XYZ_FROM_SRGB: [[f64; 3]; 3] = [
    [0.412_454_586_801_411_56, 0.357_576_568_179_580_06, 0.180_437_418_303_405_18],
    [0.212_671_896_319_477_83, 0.715_153_136_359_160_1, 0.072_174_967_321_362_07],
    [0.019_333_808_756_316_18, 0.119_192_189_393_193_47, 0.950_303_736_397_934],
];

/// From XYZ (Y of white 1) to linear sRGB, row by row.
pub const SRGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_468_714_638_092, -1.537_145_415_918_069_3, -0.498_533_648_405_860_34],
    [-0.969_264_700_833_152_6, 1.876_008_271_871_350_9, 0.041_555_960_522_394_72],
    [0.055_643_450_992_453_14, -0.204_025_986_972_328_13, 1.057_225_568_856_608_3],
];

/// Linear sRGB from tristimulus values; outside the gamut a component is negative.
#[must_use]
pub fn linear_srgb_from_xyz(xyz: [f64; 3]) -> [f64; 3] {
    times(&SRGB_FROM_XYZ, xyz)
}

/// Tristimulus values of linear sRGB.
#[must_use]
pub fn xyz_from_linear_srgb(rgb: [f64; 3]) -> [f64; 3] {
    times(&XYZ_FROM_SRGB, rgb)
}

/// The sRGB transfer curve: linear to encoded, 0 to 0 and 1 to 1. It does not clip: the curve is extended beyond 0 to 1.
#[must_use]
pub fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        (1.055 * f64::from(maths::f32::pow(linear, 1.0 / 2.4)) - 0.055) as f32
    }
}

/// The inverse of [`encode`] (to the standard's own rounding: its two pieces meet within 1e-7).
#[must_use]
pub fn decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        maths::f32::pow(((f64::from(encoded) + 0.055) / 1.055) as f32, 2.4)
    }
}

/// [`decode`] of a byte (0 to 255 for 0 to 1), by table.
#[must_use]
pub fn decode_byte(encoded: u8) -> f32 {
    static TABLE: LazyLock<[f32; 256]> = LazyLock::new(|| core::array::from_fn(|i| decode(i as f32 / 255.0)));
    TABLE[usize::from(encoded)]
}

/// The weights of red, green and blue; they sum to 1.
pub const BT709: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The weighted sum of a colour, in its own unit.
#[must_use]
pub fn luma(rgb: [f32; 3]) -> f32 {
    let [r, g, b] = BT709.map(|w| w as f32);
    r * rgb[0] + g * rgb[1] + b * rgb[2]
}

/// A colour in CIE 1976 L*a*b*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab {
    /// Lightness, 0 to 100.
    pub l: f64,
    /// Red–green axis.
    pub a: f64,
    /// Yellow–blue axis.
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

/// CIEDE2000 difference of two colours, weights k_L = k_C = k_H = 1.
#[must_use]
pub fn ciede2000(first: Lab, second: Lab) -> f64 {
    let mean_chroma = (chroma(first) + chroma(second)) / 2.0;
    let stretch = 1.0 + 0.5 * (1.0 - seventh_share(mean_chroma));
    let (one, two) = (LabPolar::new(first, stretch), LabPolar::new(second, stretch));
    let mean = LabPolar {
        lightness: (one.lightness + two.lightness) / 2.0,
        chroma: (one.chroma + two.chroma) / 2.0,
        hue_rad: mean_hue_rad(one, two),
    };
    let lightness = (two.lightness - one.lightness) / lightness_weight(mean.lightness);
    let chroma = (two.chroma - one.chroma) / (1.0 + 0.045 * mean.chroma);
    let hue = hue_difference(one, two) / (1.0 + 0.015 * mean.chroma * hue_weight(mean.hue_rad));
    (lightness * lightness + chroma * chroma + hue * hue + rotation(mean) * chroma * hue).max(0.0).sqrt()
}

/// A colour by lightness, (stretched) chroma and hue angle.
#[derive(Clone, Copy)]
struct LabPolar {
    lightness: f64,
    chroma: f64,
    hue_rad: f64,
}

impl LabPolar {
    fn new(lab: Lab, stretch: f64) -> Self {
        let stretched = Lab { a: lab.a * stretch, ..lab };
        let angle = maths_f64::atan2(stretched.b, stretched.a);
        Self { lightness: lab.l, chroma: chroma(stretched), hue_rad: if angle < 0.0 { angle + TAU } else { angle } }
    }
}

fn chroma(lab: Lab) -> f64 {
    (lab.a * lab.a + lab.b * lab.b).sqrt()
}

/// √(C⁷ / (C⁷ + 25⁷)).
fn seventh_share(chroma: f64) -> f64 {
    let seventh = maths_f64::pow(chroma / 25.0, 7.0);
    (seventh / (seventh + 1.0)).sqrt()
}

/// The signed hue difference as a length: 2 √(C₁ C₂) sin(Δh/2).
fn hue_difference(one: LabPolar, two: LabPolar) -> f64 {
    let turn = two.hue_rad - one.hue_rad;
    let turn = if turn > PI {
        turn - TAU
    } else if turn < -PI {
        turn + TAU
    } else {
        turn
    };
    2.0 * (one.chroma * two.chroma).sqrt() * maths_f64::sin(turn / 2.0)
}

/// The mean hue along the shorter arc; the sum if one colour has no hue.
fn mean_hue_rad(one: LabPolar, two: LabPolar) -> f64 {
    let sum = one.hue_rad + two.hue_rad;
    if one.chroma * two.chroma == 0.0 {
        sum
    } else if (one.hue_rad - two.hue_rad).abs() <= PI {
        sum / 2.0
    } else if sum < TAU {
        (sum + TAU) / 2.0
    } else {
        (sum - TAU) / 2.0
    }
}

fn lightness_weight(lightness: f64) -> f64 {
    let offset = (lightness - 50.0) * (lightness - 50.0);
    1.0 + 0.015 * offset / (20.0 + offset).sqrt()
}

fn hue_weight(hue_rad: f64) -> f64 {
    let wave = |order: f64, phase_deg: f64| maths_f64::cos(order * hue_rad + phase_deg.to_radians());
    1.0 - 0.17 * wave(1.0, -30.0) + 0.24 * wave(2.0, 0.0) + 0.32 * wave(3.0, 6.0) - 0.20 * wave(4.0, -63.0)
}

/// The rotation term of the blue region.
fn rotation(mean: LabPolar) -> f64 {
    let offset = (mean.hue_rad.to_degrees() - 275.0) / 25.0;
    let turn_deg = 30.0 * maths_f64::exp(-offset * offset);
    -maths_f64::sin((2.0 * turn_deg).to_radians()) * 2.0 * seventh_share(mean.chroma)
}
