//! Colour spaces of the paper's colour filter.
//!
//! | space | components | of | source |
//! | --- | --- | --- | --- |
//! | RGB NTSC | R, G, B of the primaries (0.67, 0.33), (0.21, 0.71), (0.14, 0.08), white C (0.3101, 0.3162) | linear light | FCC 1953 |
//! | RGB PAL | R, G, B of the primaries (0.64, 0.33), (0.29, 0.60), (0.15, 0.06), white D65 | linear light | EBU Tech. 3213 |
//! | YUV | Y; U = 0.492 (B − Y) + 1/2; V = 0.877 (R − Y) + 1/2 | encoded | ITU-R BT.470 |
//! | YIQ | Y; I = 0.74 (R − Y) − 0.27 (B − Y) + 1/2; Q = 0.48 (R − Y) + 0.41 (B − Y) + 1/2 | encoded | FCC 1953 |
//! | YCbCr | Y; Cb = (B − Y)/1.772 + 1/2; Cr = (R − Y)/1.402 + 1/2 | encoded | ITU-R BT.601, full range |
//! | CMY | 1 − R, 1 − G, 1 − B | either | |
//!
//! Y = 0.299 R + 0.587 G + 0.114 B. A half is added to colour differences so that an image can hold them (U and V of saturated colours still leave 0
//! … 1 and are clipped at the end). Between white points colours are adapted by Bradford's transform (Lam 1985), so that white stays white.
//!
//! Affine maps of colours: 4 × 4 matrices whose last row is 0 0 0 1.

use etendue_spectra::colour::{D65_WHITE, XYZ_FROM_SRGB};

use super::{FilterError, Stage};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourSpace {
    /// Primaries of NTSC (1953).
    RgbNtsc,
    /// Primaries of PAL.
    RgbPal,
    /// Luma and two differences, as PAL transmits them.
    Yuv,
    /// Luma and two differences, as NTSC transmits them.
    Yiq,
    /// Luma and two differences, as files store them.
    YCbCr,
    /// Complements.
    Cmy,
}

impl ColourSpace {
    /// All spaces.
    pub const ALL: [Self; 6] = [Self::RgbNtsc, Self::RgbPal, Self::Yuv, Self::Yiq, Self::YCbCr, Self::Cmy];

    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RgbNtsc => "RGB NTSC",
            Self::RgbPal => "RGB PAL",
            Self::Yuv => "YUV",
            Self::Yiq => "YIQ",
            Self::YCbCr => "YCbCr",
            Self::Cmy => "CMY",
        }
    }

    pub(crate) fn check(self, stage: Stage) -> Result<(), FilterError> {
        let required = match (self, stage) {
            (Self::RgbNtsc | Self::RgbPal, Stage::Display) => "linear light",
            (Self::Yuv | Self::Yiq | Self::YCbCr, Stage::Linear) => "encoded images",
            _ => return Ok(()),
        };
        Err(FilterError::Space { space: self.name(), wanted: required })
    }

    /// From sRGB, linear or encoded as defined for the space.
    #[must_use]
    pub fn from_rgb(self) -> Affine {
        const HALVES: [f64; 3] = [0.0, 0.5, 0.5];
        match self {
            Self::RgbNtsc => primaries(NTSC_PRIMARIES, white_of([0.3101, 0.3162])),
            Self::RgbPal => primaries(PAL_PRIMARIES, D65_WHITE),
            Self::Yuv => Affine::new(differences([[0.0, 0.492], [0.877, 0.0]]), HALVES),
            Self::Yiq => Affine::new(differences([[0.74, -0.27], [0.48, 0.41]]), HALVES),
            Self::YCbCr => Affine::new(differences([[0.0, 1.0 / 1.772], [1.0 / 1.402, 0.0]]), HALVES),
            Self::Cmy => Affine::new([[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]], [1.0; 3]),
        }
    }

    /// To sRGB, linear or encoded as defined for the space.
    #[must_use]
    pub fn to_rgb(self) -> Affine {
        self.from_rgb().inverse().expect("every space has three independent components")
    }
}

