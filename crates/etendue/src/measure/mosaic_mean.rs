//! A grey picture of a raw mosaic, without demosaicing.
//!
//! Weights 1, 2, 1 along rows and along columns, over 16, give each of the four places of a two by two tile a quarter, whatever place lies in the middle: every
//! pixel is the same mean of the colours, of red, green and blue a quarter, a half and a quarter in a Bayer mosaic. Where colours are alike but for a factor, as on
//! black and white charts, it is the picture blurred by a variance of half a pixel in both directions, without the patterns that demosaicing
//! draws along edges. Sharp edges move by some hundredths of a pixel with their place among the colours, the more the less alike the filters' responses are. Beyond its border the mosaic is taken as mirrored about the outermost pixels, which keeps colours in their places.

use etendue_metrology::Image;

/// The mean of the colours of a mosaic whose tile is two by two, at each of its pixels, without units of their own.
pub(super) fn mosaic_mean(mosaic: &Image) -> Image {
    let (width, height) = (mosaic.width(), mosaic.height());
    let of = |x: usize, y: usize| -> f32 {
        let (columns, rows) = (about(x, width), about(y, height));
        let row = |y: usize| mosaic.at(columns[0], y) + 2.0 * mosaic.at(columns[1], y) + mosaic.at(columns[2], y);
        (row(rows[0]) + 2.0 * row(rows[1]) + row(rows[2])) / 16.0
    };
    let samples = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| of(x, y));
    Image::from_samples(width, height, samples.collect()).expect("as many as before")
}

/// A place and those beside it, mirrored at the ends.
fn about(i: usize, count: usize) -> [usize; 3] {
    let last = count - 1;
    let before = if i == 0 { last.min(1) } else { i - 1 };
    let behind = if i == last { last.saturating_sub(1) } else { i + 1 };
    [before, i, behind]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of grey light of any gradient, colours of different responsivities give one mean, and nothing moves.
    #[test]
    fn every_pixel_is_the_same_mean_of_the_colours() {
        let responsivity = [[0.4_f32, 0.9], [1.0, 0.6]];
        let light = |x: usize, y: usize| 3.0 + 0.25 * x as f32 - 0.125 * y as f32;
        let (width, height) = (9, 6);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let mosaic = places.map(|(x, y)| responsivity[y % 2][x % 2] * light(x, y)).collect();
        let grey = mosaic_mean(&Image::from_samples(width, height, mosaic).expect("a picture"));
        let mean = (0.4 + 0.9 + 1.0 + 0.6) / 4.0;
        for y in 1..height - 1 {
            for x in 1..width - 1 {
                // Along a gradient a tile's colours lie aside of its middle by less than half a pixel on the whole: here by what the differences of the four are.
                let error = grey.at(x, y) / (mean * light(x, y)) - 1.0;
                assert!(error.abs() < 1e-6, "{x}, {y}: {error}");
            }
        }
    }

    #[test]
    fn at_the_border_colours_keep_their_places() {
        let mosaic = |width: usize, height: usize| {
            let samples = (0..height).flat_map(|y| (0..width).map(move |x| [[1.0, 2.0], [4.0, 9.0]][y % 2][x % 2]));
            Image::from_samples(width, height, samples.collect()).expect("a picture")
        };
        for (width, height) in [(2, 2), (3, 2), (7, 5)] {
            let grey = mosaic_mean(&mosaic(width, height));
            assert!((0..height).all(|y| (0..width).all(|x| grey.at(x, y) == 4.0)));
        }
    }
}
