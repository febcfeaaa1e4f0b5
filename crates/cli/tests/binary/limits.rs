//! Limits of input files, and how to raise them.

use crate::bad_input::Spoilt;
use crate::support::{etendue, root, text};
use std::fs;

/// Header of a PNG of this many grey pixels, without any pixels.
pub(crate) fn png_head(width: u32, height: u32) -> Vec<u8> {
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
    png.extend([width.to_be_bytes(), height.to_be_bytes()].concat());
    png.extend([8, 0, 0, 0, 0]);
    let checksum = crc(&png[12..]);
    png.extend(checksum.to_be_bytes());
    png.extend(b"\0\0\0\x0aIDAT\x78\x9c\x63\0\0\0\x01\0\x01\0\0\0\0");
    png
}

/// CRC-32 of a chunk.
fn crc(bytes: &[u8]) -> u32 {
    let shifted = |c: u32| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 };
    !bytes.iter().fold(u32::MAX, |c, byte| (0..8).fold(c ^ u32::from(*byte), |c, _| shifted(c)))
}

#[test]
fn a_picture_of_many_pixels_in_few_bytes_is_refused_by_its_head() {
    let spoilt = Spoilt::new();
    spoilt.write("checker.png", png_head(50_000, 40_000));
    spoilt.render(&[]).refused(&[
        "checker.png: decompresses to 1908 MiB; at most 1024 MiB are allowed for a file of its size",
        "or raise the limit: --limit picture-mib=1908 (named at ",
        "small.toml:6",
    ]);
    // With the limit raised the file is read, and found to be damaged.
    let raised = ["--limit", "picture-mib=1908", "--limit", "texture-cache-mib=65536"];
    spoilt.render(&raised).refused(&["checker.png: not a readable image"]);
    spoilt.write("checker.png", png_head(3000, 3000));
    spoilt.render(&["--limit", "picture-mib=8"]).refused(&["checker.png: unpacks to 9 MiB", "picture-mib=9"]);
    // Measurements store images as floats.
    let picture = text(&spoilt.folder().join("checker.png"));
    etendue(["--limit", "picture-mib=34", "measure", "sfr", &picture]).refused(&["unpacks to 35 MiB"]);
    etendue(["inspect", &picture, "--limit", "picture-mib=34"]).refused(&["unpacks to 35 MiB"]);
}

#[test]
fn a_long_description_is_refused_before_it_is_read() {
    let spoilt = Spoilt::new();
    let job = fs::read_to_string(spoilt.folder().join("small.toml")).expect("the job");
    spoilt.write("small.toml", format!("{job}# {}\n", " ".repeat(1 << 20)));
    let told =
        ["small.toml", "the file has 2 MiB, and files of its kind are read up to 1 MiB", "--limit description-mib=2"];
    spoilt.render(&["--limit", "description-mib=1"]).refused(&told);
    etendue(["plan", &spoilt.job(), "--limit", "description-mib=2"]).ok();
    spoilt.write("small.toml", &job);
    spoilt.write("tower.mtl", format!("newmtl wall\n{}", "#\n".repeat(1 << 20)));
    spoilt.render(&["--limit", "description-mib=1"]).refused(&["tower.mtl: the file has 3 MiB", "description-mib=3"]);
}

#[test]
fn corners_and_bases_are_counted() {
    let spoilt = Spoilt::new();
    spoilt.render(&["--limit", "mesh-corners=27"]).refused(&[
        "tower.obj:25",
        "more than 27 corners",
        "mesh-corners=54",
    ]);
    etendue(["plan", &spoilt.job(), "--limit", "mesh-corners=28"]).ok();
    for i in 0..3 {
        let base = if i == 0 { "small.toml".to_owned() } else { format!("{}.toml", i - 1) };
        spoilt.write(&format!("{i}.toml"), format!("format = 1\nbase = \"{base}\"\n"));
    }
    let job = text(&spoilt.folder().join("2.toml"));
    etendue(["plan", &job]).ok();
    etendue(["plan", &job, "--limit", "bases=2"])
        .refused(&["more than 2 files are built one on the other", "--limit bases=4"]);
}

#[test]
fn limits_that_are_none_are_refused() {
    etendue(["plan", "x.toml", "--limit", "picture=1"])
        .refused(&["--limit picture=1: no limit is called", "picture-mib"]);
    etendue(["plan", "x.toml", "--limit", "bases"]).refused(&["--limit bases: expected NAME=N"]);
    etendue(["plan", "x.toml", "--limit", "bases=many"]).refused(&["a whole number from 1 to 64, not 'many'"]);
}

#[test]
fn their_page_lists_them() {
    let page = fs::read_to_string(root().join("docs/limits.md")).expect("the page");
    for limit in etendue_scene::limits::ALL {
        let row = format!("| `{}` | {} | {} | {} |", limit.name, limit.default, limit.highest, limit.about);
        assert!(page.contains(&row), "docs/limits.md lacks:\n{row}");
    }
    let rows = page.lines().filter(|line| line.starts_with("| `")).count();
    assert_eq!(rows, etendue_scene::limits::ALL.len());
    assert!(etendue(["--help"]).ok().out.contains("docs/limits.md"));
}