const NTSC_PRIMARIES: [[f64; 2]; 3] = [[0.67, 0.33], [0.21, 0.71], [0.14, 0.08]];
const PAL_PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.29, 0.60], [0.15, 0.06]];

const LUMA: [f64; 3] = [0.299, 0.587, 0.114];

/// Luma, and two sums of R − Y and B − Y with these factors.
fn differences(factors: [[f64; 2]; 2]) -> [[f64; 3]; 3] {
    let row =
        |[r, b]: [f64; 2]| [r * (1.0 - LUMA[0]) - b * LUMA[0], -(r + b) * LUMA[1], b * (1.0 - LUMA[2]) - r * LUMA[2]];
    [LUMA, row(factors[0]), row(factors[1])]
}

/// Tristimulus values, Y = 1, of a chromaticity.
fn white_of([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

/// From linear sRGB to linear RGB of other primaries and their white.
fn primaries(xy: [[f64; 2]; 3], white: [f64; 3]) -> Affine {
    let columns = xy.map(white_of);
    let unscaled = Affine::new([0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])), [0.0; 3]);
    let scale = unscaled.inverse().expect("three corners of a triangle").apply(white);
    let to_xyz = Affine::new([0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i] * scale[j])), [0.0; 3]);
    let from_xyz = to_xyz.inverse().expect("three corners of a triangle");
    Affine::new(XYZ_FROM_SRGB, [0.0; 3]).then(&adaptation(D65_WHITE, white)).then(&from_xyz)
}

/// Bradford's transform from one white to another.
fn adaptation(from: [f64; 3], to: [f64; 3]) -> Affine {
    const CONES: [[f64; 3]; 3] = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];
    let cones = Affine::new(CONES, [0.0; 3]);
    let (from, to) = (cones.apply(from), cones.apply(to));
    let gain = |i: usize, j: usize| if i == j { to[i] / from[i] } else { 0.0 };
    let gains = Affine::new([0, 1, 2].map(|i| [0, 1, 2].map(|j| gain(i, j))), [0.0; 3]);
    cones.then(&gains).then(&cones.inverse().expect("Bradford's matrix has an inverse"))
}

/// The upper three rows; the fourth column is the offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine(pub [[f64; 4]; 3]);

