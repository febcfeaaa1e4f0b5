//! Raw images: normalisation to fractions of the range from black to white, and the colour measured by each pixel.
//!
//! Black level: the digital number of no light, from which every later step counts.
//!
//! From optical-black pixels it is their interquartile mean: the mean without the lowest and the highest quarter. Hot and dead pixels do not move it,
//! and its resolution is finer than one digital number. For Gaussian noise of σ its standard error is 1.09 σ/√n (Tukey 1962, trimmed means). One
//! level applies to the whole image; differences from row to row remain. It is at least 1 DN below the white level: a frame whose optical-black
//! pixels are saturated (by heat) is still a valid image, without visible content.
//!
//! The colour measured by each pixel of a raw image, in the terms of development.
//!
//! A tile of filters repeats from the top left corner. The kinds of filter in it, in the order of [`Filter`], are the **channels** of the image: a
//! Bayer tile has red, green and blue, an RCCC tile red and clear.

use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Quantity};
use rayon::prelude::*;

/// A raw image, with the data needed for development.
#[derive(Clone, Copy, Debug)]
pub struct RawImage<'a> {
    /// Digital numbers.
    pub plane: &'a Plane<DigitalNumber>,
    /// Digital number of no light.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// The colour measured by each pixel.
    pub mosaic: &'a Mosaic,
    /// Digital numbers of optical-black pixels, of any shape, if the sensor has some.
    pub optical_black: Option<&'a Plane<DigitalNumber>>,
}

/// Converts a digital number to floating point; exact to 24 bits.
fn real(dn: <DigitalNumber as Quantity>::Sample) -> f32 {
    f64::from(dn) as f32
}

/// Samples with black at 0 and white at 1; no sample exceeds 1. Noise below black stays negative.
pub(crate) fn normalised(plane: &Plane<DigitalNumber>, black_dn: f64, white_dn: f64) -> Vec<f32> {
    let black = black_dn as f32;
    let scale = (1.0 / (white_dn - black_dn)) as f32;
    plane.samples().par_iter().map(|dn| ((real(*dn) - black) * scale).min(1.0)).collect()
}

/// Source of the black level.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum BlackLevel {
    /// As the sensor states it.
    #[default]
    Stated,
    /// A fixed value, DN.
    Fixed(f64),
    /// From the optical-black pixels.
    OpticalBlack,
}

/// The black level, DN; `None` if optical-black pixels are requested and the image has none.
pub(crate) fn black_level(rule: BlackLevel, raw: &RawImage<'_>) -> Option<f64> {
    match rule {
        BlackLevel::Stated => Some(raw.black_level_dn),
        BlackLevel::Fixed(dn) => Some(dn),
        BlackLevel::OpticalBlack => {
            let shielded = raw.optical_black.filter(|plane| !plane.samples().is_empty())?;
            let mean = interquartile_mean(shielded.samples().iter().map(|dn| real(*dn)).collect());
            Some(mean.min(raw.white_level_dn - 1.0))
        }
    }
}

/// Mean of the middle half.
fn interquartile_mean(mut values: Vec<f32>) -> f64 {
    values.sort_unstable_by(f32::total_cmp);
    let cut = values.len() / 4;
    let middle = &values[cut..values.len() - cut];
    middle.iter().map(|v| f64::from(*v)).sum::<f64>() / middle.len() as f64
}

/// Maximum number of channels of an image.
pub const MAX_CHANNELS: usize = 4;

/// Maximum distance of colours used in interpolation, px.
const MAX_REACH: usize = 4;

/// Passband of a pixel's filter. The order is the order of channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Filter {
    Red,
    Green,
    Blue,
    /// Everything the sensor sees: "C" of RCCC and RCCB, "W" of RGBW.
    Clear,
    /// Near infrared.
    Infrared,
    /// Green and blue.
    Cyan,
    /// Red and blue.
    Magenta,
    /// Red and green.
    Yellow,
}

/// Arrangement of filters over the raster.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mosaic {
    /// No filters: every pixel measures lightness.
    Mono,
    /// A tile that repeats from the top left corner. Created by [`Mosaic::tile`].
    Tile(Tile),
}

/// A rectangle of filters of two to four kinds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    width: usize,
    channels: Vec<usize>,
    filters: Vec<Filter>,
    reach: usize,
}

