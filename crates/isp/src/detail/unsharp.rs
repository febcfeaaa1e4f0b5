//! Unsharp mask: what a blur takes away is added once more.
//!
//! On luma Y = 0.2126 R + 0.7152 G + 0.0722 B of the encoded picture (weights of ITU-R BT.709), so that colours do not
//! change: d = Y − blur_σ(Y); where |d| is above the threshold, each channel becomes its value + amount · d, clipped to
//! 0 … 1.

use super::{DetailError, blur, within};
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_spectra::colour::luma;
use rayon::prelude::*;

/// How much is added, and from what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsharp {
    /// Factor on the detail, above 0 and at most 10.
    pub amount: f64,
    /// σ of the blur, px, above 0 and at most 50.
    pub radius_px: f64,
    /// Detail below this (encoded, 0 … 1) is left alone, as it may be noise.
    pub threshold: f64,
}

impl Unsharp {
    /// Whether its numbers are in range.
    ///
    /// # Errors
    /// Where one is not.
    pub fn check(&self) -> Result<(), DetailError> {
        within("amount", self.amount, 0.0, 10.0, "above 0 and at most 10")?;
        within("radius_px", self.radius_px, 0.0, 50.0, "above 0 and at most 50")?;
        let threshold = self.threshold;
        let legal = (0.0..=1.0).contains(&threshold);
        let fault = DetailError::Range { name: "threshold", value: threshold, range: "from 0 to 1" };
        if legal { Ok(()) } else { Err(fault) }
    }

    /// Sharpens a picture. Runs in the rayon pool of the caller; the result does not depend on it.
    pub(crate) fn apply(&self, picture: &mut Plane<Display>) {
        let luma: Vec<[f32; 1]> = picture.samples().par_iter().map(|rgb| [luma(*rgb)]).collect();
        let blurred = blur::gaussian(&luma, picture.width(), self.radius_px);
        let (amount, threshold) = (self.amount as f32, self.threshold as f32);
        picture.samples_mut().par_iter_mut().enumerate().for_each(|(i, rgb)| {
            let detail = luma[i][0] - blurred[i][0];
            if detail.abs() > threshold {
                *rgb = rgb.map(|v| (v + amount * detail).clamp(0.0, 1.0));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge() -> Plane<Display> {
        let samples = (0..200).map(|i| if i % 20 < 10 { [0.3, 0.4, 0.5] } else { [0.6, 0.7, 0.8] }).collect();
        Plane::from_samples(20, 10, samples).expect("filled")
    }

    #[test]
    fn edges_overshoot_alike_in_all_channels_and_flats_stay() {
        let mut sharp = edge();
        Unsharp { amount: 1.0, radius_px: 1.0, threshold: 0.0 }.apply(&mut sharp);
        let (before, after) = (edge(), sharp);
        let change = |x: usize| [0, 1, 2].map(|c| after.at(x, 5)[c] - before.at(x, 5)[c]);
        assert!(change(9)[1] < -0.05 && change(10)[1] > 0.05);
        assert!((0..20).all(|x| change(x).iter().all(|c| (c - change(x)[0]).abs() < 1e-6)));
        assert!((0..5).all(|x| change(x)[0].abs() < 1e-6));
    }

    #[test]
    fn small_detail_is_left_alone() {
        let mut picture = edge();
        Unsharp { amount: 1.0, radius_px: 1.0, threshold: 0.5 }.apply(&mut picture);
        assert_eq!(picture, edge());
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let legal = Unsharp { amount: 1.0, radius_px: 1.0, threshold: 0.0 };
        assert!(legal.check().is_ok());
        assert!(Unsharp { amount: 0.0, ..legal }.check().is_err());
        assert!(Unsharp { radius_px: 51.0, ..legal }.check().is_err());
        assert!(Unsharp { threshold: -0.1, ..legal }.check().is_err());
    }
}