impl Affine {
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);

    /// Creates the map from a matrix and an offset.
    #[must_use]
    pub fn new(rows: [[f64; 3]; 3], offset: [f64; 3]) -> Self {
        Self([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]]))
    }

    /// Applies the map to a colour.
    #[must_use]
    pub fn apply(&self, v: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2] + row[3])
    }

    /// This map followed by `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self(next.0.map(|row| {
            core::array::from_fn(|j| {
                let sum: f64 = (0..3).map(|k| row[k] * self.0[k][j]).sum();
                if j == 3 { sum + row[3] } else { sum }
            })
        }))
    }

    /// The inverse map; `None` if there is none.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let m = &self.0;
        let minor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        };
        let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| minor(j, i) / determinant));
        let offset = rows.map(|row| -(0..3).map(|k| row[k] * m[k][3]).sum::<f64>());
        Some(Self::new(rows, offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colours() -> impl Iterator<Item = [f64; 3]> {
        (0..125).map(|i| [i % 5, i / 5 % 5, i / 25].map(|v| f64::from(v) / 4.0))
    }

    #[test]
    fn every_space_is_left_as_it_was_entered() {
        for space in ColourSpace::ALL {
            for rgb in colours() {
                let back = space.to_rgb().apply(space.from_rgb().apply(rgb));
                assert!((0..3).all(|c| (back[c] - rgb[c]).abs() < 1e-12), "{space:?} {rgb:?} {back:?}");
            }
        }
    }

    #[test]
    fn primaries_have_their_chromaticities() {
        let white_c = white_of([0.3101, 0.3162]);
        let spaces = [
            (ColourSpace::RgbPal, PAL_PRIMARIES, Affine::IDENTITY),
            (ColourSpace::RgbNtsc, NTSC_PRIMARIES, adaptation(D65_WHITE, white_c)),
        ];
        for (space, primaries, conversion) in spaces {
            for (i, [x, y]) in primaries.into_iter().enumerate() {
                let lone = core::array::from_fn(|c| f64::from(u8::from(c == i)));
                let xyz = conversion.apply(Affine::new(XYZ_FROM_SRGB, [0.0; 3]).apply(space.to_rgb().apply(lone)));
                let sum: f64 = xyz.iter().sum();
                assert!((xyz[0] / sum - x).abs() < 1e-12 && (xyz[1] / sum - y).abs() < 1e-12, "{space:?} {i}: {xyz:?}");
            }
        }
        // sRGB has PAL's red and blue, and nearly its green: red and blue keep their hue, and white is white.
        let red = ColourSpace::RgbPal.from_rgb().apply([1.0, 0.0, 0.0]);
        assert!(red[1].abs() < 1e-3 && red[2].abs() < 1e-3 && (0.95..1.05).contains(&red[0]), "{red:?}");
    }

    #[test]
    fn greys_are_neutral_in_every_space() {
        for grey in [0.0, 0.5, 1.0] {
            for space in [ColourSpace::Yuv, ColourSpace::Yiq, ColourSpace::YCbCr] {
                let [y, a, b] = space.from_rgb().apply([grey; 3]);
                assert!((y - grey).abs().max((a - 0.5).abs()).max((b - 0.5).abs()) < 1e-12, "{space:?}");
            }
            for space in [ColourSpace::RgbNtsc, ColourSpace::RgbPal] {
                let rgb = space.from_rgb().apply([grey; 3]);
                assert!(rgb.iter().all(|v| (v - grey).abs() < 1e-12), "{space:?} {rgb:?}");
            }
            assert_eq!(ColourSpace::Cmy.from_rgb().apply([grey; 3]), [1.0 - grey; 3]);
        }
    }

    #[test]
    fn known_colours_have_their_known_values() {
        let near = |actual: [f64; 3], expected: [f64; 3], tolerance: f64| {
            assert!((0..3).all(|c| (actual[c] - expected[c]).abs() < tolerance), "{actual:?} {expected:?}");
        };
        // Red: BT.601's Cr is 1, FCC's I is 0.6 and Q 0.21 (coefficients of two digits), PAL's V is 0.615.
        near(ColourSpace::YCbCr.from_rgb().apply([1.0, 0.0, 0.0]), [0.299, 0.5 - 0.168_736, 1.0], 1e-6);
        near(ColourSpace::Yiq.from_rgb().apply([1.0, 0.0, 0.0]), [0.299, 1.1, 0.71], 6e-3);
        near(ColourSpace::Yuv.from_rgb().apply([1.0, 0.0, 0.0]), [0.299, 0.5 - 0.147, 1.115], 1e-3);
    }

    #[test]
    fn an_inverse_undoes_and_a_flat_map_has_none() {
        let map = Affine::new([[2.0, 1.0, 0.0], [0.0, 1.0, -1.0], [1.0, 0.0, 1.0]], [0.1, -0.2, 0.3]);
        let back = map.then(&map.inverse().expect("determinant 1"));
        for (row, expected) in back.0.iter().zip(Affine::IDENTITY.0) {
            assert!((0..4).all(|j| (row[j] - expected[j]).abs() < 1e-14), "{back:?}");
        }
        assert_eq!(map.apply([1.0, 2.0, 3.0]), [4.1, -1.2, 4.3]);
        assert_eq!(Affine::new([[1.0; 3]; 3], [0.0; 3]).inverse(), None);
    }
}
