//! Pictures: as textures, as photographs to be measured, as files to be looked into.

use super::seeds::{repository, stored};
use super::target::{Target, result_text};
use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;
use etendue_io::exr::read_spectral;
use etendue_io::inspect::inspect;
use etendue_io::photograph::read_photograph;
use etendue_io::picture::read_image;
use etendue_io::tiff::{DngFacts, encode_dng, encode_raw_tiff};
use std::path::Path;

/// Three times what a picture may unpack to: readers convert.
const CONSTANT: u64 = 3 << 30;

fn read(file: &Path) -> String {
    [result_text(read_image(file)), result_text(read_photograph(file)), result_text(inspect(file))].join("; ")
}

/// A kind of picture with its seeds.
const fn target(
    name: &'static str,
    file: &'static str,
    prepare: fn(&Path) -> Vec<Vec<u8>>,
    read: fn(&Path) -> String,
    words: &'static [&'static str],
) -> Target {
    Target { name, file, prepare, read, words, is_text: false, times: 8, constant_bytes: CONSTANT }
}

const EXR_WORDS: &[&str] = &[
    "channels\0chlist\0",
    "compression\0compression\0",
    "dataWindow\0box2i\0",
    "tiles\0tiledesc\0",
    "type\0string\0",
    "deepscanline",
    "tiledimage",
    "chunkCount\0int\0",
    "lineOrder\0",
    "R\0\x01\0\0\0",
    "etendue:quantity",
    "etendue:band_width_nm",
    "view\0string\0",
];

pub(super) const EXR: Target = target(
    "exr",
    "a.exr",
    |_| {
        let mut seeds = stored("exr");
        seeds.extend(repository(["tests/oracles/figures/ground_truth.exr", "tests/oracles/figures/other_writer.exr"]));
        seeds
    },
    read,
    EXR_WORDS,
);
pub(super) const SPECTRAL_EXR: Target = target(
    "spectral-exr",
    "a.exr",
    |_| repository(["tests/oracles/figures/spectral.exr", "tests/oracles/figures/other_writer.exr"]),
    |file| result_text(read_spectral(file)) + &result_text(inspect(file)),
    EXR_WORDS,
);
pub(super) const PNG: Target = target(
    "png",
    "a.png",
    |_| {
        let mut seeds = stored("png");
        seeds.extend(repository([
            "tests/oracles/figures/flow_kitti.png",
            "tests/oracles/figures/disparity_kitti.png",
            "crates/cli/tests/jobs/small/checker.png",
        ]));
        seeds
    },
    read,
    &[
        "IHDR", "PLTE", "IDAT", "IEND", "tRNS", "gAMA", "cICP", "iCCP", "sRGB", "zTXt", "iTXt", "acTL", "fcTL", "fdAT",
        "eXIf",
    ],
);
pub(super) const JPEG: Target =
    target("jpeg", "a.jpg", |_| stored("jpeg"), read, &["\u{7f}", "JFIF\0", "Exif\0\0", "ICC_PROFILE\0", "Adobe\0"]);
pub(super) const TIFF: Target = target(
    "tiff",
    "a.tif",
    |_| {
        let mut seeds = stored("tiff");
        seeds.push(encode_raw_tiff(&raw(), 12).expect("a small picture"));
        seeds
    },
    read,
    &["II\x2a\0", "MM\0\x2a", "II\x2b\0"],
);
pub(super) const DNG: Target = target(
    "dng",
    "a.dng",
    |_| vec![encode_dng(&raw(), &facts()).expect("a small picture")],
    read,
    &["II\x2a\0", "MM\0\x2a"],
);
pub(super) const HDR: Target = target(
    "hdr",
    "a.hdr",
    |_| {
        let mut seeds = stored("hdr");
        seeds.extend(repository(["crates/cli/tests/jobs/small/sky.hdr"]));
        seeds
    },
    read,
    &[
        "#?RADIANCE\n",
        "FORMAT=32-bit_rle_rgbe\n",
        "EXPOSURE=1e99\n",
        "-Y 100000 +X 100000\n",
        "+X 3 -Y 4\n",
        "\x02\x02\x7f\u{7f}",
    ],
);
pub(super) const PFM: Target = target(
    "pfm",
    "a.pfm",
    |_| repository(["tests/oracles/figures/disparity.pfm"]),
    read,
    &["Pf\n", "PF\n", "1048576 1048576\n", "-1.0\n", "1e-300\n"],
);
pub(super) const FLO: Target = target(
    "flo",
    "a.flo",
    |_| vec![[b"PIEH".as_slice(), &2_i32.to_le_bytes(), &1_i32.to_le_bytes(), &[0; 16]].concat()],
    |file| result_text(inspect(file)),
    &["PIEH"],
);

fn facts() -> DngFacts {
    DngFacts {
        camera: "camera".to_owned(),
        software: "etendue".to_owned(),
        bits: 12,
        black_level_dn: 64.0,
        white_level_dn: 4095.0,
        tile: Some((2, vec![0, 1, 1, 2])),
        xyz_to_camera: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        neutral: [0.5, 1.0, 0.5],
        active: [0, 0, 4, 4],
    }
}

fn raw() -> Plane<DigitalNumber> {
    Plane::from_samples(4, 4, (0..16).map(|i| i * 250).collect()).expect("16 pixels")
}