/// Error of a mosaic.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MosaicError {
    /// No pixels, or not a rectangle.
    #[error("a filter tile of {width} × {height} pixels needs {} entries (at least one), but their number is {entries}", .width * .height)]
    Shape {
        /// Columns requested.
        width: usize,
        /// Rows requested.
        height: usize,
        /// Entries given.
        entries: usize,
    },
    /// One kind of filter, or too many.
    #[error(
        "a filter tile of {0} kinds of filter cannot be developed: two to four are expected; a tile of one is mono"
    )]
    Kinds(usize),
    /// A tile in which a colour is too far away.
    #[error(
        "a block of {MAX_REACH} × {MAX_REACH} pixels of the filter tile lacks one of its colours, and interpolation reaches no farther: use a tile \
         with its colours closer together"
    )]
    Sparse,
}

impl Mosaic {
    /// Creates a repeating tile of filters, row by row.
    ///
    /// # Errors
    /// If the entries do not fill the tile, are of one kind or more than four, or leave a colour too far away.
    pub fn tile(width: usize, height: usize, filters: Vec<Filter>) -> Result<Self, MosaicError> {
        if filters.is_empty() || width * height != filters.len() {
            return Err(MosaicError::Shape { width, height, entries: filters.len() });
        }
        let mut kinds = filters.clone();
        kinds.sort_unstable();
        kinds.dedup();
        if !(2..=MAX_CHANNELS).contains(&kinds.len()) {
            return Err(MosaicError::Kinds(kinds.len()));
        }
        let channel = |filter: &Filter| kinds.partition_point(|kind| kind < filter);
        let channels = filters.iter().map(channel).collect();
        let tile = Tile { width, channels, filters: kinds, reach: 0 };
        let reach = (1..MAX_REACH).find(|reach| tile.full(reach + 1)).ok_or(MosaicError::Sparse)?;
        Ok(Self::Tile(Tile { reach, ..tile }))
    }

    /// Channels of the image; 1 for a mono image.
    #[must_use]
    pub fn channels(&self) -> usize {
        match self {
            Self::Mono => 1,
            Self::Tile(tile) => tile.filters.len(),
        }
    }

    /// The channel of the pixel in column `x`, row `y`.
    #[must_use]
    pub fn channel_at(&self, x: usize, y: usize) -> usize {
        match self {
            Self::Mono => 0,
            Self::Tile(tile) => tile.at(x, y),
        }
    }

    /// Columns and rows after which the filters repeat.
    #[must_use]
    pub fn period(&self) -> (usize, usize) {
        match self {
            Self::Mono => (1, 1),
            Self::Tile(tile) => (tile.width, tile.height()),
        }
    }
}

impl Tile {
    /// The channel of the pixel in column `x`, row `y`.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> usize {
        self.channels[y % self.height() * self.width + x % self.width]
    }

    /// Rows of the tile.
    #[must_use]
    pub fn height(&self) -> usize {
        self.channels.len() / self.width
    }

    /// The kinds of filter, one per channel.
    #[must_use]
    pub fn filters(&self) -> &[Filter] {
        &self.filters
    }

    /// Maximum distance from a pixel to each of the colours, px: 1 for tiles of two by two.
    #[must_use]
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// True if it is a Bayer tile in any of its four phases.
    #[must_use]
    pub fn is_bayer(&self) -> bool {
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| self.at(x, y));
        let two_by_two = self.width <= 2 && self.height() <= 2 && self.channels.len() == 4;
        self.filters == [Filter::Red, Filter::Green, Filter::Blue]
            && two_by_two
            && matches!(corners, [1, _, _, 1] | [_, 1, 1, _])
    }

    /// True if every block of `size` × `size` pixels contains all channels.
    fn full(&self, size: usize) -> bool {
        let in_block = |x: usize, y: usize| {
            let mut is_used = [false; MAX_CHANNELS];
            for (dx, dy) in (0..size * size).map(|i| (i % size, i / size)) {
                is_used[self.at(x + dx, y + dy)] = true;
            }
            is_used.into_iter().filter(|s| *s).count() == self.filters.len()
        };
        (0..self.channels.len()).all(|i| in_block(i % self.width, i / self.width))
    }
}

#[cfg(test)]
mod tests {
    use etendue_core::Plane;

