//! Black level: the digital number of no light, which every later step counts from.
//!
//! From shielded pixels it is their interquartile mean: the mean of what is left without the lowest and the highest
//! quarter, so that hot and dead pixels do not move it, and yet finer than one digital number. Of Gaussian noise of σ its
//! standard error is 1.09 σ/√n (Tukey 1962, trimmed means). One level serves the whole picture; what differs from row to
//! row stays. It is at least 1 DN below the white level: a frame whose shielded pixels are saturated (by heat) is a picture all
//! the same, of which nothing is seen.

use crate::raw::{RawPicture, real};

/// Where the black level comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum BlackLevel {
    /// As the sensor states it.
    #[default]
    Stated,
    /// This one, DN.
    Fixed(f64),
    /// From the shielded pixels.
    OpticalBlack,
}

/// The black level, DN; `None` where shielded pixels are asked for and the picture has none.
pub(crate) fn black_level(rule: BlackLevel, raw: &RawPicture<'_>) -> Option<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Mosaic;
    use etendue_core::Plane;

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
        let raw = RawPicture {
            plane: &plane,
            black_level_dn: 10.0,
            white_level_dn: 255.0,
            mosaic: &Mosaic::Mono,
            optical_black: Some(&shielded),
        };
        let found = black_level(BlackLevel::OpticalBlack, &raw).expect("there are some");
        // Of 400 numbers 20 are 0 and 120 or more 63, so the middle 200 hold 40 to 47 of 63 and else 64.
        assert!((63.75..=63.8).contains(&found), "{found}");
        assert_eq!(black_level(BlackLevel::Stated, &raw), Some(10.0));
        assert_eq!(black_level(BlackLevel::Fixed(12.5), &raw), Some(12.5));
        let hot = Plane::filled(4, 4, 255_u8.into());
        let saturated = RawPicture { optical_black: Some(&hot), ..raw };
        assert_eq!(black_level(BlackLevel::OpticalBlack, &saturated), Some(254.0));
        let bare = RawPicture { optical_black: None, ..raw };
        assert_eq!(black_level(BlackLevel::OpticalBlack, &bare), None);
    }

    #[test]
    fn the_middle_half_is_averaged() {
        assert_eq!(interquartile_mean(vec![1e6, 5.0, 4.0, 6.0, 7.0, -1e6, 3.0, 8.0]), 5.5);
        assert_eq!(interquartile_mean(vec![3.0]), 3.0);
    }
}
