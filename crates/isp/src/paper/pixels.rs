//! What a filter of the paper works on, why it cannot be applied, and how it changes pixels one by one.

use etendue_core::Plane;
use etendue_core::quantity::{Display, Quantity};
use etendue_core::random::{FrameAddress, NoiseDraw, NoiseKey, NoiseStream, Pixel};
use rayon::prelude::*;

/// What a filter works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Linear light, before the tone curve; white is 1 and more is possible.
    Linear,
    /// The encoded image, 0 to 1.
    Display,
}

/// Why a filter cannot be applied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FilterError {
    /// A number out of its range.
    #[error("{name} is {value}, but a number {range} is needed")]
    Range {
        /// Which number.
        name: &'static str,
        /// What it is.
        value: f64,
        /// What it should be.
        range: &'static str,
    },
    /// A filter of linear light after one of the encoded image.
    #[error(
        "filter {0} (from 1) works on linear light, but one before it on the encoded picture: give glow, tone map, drops and linear colour first"
    )]
    Order(usize),
    /// A conversion that belongs to the other stage.
    #[error("conversions to and from {space} are for {wanted}: set \"on\" accordingly")]
    Space {
        /// The colour space.
        space: &'static str,
        /// The stage it is made for.
        wanted: &'static str,
    },
}

/// Refuses a number outside a range.
pub(super) fn demand(legal: bool, name: &'static str, value: f64, range: &'static str) -> Result<(), FilterError> {
    if legal && value.is_finite() { Ok(()) } else { Err(FilterError::Range { name, value, range }) }
}

/// Which filter of an image the random numbers are for: two of a kind have their own.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FilterAddress {
    pub(super) picture: FrameAddress,
    /// Its place among the filters of the encoded image.
    pub(super) place: u32,
}

/// DN of white.
pub(super) const WHITE_DN: f64 = 255.0;

/// Gives each pixel's channels the same change of brightness in DN, from a random number of its own, and clips.
pub(super) fn change_brightness(
    picture: &mut Plane<Display>,
    FilterAddress { picture: address, place }: FilterAddress,
    draw: NoiseDraw,
    change: impl Fn(&mut NoiseStream) -> Change + Sync,
) {
    let (width, key) =
        (picture.width().max(1), NoiseKey::new(address.seed, address.camera, address.frame, place, draw));
    for_each(picture, |i, rgb| {
        let mut stream = key.stream(Pixel { x: (i % width) as u32, y: (i / width) as u32 });
        let Change { factor, offset_dn } = change(&mut stream);
        rgb.map(|v| (f64::from(v) * factor + offset_dn / WHITE_DN).clamp(0.0, 1.0) as f32)
    });
}

/// What happens to a pixel's brightness.
pub(super) struct Change {
    pub(super) factor: f64,
    pub(super) offset_dn: f64,
}

/// Replaces every pixel. Runs in the rayon pool of the caller.
pub(super) fn for_each<Q: Quantity<Sample = [f32; 3]>>(
    picture: &mut Plane<Q>,
    change: impl Fn(usize, [f32; 3]) -> [f32; 3] + Sync,
) {
    picture.samples_mut().par_iter_mut().enumerate().for_each(|(i, rgb)| *rgb = change(i, *rgb));
}