    use super::Filter::{Blue, Clear, Cyan, Green, Infrared, Magenta, Red, Yellow};
    use super::*;

    #[test]
    fn hot_and_dead_pixels_do_not_move_it() {
        let (black, hot) = (63_u8, 255_u8);
        let mut samples: Vec<_> = (0..400).map(|i| (black + u8::from(i % 3 < 2)).into()).collect();
        for i in 0..20 {
            samples[i * 20] = hot.into();
            samples[i * 20 + 7] = 0_u8.into();
        }
        let shielded = Plane::from_samples(100, 4, samples).expect("filled");
        let plane = Plane::new(2, 2);
        let raw = RawImage {
            plane: &plane,
            black_level_dn: 10.0,
            white_level_dn: 255.0,
            mosaic: &Mosaic::Mono,
            optical_black: Some(&shielded),
        };
        let level = black_level(BlackLevel::OpticalBlack, &raw).expect("there are some");
        // Of 400 numbers 20 are 0 and 120 or more 63, so the middle 200 hold 40 to 47 of 63 and else 64.
        assert!((63.75..=63.8).contains(&level), "{level}");
        assert_eq!(black_level(BlackLevel::Stated, &raw), Some(10.0));
        assert_eq!(black_level(BlackLevel::Fixed(12.5), &raw), Some(12.5));
        let hot = Plane::filled(4, 4, 255_u8.into());
        let saturated = RawImage { optical_black: Some(&hot), ..raw };
        assert_eq!(black_level(BlackLevel::OpticalBlack, &saturated), Some(254.0));
        let bare = RawImage { optical_black: None, ..raw };
        assert_eq!(black_level(BlackLevel::OpticalBlack, &bare), None);
    }

    #[test]
    fn the_middle_half_is_averaged() {
        assert_eq!(interquartile_mean(vec![1e6, 5.0, 4.0, 6.0, 7.0, -1e6, 3.0, 8.0]), 5.5);
        assert_eq!(interquartile_mean(vec![3.0]), 3.0);
    }

    fn tile(width: usize, height: usize, filters: &[Filter]) -> Tile {
        match Mosaic::tile(width, height, filters.to_vec()).expect("a legal tile") {
            Mosaic::Tile(tile) => tile,
            Mosaic::Mono => unreachable!("a tile is not mono"),
        }
    }

    #[test]
    fn channels_are_the_kinds_of_filter_in_order() {
        let rccc = tile(2, 2, &[Red, Clear, Clear, Clear]);
        assert_eq!((rccc.filters(), rccc.at(0, 0), rccc.at(3, 5)), (&[Red, Clear][..], 0, 1));
        let cmyg = tile(2, 2, &[Cyan, Yellow, Green, Magenta]);
        assert_eq!((cmyg.filters(), cmyg.at(1, 0)), (&[Green, Cyan, Magenta, Yellow][..], 3));
        assert_eq!(tile(2, 2, &[Red, Green, Infrared, Blue]).reach(), 1);
    }

    #[test]
    fn only_bayer_is_bayer() {
        assert!(tile(2, 2, &[Green, Blue, Red, Green]).is_bayer() && tile(2, 2, &[Red, Green, Green, Blue]).is_bayer());
        assert!(!tile(2, 2, &[Red, Green, Blue, Green]).is_bayer());
        assert!(!tile(2, 2, &[Red, Clear, Clear, Blue]).is_bayer());
    }

    #[test]
    fn a_wider_tile_has_a_wider_reach() {
        let quad = [Red, Red, Green, Green, Red, Red, Green, Green, Green, Green, Blue, Blue, Green, Green, Blue, Blue];
        assert_eq!(tile(4, 4, &quad).reach(), 2);
    }

    #[test]
    fn what_cannot_be_developed_is_refused() {
        assert_eq!(Mosaic::tile(2, 2, vec![Red; 4]), Err(MosaicError::Kinds(1)));
        assert_eq!(Mosaic::tile(5, 1, vec![Red, Green, Blue, Clear, Cyan]), Err(MosaicError::Kinds(5)));
        assert!(matches!(Mosaic::tile(2, 2, vec![Red]), Err(MosaicError::Shape { .. })));
        let mut far = vec![Green; 36];
        far[0] = Red;
        assert_eq!(Mosaic::tile(6, 6, far), Err(MosaicError::Sparse));
    }
}
