//! The filters of the paper (Gruyer, Grapinet & De Souza 2012), separate from the physical camera, for reproduction.
//!
//! They change a finished image, as the paper's plug-ins change a rendered one, without physical quantities: their noise is not the noise of a
//! sensor. The paper gives formulas for the noises and for the affine colour matrix, and only descriptions of glow, tone mapping and drops: those
//! implemented here are **an interpretation**, stated at the head of each file.
//!
//! | filter | works on | paper |
//! | --- | --- | --- |
//! | [`Glow`]: gain control by the histogram, blooming | linear light | in words |
//! | [`ToneMap`]: the sensor's sensitivity curve, blended with the unmapped image | linear light | in words |
//! | [`Drops`]: inverted images in discs, which flow and fade | linear light | in words |
//! | [`ColourChange`]: a 4 × 4 affine matrix | either | formula |
//! | [`PulseNoise`], [`GaussianNoise`], [`UniformNoise`] | the encoded image | formula |
//!
//! Filters are applied in the order given, those of linear light before the tone curve, the others after sharpening. "Brightness" of a pixel is
//! interpreted as all three channels equally, so each noise uses one random number per pixel. Amplitudes of noise are digital numbers of an 8-bit
//! image (white is 255), for any output bit depth; every result of an encoded image is clipped to 0 … 255.

mod colour;
mod colour_space;
mod drops;
mod exposure;
mod noise;
mod pixels;

use etendue_core::quantity::{Display, LinearRgb};
use etendue_core::{Plane, random::FrameAddress};

use pixels::{BrightnessChange, FilterAddress, change_brightness, demand, for_each};

pub use colour::{Affine, ColourChange, ColourSpace, Operation};
pub use drops::Drops;
pub use exposure::{Glow, Sensitivity, ToneMap};
pub use noise::{GaussianNoise, PulseNoise, UniformNoise};
pub use pixels::{FilterError, Stage};

/// One of the paper's filters.
#[derive(Clone, Debug, PartialEq)]
pub enum Filter {
    /// Gain control and blooming.
    Glow(Glow),
    /// From the scene's range to the sensor's.
    ToneMap(ToneMap),
    /// Drops of rain on the image.
    Drops(Drops),
    /// An affine matrix on colours.
    Colour(ColourChange),
    /// Some pixels brighter, some darker.
    PulseNoise(PulseNoise),
    /// A normal number added.
    GaussianNoise(GaussianNoise),
    /// A uniform number as a factor.
    UniformNoise(UniformNoise),
}

impl Filter {
    /// The stage it applies to.
    #[must_use]
    pub fn stage(&self) -> Stage {
        match self {
            Self::Glow(_) | Self::ToneMap(_) | Self::Drops(_) => Stage::Linear,
            Self::Colour(change) => change.stage,
            Self::PulseNoise(_) | Self::GaussianNoise(_) | Self::UniformNoise(_) => Stage::Display,
        }
    }

    /// Checks the ranges of the parameters.
    ///
    /// # Errors
    /// If one is out of range.
    pub fn check(&self) -> Result<(), FilterError> {
        match self {
            Self::Glow(filter) => filter.check(),
            Self::ToneMap(filter) => filter.check(),
            Self::Drops(filter) => filter.check(),
            Self::Colour(filter) => filter.check(),
            Self::PulseNoise(filter) => filter.check(),
            Self::GaussianNoise(filter) => filter.check(),
            Self::UniformNoise(filter) => filter.check(),
        }
    }

    fn apply_linear(&self, image: &mut Plane<LinearRgb>, address: FrameAddress) {
        match self {
            Self::Glow(filter) => filter.apply(image),
            Self::ToneMap(filter) => filter.apply(image),
            Self::Drops(filter) => filter.apply(image, address),
            Self::Colour(filter) => filter.apply_linear(image),
            Self::PulseNoise(_) | Self::GaussianNoise(_) | Self::UniformNoise(_) => {}
        }
    }

