//! A mosaic with a margin, mirrored about its outermost pixels, so that the tile goes on in phase.

/// Samples with a margin on all sides.
pub(super) struct Padded {
    samples: Vec<f32>,
    stride: usize,
    margin: usize,
}

impl Padded {
    /// At least `margin + 1` columns and rows are needed.
    pub(super) fn new(samples: &[f32], width: usize, margin: usize) -> Self {
        let (height, stride) = (samples.len() / width, width + 2 * margin);
        let mut padded = Vec::with_capacity(stride * (height + 2 * margin));
        for y in 0..height + 2 * margin {
            let row = &samples[mirrored(y, margin, height) * width..][..width];
            padded.extend((1..=margin).rev().map(|x| row[x]));
            padded.extend_from_slice(row);
            padded.extend((2..=margin + 1).map(|x| row[width - x]));
        }
        Self { samples: padded, stride, margin }
    }

    /// The row `dy` away from row `y`, margins included: column x stands at x + margin.
    pub(super) fn row(&self, y: usize, dy: isize) -> &[f32] {
        let row = (y + self.margin).wrapping_add_signed(dy);
        &self.samples[row * self.stride..][..self.stride]
    }
}

/// The row of the picture that row `y` of the padded one shows.
fn mirrored(y: usize, margin: usize, height: usize) -> usize {
    let folded = y.abs_diff(margin);
    if folded < height { folded } else { 2 * (height - 1) - folded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outermost_pixels_are_the_mirrors() {
        let padded = Padded::new(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0], 3, 2);
        assert_eq!(padded.row(0, 0), [3.0, 2.0, 1.0, 2.0, 3.0, 2.0, 1.0]);
        assert_eq!(padded.row(0, -2), padded.row(2, 0));
        assert_eq!(padded.row(2, 2), padded.row(0, 0));
        assert_eq!(padded.row(1, 2), padded.row(1, 0));
    }
}
