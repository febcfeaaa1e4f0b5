//! Every measurement on images without content: one clear error and exit status 2, or correct results; never a panic or a non-number.

use crate::support::{etendue, text};
use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Display};
use etendue_io::photograph::Encoding;
use etendue_io::png::{encode_display, encode_raw16};
use std::path::Path;

pub(crate) const SIZE: (usize, usize) = (128, 96);

/// The measurements, with PICTURE for the file, and SERIES for a photon-transfer descriptor without another.
pub(crate) const MEASUREMENTS: [&str; 24] = [
    "measure sfr PICTURE",
    "measure sfr PICTURE --region 0,0,64,64",
    "measure oecf PICTURE PICTURE PICTURE --exposures 1,2,4 --channel Y",
    "measure oecf --response PICTURE PICTURE PICTURE --exposures 1,2,4 --full-scale 65535 --channel Y",
    "measure vignetting PICTURE",
    "measure shading PICTURE",
    "measure noise PICTURE PICTURE PICTURE PICTURE PICTURE PICTURE PICTURE PICTURE",
    "measure flare PICTURE --trap 10,10,20,20 --white 60,10,20,20",
    "measure flicker PICTURE --row-time-us 20 --exposure-us 100",
    "measure flicker PICTURE PICTURE PICTURE PICTURE --frame-rate-hz 30",
    "measure colour PICTURE --corners 20,20 100,20 100,80 20,80",
    "measure cdp PICTURE --darker 10,10,20,20 --brighter 60,10,20,20 --contrast 0.5",
    "measure star PICTURE --centre-px 64,48 --cycles 24 --inner-px 10 --outer-px 40",
    "measure texture PICTURE PICTURE",
    "measure depth PICTURE PICTURE",
    "measure distortion PICTURE --target dots",
    "measure distortion PICTURE --target checkerboard",
    "measure focal PICTURE --target checkerboard --pitch-mm 10 --distance-mm 1000",
    "measure chromatic PICTURE --target dots",
    "measure ptc SERIES",
    "measure dark-current 20:SERIES 40:SERIES 60:SERIES",
    "measure lens PICTURE",
    "compare PICTURE PICTURE",
    "calibrate PICTURE PICTURE PICTURE --target checkerboard --pitch-mm 10",
];

/// Measurements with a correct answer for a uniform image: no fall-off, no noise, no bands.
const UNIFORM_LIGHT_MEASUREMENTS: [&str; 4] = ["vignetting", "shading", "noise", "flicker"];

pub(crate) fn grey(folder: &Path, name: &str, (width, height): (usize, usize), reading: u32) -> String {
    let plane =
        Plane::<DigitalNumber>::from_samples(width, height, vec![reading; width * height]).expect("a rectangle");
    let file = folder.join(name);
    std::fs::write(&file, encode_raw16(&plane).expect("a picture")).expect("a temporary file");
    text(&file)
}

pub(crate) fn coloured(folder: &Path, name: &str, (width, height): (usize, usize), light: f32) -> String {
    let file = folder.join(name);
    let image = encode_display(&Plane::<Display>::filled(width, height, [light; 3]), &Encoding::Srgb);
    std::fs::write(&file, image.expect("a picture")).expect("a temporary file");
    text(&file)
}