    fn apply_display(&self, image: &mut Plane<Display>, address: FilterAddress) {
        match self {
            Self::PulseNoise(filter) => filter.apply(image, address),
            Self::GaussianNoise(filter) => filter.apply(image, address),
            Self::UniformNoise(filter) => filter.apply(image, address),
            Self::Colour(filter) => filter.apply_display(image),
            Self::Glow(_) | Self::ToneMap(_) | Self::Drops(_) => {}
        }
    }
}

/// Checks that a list of filters can be applied.
///
/// # Errors
/// If a number is out of range or the order mixes the stages.
pub fn check(filters: &[Filter]) -> Result<(), FilterError> {
    filters.iter().try_for_each(Filter::check)?;
    let position = filters.windows(2).position(|pair| pair[1].stage() < pair[0].stage());
    position.map_or(Ok(()), |i| Err(FilterError::Order(i + 2)))
}

/// Applies the filters of linear light.
pub(crate) fn apply_linear(filters: &[Filter], image: &mut Plane<LinearRgb>, address: FrameAddress) {
    filters.iter().filter(|f| f.stage() == Stage::Linear).for_each(|f| f.apply_linear(image, address));
}

/// Applies the filters of the encoded image.
pub(crate) fn apply_display(filters: &[Filter], image: &mut Plane<Display>, address: FrameAddress) {
    for (place, filter) in filters.iter().filter(|f| f.stage() == Stage::Display).enumerate() {
        filter.apply_display(image, FilterAddress { image: address, place: place as u32 });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::pixels::WHITE_DN;

    /// The first filter of a frame.
    pub(super) fn address(seed: u64, camera: u32, frame: u32) -> FilterAddress {
        FilterAddress { image: FrameAddress { seed, camera, frame, capture: 0 }, place: 0 }
    }

    fn standard_deviation(image: &Plane<Display>) -> f64 {
        let n = image.samples().len() as f64;
        let values = || image.samples().iter().map(|rgb| WHITE_DN * f64::from(rgb[1]));
        let mean = values().sum::<f64>() / n;
        (values().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt()
    }

    #[test]
    fn two_noises_of_a_kind_are_independent() {
        let noise = Filter::GaussianNoise(GaussianNoise { sigma_dn: 6.0 });
        let mut image = Plane::filled(200, 200, [0.5; 3]);
        apply_display(&[noise.clone(), noise], &mut image, FrameAddress::default());
        // √2 · 6 DN; of 40 000 numbers 4.5 standard errors are 1.6 %. Equal numbers in both would give 12 DN.
        assert!((standard_deviation(&image) / 72.0_f64.sqrt() - 1.0).abs() < 0.016, "{}", standard_deviation(&image));
    }

    #[test]
    fn numbers_are_those_of_an_8_bit_image_and_clip_at_its_ends() {
        let (pulse, seed) = (PulseNoise { amplitude_dn: 51.0, probability: 0.5 }, FrameAddress::default());
        let mut image = Plane::filled(64, 64, [0.1, 0.5, 0.9]);
        apply_display(&[Filter::PulseNoise(pulse)], &mut image, seed);
        // 51 of 255 is 0.2; black and white are the ends.
        let near = |a: [f32; 3], b: [f32; 3]| (0..3).all(|c| (a[c] - b[c]).abs() < 1e-6);
        assert!(image.samples().iter().all(|rgb| near(*rgb, [0.3, 0.7, 1.0]) || near(*rgb, [0.0, 0.3, 0.7])));
    }

    #[test]
    fn linear_filters_come_first() {
        let noise = Filter::PulseNoise(PulseNoise { amplitude_dn: 9.0, probability: 0.1 });
        let glow = Filter::Glow(Glow { percentile: 50.0, target: 0.2, threshold: 0.9, radius_px: 2.0, strength: 0.5 });
        assert_eq!(check(&[glow.clone(), noise.clone()]), Ok(()));
        assert_eq!(check(&[noise, glow]), Err(FilterError::Order(2)));
    }
}
