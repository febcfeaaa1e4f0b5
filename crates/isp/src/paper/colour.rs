//! Colour management: "a homogeneous transformation matrix on the colours of the rendered image", 4 × 4 and affine, on
//! the vector (R, G, B, 1).
//!
//! A change is a list of operations, combined into **one** matrix (the first operation is applied first) with one clip to 0 … 1 at the end (encoded
//! images only), so a conversion to another space, a change there and the conversion back lose nothing in between.
//!
//! | operation | matrix |
//! | --- | --- |
//! | scale, offset | by channel; offset in fractions of white |
//! | brightness b | b on all channels |
//! | saturation s | s 1 + (1 − s) e wᵀ: 0 is grey, 1 as it was |
//! | hue rotation θ | e wᵀ + (1 − e wᵀ) R(θ) (1 − e eᵀ/3): luminance and greys stay (after Haeberli 1993) |
//! | to, from a colour space | see [`ColourSpace`] |
//! | matrix | the upper three rows |
//!
//! e = (1, 1, 1); R(θ) turns about e, red towards green; w are the weights of luminance: of encoded images 0.299, 0.587,
//! 0.114 (ITU-R BT.601), of linear light 0.2126, 0.7152, 0.0722 (BT.709).

use etendue_core::quantity::{Display, LinearRgb, Quantity};
use etendue_core::{Plane, maths::f64::sin_cos};

use super::{FilterError, Stage, demand, for_each};

pub use super::colour_space::{Affine, ColourSpace};

/// An affine matrix on colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourChange {
    /// The stage it applies to.
    pub stage: Stage,
    /// Operations, in this order.
    pub operations: Vec<Operation>,
}

impl ColourChange {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        self.operations.iter().try_for_each(|operation| operation.check(self.stage))
    }

    /// All operations as one matrix.
    #[must_use]
    pub fn matrix(&self) -> Affine {
        self.operations.iter().fold(Affine::IDENTITY, |all, next| all.then(&next.matrix(self.stage)))
    }

    pub(super) fn apply_linear(&self, image: &mut Plane<LinearRgb>) {
        self.apply(image, |v| v);
    }

    pub(super) fn apply_display(&self, image: &mut Plane<Display>) {
        self.apply(image, |v| v.clamp(0.0, 1.0));
    }

    fn apply<Q: Quantity<Sample = [f32; 3]>>(&self, image: &mut Plane<Q>, clip: impl Fn(f32) -> f32 + Sync) {
        let matrix = self.matrix();
        for_each(image, |_, rgb| matrix.apply(rgb.map(f64::from)).map(|v| clip(v as f32)));
    }
}

/// One step of a change of colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// Factors on red, green and blue.
    Scale([f64; 3]),
    /// Fractions of white added to red, green and blue.
    Offset([f64; 3]),
    /// A factor on all channels, 0 or more.
    Brightness(f64),
    /// 0 is grey, 1 unchanged, above 1 more colourful; 0 or more.
    Saturation(f64),
    /// Degrees, red towards green.
    HueRotationDeg(f64),
    /// Conversion to a colour space: its components replace red, green and blue.
    To(ColourSpace),
    /// Conversion from a colour space.
    From(ColourSpace),
    /// Any affine map.
    Matrix(Affine),
}

impl Operation {
    /// Checks the ranges and the stage.
    fn check(&self, stage: Stage) -> Result<(), FilterError> {
        let finite = |name, values: &[f64]| {
            let not_finite = values.iter().find(|v| !v.is_finite());
            not_finite.map_or(Ok(()), |v| demand(false, name, *v, "that is finite"))
        };
        match self {
            Self::Scale(factors) => finite("scale", factors),
            Self::Offset(offsets) => finite("offset", offsets),
            Self::Brightness(b) => demand(*b >= 0.0, "brightness", *b, "of 0 or more"),
            Self::Saturation(s) => demand(*s >= 0.0, "saturation", *s, "of 0 or more"),
            Self::HueRotationDeg(angle) => finite("hue_rotation_deg", &[*angle]),
            Self::To(space) | Self::From(space) => space.check(stage),
            Self::Matrix(map) => finite("matrix", map.0.as_flattened()),
        }
    }

    #[must_use]
    pub fn matrix(&self, stage: Stage) -> Affine {
        match self {
            Self::Scale(factors) => diagonal(*factors),
            Self::Offset(offsets) => Affine::new(diagonal_rows([1.0; 3]), *offsets),
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

/// Column by column: the part of a primary perpendicular to the grey axis is rotated, then shifted along grey to zero luminance, and the primary's
/// own luminance is added.
fn hue_rotation(angle: f64, w: [f64; 3]) -> Affine {
    let columns = [0, 1, 2].map(|j| {
        let across: [f64; 3] = core::array::from_fn(|i| f64::from(u8::from(i == j)) - 1.0 / 3.0);
        let turned = turned_about_grey(across, angle);
        let luminance: f64 = (0..3).map(|i| w[i] * turned[i]).sum();
        turned.map(|v| v - luminance + w[j])
    });
    Affine::new([0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])), [0.0; 3])
}

/// A vector perpendicular to (1, 1, 1), rotated about it (Rodrigues), red towards green.
fn turned_about_grey(v: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = sin_cos(angle);
    let k = sin / 3.0_f64.sqrt();
    let cross = [v[2] - v[1], v[0] - v[2], v[1] - v[0]];
    core::array::from_fn(|i| cos * v[i] + k * cross[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_come_back_from_every_space() {
        for (space, stage) in ColourSpace::ALL.into_iter().flat_map(|s| [Stage::Linear, Stage::Display].map(|t| (s, t)))
        {
            let change = ColourChange { stage, operations: vec![Operation::To(space), Operation::From(space)] };
            if change.check().is_err() {
                continue;
            }
            let colour = |i: usize| [i % 11, i / 11 % 11, i / 121].map(|v| v as f32 / 10.0);
            let before: Vec<[f32; 3]> = (0..1331).map(colour).collect();
            let far = |after: &[[f32; 3]]| {
                let pairs = after.as_flattened().iter().zip(before.as_flattened());
                pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
            };
            let mut linear = Plane::from_samples(121, 11, before.clone()).expect("filled");
            change.apply_linear(&mut linear);
            let mut display = Plane::from_samples(121, 11, before.clone()).expect("filled");
            change.apply_display(&mut display);
            assert!(far(linear.samples()) < 1e-6 && far(display.samples()) < 1e-6, "{space:?}");
        }
    }

    #[test]
    fn operations_become_one_matrix_without_a_clip_between() {
        let operations =
            vec![Operation::Offset([2.0; 3]), Operation::To(ColourSpace::Yuv), Operation::From(ColourSpace::Yuv)];
        let there = ColourChange { stage: Stage::Display, operations };
        let back = ColourChange {
            operations: [there.operations.clone(), vec![Operation::Offset([-2.0; 3])]].concat(),
            ..there
        };
        let mut image = Plane::from_samples(2, 1, vec![[0.1, 0.6, 0.9], [0.3, 0.2, 0.1]]).expect("filled");
        let before = image.clone();
        back.apply_display(&mut image);
        let same =
            image.samples().iter().zip(before.samples()).all(|(a, b)| (0..3).all(|c| (a[c] - b[c]).abs() < 1e-6));
        assert!(same, "{image:?}");
        let mut bright = before.clone();
        ColourChange { stage: Stage::Display, operations: vec![Operation::Brightness(2.0)] }.apply_display(&mut bright);
        assert_eq!(bright.at(0, 0), [0.2, 1.0, 1.0]);
    }

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
        // A third of a turn maps red to green, except for luminance.
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
