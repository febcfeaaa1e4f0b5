//! `etendue measure colour`: the colours of a ColorChecker after a fitted matrix.

use super::readings::{Levels, Readings, Selection, part};
use super::report::{Cell, Report, Table, Telling};
use crate::failure::Failure;
use clap::Args;
use etendue_metrology::Estimate;
use etendue_metrology::colour::{ColourError, ColourPatch, measure_colour};
use etendue_spectra::chart::colorchecker;
use etendue_spectra::{colour, illuminant, observer};
use glam::DVec2;
use std::path::PathBuf;

/// `etendue measure colour`
#[derive(Debug, Args)]
pub struct Colour {
    /// A picture of a ColorChecker of 24 patches, in colour
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// Middles of the four corner patches, raster coordinates, in the chart's order: dark skin, bluish green, black, white
    #[arg(long, value_name = "X,Y", num_args = 4, value_parser = corner, required = true)]
    pub corners: Vec<DVec2>,
    /// Side of the squares that are read, of the distance of patches
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, allow_negative_numbers = true)]
    pub patch: f64,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub levels: Levels,
    #[command(flatten)]
    pub telling: Telling,
}

fn corner(text: &str) -> Result<DVec2, String> {
    let both = text.split_once(',').and_then(|(x, y)| Some(DVec2::new(x.trim().parse().ok()?, y.trim().parse().ok()?)));
    both.ok_or_else(|| format!("expected X,Y, not '{text}'"))
}

/// Columns and rows of the chart.
const CHART: (usize, usize) = (6, 4);

pub(super) fn run(arguments: &Colour) -> Result<(), Failure> {
    let Some(colours) = arguments.selection.colours(&arguments.picture)? else {
        let file = arguments.picture.display();
        return Err(Failure::input(format!(
            "{file}: expected a picture in colour: channels R, G and B, or a raw mosaic of them"
        )));
    };
    let patches = patches(arguments, &colours)?;
    let black = arguments.levels.black(&colours[1]);
    let found = measure_colour(&patches, black, arguments.levels.full_scale(&colours[1]), colour::D65_WHITE);
    let found = found.map_err(|error| Failure::input(format!("{}: {error}", arguments.picture.display())))?;
    report(&patches, &found).tell(&arguments.telling)
}

fn patches(arguments: &Colour, colours: &[Readings; 3]) -> Result<Vec<ColourPatch>, Failure> {
    if !(arguments.patch > 0.0 && arguments.patch <= 1.0) {
        return Err(Failure::input("--patch: expected a share above 0 and at most 1"));
    }
    let [a, b, c, d] = arguments.corners[..] else { return Err(Failure::input("--corners: expected four of them")) };
    // A mosaic's pixels of one colour lie twice as far apart as the file's.
    let scale = mosaic_scale(arguments);
    let (columns, rows) = ((CHART.0 - 1) as f64, (CHART.1 - 1) as f64);
    // Bilinear between the corners: exact where the chart is parallel to the sensor, near it otherwise.
    let middle = |i: usize| {
        let (u, v) = ((i % CHART.0) as f64 / columns, (i / CHART.0) as f64 / rows);
        ((a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v) * scale
    };
    let distance = ((b - a).length() / columns).min((d - a).length() / rows) * scale;
    let side = (arguments.patch * distance).floor().max(2.0);
    let patch = |(i, patch): (usize, &etendue_spectra::chart::Patch)| {
        let corner = (middle(i) - 0.5 * side).round();
        if corner.x < 0.0 || corner.y < 0.0 {
            return Err(Failure::input("--corners: a patch lies beyond the picture"));
        }
        let at = [corner.x as usize, corner.y as usize, side as usize, side as usize];
        let one = |c: usize| part(&colours[c].image, at, "--corners: a patch");
        let reference = observer::xyz_of_reflectance(&patch.reflectance, illuminant::d65());
        Ok(ColourPatch { name: patch.name.to_owned(), pixels: [one(0)?, one(1)?, one(2)?], reference })
    };
    colorchecker().iter().enumerate().map(patch).collect()
}

/// The side of the whole picture over that of one colour's pixels, inverted.
fn mosaic_scale(arguments: &Colour) -> f64 {
    let mosaic = arguments.selection.cfa.is_some()
        || etendue_io::photograph::read_photograph(&arguments.picture)
            .is_ok_and(|p| p.raw.is_some_and(|facts| facts.filters.channels.len() > 1));
    if mosaic { 0.5 } else { 1.0 }
}

fn report(patches: &[ColourPatch], found: &ColourError) -> Report {
    let method = "ColorChecker under D65 after a fitted 3 × 3 matrix, CIEDE2000 (± one standard uncertainty)";
    let mut report = Report::new("colour", method);
    report.figure("mean_delta_e00", "mean ΔE00", "", found.mean);
    report.figure("largest_delta_e00", "largest ΔE00", "", found.largest);
    let number = |x: f64| Cell::Number(x, 2);
    let row = |((patch, difference), [seen, reference]): ((&ColourPatch, &Estimate), &[[f64; 3]; 2])| {
        let lab = seen.iter().chain(reference).map(|x| number(*x));
        [Cell::Text(patch.name.replace('_', " ")), Cell::Estimate(*difference)].into_iter().chain(lab).collect()
    };
    report.table(Table {
        key: "patches",
        columns: vec![
            ("patch", "patch"),
            ("delta_e00", "ΔE00"),
            ("l", "L*"),
            ("a", "a*"),
            ("b", "b*"),
            ("reference_l", "true L*"),
            ("reference_a", "true a*"),
            ("reference_b", "true b*"),
        ],
        rows: patches.iter().zip(&found.differences).zip(&found.colours).map(row).collect(),
    });
    let to = ["X", "Y", "Z"];
    report.table(Table {
        key: "matrix",
        columns: vec![("to", "XYZ ="), ("red", "red"), ("green", "green"), ("blue", "blue")],
        rows: to
            .iter()
            .zip(found.matrix)
            .map(|(name, row)| {
                let cells = row.map(|m| Cell::Estimate(Estimate::new(m, 0.0)));
                std::iter::once(Cell::Text((*name).to_owned())).chain(cells).collect()
            })
            .collect(),
    });
    report
}
