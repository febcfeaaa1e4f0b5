//! Demosaic: the colours that a pixel did not measure, from its neighbours.
//!
//! | method | mosaics | looks as far as |
//! | --- | --- | --- |
//! | [`Demosaic::Bilinear`] | all | the tile's reach |
//! | [`Demosaic::MalvarHeCutler`] | Bayer | 2 px |
//! | [`Demosaic::HamiltonAdams`] | Bayer | 3 px |

mod bilinear;
mod hamilton_adams;
mod malvar;
mod padded;

use crate::mosaic::{Mosaic, Tile};

/// How colours are interpolated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Demosaic {
    /// The weighted mean of the neighbours of each colour.
    #[default]
    Bilinear,
    /// Bilinear, corrected by the second difference of the measured colour.
    MalvarHeCutler,
    /// Along the direction of the smaller gradient.
    HamiltonAdams,
}

impl Demosaic {
    /// The smallest picture, px a side, that the method can work on.
    #[must_use]
    pub fn least_px(self, mosaic: &Mosaic) -> usize {
        match (self, mosaic) {
            (_, Mosaic::Mono) => 0,
            (Self::Bilinear, Mosaic::Tile(tile)) => tile.reach() + 1,
            (Self::MalvarHeCutler, _) => malvar::MARGIN + 1,
            (Self::HamiltonAdams, _) => hamilton_adams::MARGIN + 1,
        }
    }

    /// All `N` channels at every pixel. The caller has checked that the method fits the tile. Runs in the rayon pool of
    /// the caller; the result does not depend on it.
    pub(crate) fn apply<const N: usize>(self, samples: &[f32], width: usize, tile: &Tile) -> Vec<[f32; N]> {
        let three = |rgb: Vec<[f32; 3]>| rgb.into_iter().map(|v| core::array::from_fn(|c| v[c])).collect();
        match self {
            Self::Bilinear => bilinear::demosaic(samples, width, tile),
            Self::MalvarHeCutler => three(malvar::demosaic(samples, width, tile)),
            Self::HamiltonAdams => three(hamilton_adams::demosaic(samples, width, tile)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Filter::{Blue, Green, Red};

    fn phases() -> [Mosaic; 4] {
        [[Red, Green, Green, Blue], [Green, Red, Blue, Green], [Green, Blue, Red, Green], [Blue, Green, Green, Red]]
            .map(|f| Mosaic::tile(2, 2, f.to_vec()).expect("Bayer"))
    }

    fn interpolated(method: Demosaic, samples: &[f32], width: usize, mosaic: &Mosaic) -> Vec<[f32; 3]> {
        match mosaic {
            Mosaic::Tile(tile) => method.apply(samples, width, tile),
            Mosaic::Mono => unreachable!("the phases are tiles"),
        }
    }

    const METHODS: [Demosaic; 3] = [Demosaic::Bilinear, Demosaic::MalvarHeCutler, Demosaic::HamiltonAdams];

    #[test]
    fn a_ramp_is_exact_inside_and_flat_colours_everywhere() {
        let (width, height) = (12, 9);
        let ramp: Vec<f32> = (0..width * height).map(|i| ((i % width) * 8 + (i / width) * 4) as f32).collect();
        for (mosaic, method) in phases().iter().flat_map(|m| METHODS.map(|method| (m, method))) {
            let plane = interpolated(method, &ramp, width, mosaic);
            for (x, y) in (3..height - 3).flat_map(|y| (3..width - 3).map(move |x| (x, y))) {
                // Sums of small whole numbers over powers of two: no rounding at all.
                assert_eq!(plane[y * width + x], [(x * 8 + y * 4) as f32; 3], "{method:?} {x} {y}");
            }
            let colour = [0.5, 0.25, 0.75];
            let flat: Vec<f32> = (0..64).map(|i| colour[mosaic.channel_at(i % 8, i / 8)]).collect();
            assert!(interpolated(method, &flat, 8, mosaic).iter().all(|rgb| *rgb == colour), "{method:?}");
        }
    }

    #[test]
    fn what_was_measured_stays() {
        let samples: Vec<f32> = (0..120).map(|i| (i * 37 % 101) as f32 / 101.0).collect();
        for (mosaic, method) in phases().iter().flat_map(|m| METHODS.map(|method| (m, method))) {
            let plane = interpolated(method, &samples, 12, mosaic);
            assert!((0..120).all(|i| plane[i][mosaic.channel_at(i % 12, i / 12)] == samples[i]), "{method:?}");
        }
    }

    fn square(x: f64) -> f64 {
        x * x
    }

    /// Root of the mean squared error of a grey disc of soft rim (2 px), away from the edge.
    fn disc_error(method: Demosaic, mosaic: &Mosaic) -> f64 {
        let n = 48;
        let truth = |i: usize| {
            let (x, y) = ((i % n) as f64 - 23.3, (i / n) as f64 - 22.6);
            (0.5 + 0.25 * (15.0 - (x * x + y * y).sqrt())).clamp(0.1, 0.9)
        };
        let samples: Vec<f32> = (0..n * n).map(|i| truth(i) as f32).collect();
        let plane = interpolated(method, &samples, n, mosaic);
        let inside = |i: &usize| (4..n - 4).contains(&(i % n)) && (4..n - 4).contains(&(i / n));
        let squares = (0..n * n).filter(inside).flat_map(|i| plane[i].map(|v| square(f64::from(v) - truth(i))));
        (squares.clone().sum::<f64>() / squares.count() as f64).sqrt()
    }

    #[test]
    fn gradients_make_edges_sharper_than_bilinear() {
        for mosaic in phases() {
            let [bilinear, malvar, adams] = METHODS.map(|m| disc_error(m, &mosaic));
            // Malvar, He & Cutler 2004 report 5.5 dB over bilinear on photographs: a factor of 1.9.
            assert!(malvar < bilinear / 1.5 && adams < bilinear / 1.5, "{bilinear} {malvar} {adams}");
        }
    }
}
