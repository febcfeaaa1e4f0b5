//! `cfa`: the colour filter array.

use crate::place::Placed;
use crate::reader::{Rule, choice, either, integer, list, record, text, variant, words};

/// A colour filter array.
#[derive(Clone, Debug)]
pub enum CfaSource {
    /// By its name.
    Named(Placed<Cfa>),
    /// By its tile.
    Tile(Tile),
}

words! {
    /// A named colour filter array.
    pub enum Cfa {
        /// No filters.
        "mono" => Mono,
        /// Red, green; green, blue.
        "rggb" => Rggb,
        /// Blue, green; green, red.
        "bggr" => Bggr,
        /// Green, red; blue, green.
        "grbg" => Grbg,
        /// Green, blue; red, green.
        "gbrg" => Gbrg,
        /// Red, clear; clear, clear.
        "rccc" => Rccc,
        /// Red, clear; clear, blue.
        "rccb" => Rccb,
        /// Red, green; white, blue.
        "rgwb" => Rgwb,
        /// Red, green; infrared, blue.
        "rgib" => Rgib,
        /// Cyan, yellow; green, magenta.
        "cygm" => Cygm,
    }
}

record! {
    /// A tile of filters, repeated over the image from its top-left pixel.
    pub struct Tile {
        /// Columns of the tile.
        required columns: Placed<u64> = integer(1, 64);
        /// Channels, row by row, each with its "quantum_efficiency".
        required channels: Vec<Placed<String>> = list(text("the name of a channel"), 1);
    }
}

impl Cfa {
    /// Names of the channels of two rows of two pixels; a single name where there are no filters.
    #[must_use]
    pub fn tile(self) -> &'static [&'static str] {
        match self {
            Self::Mono => &["mono"],
            Self::Rggb => &["red", "green", "green", "blue"],
            Self::Bggr => &["blue", "green", "green", "red"],
            Self::Grbg => &["green", "red", "blue", "green"],
            Self::Gbrg => &["green", "blue", "red", "green"],
            Self::Rccc => &["red", "clear", "clear", "clear"],
            Self::Rccb => &["red", "clear", "clear", "blue"],
            Self::Rgwb => &["red", "green", "white", "blue"],
            Self::Rgib => &["red", "green", "infrared", "blue"],
            Self::Cygm => &["cyan", "yellow", "green", "magenta"],
        }
    }
}

impl CfaSource {
    /// Columns of the tile, and the names of its channels, row by row.
    #[must_use]
    pub fn tile(&self) -> (usize, Vec<&str>) {
        match self {
            Self::Named(name) => {
                let tile = name.value.tile();
                (tile.len().min(2), tile.to_vec())
            }
            Self::Tile(tile) => (tile.columns.value as usize, tile.channels.iter().map(|c| c.value.as_str()).collect()),
        }
    }

    /// Names of the channels, each once; red, green and blue first where present.
    #[must_use]
    pub fn channels(&self) -> Vec<&str> {
        let mut names = self.tile().1;
        let order = |name: &str| ["red", "green", "blue"].iter().position(|n| *n == name).unwrap_or(3);
        names.sort_by_key(|name| (order(name), (*name).to_owned()));
        names.dedup();
        names
    }
}

pub(super) fn cfa() -> impl Rule<Out = CfaSource> {
    either(variant!(choice(), CfaSource::Named), variant!(record::<Tile>(), CfaSource::Tile))
}
