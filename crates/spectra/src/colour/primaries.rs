//! Linear RGB of other primaries and white.
//!
//! With the columns (x, y, 1 − x − y)/y of red, green and blue as P and the white's as w, XYZ = P diag(P⁻¹ w) rgb: rgb = (1, 1, 1) is the white with
//! Y = 1. A colour stays the colour that it is: the white is not adapted to D65.

use super::srgb::SRGB_FROM_XYZ;

type Matrix = [[f64; 3]; 3];

/// Chromaticities x, y of the primaries and of the white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    /// Red.
    pub red: [f64; 2],
    /// Green.
    pub green: [f64; 2],
    /// Blue.
    pub blue: [f64; 2],
    /// White.
    pub white: [f64; 2],
}

/// Those of ITU-R BT.709 and of sRGB.
pub const REC_709: Primaries =
    Primaries { red: [0.64, 0.33], green: [0.3, 0.6], blue: [0.15, 0.06], white: [0.3127, 0.329] };

impl Primaries {
    /// Whether these are the same to `tolerance` in every chromaticity.
    #[must_use]
    pub fn is_close_to(&self, other: &Self, tolerance: f64) -> bool {
        let all = |p: &Self| [p.red, p.green, p.blue, p.white].into_iter().flatten().collect::<Vec<_>>();
        all(self).into_iter().zip(all(other)).all(|(a, b)| (a - b).abs() <= tolerance)
    }

    /// From linear RGB of these primaries to linear sRGB, row by row; `None` where the chromaticities make no colour space.
    #[must_use]
    pub fn to_linear_srgb(&self) -> Option<[[f64; 3]; 3]> {
        let [r, g, b, w] =
            [tristimulus(self.red)?, tristimulus(self.green)?, tristimulus(self.blue)?, self.white_xyz()?];
        // Columns to rows.
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

/// (x, y, z) of a primary; its scale is found from the white.
fn tristimulus([x, y]: [f64; 2]) -> Option<[f64; 3]> {
    (x.is_finite() && y.is_finite()).then_some([x, y, 1.0 - x - y])
}

fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// By Cramer's rule; `None` of primaries on one line.
fn inverse(m: &Matrix) -> Option<Matrix> {
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    (determinant.abs() > 1e-9).then(|| core::array::from_fn(|i| core::array::from_fn(|j| cofactor(j, i) / determinant)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::linear_srgb_from_xyz;

    #[test]
    fn primaries_of_xyz_and_of_rec_709_are_known() {
        let xyz = Primaries { red: [1.0, 0.0], green: [0.0, 1.0], blue: [0.0, 0.0], white: [1.0 / 3.0; 2] };
        let found = xyz.to_linear_srgb().expect("a space");
        for (row, expected) in found.iter().zip(&SRGB_FROM_XYZ) {
            assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{row:?}");
        }
        let same = REC_709.to_linear_srgb().expect("a space");
        for (i, row) in same.iter().enumerate() {
            // The standard's white is rounded to four digits.
            assert!(row.iter().enumerate().all(|(j, x)| (x - f64::from(u8::from(i == j))).abs() < 2e-3), "{same:?}");
        }
    }

    #[test]
    fn white_keeps_its_chromaticity() {
        let aces =
            Primaries { red: [0.713, 0.293], green: [0.165, 0.83], blue: [0.128, 0.044], white: [0.32168, 0.33767] };
        let found = times(&aces.to_linear_srgb().expect("a space"), [1.0; 3]);
        let expected = linear_srgb_from_xyz([0.32168 / 0.33767, 1.0, (1.0 - 0.32168 - 0.33767) / 0.33767]);
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    }

    #[test]
    fn what_is_no_colour_space_is_none() {
        let line = Primaries { red: [0.6, 0.3], green: [0.4, 0.3], blue: [0.2, 0.3], white: [0.3, 0.3] };
        assert_eq!(line.to_linear_srgb(), None);
        assert_eq!(Primaries { white: [0.3, 0.0], ..REC_709 }.to_linear_srgb(), None);
        assert_eq!(Primaries { red: [f64::NAN, 0.3], ..REC_709 }.to_linear_srgb(), None);
        assert!(REC_709.is_close_to(&Primaries { white: [0.31271, 0.32902], ..REC_709 }, 5e-4));
    }
}
