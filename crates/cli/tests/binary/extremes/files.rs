//! Invalid files, and files beyond the limits.

use super::refused;
use crate::bad_input::ModifiedJob;
use crate::limits::png_head;
use crate::support::{CommandOutput, etendue, text};
use etendue_testkit::page::{Row, check};
use std::os::unix::fs::symlink;
use std::path::Path;

/// Plans the small job with other contents of one of its files.
fn with_file(name: &str, bytes: &[u8]) -> (ModifiedJob, CommandOutput) {
    let job = ModifiedJob::new();
    job.write(name, bytes);
    let output = etendue(["plan", &job.job()]);
    (job, output)
}

fn row(extreme: &str, expected: &str, (job, output): &(ModifiedJob, CommandOutput)) -> Row {
    refused(extreme, expected, output, &[job.folder()])
}

/// The first part of a file of the small job.
fn part(name: &str, of: f64) -> Vec<u8> {
    let bytes = std::fs::read(ModifiedJob::new().folder().join(name)).expect("a file of the job");
    bytes[..(bytes.len() as f64 * of) as usize].to_vec()
}

/// Replaces text in a text file.
fn spoilt(name: &str, from: &str, to: &str) -> (ModifiedJob, CommandOutput) {
    let job = ModifiedJob::new();
    job.replace_first(name, from, to);
    let output = etendue(["plan", &job.job()]);
    (job, output)
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
            let job = ModifiedJob::new();
            let set = format!("{}=1", vec!["a"; 20_000].join("."));
            let output = etendue(["plan", &job.job(), "--set", &set]);
            refused("a key of 20 000 parts", "refused in one line", &output, &[job.folder()])
        },
    ]
}

/// A TIFF of one pixel that states big-endian order and is not.
const WRONG_BYTE_ORDER: &[u8] = b"MM*\0\x08\0\0\0\x01\0\0\x01\x04\0\x01\0\0\0\x01\0\0\0\0\0\0\0";

/// Files at their limits: docs/limits.md.
fn budgets() -> Vec<Row> {
    let raised = "the limit to raise";
    let long = |modified: &ModifiedJob| {
        let job = std::fs::read_to_string(modified.job()).expect("the job");
        modified.write("small.toml", format!("{job}# {}\n", " ".repeat(16 << 20)));
        modified.job()
    };
    let chain = |modified: &ModifiedJob| {
        for i in 0..17 {
            let base = if i == 0 { "small.toml".to_owned() } else { format!("{}.toml", i - 1) };
            modified.write(&format!("{i}.toml"), format!("format = 1\nbase = \"{base}\"\n"));
        }
        text(&modified.folder().join("16.toml"))
    };
    let planned = |extreme: &str, change: &dyn Fn(&ModifiedJob) -> String| {
        let modified = ModifiedJob::new();
        let output = etendue(["plan", &change(&modified)]);
        refused(extreme, raised, &output, &[modified.folder()])
    };
    let image = png_head(40_000, 40_000);
    vec![
        planned("a job of 17 MB", &long),
        planned("17 files, each based on the next", &chain),
        row("a PNG of 40 000 × 40 000 px in 70 bytes", raised, &with_file("checker.png", &image)),
    ]
}

fn numbers() -> Vec<Row> {
    let place = "file, line and key";
    let folder = tempfile::tempdir().expect("a folder");
    let tiff = folder.path().join("ends.tif");
    std::fs::write(&tiff, WRONG_BYTE_ORDER).expect("written");
    let ends = etendue(["measure", "sfr", &text(&tiff)]);
    vec![
        row("a number of the job is NaN", place, &spoilt("small.toml", "f_number = 2", "f_number = nan")),
        row("a vertex of a mesh is NaN", place, &spoilt("tower.obj", "v ", "v nan ")),
        row("a vertex at 10⁴⁰ m", place, &spoilt("tower.obj", "v ", "v 1e40 ")),
        refused("a TIFF of the wrong endianness", "refused as damaged", &ends, &[folder.path()]),
    ]
}

fn names_and_paths() -> Vec<Row> {
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "file = \"checker.png\"", "file = \"../../../../etc/passwd\"");
    let climbing = etendue(["plan", &job.job(), "--sandboxed"]);
    let linked = ModifiedJob::new();
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
        refused("`--sandboxed`, a path through parents", "refused unread", &climbing, &[job.folder()]),
        refused("`--sandboxed`, a link to a foreign file", "refused unread", &through, &[linked.folder()]),
        refused("a device instead of a file", "refused: unbounded", &device, &[]),
    ]
}

fn folders() -> Vec<Row> {
    let render = |out: &Path| {
        let job = ModifiedJob::new();
        etendue(["render", &job.job(), "-o", &text(out), "--spp", "1000000"])
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
    let caption = "Each is refused with status 2 and nothing is written. Found: the first error. Readers are also fuzzed (docs/evidence/fuzzing.md); docs/limits.md has the limits.";
    check("Files", caption, &parts.concat());
}
