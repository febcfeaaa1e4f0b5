//! The complete development from a raw image to a display image.

mod processing;

use etendue_core::quantity::{Display, LinearRgb};
use etendue_core::{Plane, random::FrameAddress};
use rayon::prelude::*;

use crate::paper::{self, Stage};
use crate::raw::{Mosaic, RawImage, Tile, black_level, normalised};
use crate::white_balance::{WhiteBalance, grey_world};
use crate::{colour_matrix::ColourMatrix, correction};

pub use processing::{Colour, DevelopError, Processing};

/// A developed image.
#[derive(Clone, Debug, PartialEq)]
pub struct DevelopmentResult {
    /// Linear sRGB, neither clipped below 0 nor above 1; camera channels end at white unless filters of linear light use values above it.
    pub linear: Plane<LinearRgb>,
    /// The same, clipped and encoded.
    pub display: Plane<Display>,
    /// Measured values of the development.
    pub report: DevelopmentReport,
}

/// Values that development measured in the image.
#[derive(Clone, Debug, PartialEq)]
pub struct DevelopmentReport {
    /// The subtracted black level, DN.
    pub black_level_dn: f64,
    /// The gains of the channels; empty for a mono image.
    pub white_balance: Vec<f64>,
    /// Number of corrected defective pixels.
    pub corrected_pixels: usize,
}

impl Processing {
    /// The maximum sample after white balance: the value displayed as white, or the full range if filters of linear light use it. Without the limit,
    /// interpolation next to a light a hundred times white would give a wall of ten times white the light of the lamp in some channels only, a fringe
    /// of pure colours where everything is white.
    fn ceiling(&self) -> f32 {
        let headroom = self.image_filters.iter().any(|filter| filter.stage() == Stage::Linear);
        if headroom { 1.0 } else { (1.0 / self.exposure_gain).min(1.0) as f32 }
    }

    /// A display image from linear light: tone curve, sharpening, the paper's filters of encoded images with the random numbers of `address`.
    #[must_use]
    pub fn displayed(&self, linear: &Plane<LinearRgb>, address: FrameAddress) -> Plane<Display> {
        let mut display = self.tone.encode_plane(linear);
        if let Some(sharpening) = &self.sharpening {
            sharpening.apply(&mut display);
        }
        paper::apply_display(&self.image_filters, &mut display, address);
        display
    }
}

/// Develops a raw image; `address` selects the random numbers of the paper's noises and drops. Runs in the rayon pool of the caller; the bits do not
/// depend on it.
///
/// # Errors
/// If image and processing contradict each other or a number is out of range.
pub fn develop(
    raw: &RawImage<'_>,
    processing: &Processing,
    address: FrameAddress,
) -> Result<DevelopmentResult, DevelopError> {
    processing.check(raw.mosaic, raw.plane.width(), raw.plane.height())?;
    let black = black_level(processing.black_level, raw).ok_or(DevelopError::NoOpticalBlack)?;
    processing::check_levels(black, raw.white_level_dn)?;
    let width = raw.plane.width();
    let samples = normalised(raw.plane, black, raw.white_level_dn);
    let (mut samples, corrected_pixels) = correction::corrected(samples, width, raw.mosaic, &processing.defects);
    shade(&mut samples, raw, processing);
    let gains = gains(&samples, raw, processing.colour.as_ref());
    balance(&mut samples, width, raw.mosaic, &gains, processing.ceiling());
    let linear = Plane::from_samples(width, raw.plane.height(), colours(samples, width, raw.mosaic, processing));
    let mut linear = linear.expect("as many colours as samples");
    paper::apply_linear(&processing.image_filters, &mut linear, address);
    let display = processing.displayed(&linear, address);
    let facts = DevelopmentReport { black_level_dn: black, white_balance: gains, corrected_pixels };
    Ok(DevelopmentResult { linear, display, report: facts })
}

