//! Colour filter arrays: the channel of each pixel.

/// The four possible phases of a Bayer tile, named by its rows: the first two letters are the top row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BayerPhase {
    /// Red green / green blue.
    Rggb,
    /// Green red / blue green.
    Grbg,
    /// Green blue / red green.
    Gbrg,
    /// Blue green / green red.
    Bggr,
}

/// A tile of channel numbers that repeats over the raster from its top left corner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cfa {
    width: usize,
    channels: Vec<usize>,
}

/// Error of a tile.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CfaError {
    /// No pixels, or not a rectangle.
    #[error("a colour filter tile of {width} × {height} pixels needs {} entries (at least one), but their number is {entries}", .width * .height)]
    Shape {
        /// Columns requested.
        width: usize,
        /// Rows requested.
        height: usize,
        /// Entries given.
        entries: usize,
    },
}

impl Cfa {
    /// Every pixel is of channel 0.
    #[must_use]
    pub fn mono() -> Self {
        Self { width: 1, channels: vec![0] }
    }

    /// A Bayer tile over the channels 0 (red), 1 (green) and 2 (blue).
    #[must_use]
    pub fn bayer(phase: BayerPhase) -> Self {
        let channels = match phase {
            BayerPhase::Rggb => [0, 1, 1, 2],
            BayerPhase::Grbg => [1, 0, 2, 1],
            BayerPhase::Gbrg => [1, 2, 0, 1],
            BayerPhase::Bggr => [2, 1, 1, 0],
        };
        Self { width: 2, channels: channels.to_vec() }
    }

    /// Creates any tile, from channel numbers row by row.
    ///
    /// # Errors
    /// If the entries do not fill the tile or there are none.
    pub fn tile(width: usize, height: usize, channels: Vec<usize>) -> Result<Self, CfaError> {
        if channels.is_empty() || width * height != channels.len() {
            return Err(CfaError::Shape { width, height, entries: channels.len() });
        }
        Ok(Self { width, channels })
    }

    /// Columns of the tile.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows of the tile.
    #[must_use]
    pub fn height(&self) -> usize {
        self.channels.len() / self.width
    }

    /// The tile's channel numbers, row by row.
    #[must_use]
    pub fn channels(&self) -> &[usize] {
        &self.channels
    }

    /// The channel of the pixel in column `x`, row `y` of the raster.
    #[must_use]
    pub fn channel_at(&self, x: usize, y: usize) -> usize {
        self.channels[y % self.height() * self.width + x % self.width]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_named_by_their_rows() {
        let rows = |phase| {
            let cfa = Cfa::bayer(phase);
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| "rgb".as_bytes()[cfa.channel_at(x + 4, y + 6)] as char)
        };
        assert_eq!(rows(BayerPhase::Rggb), ['r', 'g', 'g', 'b']);
        assert_eq!(rows(BayerPhase::Grbg), ['g', 'r', 'b', 'g']);
        assert_eq!(rows(BayerPhase::Gbrg), ['g', 'b', 'r', 'g']);
        assert_eq!(rows(BayerPhase::Bggr), ['b', 'g', 'g', 'r']);
    }

    #[test]
    fn tiles_that_are_no_rectangles_are_refused() {
        assert!(Cfa::tile(2, 2, vec![0, 1, 1]).is_err());
        assert!(Cfa::tile(0, 0, vec![]).is_err());
        let rccc = Cfa::tile(2, 2, vec![0, 1, 1, 1]).expect("a rectangle");
        assert_eq!((rccc.channel_at(2, 2), rccc.channel_at(3, 2)), (0, 1));
    }
}
