//! Stages and errors of the paper's filters, and changes of individual pixels.

use etendue_core::Plane;
use etendue_core::quantity::{Display, Quantity};
use etendue_core::random::{FrameAddress, NoiseDraw, NoiseKey, NoiseStream, Pixel};
use rayon::prelude::*;

/// Stage to which a filter applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Linear light, before the tone curve; white is 1 and larger values are possible.
    Linear,
    /// The encoded image, 0 to 1.
    Display,
}

/// Error of a filter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FilterError {
    /// A number out of its range.
    #[error("{name} is {value}, but a number {range} is needed")]
    Range {
        /// Name of the number.
        name: &'static str,
        value: f64,
        /// The legal range.
        range: &'static str,
    },
    /// A filter of linear light after one of the encoded image.
    #[error(
        "filter {0} (from 1) works on linear light, but one before it works on the encoded image: put glow, tone map, drops and linear colour first"
    )]
    Order(usize),
    /// A conversion that belongs to the other stage.
    #[error("conversions to and from {space} are for {wanted}: set \"on\" accordingly")]
    Space {
        /// The colour space.
        space: &'static str,
        /// The stage it is defined for.
        wanted: &'static str,
    },
}

/// Refuses a number outside a range.
pub(super) fn demand(legal: bool, name: &'static str, value: f64, range: &'static str) -> Result<(), FilterError> {
    if legal && value.is_finite() { Ok(()) } else { Err(FilterError::Range { name, value, range }) }
}

/// Address of a filter's random numbers: two filters of a kind have different ones.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FilterAddress {
    pub(super) image: FrameAddress,
    /// Its index among the filters of the encoded image.
    pub(super) place: u32,
}

pub(super) const WHITE_DN: f64 = 255.0;

/// Changes the brightness of each pixel by the same amount in all channels, in DN, from its own random number, and clips.
pub(super) fn change_brightness(
    image: &mut Plane<Display>,
    FilterAddress { image: address, place }: FilterAddress,
    purpose: NoiseDraw,
    change: impl Fn(&mut NoiseStream) -> BrightnessChange + Sync,
) {
    let (width, key) =
        (image.width().max(1), NoiseKey::new(address.seed, address.camera, address.frame, place, purpose));
    for_each(image, |i, rgb| {
        let mut stream = key.stream(Pixel { x: (i % width) as u32, y: (i / width) as u32 });
        let BrightnessChange { factor, offset_dn } = change(&mut stream);
        rgb.map(|v| (f64::from(v) * factor + offset_dn / WHITE_DN).clamp(0.0, 1.0) as f32)
    });
}

/// Change of a pixel's brightness.
pub(super) struct BrightnessChange {
    pub(super) factor: f64,
    pub(super) offset_dn: f64,
}

/// Replaces every pixel. Runs in the rayon pool of the caller.
pub(super) fn for_each<Q: Quantity<Sample = [f32; 3]>>(
    image: &mut Plane<Q>,
    change: impl Fn(usize, [f32; 3]) -> [f32; 3] + Sync,
) {
    image.samples_mut().par_iter_mut().enumerate().for_each(|(i, rgb)| *rgb = change(i, *rgb));
}