/// Shading gains; a saturated sample stays 1.
fn shade(samples: &mut [f32], raw: &RawImage<'_>, processing: &Processing) {
    let Some(shading) = &processing.shading else { return };
    let (width, height) = (raw.plane.width(), raw.plane.height());
    samples.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        for (v, gain) in row.iter_mut().zip(shading.row(y, width, height)) {
            *v = (*v * gain).min(1.0);
        }
    });
}

/// The gains of the channels; empty for a mono image.
fn gains(samples: &[f32], raw: &RawImage<'_>, colour: Option<&Colour>) -> Vec<f64> {
    match colour.map(|c| &c.white_balance) {
        None => Vec::new(),
        Some(WhiteBalance::Gains(gains)) => gains.clone(),
        Some(WhiteBalance::GreyWorld) => grey_world(samples, raw.plane.width(), raw.mosaic),
    }
}

/// White balance; no sample exceeds `ceiling`. Noise below black stays negative.
fn balance(samples: &mut [f32], width: usize, mosaic: &Mosaic, gains: &[f64], ceiling: f32) {
    let Mosaic::Tile(tile) = mosaic else { return };
    let gains: Vec<f32> = gains.iter().map(|g| *g as f32).collect();
    samples.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        for (x, v) in row.iter_mut().enumerate() {
            *v = (*v * gains[tile.at(x, y)]).min(ceiling);
        }
    });
}

/// Linear sRGB of balanced samples.
fn colours(samples: Vec<f32>, width: usize, mosaic: &Mosaic, processing: &Processing) -> Vec<[f32; 3]> {
    match mosaic {
        Mosaic::Mono => {
            let grey = ColourMatrix::new([vec![1.0], vec![1.0], vec![1.0]]).expect("a column");
            let lone: Vec<[f32; 1]> = samples.into_par_iter().map(|v| [v]).collect();
            finished(lone, width, &grey, processing)
        }
        Mosaic::Tile(tile) => match tile.filters().len() {
            2 => interpolated::<2>(samples, width, tile, processing),
            3 => interpolated::<3>(samples, width, tile, processing),
            _ => interpolated::<4>(samples, width, tile, processing),
        },
    }
}

fn interpolated<const N: usize>(
    samples: Vec<f32>,
    width: usize,
    tile: &Tile,
    processing: &Processing,
) -> Vec<[f32; 3]> {
    let colour = processing.colour.as_ref().expect("checked: a tile has colour settings");
    let image = processing.demosaic.apply::<N>(&samples, width, tile);
    // The samples of a large image are dropped here, because its colours take three times their memory.
    drop(samples);
    finished(image, width, &colour.matrix, processing)
}

/// Noise reduction, colour matrix and digital gain.
fn finished<const N: usize>(
    image: Vec<[f32; N]>,
    width: usize,
    matrix: &ColourMatrix,
    processing: &Processing,
) -> Vec<[f32; 3]> {
    let image = match &processing.noise_reduction {
        Some(filter) => filter.apply(&image, width),
        None => image,
    };
    let rows: [[f32; N]; 3] = matrix
        .rows()
        .each_ref()
        .map(|row| core::array::from_fn(|channel| (row[channel] * processing.exposure_gain) as f32));
    image.par_iter().map(|channels| product(&rows, channels)).collect()
}

