//! Point spreads over the field in the form of Zemax's "Huygens PSF" saved as text, made from a formula.
//!
//! A stand-in for a lens with coma in proportion to the distance from the axis: a ray through the pupil at (ρ, φ) lands C ρ² (2 + cos 2φ) outwards and
//! C ρ² sin 2φ aside of the point (Welford, Aberrations of Optical Systems, 1986, third order), blurred by a Gaussian.

use crate::File;
use core::f64::consts::TAU;
use core::fmt::Write as _;
use etendue_core::maths::f64 as maths;

/// Distances from the axis, mm: to the corner of a picture of 36 × 24 mm.
const FIELDS_MM: [f64; 3] = [0.0, 11.0, 22.0];
const FOCAL_LENGTH_MM: f64 = 99.5;
/// Coma's C at the farthest, and the Gaussian's width, µm.
const COMA_UM: f64 = 40.0;
const WIDTH_UM: f64 = 30.0;
/// Samples, and their distance, µm.
const SIDE: usize = 21;
const SPACING_UM: f64 = 25.0;
/// Rings of the pupil of equal area, and rays of each.
const RINGS: usize = 24;
const RAYS: usize = 48;

/// The listings.
#[must_use]
pub fn files() -> Vec<File> {
    let name = |i: usize| format!("lenses/point-spread-{i}.txt");
    FIELDS_MM.iter().enumerate().map(|(i, field_mm)| File::text(name(i), listing(*field_mm))).collect()
}

/// Light at an offset outwards of the point and across, µm, of any scale.
fn light(coma_um: f64, outwards_um: f64, across_um: f64) -> f64 {
    let ray = |i: usize| {
        let rho_squared = ((i / RAYS) as f64 + 0.5) / RINGS as f64;
        let (sin, cos) = maths::sin_cos(2.0 * TAU * (i % RAYS) as f64 / RAYS as f64);
        let (x, y) = (outwards_um - coma_um * rho_squared * (2.0 + cos), across_um - coma_um * rho_squared * sin);
        maths::exp(-0.5 * (x * x + y * y) / (WIDTH_UM * WIDTH_UM))
    };
    (0..RINGS * RAYS).map(ray).sum::<f64>() / (RINGS * RAYS) as f64
}

/// The listing of a field of y.
fn listing(field_mm: f64) -> String {
    let coma_um = COMA_UM * field_mm / FIELDS_MM[FIELDS_MM.len() - 1];
    let angle_deg = maths::atan2(field_mm, FOCAL_LENGTH_MM).to_degrees();
    let (side_um, middle) = (SPACING_UM * SIDE as f64, SIDE / 2);
    // A centre's row counts from the last; the first row has the greatest y.
    let mut text = format!(
        "Listing of Huygens PSF Data\n\nTitle: a stand-in, made by the generator of the scenes\n\n0.5500 µm at 0.0000, {angle_deg:.4} (deg).\n\
         Data spacing is {SPACING_UM:.3} µm.\nData area is {side_um:.3} by {side_um:.3} µm.\nImage grid size: {SIDE} by {SIDE}\n\
         Center point is: {0}, {0}\nCenter coordinates  :   0.00000000E+00,   {field_mm:.8E} Millimeters\n\nValues are relative intensity.\n\n",
        middle + 1
    );
    for row in 0..SIDE {
        let y_um = SPACING_UM * (middle as f64 - row as f64);
        let value = |column: usize| light(coma_um, y_um, SPACING_UM * (column as f64 - middle as f64));
        let values: Vec<String> = (0..SIDE).map(|column| format!("{:.3E}", value(column))).collect();
        let _ = writeln!(text, "{}", values.join("\t"));
    }
    text
}
