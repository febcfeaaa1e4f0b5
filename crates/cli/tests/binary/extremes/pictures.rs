//! Measurements of images without content, or with other content.

use super::told;
use crate::bad_pictures::{MEASUREMENTS, SIZE, coloured, floats, grey, of_picture};
use crate::support::{error_message, etendue};
use etendue_testkit::page::{Row, check};
use std::path::Path;

/// Number of measurements that refuse an image, and one of the messages.
fn measured(extreme: &str, expected: &str, picture: &str, folder: &Path) -> Row {
    let runs: Vec<_> = MEASUREMENTS.iter().map(|line| etendue(of_picture(line, picture))).collect();
    let refused = runs.iter().filter(|run| run.status == 2 && run.out.is_empty()).count();
    let answered =
        runs.iter().filter(|run| run.status == 0 && !run.out.contains("NaN") && !run.out.contains("inf")).count();
    let first = runs[0].err.lines().find_map(error_message).unwrap_or_default();
    Row {
        extreme: extreme.to_owned(),
        expected: expected.to_owned(),
        found: format!("{refused} refuse, {answered} answer; `sfr`: {}", told(first, &[folder])),
        holds: refused + answered == MEASUREMENTS.len(),
    }
}

#[test]
fn pictures_that_show_nothing() {
    let place = tempfile::tempdir().expect("a folder");
    let folder = place.path();
    let all = "each refuses it with one error; `compare` finds it equal to itself";
    let even = "no fall-off, no noise, no flicker, all else refused";
    let number = "a reading that is no number is named by its place";
    let bad = |value: f32| move |i: usize| if i == 6208 { value } else { 20_000.0 + (i % 7) as f32 };
    let rows = [
        measured("a picture of one pixel", all, &grey(folder, "pixel.png", (1, 1), 20_000), folder),
        measured("an even picture", even, &grey(folder, "even.png", SIZE, 20_000), folder),
        measured("an even picture in colour", even, &coloured(folder, "coloured-even.png", SIZE, 0.4), folder),
        measured("an even picture of 3·10³⁸", even, &floats(folder, "huge.tif", |_| 3e38), folder),
        measured("a dark picture", all, &grey(folder, "dark.png", SIZE, 0), folder),
        measured("a picture that is clipped everywhere", all, &grey(folder, "clipped.png", SIZE, 65_535), folder),
        measured("one pixel is NaN", number, &floats(folder, "nan.tif", bad(f32::NAN)), folder),
        measured("one pixel is infinite", number, &floats(folder, "infinite.tif", bad(f32::INFINITY)), folder),
    ];
    let about = "How many of the command lines of `measure` and `calibrate` (crates/cli/tests/binary/bad\\_pictures.rs, `ptc`, `dark-current`, `lens` and `compare` among them) refuse a picture of 128 × 96 px with \
        status 2 and one error, how many answer, and the first error. Never a panic, never a number that is none. Pictures of charts that are mirrored, turned or of another chart are below.";
    check("Measurements of pictures that show nothing", about, &rows);
}
