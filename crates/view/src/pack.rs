//! Planes as text that the page's script unpacks (`page/chunks.js`).
//!
//! Planes follow one another. For each, the first (lowest) bytes of all its numbers come first, then the second, and so on, which
//! groups equal bytes. The whole is compressed with DEFLATE in the zlib format (RFC 1950) and encoded in base64. Numbers are
//! stored exactly, except those of spectra: these are divided by a power of two, which brings the largest of the plane's layer
//! below 2¹⁵, and rounded to half floats: to 2⁻¹¹ of the value down to 2⁻²⁸ of that largest one, and to 2⁻³⁹ of it below.
//!
//! Downsampling: blocks of a whole number of columns and rows become one pixel.
//!
//! For light and other numbers, a block is the mean of its finite pixels, with its standard error as for independent pixel
//! errors. Raws, lengths, identifiers, flow and vectors have no meaningful mean: the middle pixel represents the block.

use std::io::Write as _;

use etendue::Error;
use flate2::{Compression, write::ZlibEncoder};
use half::f16;

use crate::layer::{Layer, NamedPlane, Role, Samples};
use crate::page::encoded;

/// Planes in the form of the page.
pub(crate) struct EncodedPlanes {
    /// Encoding of each plane: its type and the factor of its numbers.
    pub(crate) types: Vec<(&'static str, f64)>,
    /// All of them in base64.
    pub(crate) text: String,
}

/// Packs planes of one layer.
pub(crate) fn packed(planes: &[NamedPlane]) -> Result<EncodedPlanes, Error> {
    let mut deflated = ZlibEncoder::new(Vec::new(), Compression::default());
    let mut types = Vec::new();
    let [value_scale, error_scale] = [Role::Value, Role::Error].map(|role| scale(planes, role));
    for plane in planes {
        let scale = if plane.role == Role::Value { value_scale } else { error_scale };
        let (name, bytes) = bytes(&plane.samples, scale);
        types.push((name, if name == "f16" { scale } else { 1.0 }));
        deflated.write_all(&bytes).map_err(Error::run)?;
    }
    Ok(EncodedPlanes { types, text: encoded(&deflated.finish().map_err(Error::run)?) })
}

/// The power of two by which rounded numbers are divided.
fn scale(planes: &[NamedPlane], role: Role) -> f64 {
    let rounded = planes.iter().filter(|plane| plane.role == role && matches!(plane.samples, Samples::Rounded(_)));
    let sizes = rounded.flat_map(|plane| plane.samples.numbers()).map(f64::abs).filter(|size| size.is_finite());
    let max_size = sizes.fold(0.0, f64::max);
    let mut scale = 1.0;
    // The range of 32-bit floats ends the loops.
    while max_size / scale >= 32_768.0 {
        scale *= 2.0;
    }
    while max_size > 0.0 && max_size / scale < 16_384.0 {
        scale /= 2.0;
    }
    scale
}

fn bytes(samples: &Samples, scale: f64) -> (&'static str, Vec<u8>) {
    match samples {
        Samples::Bytes(all) => ("u8", all.clone()),
        Samples::Words(all) => ("u16", side_by_side(all.iter().map(|v| v.to_le_bytes()))),
        Samples::Integers(all) => ("u32", side_by_side(all.iter().map(|v| v.to_le_bytes()))),
        Samples::Exact(all) => ("f32", side_by_side(all.iter().map(|v| v.to_le_bytes()))),
        Samples::Rounded(all) => {
            ("f16", side_by_side(all.iter().map(|v| f16::from_f64(f64::from(*v) / scale).to_le_bytes())))
        }
    }
}

/// The first bytes of all numbers, then the second ones.
fn side_by_side<const N: usize>(numbers: impl Iterator<Item = [u8; N]> + Clone) -> Vec<u8> {
    (0..N).flat_map(|place| numbers.clone().map(move |bytes| bytes[place])).collect()
}

/// The smallest factor by which a layer takes at most this many bytes.
pub(crate) fn factor(layer: &Layer, max_bytes: usize) -> usize {
    let (width, height) = layer.size;
    let bytes = |step: usize| width.div_ceil(step) * height.div_ceil(step) * layer.pixel_bytes();
    (1..).find(|step| bytes(*step) <= max_bytes || *step >= width.max(height)).unwrap_or(1)
}

/// Columns and rows of a layer in blocks of `step`².
pub(crate) fn size(layer: &Layer, step: usize) -> (usize, usize) {
    (layer.size.0.div_ceil(step), layer.size.1.div_ceil(step))
}

/// The planes of a layer in blocks of `step`².
pub(crate) fn planes(layer: &Layer, step: usize) -> Vec<NamedPlane> {
    if step == 1 {
        return layer.planes.clone();
    }
    let blocks = BlockGrid { size: layer.size, step };
    let binned = |plane: &NamedPlane| NamedPlane {
        samples: match (layer.kind.has_means(), plane.role) {
            (false, _) => blocks.reduced(&plane.samples),
            (true, Role::Value) => blocks.means(&plane.samples),
            (true, Role::Error) => blocks.errors(&plane.samples),
        },
        ..plane.clone()
    };
    layer.planes.iter().map(binned).collect()
}

struct BlockGrid {
    size: (usize, usize),
    step: usize,
}

impl BlockGrid {
    /// Pixel indices of each block.
    fn each(&self) -> impl Iterator<Item = impl Iterator<Item = usize>> {
        let ((width, height), step) = (self.size, self.step);
        (0..height).step_by(step).flat_map(move |y| {
            (0..width).step_by(step).map(move |x| {
                let rows = y..(y + step).min(height);
                rows.flat_map(move |y| (x..(x + step).min(width)).map(move |x| y * width + x))
            })
        })
    }

