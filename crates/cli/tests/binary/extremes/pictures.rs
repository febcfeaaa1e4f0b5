//! Measurements of images without content, or with other content.

use super::table_text;
use crate::bad_pictures::{MEASUREMENTS, SIZE, coloured, commands_for_image, floats, grey};
use crate::support::{error_message, etendue};
use etendue_testkit::page::{Row, check};
use std::path::Path;

/// Number of measurements that refuse an image, and one of the messages.
fn measured(extreme: &str, expected: &str, image: &str, folder: &Path) -> Row {
    let runs: Vec<_> = MEASUREMENTS.iter().map(|line| etendue(commands_for_image(line, image))).collect();
    let refusal_count = runs.iter().filter(|run| run.status == 2 && run.out.is_empty()).count();
    let answered =
        runs.iter().filter(|run| run.status == 0 && !run.out.contains("NaN") && !run.out.contains("inf")).count();
    let first = runs[0].err.lines().find_map(error_message).unwrap_or_default();
    Row {
        extreme: extreme.to_owned(),
        expected: expected.to_owned(),
        actual: format!("{refusal_count} refuse, {answered} answer; `sfr`: {}", table_text(first, &[folder])),
        holds: refusal_count + answered == MEASUREMENTS.len(),
    }
}

#[test]
fn pictures_that_show_nothing() {
    let place = tempfile::tempdir().expect("a folder");
    let folder = place.path();
    let all = "refused with one error; `compare` finds it equal to itself";
    let expected_result = "no fall-off, noise or flicker; all else refused";
    let number = "the value that is not finite is named by its place";
    let bad = |value: f32| move |i: usize| if i == 6208 { value } else { 20_000.0 + (i % 7) as f32 };
    let rows = [
        measured("an image of one pixel", all, &grey(folder, "pixel.png", (1, 1), 20_000), folder),
        measured("a uniform image", expected_result, &grey(folder, "even.png", SIZE, 20_000), folder),
        measured(
            "a uniform image in colour",
            expected_result,
            &coloured(folder, "coloured-even.png", SIZE, 0.4),
            folder,
        ),
        measured("a uniform image of 3·10³⁸", expected_result, &floats(folder, "huge.tif", |_| 3e38), folder),
        measured("a dark image", all, &grey(folder, "dark.png", SIZE, 0), folder),
        measured("an image that is clipped everywhere", all, &grey(folder, "clipped.png", SIZE, 65_535), folder),
        measured("one pixel is NaN", number, &floats(folder, "nan.tif", bad(f32::NAN)), folder),
        measured("one pixel is infinite", number, &floats(folder, "infinite.tif", bad(f32::INFINITY)), folder),
    ];
    let caption = "Each command line of `measure` and `calibrate` (crates/cli/tests/binary/bad\\_pictures.rs, among them `ptc`, `dark-current`, `lens` and `compare`) reads an image of 128 × 96 px. Found: how many refuse it with status 2 and one error, how many answer, and the first error. None panics, and none prints a value that is not finite. Mirrored, rotated and wrong charts are below.";
    check("Measurements of images without content", caption, &rows);
}
