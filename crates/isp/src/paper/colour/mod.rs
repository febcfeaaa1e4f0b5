//! Colour management: "a homogeneous transformation matrix on the colours of the rendered image", 4 × 4 and affine, on
//! the vector (R, G, B, 1).
//!
//! A change is a list of operations, which become **one** matrix (the first operation is applied first) and one clip to
//! 0 … 1 at the end (encoded pictures only), so that going to another space, changing something there, and coming back
//! loses nothing on the way.
//!
//! | operation | matrix |
//! | --- | --- |
//! | scale, offset | by channel; offset in shares of white |
//! | brightness b | b on all channels |
//! | saturation s | s 1 + (1 − s) e wᵀ: 0 is grey, 1 as it was |
//! | hue rotation θ | e wᵀ + (1 − e wᵀ) R(θ) (1 − e eᵀ/3): luminance and greys stay (after Haeberli 1993) |
//! | to, from a colour space | see [`ColourSpace`] |
//! | matrix | the upper three rows |
//!
//! e = (1, 1, 1); R(θ) turns about e, red towards green; w are the weights of luminance: of encoded pictures 0.299, 0.587,
//! 0.114 (ITU-R BT.601), of linear light 0.2126, 0.7152, 0.0722 (BT.709).

mod affine;
mod operation;
mod space;

pub use affine::Affine;
pub use operation::Operation;
pub use space::ColourSpace;

use super::{FilterError, Stage, for_each};
use etendue_core::Plane;
use etendue_core::quantity::{Display, LinearRgb, Quantity};

/// An affine matrix on colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourChange {
    /// What it works on.
    pub stage: Stage,
    /// What is done, in this order.
    pub operations: Vec<Operation>,
}

impl ColourChange {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        self.operations.iter().try_for_each(|operation| operation.check(self.stage))
    }

    /// All operations in one.
    #[must_use]
    pub fn matrix(&self) -> Affine {
        self.operations.iter().fold(Affine::IDENTITY, |all, next| all.then(&next.matrix(self.stage)))
    }

    pub(super) fn apply_linear(&self, picture: &mut Plane<LinearRgb>) {
        self.apply(picture, |v| v);
    }

    pub(super) fn apply_display(&self, picture: &mut Plane<Display>) {
        self.apply(picture, |v| v.clamp(0.0, 1.0));
    }

    fn apply<Q: Quantity<Sample = [f32; 3]>>(&self, picture: &mut Plane<Q>, clip: impl Fn(f32) -> f32 + Sync) {
        let matrix = self.matrix();
        for_each(picture, |_, rgb| matrix.apply(rgb.map(f64::from)).map(|v| clip(v as f32)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_come_back_from_every_space() {
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
        let mut picture = Plane::from_samples(2, 1, vec![[0.1, 0.6, 0.9], [0.3, 0.2, 0.1]]).expect("filled");
        let before = picture.clone();
        back.apply_display(&mut picture);
        let same =
            picture.samples().iter().zip(before.samples()).all(|(a, b)| (0..3).all(|c| (a[c] - b[c]).abs() < 1e-6));
        assert!(same, "{picture:?}");
        let mut bright = before.clone();
        ColourChange { stage: Stage::Display, operations: vec![Operation::Brightness(2.0)] }.apply_display(&mut bright);
        assert_eq!(bright.at(0, 0), [0.2, 1.0, 1.0]);
    }
}
