use super::*;
use crate::exr::tests_support;
use ::tiff::encoder::{TiffEncoder, colortype};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb};
use std::io::Cursor;

fn encoded(image: DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("encodable");
    bytes.into_inner()
}

fn read(bytes: &[u8]) -> Result<Photograph, String> {
    decode_photograph(Path::new("t.tif"), bytes).map_err(|e| e.to_string())
}

fn tiff<C: colortype::ColorType>(width: u32, height: u32, values: &[C::Inner]) -> Vec<u8>
where
    [C::Inner]: ::tiff::encoder::TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).expect("a buffer");
    encoder.write_image::<C>(width, height, values).expect("a picture");
    bytes.into_inner()
}

#[test]
fn tiff_of_every_width_keeps_its_numbers() {
    let grey8 = read(&tiff::<colortype::Gray8>(2, 1, &[1, 255])).expect("grey");
    assert_eq!((grey8.full_scale, grey8.stated.encoding), (Some(255.0), Encoding::Srgb));
    let grey16 = read(&tiff::<colortype::Gray16>(2, 1, &[1, 65_535])).expect("grey");
    assert_eq!(grey16.channel("Y").expect("grey").samples, [1.0, 65_535.0]);
    assert_eq!((grey16.full_scale, grey16.stated.encoding), (Some(65_535.0), Encoding::Linear));
    let grey32 = read(&tiff::<colortype::Gray32>(2, 1, &[1, 1 << 24])).expect("grey");
    assert_eq!(grey32.channel("Y").expect("grey").samples, [1.0, 16_777_216.0]);
    let rgb = read(&tiff::<colortype::RGB16>(2, 1, &[1, 2, 3, 4, 5, 6])).expect("colour");
    assert_eq!((rgb.names(), &rgb.stated.encoding), (vec!["R", "G", "B"], &Encoding::Srgb));
    assert_eq!(rgb.channel("B").expect("blue").samples, [3.0, 6.0]);
    let float = read(&tiff::<colortype::Gray32Float>(2, 1, &[0.5, -2.0])).expect("floats");
    assert_eq!((&float.channels[0].samples[..], float.full_scale), (&[0.5, -2.0][..], None));
}

#[test]
fn a_tiff_that_is_cut_or_strange_is_refused() {
    let complete = tiff::<colortype::Gray16>(64, 64, &[7; 4096]);
    let message = read(&complete[..complete.len() / 2]).expect_err("cut");
    assert!(message.starts_with("t.tif: not a readable TIFF"), "{message}");
    let message = read(&tiff::<colortype::CMYK8>(1, 1, &[1, 2, 3, 4])).expect_err("ink");
    assert_eq!(message, "t.tif: a TIFF in CMYK(8); expected grey or RGB: convert it");
    let message = read(b"{}").expect_err("no picture");
    let kinds = "expected PNG, JPEG, TIFF, uncompressed DNG, Radiance HDR, PFM or OpenEXR";
    assert_eq!(message, format!("t.tif: not an image of a known format; {kinds}"));
    let message = read(&tiff::<colortype::Gray32Float>(1, 1, &[f32::NAN])).expect_err("no number");
    assert_eq!(message, "t.tif: sample 0 is NaN; expected finite numbers");
}

#[test]
fn png_jpeg_and_exr_say_what_their_numbers_are() {
    let rgb = DynamicImage::ImageRgb8(ImageBuffer::from_pixel(2, 1, Rgb([1_u8, 2, 3])));
    for format in [ImageFormat::Png, ImageFormat::Jpeg] {
        let p = read(&encoded(rgb.clone(), format)).expect("readable");
        assert_eq!((p.names(), &p.stated.encoding, p.full_scale), (vec!["R", "G", "B"], &Encoding::Srgb, Some(255.0)));
    }
    let grey = DynamicImage::ImageLuma16(ImageBuffer::from_pixel(1, 1, Luma([4095_u16])));
    let p = read(&encoded(grey, ImageFormat::Png)).expect("readable");
    assert_eq!((p.channels[0].samples[0], p.stated.encoding), (4095.0, Encoding::Linear));
    let p = read(&tests_support::small_exr(1, 1, &["front.R", "depth.Z"], 0.25)).expect("readable");
    assert_eq!((p.names(), &p.stated.encoding), (vec!["depth.Z", "front.R"], &Encoding::Linear));
}

