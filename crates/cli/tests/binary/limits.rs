//! Limits of input files, and how to raise them.

use crate::bad_input::ModifiedJob;
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
    let job = ModifiedJob::new();
    job.write("checker.png", png_head(50_000, 40_000));
    job.render(&[]).refused(&[
        "checker.png: decompresses to 1908 MiB; at most 1024 MiB are allowed for a file of its size",
        "or raise the limit: --limit picture-mib=1908 (referenced at ",
        "small.toml:6",
    ]);
    // With the limit raised the file is read, and found to be damaged.
    let raised = ["--limit", "picture-mib=1908", "--limit", "texture-cache-mib=65536"];
    job.render(&raised).refused(&["checker.png: not a readable image"]);
    job.write("checker.png", png_head(3000, 3000));
    job.render(&["--limit", "picture-mib=8"]).refused(&["checker.png: decompresses to 9 MiB", "picture-mib=9"]);
    // Measurements store images as floats.
    let image = text(&job.folder().join("checker.png"));
    etendue(["--limit", "picture-mib=34", "measure", "sfr", &image]).refused(&["decompresses to 35 MiB"]);
    etendue(["inspect", &image, "--limit", "picture-mib=34"]).refused(&["decompresses to 35 MiB"]);
}

#[test]
fn a_long_description_is_refused_before_it_is_read() {
    let modified = ModifiedJob::new();
    let job = fs::read_to_string(modified.folder().join("small.toml")).expect("the job");
    modified.write("small.toml", format!("{job}# {}\n", " ".repeat(1 << 20)));
    let phrases =
        ["small.toml", "the file has 2 MiB, but files of its kind may have at most 1 MiB", "--limit description-mib=2"];
    modified.render(&["--limit", "description-mib=1"]).refused(&phrases);
    etendue(["plan", &modified.job(), "--limit", "description-mib=2"]).ok();
    modified.write("small.toml", &job);
    modified.write("tower.mtl", format!("newmtl wall\n{}", "#\n".repeat(1 << 20)));
    modified.render(&["--limit", "description-mib=1"]).refused(&["tower.mtl: the file has 3 MiB", "description-mib=3"]);
}

#[test]
fn corners_and_bases_are_counted() {
    let modified = ModifiedJob::new();
    modified.render(&["--limit", "mesh-corners=27"]).refused(&[
        "tower.obj:25",
        "more than 27 corners",
        "mesh-corners=54",
    ]);
    etendue(["plan", &modified.job(), "--limit", "mesh-corners=28"]).ok();
    for i in 0..3 {
        let base = if i == 0 { "small.toml".to_owned() } else { format!("{}.toml", i - 1) };
        modified.write(&format!("{i}.toml"), format!("format = 1\nbase = \"{base}\"\n"));
    }
    let job = text(&modified.folder().join("2.toml"));
    etendue(["plan", &job]).ok();
    etendue(["plan", &job, "--limit", "bases=2"]).refused(&["references has more than 2 files", "--limit bases=4"]);
}

#[test]
fn limits_that_are_none_are_refused() {
    etendue(["plan", "x.toml", "--limit", "picture=1"]).refused(&["--limit picture=1: unknown limit", "picture-mib"]);
    etendue(["plan", "x.toml", "--limit", "bases"]).refused(&["--limit bases: expected NAME=N"]);
    etendue(["plan", "x.toml", "--limit", "bases=many"]).refused(&["a whole number from 1 to 64, not 'many'"]);
}

#[test]
fn their_page_lists_them() {
    let page = fs::read_to_string(root().join("docs/limits.md")).expect("the page");
    for limit in etendue_scene::limits::ALL {
        let meaning = limit.meaning.replace("`cache`", "`--cache`");
        let row = format!("| `{}` | {} | {} | {meaning} |", limit.name, limit.default, limit.highest);
        assert!(page.contains(&row), "docs/limits.md lacks:\n{row}");
    }
    let rows = page.lines().filter(|line| line.starts_with("| `")).count();
    assert_eq!(rows, etendue_scene::limits::ALL.len());
    assert!(etendue(["--help"]).ok().out.contains("docs/limits.md"));
}
