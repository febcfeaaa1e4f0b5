//! Images in the formats and forms that other programs write.

use std::path::Path;

use etendue_io::assets::load_assets;
use etendue_io::picture::{decode_image, read_image};
use etendue_scene::Place;
use etendue_scene::asset::{AssetKind, AssetRequest, ImagePixels, ReplacedMaterials, layer_key};
use etendue_testkit::skip::all_here;

fn pixels(name: &str, bytes: &[u8]) -> ImagePixels {
    decode_image(Path::new(name), bytes).unwrap_or_else(|error| panic!("{error}")).pixels
}

/// Colour map of a TGA file.
#[derive(Clone, Copy)]
struct ColourMap<'a> {
    /// Bits of an entry; 0 without a map.
    entry_bits: u8,
    entries: &'a [u8],
}

/// TGA file of 2 × 2 pixels.
fn tga(image_type: u8, depth: u8, descriptor: u8, colour_map: ColourMap<'_>, data: &[u8]) -> Vec<u8> {
    let ColourMap { entry_bits, entries } = colour_map;
    let count = if entry_bits == 0 { 0 } else { (entries.len() / usize::from(entry_bits.div_ceil(8))) as u8 };
    let head =
        [3, u8::from(count > 0), image_type, 0, 0, count, 0, entry_bits, 0, 0, 0, 0, 2, 0, 2, 0, depth, descriptor];
    [&head[..], b"id!", entries, data].concat()
}

const TOP_LEFT: u8 = 0x20;
const RGB: [[u8; 3]; 4] = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]];

/// Pixels red, green / blue, white in all forms of the Truevision specification 2.0.
#[test]
fn tga_of_every_form_is_read() {
    let bgr: Vec<u8> = RGB.iter().flat_map(|[r, g, b]| [*b, *g, *r]).collect();
    let no_map = ColourMap { entry_bits: 0, entries: &[] };
    let expected = ImagePixels::Rgb8(RGB.to_vec());
    assert_eq!(pixels("a.tga", &tga(2, 24, TOP_LEFT, no_map, &bgr)), expected);
    let from_bottom = [&bgr[6..], &bgr[..6]].concat();
    assert_eq!(pixels("a.tga", &tga(2, 24, 0, no_map, &from_bottom)), expected, "the first row is the bottom one");
    assert_eq!(
        pixels("a.tga", &tga(2, 24, TOP_LEFT | 8, no_map, &bgr)),
        expected,
        "8 bits of opacity that 24 bits lack"
    );
    // 5 bits per colour, and an attribute bit.
    let words: Vec<u8> = [0xfc00_u16, 0x03e0, 0x001f, 0x7fff].iter().flat_map(|w| w.to_le_bytes()).collect();
    for (depth, descriptor) in [(16, 1), (16, 0), (15, 0)] {
        assert_eq!(pixels("a.tga", &tga(2, depth, TOP_LEFT | descriptor, no_map, &words)), expected, "{depth}");
    }
    assert_eq!(
        pixels("a.tga", &tga(1, 8, TOP_LEFT, ColourMap { entry_bits: 24, entries: &bgr }, &[0, 1, 2, 3])),
        expected,
        "a palette"
    );
    assert_eq!(
        pixels("a.tga", &tga(1, 8, TOP_LEFT, ColourMap { entry_bits: 16, entries: &words }, &[0, 1, 2, 3])),
        expected,
        "a palette of 16 bits"
    );
    let packets = [&[0x00, 0, 0, 255, 0x02][..], &bgr[3..]].concat();
    assert_eq!(pixels("a.tga", &tga(10, 24, TOP_LEFT, no_map, &packets)), expected, "run lengths");
    assert_eq!(
        pixels("a.tga", &tga(9, 8, TOP_LEFT, ColourMap { entry_bits: 24, entries: &bgr }, &[0x03, 0, 1, 2, 3])),
        expected
    );
    let run = tga(10, 24, TOP_LEFT, no_map, &[0x83, 50, 100, 200]);
    assert_eq!(pixels("a.tga", &run), ImagePixels::Rgb8(vec![[200, 100, 50]; 4]), "a run over both rows");
    assert_eq!(pixels("a.tga", &tga(3, 8, TOP_LEFT, no_map, &[1, 2, 3, 4])), ImagePixels::Gray8(vec![1, 2, 3, 4]));
    let bgra = |a: u8| -> Vec<u8> { RGB.iter().flat_map(|[r, g, b]| [*b, *g, *r, a]).collect() };
    let rgba = |a: u8| ImagePixels::Rgba8(RGB.iter().map(|[r, g, b]| [*r, *g, *b, a]).collect());
    assert_eq!(pixels("a.tga", &tga(2, 32, TOP_LEFT | 8, no_map, &bgra(7))), rgba(7));
    assert_eq!(pixels("a.tga", &tga(2, 32, TOP_LEFT, no_map, &bgra(0))), rgba(255), "opacity that was not written");
    let message = decode_image(Path::new("a.tga"), &tga(2, 24, TOP_LEFT, no_map, &bgr)[..30]).expect_err("cut");
    assert!(message.to_string().contains("truncated"), "{message}");
}

