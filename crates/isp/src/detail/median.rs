//! Median of each channel over a square; at the picture's edge over the pixels that exist.

use rayon::prelude::*;

pub(super) fn apply<const N: usize>(picture: &[[f32; N]], width: usize, radius: usize) -> Vec<[f32; N]> {
    let height = picture.len() / width.max(1);
    let at = |i: usize| {
        let (x, y) = (i % width, i / width);
        core::array::from_fn(|c| {
            let mut values = [0.0; 49];
            let mut count = 0;
            for row in y.saturating_sub(radius)..(y + radius + 1).min(height) {
                for column in x.saturating_sub(radius)..(x + radius + 1).min(width) {
                    values[count] = picture[row * width + column][c];
                    count += 1;
                }
            }
            middle(&mut values[..count])
        })
    };
    (0..picture.len()).into_par_iter().map(at).collect()
}

/// The value in the middle; of an even number the lower of the two.
fn middle(values: &mut [f32]) -> f32 {
    let half = (values.len() - 1) / 2;
    *values.select_nth_unstable_by(half, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_pixels_go_and_edges_stay() {
        let mut picture: Vec<[f32; 2]> = (0..80).map(|i| if i % 10 < 5 { [0.1, 0.9] } else { [0.6, 0.2] }).collect();
        let clean = picture.clone();
        picture[22] = [1.0, 0.0];
        picture[57] = [0.0, 1.0];
        assert_eq!(apply(&picture, 10, 1), clean);
    }
}