/// Left to right, so that three channels round as m₀ c₀ + m₁ c₁ + m₂ c₂.
fn product<const N: usize>(rows: &[[f32; N]; 3], channels: &[f32; N]) -> [f32; 3] {
    rows.map(|row| (1..N).fold(row[0] * channels[0], |sum, c| sum + row[c] * channels[c]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demosaic::Demosaic;
    use crate::raw::Filter::{Blue, Clear, Green, Infrared, Red};
    use crate::tone::to_8_bit;
    use etendue_core::quantity::{DigitalNumber, Quantity};
    use etendue_spectra::colour;

    type Dn = <DigitalNumber as Quantity>::Sample;

    fn processing() -> Processing {
        let rows = [vec![1.75, -0.5, -0.25], vec![-0.25, 1.5, -0.25], vec![0.0, -0.5, 1.5]];
        let matrix = ColourMatrix::new(rows).expect("a matrix");
        Processing::plain(Some(Colour { white_balance: WhiteBalance::Gains(vec![2.0, 1.0, 1.5]), matrix }))
    }

    fn bayer() -> Mosaic {
        Mosaic::tile(2, 2, vec![Red, Green, Green, Blue]).expect("Bayer")
    }

    /// A raw image of black 100 DN and white 1 100 DN.
    fn raw<'a>(plane: &'a Plane<DigitalNumber>, mosaic: &'a Mosaic) -> RawImage<'a> {
        RawImage { plane, black_level_dn: 100.0, white_level_dn: 1100.0, mosaic, optical_black: None }
    }

    fn plane(width: usize, height: usize, dn: impl Fn(usize, usize) -> Dn) -> Plane<DigitalNumber> {
        let samples = (0..width * height).map(|i| dn(i % width, i / width)).collect();
        Plane::from_samples(width, height, samples).expect("filled")
    }

    fn developed(dn: [Dn; 4], processing: &Processing) -> DevelopmentResult {
        let plane = plane(8, 6, |x, y| dn[y % 2 * 2 + x % 2]);
        develop(&raw(&plane, &bayer()), processing, FrameAddress::default()).expect("legal")
    }

    #[test]
    fn neutral_stays_neutral() {
        // 0.2 of the range in green, and the same after balance in red and blue.
        let image = developed([200, 300, 300, 233], &Processing { exposure_gain: 2.0, ..processing() });
        for rgb in image.linear.samples() {
            // Blue is off by a third of a digital number: 0.0005 · 1.5 · 2, times up to 1.5 by the matrix.
            assert!(rgb.iter().all(|v| (v - 0.4).abs() < 2.5e-3), "{rgb:?}");
        }
        let code = (255.0 * colour::encode(0.4)).round() as u8;
        assert!(to_8_bit(&image.display).iter().flatten().all(|v| v.abs_diff(code) <= 1));
    }

    #[test]
    fn saturation_is_white_and_not_magenta() {
        for dn in [[1100; 4], [4095; 4], [900, 1100, 1100, 950]] {
            let image = developed(dn, &processing());
            assert!(image.linear.samples().iter().flatten().all(|v| (v - 1.0).abs() < 1e-6));
            assert!(to_8_bit(&image.display).iter().all(|rgb| *rgb == [255; 3]));
        }
    }

    #[test]
    fn what_is_shown_as_white_has_no_coloured_rims() {
        // A white light next to a wall of an eighth of white, in an image of gain 64: both are white, and so is their border.
        let pattern = |x: usize, y: usize| if (x / 3 + y / 3).is_multiple_of(2) { 1100 } else { 225 };
        let plane = plane(18, 18, pattern);
        let bright = |filters| {
            let settings = Processing { exposure_gain: 64.0, image_filters: filters, ..processing() };
            develop(&raw(&plane, &bayer()), &settings, FrameAddress::default()).expect("legal")
        };
        let without_defects = bright(Vec::new());
        assert!(to_8_bit(&without_defects.display).iter().all(|rgb| *rgb == [255; 3]));
        assert!(without_defects.linear.samples().iter().flatten().all(|v| (v - 1.0).abs() < 1e-5));
        // A filter of linear light receives the full range of the raw: 64 times white.
        let halved = paper::ColourChange { stage: Stage::Linear, operations: vec![paper::Operation::Brightness(0.5)] };
        let largest =
            bright(vec![paper::Filter::Colour(halved)]).linear.samples().iter().fold(0.0, |m: f32, v| m.max(v[1]));
        assert!((31.9..50.0).contains(&largest), "{largest}");
    }

    #[test]
    fn noise_below_black_survives_to_the_linear_image() {
        let image = developed([90; 4], &processing());
        assert!(image.linear.samples().iter().all(|rgb| rgb[1] < 0.0));
        assert!(to_8_bit(&image.display).iter().all(|rgb| *rgb == [0; 3]));
    }

    #[test]
    fn mono_is_grey() {
        let plane = plane(3, 1, |x, _| [100, 600, 1100][x]);
        let image =
            develop(&raw(&plane, &Mosaic::Mono), &Processing::plain(None), FrameAddress::default()).expect("legal");
        assert_eq!(image.linear.samples(), [[0.0; 3], [0.5; 3], [1.0; 3]]);
    }

    #[test]
    fn grey_world_finds_the_gains_of_a_grey() {
        let mut grey = processing();
        grey.colour.as_mut().expect("colour").white_balance = WhiteBalance::GreyWorld;
        let image = developed([300, 500, 500, 350], &grey);
        let gains = &image.report.white_balance;
        assert!(
            gains.iter().zip([2.0, 1.0, 1.6]).all(|(actual, expected)| (actual - expected).abs() < 1e-6),
            "{gains:?}"
        );
        // The same grey everywhere: 0.4 of the range, to f32.
        assert!(image.linear.samples().iter().flatten().all(|v| (v - 0.4).abs() < 1e-6));
    }

    #[test]
    fn black_level_defects_and_shading_come_first() {
        let dark = plane(4, 4, |_, _| 200);
        // Half the light at the left edge of a flat image of 0.5, and one dead pixel.
        let fall = |x: usize| 0.5 + 0.5 * (x as f64 + 0.5) / 8.0;
        let shaded = plane(8, 6, |x, y| if (x, y) == (5, 2) { 0 } else { (200.0 + 450.0 * fall(x)) as Dn });
        let gains: Vec<f64> = [0.5, 1.0, 0.5, 1.0].map(|light| 1.0 / light).to_vec();
        let settings = Processing {
            black_level: crate::BlackLevel::OpticalBlack,
            defects: crate::Defects { map: vec![[5, 2]], outlier_threshold: None },
            shading: Some(crate::Shading::Grid { columns: 2, gains }),
            ..Processing::plain(None)
        };
        let raw = RawImage { optical_black: Some(&dark), ..raw(&shaded, &Mosaic::Mono) };
        let image = develop(&raw, &settings, FrameAddress::default()).expect("legal");
        assert_eq!((image.report.black_level_dn, image.report.corrected_pixels), (200.0, 1));
        let grey = |x: usize| f64::from(image.linear.at(x, 2)[0]);
        let expected = |x: usize| 0.5 * fall(x) * (2.0 - (x as f64 + 0.5) / 8.0);
        // 1/900 from the ADC; the dead pixel takes the median of its neighbours, between which light differs by 0.03.
        assert!((0..8).all(|x| (grey(x) - expected(x)).abs() < if x == 5 { 0.04 } else { 2.5e-3 }));
    }

    #[test]
    fn two_and_four_channels_are_developed_with_their_matrix() {
        let rccc = Mosaic::tile(2, 2, vec![Red, Clear, Clear, Clear]).expect("legal");
        let of = |mosaic: &Mosaic, rows: [Vec<f64>; 3], dn: [Dn; 4]| {
            let matrix = ColourMatrix::new(rows).expect("a matrix");
            let white_balance = WhiteBalance::Gains(vec![1.0; matrix.channels()]);
            let plane = plane(6, 6, |x, y| dn[y % 2 * 2 + x % 2]);
            let settings = Processing::plain(Some(Colour { white_balance, matrix }));
            develop(&raw(&plane, mosaic), &settings, FrameAddress::default()).expect("legal").linear.at(3, 3)
        };
        // Red unchanged, grey from clear.
        assert_eq!(of(&rccc, [vec![1.0, 0.0], vec![0.0, 1.0], vec![0.0, 1.0]], [350, 600, 600, 600]), [0.25, 0.5, 0.5]);
        let rgbi = Mosaic::tile(2, 2, vec![Red, Green, Infrared, Blue]).expect("legal");
        // Infrared is subtracted from all three.
        let rows = [0, 1, 2].map(|c| {
            (0..4)
                .map(|k| {
                    if k == c {
                        1.0
                    } else if k == 3 {
                        -1.0
                    } else {
                        0.0
                    }
                })
                .collect()
        });
        let [r, g, b] = of(&rgbi, rows, [600, 850, 350, 1100]);
        // Differences of numbers up to 1, to f32.
        assert!((r - 0.25).abs().max((g - 0.5).abs()).max((b - 0.75).abs()) < 2e-7);
    }

    #[test]
    fn contradictions_are_refused() {
        let (empty, mosaic) = (Plane::new(4, 4), bayer());
        let raw = RawImage { black_level_dn: 0.0, ..raw(&empty, &mosaic) };
        let mono = RawImage { mosaic: &Mosaic::Mono, ..raw };
        let with = |gains: Vec<f64>| {
            let mut settings = processing();
            settings.colour.as_mut().expect("colour").white_balance = WhiteBalance::Gains(gains);
            settings
        };
        let dim = Processing { exposure_gain: 0.0, ..processing() };
        let no_colour = Processing { colour: None, ..processing() };
        let shielded = Processing { black_level: crate::BlackLevel::OpticalBlack, ..processing() };
        let defects = crate::Defects { map: vec![[4, 0]], outlier_threshold: None };
        let with_defects = Processing { defects, ..processing() };
        let malvar = Processing { demosaic: Demosaic::MalvarHeCutler, ..processing() };
        let rccb = Mosaic::tile(2, 2, vec![Red, Clear, Clear, Blue]).expect("legal");
        let thin = Plane::new(4, 1);
        let cases = [
            (RawImage { white_level_dn: 0.0, ..raw }, processing(), DevelopError::Levels { black: 0.0, white: 0.0 }),
            (raw, with(vec![0.5, 1.0, 2.0]), DevelopError::WhiteBalance(vec![0.5, 1.0, 2.0])),
            (raw, with(vec![1.0]), DevelopError::Channels { mosaic: 3, settings: 1 }),
            (raw, dim, DevelopError::ExposureGain(0.0)),
            (raw, no_colour, DevelopError::NoColour),
            (raw, shielded, DevelopError::NoOpticalBlack),
            (raw, with_defects, DevelopError::DefectOutside { x: 4, y: 0, width: 4, height: 4 }),
            (mono, processing(), DevelopError::ColourOfMono),
            (RawImage { mosaic: &rccb, ..raw }, malvar, DevelopError::NotBayer),
            (RawImage { plane: &thin, ..raw }, processing(), DevelopError::TooSmall { width: 4, height: 1, least: 2 }),
        ];
        for (raw, processing, error) in cases {
            assert_eq!(develop(&raw, &processing, FrameAddress::default()), Err(error));
        }
    }

    #[test]
    fn threads_change_no_bit() {
        let (plane, mosaic) = (plane(31, 17, |x, y| ((y * 31 + x) * 37 % 1200) as Dn), bayer());
        let with = |threads, settings: &Processing| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| develop(&raw(&plane, &mosaic), settings, FrameAddress::default()).expect("legal"))
        };
        let bilateral = crate::Bilateral { radius_px: 1.5, range: 0.1 };
        let full = Processing {
            defects: crate::Defects { map: vec![[3, 4]], outlier_threshold: Some(0.2) },
            demosaic: Demosaic::HamiltonAdams,
            noise_reduction: Some(crate::NoiseReduction::Bilateral(bilateral)),
            sharpening: Some(crate::UnsharpMask { amount: 1.0, radius_px: 1.0, threshold: 0.0 }),
            image_filters: vec![
                paper::Filter::Glow(paper::Glow {
                    percentile: 50.0,
                    target: 0.2,
                    threshold: 0.5,
                    radius_px: 2.0,
                    strength: 0.5,
                }),
                paper::Filter::GaussianNoise(paper::GaussianNoise { sigma_dn: 4.0 }),
            ],
            ..processing()
        };
        for settings in [processing(), full] {
            assert_eq!(with(1, &settings), with(3, &settings));
        }
    }
}
