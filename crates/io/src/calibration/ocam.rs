//! OCamCalib's `calib_results.txt` (Scaramuzza 2006): five lines of numbers between comments.
//!
//! | line | holds |
//! | --- | --- |
//! | 1 | count, a₀, a₁, … of the direct polynomial (px) |
//! | 2 | count and coefficients of the inverse polynomial, highest last; may be `0` |
//! | 3 | centre: row and column, from 0 at the centre of the first pixel |
//! | 4 | affine c, d, e |
//! | 5 | height and width, px |
//!
//! The inverse polynomial is a fit to the inverse; the exact inverse is used, and a note states the error of the fit.

use etendue_projection::{Calibration, CameraMatrix, Model, model::Ocam, plane::Affine};

use super::{ReaderResult, TreeError, TreeResult, camera_error, models::invalid_model};

const LINES: [&str; 5] = [
    "the direct polynomial: count a0 a1 …",
    "the inverse polynomial: count and coefficients",
    "the centre: row column",
    "the affine parameters: c d e",
    "the image size: height width",
];

pub(super) fn read(text: &str) -> TreeResult<ReaderResult> {
    let rows = rows(text)?;
    let direct = counted(&rows[0])?;
    let inverse = counted(&rows[1])?;
    let [row, column] = exactly(&rows[2])?;
    let [c, d, e] = exactly(&rows[3])?;
    let size_px = size(&rows[4])?;
    let note = note(direct, inverse, size_px);
    let model = Ocam::new(direct.to_vec(), Affine { c, d, e }).map_err(invalid_model(rows[0].line))?;
    let matrix = CameraMatrix { fx: 1.0, fy: 1.0, skew: 0.0, cx: column, cy: row }.from_opencv();
    let calibration = Calibration::new(Model::Ocam(model), matrix, size_px).map_err(camera_error(rows[2].line))?;
    Ok(ReaderResult::new("", calibration, note.into_iter().collect()))
}

struct OcamRow {
    line: usize,
    what: &'static str,
    numbers: Vec<f64>,
}

/// The five lines of numbers.
fn rows(text: &str) -> TreeResult<[OcamRow; 5]> {
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let lines: Vec<(usize, &str)> = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')).collect();
    if lines.len() > LINES.len() {
        return Err(TreeError::at(lines[LINES.len()].0, "a sixth line of numbers; expected five"));
    }
    let rows = LINES.iter().enumerate().map(|(i, what)| match lines.get(i) {
        Some((line, text)) => row(*line, what, text),
        None => Err(TreeError::at(0, format!("ends before {what}; expected five lines of numbers"))),
    });
    let rows: Vec<OcamRow> = rows.collect::<TreeResult<_>>()?;
    rows.try_into().map_err(|_| TreeError::at(0, "expected five lines of numbers"))
}

fn row(line: usize, what: &'static str, text: &str) -> TreeResult<OcamRow> {
    let number = |word: &str| {
        let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
        number.ok_or_else(|| TreeError::at(line, format!("found \"{word}\"; expected {what}")))
    };
    Ok(OcamRow { line, what, numbers: text.split_whitespace().map(number).collect::<TreeResult<_>>()? })
}

/// Numbers after their count.
fn counted(row: &OcamRow) -> TreeResult<&[f64]> {
    match &row.numbers[..] {
        [count, rest @ ..] if *count == rest.len() as f64 => Ok(rest),
        [count, rest @ ..] => Err(TreeError::at(
            row.line,
            format!("the count is {count}, but {} numbers follow: {}", rest.len(), row.what),
        )),
        [] => Err(TreeError::at(row.line, format!("expected {}", row.what))),
    }
}

fn exactly<const N: usize>(row: &OcamRow) -> TreeResult<[f64; N]> {
    let count = row.numbers.len();
    let error = || TreeError::at(row.line, format!("found {count} numbers; expected {N}: {}", row.what));
    row.numbers.clone().try_into().map_err(|_| error())
}

fn size(row: &OcamRow) -> TreeResult<[usize; 2]> {
    let [height, width] = exactly(row)?;
    let pixels = |x: f64| (1.0..=1e6).contains(&x) && x.fract() == 0.0;
    if !(pixels(height) && pixels(width)) {
        return Err(TreeError::at(
            row.line,
            format!("found {height} {width}; expected whole numbers of pixels of at least 1"),
        ));
    }
    Ok([width as usize, height as usize])
}

/// Model of a polynomial whose stretch c, d, e is of columns: u = c x + d y, v = e x + y.
pub(super) fn column_first(direct: Vec<f64>, [c, d, e]: [f64; 3], line: usize) -> TreeResult<Model> {
    if !(c > 0.0 && c.is_finite()) {
        return Err(TreeError::at(line, format!("the affine parameter c is {c}; expected a positive number")));
    }
    // `Affine` stretches rows: c goes into the unit of the radius, in which the coefficient of its power k is aₖ c¹⁻ᵏ.
    let factors = std::iter::successors(Some(c), |factor| Some(factor / c));
    let coefficients = direct.into_iter().zip(factors).map(|(a, factor)| a * factor).collect();
    let stretch = Affine { c: 1.0 / c, d: e / c, e: d / c };
    Ocam::new(coefficients, stretch).map(Model::Ocam).map_err(invalid_model(line))
}

/// Note with the deviation of the inverse polynomial from the inverse of the direct one, over half the image diagonal.
pub(super) fn note(direct: &[f64], inverse: &[f64], [width, height]: [usize; 2]) -> Option<String> {
    if inverse.is_empty() {
        return None;
    }
    let value = |c: &[f64], x: f64| c.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let half_diagonal = 0.5 * (width as f64 * width as f64 + height as f64 * height as f64).sqrt();
    let off = (0..=256).map(|i| {
        let radius = half_diagonal * f64::from(i) / 256.0;
        let angle = etendue_core::maths::f64::atan2(value(direct, radius), radius);
        (value(inverse, angle) - radius).abs()
    });
    let worst = off.fold(0.0, f64::max);
    Some(format!(
        "the exact inverse is used; the file's inverse polynomial deviates from it by up to {worst:.3} px within half the diagonal"
    ))
}
