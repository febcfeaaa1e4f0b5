//! What compressed pictures take in memory: at most three times what they unpack to, and the file.

use crate::ALONE;
use etendue_fuzz::attempt::attempt;
use etendue_fuzz::targets::target;
use exr::prelude::{
    Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Vec2, WritableImage, f16,
};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb, Rgba};
use std::fs;
use std::io::Cursor;
use tiff::encoder::compression::DeflateLevel;
use tiff::encoder::{Compression as Packing, TiffEncoder, colortype};

const WIDTH: u32 = 1200;
const HEIGHT: u32 = 800;
/// What readers hold beside, whatever the size: rows, blocks, tables of codes.
const CONSTANT: u64 = 4 << 20;

/// A picture: its name, the target that reads it, numbers a pixel (4 bytes each at most), its file.
struct PackedImage(String, &'static str, u64, Vec<u8>);

/// Stripes, so that files are small.
fn level(x: usize) -> f32 {
    (x / 100) as f32 / 16.0
}

fn byte(x: u32) -> u8 {
    (x / 100) as u8 * 10
}

fn packed_exr(name: &str, compression: Compression, half: bool) -> PackedImage {
    let size = (WIDTH as usize, HEIGHT as usize);
    let encoding = Encoding { compression, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let mut bytes = Cursor::new(Vec::new());
    let written = if half {
        let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
            let value = f16::from_f32(level(at.x()));
            (value, value, value)
        });
        let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
        Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes)
    } else {
        let channels = SpecificChannels::rgb(|at: Vec2<usize>| (level(at.x()), 1.0_f32, 0.5_f32));
        let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
        Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes)
    };
    written.expect("a picture");
    let depth = if half { "half" } else { "float" };
    PackedImage(format!("EXR {name} {depth}"), "exr", 3, bytes.into_inner())
}

fn packed_image(
    name: &str,
    target: &'static str,
    numbers: u64,
    format: ImageFormat,
    image: &DynamicImage,
) -> PackedImage {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("a picture");
    PackedImage(name.to_owned(), target, numbers, bytes.into_inner())
}

fn packed_tiff(name: &str, packing: Packing) -> PackedImage {
    let mut bytes = Cursor::new(Vec::new());
    let data: Vec<u16> = (0..HEIGHT).flat_map(|_| (0..WIDTH).flat_map(|x| [u16::from(byte(x)); 3])).collect();
    let mut encoder = TiffEncoder::new(&mut bytes).expect("memory").with_compression(packing);
    encoder.write_image::<colortype::RGB16>(WIDTH, HEIGHT, &data).expect("a picture");
    PackedImage(format!("TIFF {name}"), "tiff", 3, bytes.into_inner())
}

fn packed_images() -> Vec<PackedImage> {
    let compressions = [
        ("none", Compression::Uncompressed),
        ("RLE", Compression::RLE),
        ("ZIPS", Compression::ZIP1),
        ("ZIP", Compression::ZIP16),
        ("PIZ", Compression::PIZ),
        ("PXR24", Compression::PXR24),
        ("B44", Compression::B44),
        ("B44A", Compression::B44A),
        ("DWAA", Compression::DWAA(None)),
        ("DWAB", Compression::DWAB(None)),
    ];
    let mut all: Vec<PackedImage> = compressions.map(|(name, compression)| packed_exr(name, compression, false)).into();
    all.extend([("ZIP", Compression::ZIP16), ("B44", Compression::B44)].map(|(name, by)| packed_exr(name, by, true)));
    let grey = DynamicImage::ImageLuma8(ImageBuffer::from_fn(WIDTH, HEIGHT, |x, _| Luma([byte(x)])));
    let wide = DynamicImage::ImageRgba16(ImageBuffer::from_fn(WIDTH, HEIGHT, |x, _| Rgba([u16::from(byte(x)); 4])));
    let colours = DynamicImage::ImageRgb8(ImageBuffer::from_fn(WIDTH, HEIGHT, |x, _| Rgb([byte(x); 3])));
    let floats = DynamicImage::ImageRgb32F(ImageBuffer::from_fn(WIDTH, HEIGHT, |x, _| Rgb([level(x as usize); 3])));
    all.extend([
        packed_image("PNG grey 8", "png", 1, ImageFormat::Png, &grey),
        packed_image("PNG colours 8", "png", 3, ImageFormat::Png, &colours),
        packed_image("PNG colours and opacity 16", "png", 4, ImageFormat::Png, &wide),
        packed_image("JPEG grey", "jpeg", 1, ImageFormat::Jpeg, &grey),
        packed_image("JPEG colours", "jpeg", 3, ImageFormat::Jpeg, &colours),
        packed_image("HDR", "hdr", 3, ImageFormat::Hdr, &floats),
        packed_tiff("LZW", Packing::Lzw),
        packed_tiff("deflate", Packing::Deflate(DeflateLevel::default())),
        packed_tiff("PackBits", Packing::Packbits),
    ]);
    all
}

#[test]
fn a_compressed_picture_takes_three_times_what_it_unpacks_to() {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let (mut findings, mut table_text) = (Vec::new(), String::new());
    for PackedImage(name, target_name, numbers, input) in packed_images() {
        let target = target(target_name).expect("a target");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join(target.file);
        fs::write(&file, &input).expect("written");
        let attempt = attempt(target, &file);
        let unpacked = 4 * numbers * u64::from(WIDTH) * u64::from(HEIGHT);
        table_text += &format!(
            "{name}: {:.2} of {:.1} MB, file {:.3} MB, {:.2} s, {}\n",
            attempt.peak_bytes as f64 / unpacked as f64,
            unpacked as f64 / 1e6,
            input.len() as f64 / 1e6,
            attempt.time_s,
            attempt.path()
        );
        // TIFF is no texture.
        let is_read = attempt.path().ends_with("read; read");
        if !is_read || attempt.peak_bytes > 3 * unpacked + input.len() as u64 + CONSTANT {
            findings.push(name);
        }
    }
    assert!(findings.is_empty(), "{findings:#?}\n{table_text}");
}