    /// Index of the middle pixel of each block.
    fn middles(&self) -> impl Iterator<Item = usize> {
        let ((width, height), step) = (self.size, self.step);
        let middle = move |from: usize, end: usize| (from + (from + step).min(end)) / 2;
        (0..height)
            .step_by(step)
            .flat_map(move |y| (0..width).step_by(step).map(move |x| middle(y, height) * width + middle(x, width)))
    }

    fn reduced(&self, samples: &Samples) -> Samples {
        fn at<T: Copy>(all: &[T], places: impl Iterator<Item = usize>) -> Vec<T> {
            places.map(|place| all[place]).collect()
        }
        match samples {
            Samples::Bytes(all) => Samples::Bytes(at(all, self.middles())),
            Samples::Words(all) => Samples::Words(at(all, self.middles())),
            Samples::Integers(all) => Samples::Integers(at(all, self.middles())),
            Samples::Exact(all) => Samples::Exact(at(all, self.middles())),
            Samples::Rounded(all) => Samples::Rounded(at(all, self.middles())),
        }
    }

    fn means(&self, samples: &Samples) -> Samples {
        let mean = |value_at: &dyn Fn(usize) -> f64| {
            self.each().map(|block| mean_of_finite(block.map(value_at))).collect::<Vec<_>>()
        };
        match samples {
            Samples::Bytes(all) => Samples::Bytes(mean(&|i| all[i].into()).iter().map(|v| v.round() as u8).collect()),
            Samples::Words(all) => Samples::Words(mean(&|i| all[i].into()).iter().map(|v| v.round() as u16).collect()),
            Samples::Integers(_) => self.reduced(samples),
            Samples::Exact(all) => Samples::Exact(mean(&|i| all[i].into()).iter().map(|v| *v as f32).collect()),
            Samples::Rounded(all) => Samples::Rounded(mean(&|i| all[i].into()).iter().map(|v| *v as f32).collect()),
        }
    }

    /// Standard errors of means of independent pixels.
    fn errors(&self, samples: &Samples) -> Samples {
        let error_plane = |all: &[f32]| {
            let error = |block: &mut dyn Iterator<Item = usize>| {
                let (sum, count) = block
                    .fold((0.0, 0.0), |(sum, count), i| (sum + f64::from(all[i]) * f64::from(all[i]), count + 1.0));
                (sum.sqrt() / count) as f32
            };
            self.each().map(|mut block| error(&mut block)).collect()
        };
        match samples {
            Samples::Exact(all) => Samples::Exact(error_plane(all)),
            Samples::Rounded(all) => Samples::Rounded(error_plane(all)),
            all_samples => self.reduced(all_samples),
        }
    }
}

/// The mean of the finite numbers; the last of the numbers if none is finite.
fn mean_of_finite(numbers: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count, mut last) = (0.0, 0.0, f64::NAN);
    for number in numbers {
        last = number;
        if number.is_finite() {
            (sum, count) = (sum + number, count + 1.0);
        }
    }
    if count > 0.0 { sum / count } else { last }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::io::Read as _;

    use flate2::read::ZlibDecoder;

    use super::*;
    use crate::layer::LayerKind;

