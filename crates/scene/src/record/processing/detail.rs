//! Noise reduction and sharpening.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{integer, keyed, number, record};

keyed! {
    /// Noise reduction method.
    pub enum NoiseReductionKind {
        /// Bilateral filter (Tomasi & Manduchi 1998): spatial σ; with "range".
        bilateral_px => Bilateral(Placed<f64>) = number("px").above(0.0).at_most(10.0);
        /// Median over a square of 2 r + 1 pixels: r.
        median_px => Median(Placed<u64>) = integer(1, 3);
    }
}

record! {
    /// Noise reduction.
    pub struct NoiseReduction check(check) {
        /// Method.
        inside kind: NoiseReductionKind;
        /// With "bilateral_px": σ over the colours, fraction of white; two or three times the noise.
        optional range: Placed<f64> = number("").above(0.0).at_most(1.0);
    }
}

fn check(reduction: &NoiseReduction, errors: &mut DescriptionErrors) {
    match (&reduction.kind, &reduction.range) {
        (NoiseReductionKind::Bilateral(_), None) => {
            errors.add(
                ErrorCode::MissingKey,
                &reduction.place,
                "\"bilateral_px\" needs \"range\"",
                "add it: two or three times the noise, as a fraction of white",
            );
        }
        (NoiseReductionKind::Median(_), Some(range)) => {
            errors.add(
                ErrorCode::NoEffect,
                &range.place,
                "\"range\" has no effect here, it belongs to \"bilateral_px\"",
                "remove it",
            );
        }
        _ => {}
    }
}

record! {
    /// Unsharp mask on luma.
    pub struct Sharpening {
        /// Factor on the detail.
        required amount: Placed<f64> = number("").above(0.0).at_most(10.0);
        /// σ of the blur that separates detail.
        required radius_px: Placed<f64> = number("px").above(0.0).at_most(50.0);
        /// Amplitude up to which detail is unchanged, fraction of white. Default: 0.
        optional threshold: Placed<f64> = number("").at_least(0.0).at_most(1.0);
    }
}
