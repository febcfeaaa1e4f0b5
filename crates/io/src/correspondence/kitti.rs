//! KITTI's PNGs of 16 bits: optical flow in three channels, disparity in one (format of the development kit of the 2015 benchmark). A tEXt
//! chunk says what they are, which KITTI's own readers pass over: by their pixels they could be pictures.

use crate::Error;
use crate::exr::EncodeError;
use crate::picture::{Kept, decode_raster};
use crate::png::{encode_grey16, encode_rgb16, with_text};
use crate::png_chunks::title;
use etendue_core::Plane;
use etendue_core::quantity::{Disparity, OpticalFlow};
use std::path::Path;

const FLOW_TITLE: &str = "optical flow, KITTI 2015";
const DISPARITY_TITLE: &str = "disparity, KITTI 2015";
/// Units a pixel of flow, and the number of no flow.
const FLOW_UNITS: f64 = 64.0;
const FLOW_ZERO: f64 = 32_768.0;
/// Units a pixel of disparity.
const DISPARITY_UNITS: f64 = 256.0;

/// Optical flow as KITTI's PNG of 16 bits.
///
/// # Errors
/// Of a plane without pixels, or of more than PNG counts.
pub fn encode_kitti_flow(flow: &Plane<OpticalFlow>) -> Result<Vec<u8>, EncodeError> {
    let values: Vec<u16> = flow.samples().iter().flat_map(|vector| stored_flow(*vector)).collect();
    Ok(with_text(encode_rgb16(flow.width(), flow.height(), &values)?, "Title", FLOW_TITLE))
}

/// Disparity as KITTI's PNG of 16 bits.
///
/// # Errors
/// As [`encode_kitti_flow`].
pub fn encode_kitti_disparity(disparity: &Plane<Disparity>) -> Result<Vec<u8>, EncodeError> {
    let values: Vec<u16> = disparity.samples().iter().map(|px| stored_disparity(*px)).collect();
    Ok(with_text(encode_grey16(disparity.width(), disparity.height(), &values)?, "Title", DISPARITY_TITLE))
}

/// Numbers of a vector; zeros where it is not known or too long.
fn stored_flow(vector: [f32; 2]) -> [u16; 3] {
    let [u, v] = vector.map(|px| in_16_bits(f64::from(px) * FLOW_UNITS + FLOW_ZERO));
    u.zip(v).map_or([0; 3], |(u, v)| [u, v, 1])
}

/// The number of a disparity; 0 where it is not known, negative (but for rounding) or too large.
fn stored_disparity(px: f32) -> u16 {
    in_16_bits(f64::from(px) * DISPARITY_UNITS).map_or(0, |units| units.max(1))
}

fn in_16_bits(number: f64) -> Option<u16> {
    let whole = number.round();
    (0.0..=f64::from(u16::MAX)).contains(&whole).then_some(whole as u16)
}

/// Whether a PNG says of itself that it is optical flow.
pub(crate) fn is_kitti_flow(bytes: &[u8]) -> bool {
    title(bytes) == Some(FLOW_TITLE)
}

/// The flow in the bytes of KITTI's PNG, NaN where it is not known.
pub(crate) fn decode_kitti_flow(file: &Path, bytes: &[u8]) -> Result<Plane<OpticalFlow>, Error> {
    let (_, picture) = decode_raster(file, bytes, "KITTI's PNG", Kept::Floats)?;
    let image::DynamicImage::ImageRgb16(picture) = picture else {
        return Err(Error::new(file, "not KITTI's optical flow: expected a PNG of three channels of 16 bits"));
    };
    let px = |number: u16| ((f64::from(number) - FLOW_ZERO) / FLOW_UNITS) as f32;
    let vector = |[u, v, known]: [u16; 3]| if known == 0 { [f32::NAN; 2] } else { [px(u), px(v)] };
    let vectors = picture.pixels().map(|pixel| vector(pixel.0)).collect();
    let plane = Plane::from_samples(picture.width() as usize, picture.height() as usize, vectors);
    plane.ok_or_else(|| Error::new(file, "fewer pixels than its header says"))
}

#[cfg(test)]
mod tests {
    use super::super::tests_support::flow;
    use super::*;

    #[test]
    fn flow_has_the_numbers_of_the_development_kit() {
        assert_eq!(stored_flow([0.0, 0.0]), [32_768, 32_768, 1]);
        assert_eq!(stored_flow([1.0, -2.5]), [32_832, 32_608, 1]);
        assert_eq!(stored_flow([-512.0, 511.984]), [0, 65_535, 1]);
        for lost in [[f32::NAN, 0.0], [0.0, f32::NAN], [-512.01, 0.0], [0.0, 512.0], [f32::INFINITY, 1.0]] {
            assert_eq!(stored_flow(lost), [0; 3], "{lost:?}");
        }
    }

    #[test]
    fn disparity_has_the_numbers_of_the_development_kit() {
        assert_eq!([1.0, 0.0, 1e-4, -1e-12, 255.99, 37.5].map(stored_disparity), [256, 1, 1, 1, 65_533, 9_600]);
        assert_eq!([f32::NAN, -0.1, 256.0, f32::INFINITY].map(stored_disparity), [0; 4]);
    }

    #[test]
    fn flow_comes_back_to_half_a_step() {
        let vectors = [[0.0, 0.0], [12.34, -56.78], [f32::NAN, 1.0], [-511.9, 511.9], [600.0, 0.0], [0.007, -0.009]];
        let bytes = encode_kitti_flow(&flow(2, &vectors)).expect("six pixels");
        assert!(is_kitti_flow(&bytes));
        let read = decode_kitti_flow(Path::new("flow.png"), &bytes).expect("our own");
        assert_eq!((read.width(), read.height()), (2, 3));
        for (read, written) in read.samples().iter().zip(vectors) {
            let known = written.iter().all(|px| px.abs() < 512.0);
            assert_eq!(read.iter().all(|px| px.is_finite()), known, "{written:?}");
            // Numbers are rounded to the nearest of steps of 1/64 px; 2^-15 of 512 px is the rounding of f32.
            let close = (0..2).all(|i| (read[i] - written[i]).abs() <= 0.5 / 64.0 + 512.0 * f32::EPSILON);
            assert!(close || !known, "{read:?} {written:?}");
        }
    }
}