    /// Base64 back to bytes.
    fn decoded(text: &str) -> Vec<u8> {
        let value = |c: u8| match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            _ => 63,
        };
        let characters = text.trim_end_matches('=').as_bytes();
        let group = |four: &[u8]| {
            let bits = four.iter().enumerate().fold(0_u32, |bits, (i, c)| bits | u32::from(value(*c)) << (18 - 6 * i));
            bits.to_be_bytes()[1..four.len()].to_vec()
        };
        characters.chunks(4).flat_map(group).collect()
    }

    /// The numbers of all planes, by type.
    pub(crate) fn unpacked(text: &str, types: &[(&str, f64)], pixels: usize) -> Vec<Vec<f64>> {
        let mut bytes = Vec::new();
        ZlibDecoder::new(&decoded(text)[..]).read_to_end(&mut bytes).expect("deflated");
        let mut at = 0;
        let mut plane = |(name, scale): &(&str, f64)| {
            let width = match *name {
                "u8" => 1,
                "u16" | "f16" => 2,
                _ => 4,
            };
            let from = at;
            at += width * pixels;
            let byte =
                |pixel: usize, place: usize| if place < width { bytes[from + place * pixels + pixel] } else { 0 };
            let number = |pixel: usize| {
                let all = [0, 1, 2, 3].map(|place| byte(pixel, place));
                match *name {
                    "f32" => f64::from(f32::from_le_bytes(all)),
                    "f16" => f64::from(f16::from_le_bytes([all[0], all[1]])) * scale,
                    _ => f64::from(u32::from_le_bytes(all)),
                }
            };
            (0..pixels).map(number).collect()
        };
        let planes = types.iter().map(&mut plane).collect();
        assert_eq!(at, bytes.len(), "nothing is left over");
        planes
    }

    fn decoded_values(samples: Samples) -> Vec<f64> {
        let pixels = samples.numbers().count();
        let planes = [NamedPlane::value("a", samples)];
        let packed = packed(&planes).expect("packed");
        unpacked(&packed.text, &packed.types, pixels).remove(0)
    }

    #[test]
    fn whole_numbers_and_exact_floats_come_back() {
        assert_eq!(decoded_values(Samples::Bytes(vec![0, 7, 255])), [0.0, 7.0, 255.0]);
        assert_eq!(decoded_values(Samples::Words(vec![0, 258, 65_535])), [0.0, 258.0, 65_535.0]);
        assert_eq!(
            decoded_values(Samples::Integers(vec![1, 16_909_060, u32::MAX])),
            [1.0, 16_909_060.0, 4_294_967_295.0]
        );
        let exact = decoded_values(Samples::Exact(vec![-0.1, 3e-42, f32::INFINITY, f32::NAN]));
        assert_eq!(exact[..3], [f64::from(-0.1_f32), f64::from(3e-42_f32), f64::INFINITY]);
        assert!(exact[3].is_nan());
    }

    #[test]
    fn rounded_numbers_keep_their_stated_precision() {
        for size in [3e-38_f32, 1.7e-9, 1.0, 65_504.0, 3e38] {
            let steps = (0..200).map(|i| size * (1.0 - i as f32 / 201.0)).collect::<Vec<_>>();
            for (decoded, value) in decoded_values(Samples::Rounded(steps.clone())).iter().zip(&steps) {
                assert!((decoded - f64::from(*value)).abs() <= f64::from(*value) / 2048.0, "{decoded} for {value}");
            }
        }
        // 2⁻²⁸ of the largest and less: subnormal half floats.
        let min_step = 1.0 / (1_u64 << 39) as f64;
        let small = decoded_values(Samples::Rounded(vec![1.0, 1e-9, 1e-11, 0.0, f32::NAN, f32::NEG_INFINITY]));
        assert!((small[1] - 1e-9).abs() < min_step && (small[2] - 1e-11).abs() < min_step, "{small:?}");
        assert!(small[3] == 0.0 && small[4].is_nan() && small[5] == f64::NEG_INFINITY);
    }

    fn layer(kind: LayerKind, planes: Vec<NamedPlane>) -> Layer {
        Layer { name: "a".to_owned(), kind, unit: String::new(), meaning: String::new(), size: (5, 3), planes }
    }

    #[test]
    fn blocks_have_means_of_what_is_finite_and_the_last_ones_are_smaller() {
        let mut values: Vec<f32> = (0..15).map(|i| i as f32).collect();
        values[1] = f32::INFINITY;
        values[14] = f32::NAN;
        let error = NamedPlane { role: Role::Error, ..NamedPlane::value("v", Samples::Exact(vec![3.0; 15])) };
        let light = layer(LayerKind::Number, vec![NamedPlane::value("v", Samples::Exact(values)), error]);
        assert_eq!((size(&light, 2), light.pixel_bytes()), ((3, 2), 8));
        let [means, errors] = &planes(&light, 2)[..] else { panic!("two planes") };
        let Samples::Exact(means) = &means.samples else { panic!("exact") };
        assert_eq!(means[..5], [(0.0 + 5.0 + 6.0) / 3.0, 5.0, 6.5, 10.5, 12.5]);
        assert!(means[5].is_nan());
        // The mean of two errors of 3 has √18 / 2.
        let two_pixel_error = 4.5_f64.sqrt() as f32;
        assert_eq!(
            errors.samples,
            Samples::Exact(vec![1.5, 1.5, two_pixel_error, two_pixel_error, two_pixel_error, 3.0])
        );
    }

    #[test]
    fn identities_of_a_block_are_those_of_its_middle_pixel() {
        let ids = layer(
            LayerKind::Identity { names: Vec::new() },
            vec![NamedPlane::value("id", Samples::Integers((0..15).collect()))],
        );
        assert_eq!(planes(&ids, 3)[0].samples, Samples::Integers(vec![6, 9]));
        assert_eq!(planes(&ids, 2)[0].samples, Samples::Integers(vec![6, 8, 9, 11, 13, 14]));
    }

    #[test]
    fn a_layer_is_as_large_as_it_may_be() {
        let bytes = layer(LayerKind::Number, vec![NamedPlane::value("v", Samples::Exact(vec![0.0; 15]))]);
        assert_eq!([60, 59, 24, 23, 8, 4, 1].map(|max_bytes| factor(&bytes, max_bytes)), [1, 2, 2, 3, 3, 5, 5]);
    }
}