#[test]
fn a_side_car_makes_a_grey_picture_raw() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("raw.0000.png");
    let grey = DynamicImage::ImageLuma16(ImageBuffer::from_pixel(1, 1, Luma([100_u16])));
    std::fs::write(&file, encoded(grey, ImageFormat::Png)).expect("written");
    assert_eq!(read_photograph(&file).expect("readable").raw, None);
    let sidecar = |quantity: &str, level: &str| {
        let text = format!(
            r#"{{"program": "etendue", "files": {{"raw.0000.png": {{"quantity": "{quantity}"}}}}, "sensor": {{"electronics":
            {{"black_level_dn": {level}, "white_level_dn": 4000.5, "exposure_s": 0.01,
            "cfa": {{"columns": 2, "channels": ["R", "G", "G", "B"]}}}}}}}}"#
        );
        std::fs::write(folder.path().join("camera.json"), text).expect("written");
        read_photograph(&file).map(|p| p.raw)
    };
    let facts = sidecar("digital number", "64").expect("readable").expect("raw");
    assert_eq!((facts.black_level_dn, facts.white_level_dn, facts.filters.columns), (64.0, 4000.5, 2));
    assert_eq!(facts.filters.channels, ["R", "G", "G", "B"]);
    assert_eq!(sidecar("planar depth, 0 is invalid", "64").expect("readable"), None);
    assert!(sidecar("digital number", "null").expect_err("no level").to_string().contains("lacks levels"));
}

#[test]
fn a_digital_negative_of_ours_is_grey_of_its_numbers() {
    let facts = |bits| crate::tiff::DngFacts {
        camera: "front".into(),
        software: "etendue".into(),
        bits,
        black_level_dn: 64.0,
        white_level_dn: 4000.0,
        tile: (bits == 12).then(|| (2, vec![0, 1, 1, 2])),
        xyz_to_camera: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        neutral: [1.0; 3],
        active: [0, 0, 2, 2],
    };
    for (bits, numbers) in [(12, [64, 100, 4095, 7]), (24, [64, 100, 16_777_215, 7])] {
        let raw = etendue_core::Plane::from_samples(2, 2, numbers.to_vec()).expect("four pixels");
        let photograph = read(&crate::tiff::encode_dng(&raw, &facts(bits)).expect("a file")).expect("readable");
        assert_eq!(photograph.stated.encoding, Encoding::Linear);
        assert!(photograph.channels[0].samples.iter().map(|v| *v as u32).eq(numbers), "{photograph:?}");
    }
    // A file that ends within its directory is reported as truncated, whatever precedes it.
    let cut = crate::tiff::encode_dng(&etendue_core::Plane::new(2, 2), &facts(12)).expect("a file");
    assert!((4..60).all(|length| read(&cut[..length]).is_err()));
}

#[test]
fn a_side_car_states_the_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("raw.0003.png");
    let grey = DynamicImage::ImageLuma16(ImageBuffer::from_pixel(1, 1, Luma([100_u16])));
    std::fs::write(&file, encoded(grey, ImageFormat::Png)).expect("written");
    let text = r#"{"program": "etendue", "seed": 5, "camera_index": 1,
        "files": {"raw.0003.png": {"quantity": "digital number"}},
        "sensor": {"electronics": {"black_level_dn": 1, "white_level_dn": 2, "exposure_s": 3, "bits": 12,
            "cfa": {"columns": 1, "channels": ["mono"]}}},
        "frames": [{"frame": 2, "raw": "raw.0002.png"}, {"frame": 3, "raw": "raw.0003.png", "exposure_s": 0.5,
            "black_level_dn": 10, "white_level_dn": 20, "picture_in_raw_px": [0, 4, 8, 6],
            "companding_knees_dn": [[8, 8], [64, 16]]}]}"#;
    std::fs::write(folder.path().join("camera.json"), text).expect("written");
    let facts = read_photograph(&file).expect("readable").raw.expect("raw");
    assert_eq!((facts.black_level_dn, facts.white_level_dn, facts.exposure_s), (10.0, 20.0, 0.5));
    let knees = Some(vec![[8.0, 8.0], [64.0, 16.0]]);
    let frame = RawFrame {
        number: 3,
        seed: 5,
        camera_index: 1,
        bits: 12,
        picture_px: [0, 4, 8, 6],
        companding_knees_dn: knees,
    };
    assert_eq!(facts.frame, Some(frame));
}
