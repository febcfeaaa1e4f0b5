//! What a change of colour is made of.

use super::super::{FilterError, Stage, demand};
use super::{Affine, ColourSpace};
use etendue_core::maths::f64::sin_cos;

/// One step of a change of colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// Factors on red, green and blue.
    Scale([f64; 3]),
    /// Shares of white added to red, green and blue.
    Offset([f64; 3]),
    /// A factor on all channels, 0 or more.
    Brightness(f64),
    /// 0 is grey, 1 as it was, more is more colourful; 0 or more.
    Saturation(f64),
    /// Degrees, red towards green.
    HueRotationDeg(f64),
    /// To a colour space: its components take the places of red, green and blue.
    To(ColourSpace),
    /// From a colour space.
    From(ColourSpace),
    /// Any affine map.
    Matrix(Affine),
}

impl Operation {
    /// Whether its numbers are in range and it is made for the stage.
    pub(super) fn check(&self, stage: Stage) -> Result<(), FilterError> {
        let finite = |name, values: &[f64]| {
            let fault = values.iter().find(|v| !v.is_finite());
            fault.map_or(Ok(()), |v| demand(false, name, *v, "that is finite"))
        };
        match self {
            Self::Scale(factors) => finite("scale", factors),
            Self::Offset(shares) => finite("offset", shares),
            Self::Brightness(b) => demand(*b >= 0.0, "brightness", *b, "of 0 or more"),
            Self::Saturation(s) => demand(*s >= 0.0, "saturation", *s, "of 0 or more"),
            Self::HueRotationDeg(angle) => finite("hue_rotation_deg", &[*angle]),
            Self::To(space) | Self::From(space) => space.check(stage),
            Self::Matrix(map) => finite("matrix", map.0.as_flattened()),
        }
    }

    /// Its matrix.
    #[must_use]
    pub fn matrix(&self, stage: Stage) -> Affine {
        match self {
            Self::Scale(factors) => diagonal(*factors),
            Self::Offset(shares) => Affine::new(diagonal_rows([1.0; 3]), *shares),
            Self::Brightness(b) => diagonal([*b; 3]),
            Self::Saturation(s) => saturation(*s, weights(stage)),
            Self::HueRotationDeg(angle) => hue_rotation(angle.to_radians(), weights(stage)),
            Self::To(space) => space.from_rgb(),
            Self::From(space) => space.to_rgb(),
            Self::Matrix(map) => *map,
        }
    }
}

/// The weights of luminance.
fn weights(stage: Stage) -> [f64; 3] {
    match stage {
        Stage::Linear => etendue_spectra::colour::BT709,
        Stage::Display => [0.299, 0.587, 0.114],
    }
}

fn diagonal_rows(d: [f64; 3]) -> [[f64; 3]; 3] {
    [[d[0], 0.0, 0.0], [0.0, d[1], 0.0], [0.0, 0.0, d[2]]]
}

fn diagonal(d: [f64; 3]) -> Affine {
    Affine::new(diagonal_rows(d), [0.0; 3])
}

fn saturation(s: f64, w: [f64; 3]) -> Affine {
    let one = |i: usize, j: usize| f64::from(u8::from(i == j));
    Affine::new([0, 1, 2].map(|i| [0, 1, 2].map(|j| s * one(i, j) + (1.0 - s) * w[j])), [0.0; 3])
}

/// Column by column: the part of a primary across the grey axis is turned, then greyed to leave no luminance, and the
/// primary's own luminance is added.
fn hue_rotation(angle: f64, w: [f64; 3]) -> Affine {
    let columns = [0, 1, 2].map(|j| {
        let across: [f64; 3] = core::array::from_fn(|i| f64::from(u8::from(i == j)) - 1.0 / 3.0);
        let turned = turned_about_grey(across, angle);
        let luminance: f64 = (0..3).map(|i| w[i] * turned[i]).sum();
        turned.map(|v| v - luminance + w[j])
    });
    Affine::new([0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])), [0.0; 3])
}

/// A vector across (1, 1, 1), turned about it (Rodrigues), red towards green.
fn turned_about_grey(v: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = sin_cos(angle);
    let k = sin / 3.0_f64.sqrt();
    let cross = [v[2] - v[1], v[0] - v[2], v[1] - v[0]];
    core::array::from_fn(|i| cos * v[i] + k * cross[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLOURS: [[f64; 3]; 4] = [[0.2, 0.5, 0.9], [1.0, 0.0, 0.0], [0.4, 0.4, 0.4], [0.0, 1.0, 0.3]];

    fn near(a: [f64; 3], b: [f64; 3]) -> bool {
        (0..3).all(|c| (a[c] - b[c]).abs() < 1e-12)
    }

    fn luminance(v: [f64; 3], stage: Stage) -> f64 {
        (0..3).map(|c| weights(stage)[c] * v[c]).sum()
    }

    #[test]
    fn hue_and_saturation_keep_luminance_and_greys() {
        for (stage, colour) in [Stage::Linear, Stage::Display].into_iter().flat_map(|s| COLOURS.map(|c| (s, c))) {
            for operation in [Operation::HueRotationDeg(77.0), Operation::Saturation(0.3), Operation::Saturation(1.7)] {
                let changed = operation.matrix(stage).apply(colour);
                assert!((luminance(changed, stage) - luminance(colour, stage)).abs() < 1e-12, "{operation:?}");
                assert!(near(operation.matrix(stage).apply([0.4; 3]), [0.4; 3]), "{operation:?}");
            }
        }
    }

    #[test]
    fn turns_add_up_to_a_full_one() {
        let turn = |deg| Operation::HueRotationDeg(deg).matrix(Stage::Display);
        for colour in COLOURS {
            assert!(near(turn(40.0).then(&turn(-40.0)).apply(colour), colour));
            assert!(near(turn(120.0).then(&turn(240.0)).apply(colour), colour));
        }
        // A third of a turn takes red to where green is, but for luminance.
        let green = turn(120.0).apply([1.0, 0.0, 0.0]);
        assert!((green[0] - green[2]).abs() < 1e-12 && (green[1] - green[0] - 1.0).abs() < 1e-12, "{green:?}");
    }

    #[test]
    fn no_saturation_is_grey_and_one_changes_nothing() {
        let grey = Operation::Saturation(0.0).matrix(Stage::Display).apply([1.0, 0.0, 0.0]);
        assert!(near(grey, [0.299; 3]));
        assert!(near(Operation::Saturation(1.0).matrix(Stage::Display).apply(COLOURS[0]), COLOURS[0]));
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        assert!(Operation::Saturation(-0.1).check(Stage::Display).is_err());
        assert!(Operation::Scale([1.0, f64::NAN, 1.0]).check(Stage::Display).is_err());
        assert!(Operation::To(ColourSpace::Yuv).check(Stage::Linear).is_err());
        assert!(Operation::From(ColourSpace::RgbNtsc).check(Stage::Display).is_err());
        assert!(Operation::To(ColourSpace::Cmy).check(Stage::Linear).is_ok());
    }
}