/// A TIFF of 32-bit floats in one strip: its tags, one entry of 12 bytes each.
pub(crate) fn floats(folder: &Path, name: &str, sample: impl Fn(usize) -> f32) -> String {
    let count = SIZE.0 * SIZE.1;
    let data: Vec<u8> = (0..count).flat_map(|i| sample(i).to_le_bytes()).collect();
    let short = |value: u32| (3_u16, value);
    let long = |value: usize| (4_u16, value as u32);
    let tags = [
        (256_u16, long(SIZE.0)),
        (257, long(SIZE.1)),
        (258, short(32)),
        (259, short(1)),
        (262, short(1)),
        (273, long(8)),
        (277, short(1)),
        (278, long(SIZE.1)),
        (279, long(data.len())),
        (339, short(3)),
    ];
    let mut bytes = b"II*\0".to_vec();
    bytes.extend((8 + data.len() as u32).to_le_bytes());
    bytes.extend(&data);
    bytes.extend((tags.len() as u16).to_le_bytes());
    for (tag, (kind, value)) in tags {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(0_u32.to_le_bytes());
    let file = folder.join(name);
    std::fs::write(&file, bytes).expect("a temporary file");
    text(&file)
}

/// A photon-transfer descriptor, twelve levels of light and dark, all of them this image.
fn series(image: &str) -> String {
    let (file, name) = (Path::new(image), Path::new(image).file_name().expect("a name").to_string_lossy());
    let level = |i: u32| {
        let (ns, photons) = (1e6 * f64::from(i), 300.0 * f64::from(i));
        format!("b {ns:.1} {photons:.1}\ni {name}\ni {name}\nd {ns:.1}\ni {name}\ni {name}\n")
    };
    let (width, height) = if image.contains("pixel") { (1, 1) } else { SIZE };
    let text = (1..=12).map(level).fold(format!("v 4.0\nn 16 {width} {height}\n"), |all, level| all + &level);
    let descriptor = file.with_extension("txt");
    std::fs::write(&descriptor, text).expect("a temporary file");
    crate::support::text(&descriptor)
}

/// The arguments of a measurement of an image, results as JSON.
pub(crate) fn commands_for_image(line: &str, image: &str) -> Vec<String> {
    // Grey images have one channel, which is not named.
    let line = if image.contains("coloured") { line.to_owned() } else { line.replace(" --channel Y", "") };
    let series = series(image);
    let words = line.split(' ').map(|word| word.replace("PICTURE", image).replace("SERIES", &series));
    words.chain((!line.starts_with("calibrate")).then(|| "--json".to_owned())).collect()
}

/// Runs every measurement on an image. Those that may answer are named; all others must refuse it.
#[track_caller]
fn measure_all(image: &str, may_answer: &[&str]) {
    for line in MEASUREMENTS {
        let run = etendue(commands_for_image(line, image));
        let words = format!("{line} of {image}: {run:?}");
        if run.status == 0 {
            // Any image is equal to itself.
            let may = line.starts_with("compare") || may_answer.iter().any(|name| line.contains(name));
            assert!(may, "{words}");
            let nothing = run.out.contains("NaN") || run.out.contains("inf");
            assert!(!nothing && serde_json::from_str::<serde_json::Value>(&run.out).is_ok(), "{words}");
            continue;
        }
        assert!(run.status == 2 && run.out.is_empty(), "{words}");
        let errors: Vec<&str> = run.err.lines().filter(|l| l.starts_with("error[")).collect();
        // Of several views each invalid file is named.
        assert!(errors.len() == 1 || (line.starts_with("calibrate") && errors.len() == 3), "{words}");
        // A reading that is no number is reported as such by the reader only.
        let named = errors[0].contains("expected finite numbers");
        assert!(named || !(errors[0].contains("NaN") || errors[0].contains("inf ")), "{words}");
    }
}

#[test]
fn a_picture_of_one_pixel() {
    let folder = tempfile::tempdir().expect("a folder");
    measure_all(&grey(folder.path(), "pixel.png", (1, 1), 20_000), &[]);
    measure_all(&coloured(folder.path(), "coloured-pixel.png", (1, 1), 0.4), &[]);
}

#[test]
fn even_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    measure_all(&grey(folder.path(), "even.png", SIZE, 20_000), &UNIFORM_LIGHT_MEASUREMENTS);
    measure_all(&coloured(folder.path(), "coloured-even.png", SIZE, 0.4), &UNIFORM_LIGHT_MEASUREMENTS);
    measure_all(&floats(folder.path(), "huge.tif", |_| 3e38), &UNIFORM_LIGHT_MEASUREMENTS);
}

#[test]
fn dark_and_clipped_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    measure_all(&grey(folder.path(), "dark.png", SIZE, 0), &[]);
    measure_all(&grey(folder.path(), "clipped.png", SIZE, 65_535), &[]);
    measure_all(&coloured(folder.path(), "coloured-clipped.png", SIZE, 1.0), &[]);
}

#[test]
fn readings_that_are_no_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bad) in [("nan.tif", f32::NAN), ("infinite.tif", f32::INFINITY)] {
        measure_all(&floats(folder.path(), name, |i| if i == 6208 { bad } else { 20_000.0 + (i % 7) as f32 }), &[]);
    }
}
