//! A photograph in memory, and what its channels are where nothing is said of them.

use super::raw::RawFacts;
use crate::encoding::{Encoding, Stated};

/// All kinds of file that are read.
pub(crate) const KINDS: &str = "PNG, JPEG, TIFF, uncompressed DNG, Radiance HDR, PFM or OpenEXR";

/// One channel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name: Y, R, G, B, A, or an EXR channel's full name.
    pub name: String,
    /// Numbers as stored.
    pub samples: Vec<f32>,
}

/// A picture to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Photograph {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels of equal size, in the order of the file.
    pub channels: Vec<Channel>,
    /// The largest number that the file can hold; `None` for floats.
    pub full_scale: Option<f64>,
    /// What the numbers are taken for, and why; a caller who is told otherwise changes it.
    pub stated: Stated,
    /// What a side-car states of a raw picture.
    pub raw: Option<RawFacts>,
    /// Pixels of a rendered picture whose errors may be equal, because their paths shared what they found; 1: none are.
    pub correlated_block_px: u32,
}

impl Photograph {
    /// The channel of that name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|c| c.name == name)
    }

    /// The names of all channels.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|c| c.name.as_str()).collect()
    }
}

/// Floats are in proportion to light.
pub(super) fn of_floats() -> Stated {
    Stated::new(Encoding::Linear, "floats")
}

/// What numbers up to `full_scale` are taken for where nothing says it.
pub(super) fn guess(full_scale: Option<f64>, colour: bool) -> Stated {
    match full_scale {
        None => of_floats(),
        Some(full) if full > 65_535.0 => Stated::guessed(Encoding::Linear, "whole numbers of 32 bits mostly are"),
        Some(full) if full > 255.0 && !colour => {
            Stated::guessed(Encoding::Linear, "grey numbers of 16 bits mostly are")
        }
        Some(full) if full > 255.0 => Stated::guessed(Encoding::Srgb, "colours of 16 bits mostly are"),
        Some(_) => Stated::guessed(Encoding::Srgb, "numbers of 8 bits mostly are"),
    }
}

/// Y, or R, G, B, each with A where there is one more.
pub(super) fn channel_names(count: usize) -> Option<&'static [&'static str]> {
    match count {
        1 => Some(&["Y"]),
        2 => Some(&["Y", "A"]),
        3 => Some(&["R", "G", "B"]),
        4 => Some(&["R", "G", "B", "A"]),
        _ => None,
    }
}

/// Channels of samples that lie side by side.
pub(super) fn separated(names: &[&str], samples: &[f32]) -> Vec<Channel> {
    let channel = |(i, name): (usize, &&str)| Channel {
        name: (*name).to_owned(),
        samples: samples.iter().skip(i).step_by(names.len()).copied().collect(),
    };
    names.iter().enumerate().map(channel).collect()
}
