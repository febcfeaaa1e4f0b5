//! A laboratory file: facts about the images of a laboratory folder that the images do not contain.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, exactly, integer, keyed_by_name, list, number, record, text, vector, words};

record! {
    /// Facts that `etendue characterise` cannot read from images, their EXIF data or side-cars.
    pub struct Laboratory check(check) {
        /// Pixel pitch. Default: from side-cars.
        optional pixel_pitch_um: Placed<f64> = number("µm").above(0.0);
        /// Bits of the ADC. Default: from side-cars.
        optional bits: Placed<u64> = integer(1, 24);
        /// f-number. Default: from side-cars or EXIF data.
        optional f_number: Placed<f64> = number("").at_least(0.5);
        /// Colour filters of a two-by-two tile, row by row: "RGGB". Default: from side-cars or EXIF data.
        optional cfa: Placed<String> = text("four of the letters R, G and B");
        /// Exposure times by folder path, for images that do not state theirs: `{ "dark/long" = 4.0 }`. The longest matching path counts.
        many exposures_s: (Placed<String>, Placed<f64>) = keyed_by_name(number("s").at_least(0.0));
        /// Light in `flat/`. Default: uniform, steady, of unknown strength.
        optional flat: FlatLight = record();
        /// Chart in `chart/`. Default: from its truth.json.
        optional chart: LaboratoryChart = record();
        /// Slanted edges in `edges/`. Default: from its truth.json.
        optional edges: LaboratoryEdges = record();
        /// ColorChecker in `checker/`. Default: from its truth.json.
        optional checker: LaboratoryChecker = record();
    }
}

record! {
    /// Light on the bare sensor, of one wavelength.
    pub struct FlatLight {
        /// Photons per second on a whole pixel.
        required photons_per_s: Placed<f64> = number("1/s").above(0.0);
        /// Wavelength of the light.
        required wavelength_nm: Placed<f64> = number("nm").at_least(300.0).at_most(1100.0);
    }
}

words! {
    /// Charts of points.
    pub enum ChartOfPoints {
        /// Dark and bright squares; its points are the inner corners.
        "checkerboard" => Checkerboard,
        /// A square grid of discs.
        "dots" => Dots,
    }
}

record! {
    /// A plane chart of points.
    pub struct LaboratoryChart {
        /// Chart type. Default: the type with more detected points.
        optional target: Placed<ChartOfPoints> = choice();
        /// Distance between neighbouring points.
        required pitch_mm: Placed<f64> = number("mm").above(0.0);
        /// Columns and rows of points (checkerboard: inner corners). Default: as detected.
        optional grid: Placed<[f64; 2]> = vector::<2>(number("").at_least(2.0));
    }
}

record! {
    /// Positions of slanted edges.
    pub struct LaboratoryEdges {
        /// Regions with one edge each: left column, top row, columns, rows.
        many regions_px: Placed<[f64; 4]> = list(vector::<4>(number("px").at_least(0.0)), 1);
    }
}

record! {
    /// Position of a ColorChecker, lit by daylight D65.
    pub struct LaboratoryChecker {
        /// Centres of the corner patches dark skin, bluish green, black and white, raster coordinates.
        required corners_px: Placed<[Placed<[f64; 2]>; 4]> = exactly(vector::<2>(number("px").at_least(0.0)));
    }
}

/// The letters of a tile of two by two.
fn is_tile(text: &str) -> bool {
    text.len() == 4 && text.bytes().all(|letter| b"RGB".contains(&letter))
}

fn check(laboratory: &Laboratory, errors: &mut DescriptionErrors) {
    if let Some(cfa) = laboratory.cfa.as_ref().filter(|cfa| !is_tile(&cfa.value)) {
        errors.add(
            ErrorCode::UnknownWord,
            &cfa.place,
            format!("\"{}\" is not a colour filter pattern", cfa.value),
            "give four of R, G and B: \"RGGB\"",
        );
    }
    let are_integers = |numbers: &[f64]| numbers.iter().all(|n| n.fract() == 0.0);
    if let Some(grid) =
        laboratory.chart.as_ref().and_then(|chart| chart.grid.as_ref()).filter(|g| !are_integers(&g.value))
    {
        errors.add(
            ErrorCode::WrongType,
            &grid.place,
            format!("{:?} are not whole numbers", grid.value),
            "give whole numbers",
        );
    }
    let regions = laboratory.edges.iter().flat_map(|edges| &edges.regions_px);
    for region in regions.filter(|region| !are_integers(&region.value)) {
        errors.add(
            ErrorCode::WrongType,
            &region.place,
            format!("{:?} contains a fraction of a pixel", region.value),
            "give whole numbers",
        );
    }
}