/// BMP file of 2 × 2 pixels, the bottom row first.
fn bmp(bits: u16, compression: u32, palette: &[u8], data: &[u8]) -> Vec<u8> {
    let begin = 54 + palette.len() as u32;
    let mut bytes = [&b"BM"[..], &(begin + data.len() as u32).to_le_bytes(), &[0; 4], &begin.to_le_bytes()].concat();
    for number in [40, 2, 2] {
        bytes.extend(u32::to_le_bytes(number));
    }
    bytes.extend(1_u16.to_le_bytes());
    bytes.extend(bits.to_le_bytes());
    for number in [compression, data.len() as u32, 2835, 2835, palette.len() as u32 / 4, 0] {
        bytes.extend(number.to_le_bytes());
    }
    [&bytes[..], palette, data].concat()
}

#[test]
fn bmp_of_every_depth_is_read() {
    let expected = ImagePixels::Rgb8(RGB.to_vec());
    let palette: Vec<u8> = RGB.iter().flat_map(|[r, g, b]| [*b, *g, *r, 0]).collect();
    assert_eq!(pixels("a.bmp", &bmp(8, 0, &palette, &[2, 3, 0, 0, 0, 1, 0, 0])), expected);
    assert_eq!(pixels("a.bmp", &bmp(4, 0, &palette, &[0x23, 0, 0, 0, 0x01, 0, 0, 0])), expected);
    assert_eq!(
        pixels("a.bmp", &bmp(1, 0, &palette[..8], &[0x40, 0, 0, 0, 0x80, 0, 0, 0])),
        ImagePixels::Rgb8(vec![RGB[1], RGB[0], RGB[0], RGB[1]])
    );
    assert_eq!(pixels("a.bmp", &bmp(8, 1, &palette, &[1, 2, 1, 3, 0, 0, 1, 0, 1, 1, 0, 1])), expected, "run lengths");
    let rows: [u8; 16] = [255, 0, 0, 255, 255, 255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 0];
    assert_eq!(pixels("a.bmp", &bmp(24, 0, &[], &rows)), expected, "rows of four bytes");
    let words: Vec<u8> = [0x001f_u16, 0x7fff, 0x7c00, 0x03e0].iter().flat_map(|w| w.to_le_bytes()).collect();
    assert_eq!(pixels("a.bmp", &bmp(16, 0, &[], &words)), expected);
    let wide: Vec<u8> = [RGB[2], RGB[3], RGB[0], RGB[1]].iter().flat_map(|[r, g, b]| [*b, *g, *r, 0]).collect();
    assert_eq!(pixels("a.bmp", &bmp(32, 0, &[], &wide)), expected);
}

#[test]
fn formats_that_are_not_read_are_named() {
    for (bytes, expected) in [
        (&b"GIF89a\x01\0\x01\0"[..], "a GIF image"),
        (b"\xabKTX 20\xbb\r\n\x1a\n....", "a KTX2 image"),
        (b"#!/bin/sh\n", "expected PNG, JPEG, TGA, BMP"),
    ] {
        let message = decode_image(Path::new("a.png"), bytes).expect_err("not read").to_string();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn images_of_the_case_table_are_read() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases/scenes-and-lenses");
    if !all_here("images_of_the_case_table_are_read", &[&cases]) {
        return;
    }
    for name in ["wall.tga", "wall.bmp"] {
        let image = read_image(&cases.join(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(image.pixels, ImagePixels::Rgb8(vec![[200, 100, 50]; 16]), "{name}");
    }
    let turned = read_image(&cases.join("h03_plusY.hdr")).unwrap_or_else(|error| panic!("{error}"));
    // Mantissas 128, 64, 32 and the exponent 128: 2^-8 of them.
    assert_eq!((turned.width, turned.height), (8, 4));
    assert_eq!(turned.pixels, ImagePixels::Rgb32F(vec![[0.5, 0.25, 0.125]; 32]));
    let path = cases.join("e03_layered.exr");
    let request = |layer: &str| AssetRequest {
        path: path.clone(),
        kind: AssetKind::ImageLayer(layer.to_owned()),
        place: Place::file_head(path.as_path()),
        covered: ReplacedMaterials::All,
    };
    let assets = load_assets(&[request("ViewLayer.Combined")]).unwrap_or_else(|errors| panic!("{errors:?}"));
    assert!(matches!(assets.images[&layer_key(&path, "ViewLayer.Combined")].pixels, ImagePixels::Rgba32F(_)));
    let message = load_assets(&[request("Diffuse")]).expect_err("no such layer")[0].to_string();
    assert!(message.contains("name one of its layers with \"layer\": ViewLayer.Combined"), "{message}");
}
