//! Which colour a pixel of a raw picture measures, in the words of development.

/// What a pixel's filter lets through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
}

/// How filters lie over the raster.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mosaic {
    /// No filters: every pixel measures lightness.
    Mono,
    /// A tile that repeats from the top left corner. Made by [`Mosaic::tile`].
    Tile(Tile),
}

/// A rectangle of filters, every two by two neighbours of which hold all three colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    width: usize,
    filters: Vec<Filter>,
}

/// Why a mosaic cannot be developed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MosaicError {
    /// No pixels, or not a rectangle.
    #[error("a filter tile {width} wide and {height} high needs {} entries and at least one, but {entries} are given", .width * .height)]
    Shape {
        /// Columns asked for.
        width: usize,
        /// Rows asked for.
        height: usize,
        /// Entries given.
        entries: usize,
    },
    /// Somewhere a colour is farther than a neighbour away.
    #[error(
        "the two by two pixels at column {x}, row {y} of the filter tile lack a colour, and bilinear demosaic needs red, green and blue in each: only Bayer-like tiles can be developed"
    )]
    Sparse {
        /// Column of the block's top left pixel.
        x: usize,
        /// Row of the block's top left pixel.
        y: usize,
    },
}

impl Mosaic {
    /// A repeating tile of filters, row by row.
    ///
    /// # Errors
    /// Where the entries do not fill the tile, or two by two neighbours anywhere lack a colour.
    pub fn tile(width: usize, height: usize, filters: Vec<Filter>) -> Result<Self, MosaicError> {
        if filters.is_empty() || width * height != filters.len() {
            return Err(MosaicError::Shape { width, height, entries: filters.len() });
        }
        let tile = Tile { width, filters };
        for (x, y) in (0..width * height).map(|i| (i % width, i / width)) {
            let block = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| tile.at(x + dx, y + dy));
            if ![Filter::Red, Filter::Green, Filter::Blue].iter().all(|f| block.contains(f)) {
                return Err(MosaicError::Sparse { x, y });
            }
        }
        Ok(Self::Tile(tile))
    }
}

impl Tile {
    /// The filter of the pixel in column `x`, row `y`.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> Filter {
        let height = self.filters.len() / self.width;
        self.filters[y % height * self.width + x % self.width]
    }
}

#[cfg(test)]
mod tests {
    use super::Filter::{Blue, Green, Red};
    use super::*;

    #[test]
    fn bayer_tiles_pass_and_others_are_told_why_not() {
        assert!(Mosaic::tile(2, 2, vec![Green, Blue, Red, Green]).is_ok());
        assert_eq!(Mosaic::tile(2, 2, vec![Red; 4]), Err(MosaicError::Sparse { x: 0, y: 0 }));
        assert!(matches!(Mosaic::tile(2, 2, vec![Red]), Err(MosaicError::Shape { .. })));
        // A quad-Bayer tile has blocks of one colour.
        let quad = [Red, Red, Green, Green, Red, Red, Green, Green, Green, Green, Blue, Blue, Green, Green, Blue, Blue];
        assert!(Mosaic::tile(4, 4, quad.to_vec()).is_err());
    }
}
