//! Invalid files, and files beyond the limits.

use super::refused;
use crate::bad_input::Spoilt;
use crate::limits::png_head;
use crate::support::{Ran, etendue, text};
use etendue_testkit::page::{Row, check};
use std::os::unix::fs::symlink;
use std::path::Path;

/// Plans the small job with other contents of one of its files.
fn with_file(name: &str, bytes: &[u8]) -> (Spoilt, Ran) {
    let spoilt = Spoilt::new();
    spoilt.write(name, bytes);
    let ran = etendue(["plan", &spoilt.job()]);
    (spoilt, ran)
}

fn row(extreme: &str, expected: &str, (spoilt, ran): &(Spoilt, Ran)) -> Row {
    refused(extreme, expected, ran, &[spoilt.folder()])
}

/// The first part of a file of the small job.
fn part(name: &str, of: f64) -> Vec<u8> {
    let bytes = std::fs::read(Spoilt::new().folder().join(name)).expect("a file of the job");
    bytes[..(bytes.len() as f64 * of) as usize].to_vec()
}

/// Replaces text in a text file.
fn spoilt(name: &str, from: &str, to: &str) -> (Spoilt, Ran) {
    let spoilt = Spoilt::new();
    spoilt.spoil(name, from, to);
    let ran = etendue(["plan", &spoilt.job()]);
    (spoilt, ran)
}

fn empty_and_cut() -> Vec<Row> {
    let named = "the file and where the job names it";
    let empty = |name: &str| row(&format!("{name} is empty"), named, &with_file(name, b""));
    let cut = |name: &str| row(&format!("{name} is truncated"), named, &with_file(name, &part(name, 0.5)));
    let job = row("a job file that is empty", "the missing key", &with_file("small.toml", b""));
    vec![job, empty("tower.obj"), empty("checker.png"), empty("sky.hdr"), cut("checker.png"), cut("sky.hdr")]
}

fn counts() -> Vec<Row> {
    let before = "refused before any allocation";
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\n";
    let png = png_head(i32::MAX as u32, i32::MAX as u32);
    let far = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n";
    let deep = format!("format = 1\nscene = {}{}\n", "[".repeat(5000), "]".repeat(5000));
    let bases = "format = 1\nbase = \"small.toml\"\n";
    vec![
        row("an HDR image of 4·10¹⁸ pixels in 62 bytes", before, &with_file("sky.hdr", hdr)),
        row("a PNG whose header states 2³¹ − 1 pixels per side", before, &with_file("checker.png", &png)),
        row("a face with vertex 4 000 000 000 of three", "file and line", &with_file("tower.obj", far.as_bytes())),
        row("nested lists, 5 000 deep", "refused at a depth of 80", &with_file("small.toml", deep.as_bytes())),
        row("a job that is its own base", "the cycle", &with_file("small.toml", bases.as_bytes())),
        {
            let spoilt = Spoilt::new();
            let set = format!("{}=1", vec!["a"; 20_000].join("."));
            let ran = etendue(["plan", &spoilt.job(), "--set", &set]);
            refused("a key of 20 000 parts", "refused in one line", &ran, &[spoilt.folder()])
        },
    ]
}

/// A TIFF of one pixel that states big-endian order and is not.
const WRONG_ENDS: &[u8] = b"MM*\0\x08\0\0\0\x01\0\0\x01\x04\0\x01\0\0\0\x01\0\0\0\0\0\0\0";

/// Files at their limits: docs/limits.md.
fn budgets() -> Vec<Row> {
    let raised = "the limit to raise";
    let long = |spoilt: &Spoilt| {
        let job = std::fs::read_to_string(spoilt.job()).expect("the job");
        spoilt.write("small.toml", format!("{job}# {}\n", " ".repeat(16 << 20)));
        spoilt.job()
    };
    let chain = |spoilt: &Spoilt| {
        for i in 0..17 {
            let base = if i == 0 { "small.toml".to_owned() } else { format!("{}.toml", i - 1) };
            spoilt.write(&format!("{i}.toml"), format!("format = 1\nbase = \"{base}\"\n"));
        }
        text(&spoilt.folder().join("16.toml"))
    };
    let planned = |extreme: &str, made: &dyn Fn(&Spoilt) -> String| {
        let spoilt = Spoilt::new();
        let ran = etendue(["plan", &made(&spoilt)]);
        refused(extreme, raised, &ran, &[spoilt.folder()])
    };
    let picture = png_head(40_000, 40_000);
    vec![
        planned("a job of 17 MB", &long),
        planned("17 files, each based on the next", &chain),
        row("a PNG of 40 000 × 40 000 px in 70 bytes", raised, &with_file("checker.png", &picture)),
    ]
}

fn numbers() -> Vec<Row> {
    let place = "file, line and key";
    let folder = tempfile::tempdir().expect("a folder");
    let tiff = folder.path().join("ends.tif");
    std::fs::write(&tiff, WRONG_ENDS).expect("written");
    let ends = etendue(["measure", "sfr", &text(&tiff)]);
    vec![
        row("a number of the job is NaN", place, &spoilt("small.toml", "f_number = 2", "f_number = nan")),
        row("a vertex of a mesh is NaN", place, &spoilt("tower.obj", "v ", "v nan ")),
        row("a vertex at 10⁴⁰ m", place, &spoilt("tower.obj", "v ", "v 1e40 ")),
        refused("a TIFF of the wrong endianness", "refused as damaged", &ends, &[folder.path()]),
    ]
}

fn names_and_paths() -> Vec<Row> {
    let spoilt = Spoilt::new();
    spoilt.spoil("small.toml", "file = \"checker.png\"", "file = \"../../../../etc/passwd\"");
    let climbing = etendue(["plan", &spoilt.job(), "--sandboxed"]);
    let linked = Spoilt::new();
    let link = linked.folder().join("checker.png");
    std::fs::remove_file(&link).expect("removed");
    symlink("/etc/passwd", &link).expect("a link");
    let through = etendue(["plan", &linked.job(), "--sandboxed"]);
    let camera = row(
        "a camera called \"../x\"",
        "camera names are file names",
        &self::spoilt("small.toml", "name = \"front\"", "name = \"../x\""),
    );
    let device = etendue(["inspect", "/dev/zero"]);
    vec![
        camera,
        refused("`--sandboxed`, a path through parents", "refused unread", &climbing, &[spoilt.folder()]),
        refused("`--sandboxed`, a link to a foreign file", "refused unread", &through, &[linked.folder()]),
        refused("a device instead of a file", "refused: unbounded", &device, &[]),
    ]
}

fn folders() -> Vec<Row> {
    let render = |out: &Path| {
        let spoilt = Spoilt::new();
        etendue(["render", &spoilt.job(), "-o", &text(out), "--spp", "1000000"])
    };
    let place = tempfile::tempdir().expect("a folder");
    let file = place.path().join("file");
    std::fs::write(&file, b"theirs").expect("written");
    vec![
        refused(
            "an output folder that is not writable, even for root",
            "refused before rendering",
            &render(Path::new("/proc")),
            &[],
        ),
        refused("a file instead of the output folder", "refused before rendering", &render(&file), &[place.path()]),
    ]
}

#[test]
fn files_that_are_none() {
    let parts = [empty_and_cut(), counts(), budgets(), numbers(), names_and_paths(), folders()];
    let about = "Each is refused with status 2 and nothing is written. Found: the first error. Readers are also fuzzed (docs/evidence/fuzzing.md); docs/limits.md has the limits.";
    check("Files", about, &parts.concat());
}
