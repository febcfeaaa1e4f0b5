//! Image size by wavelength.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{list, number, record};

record! {
    /// Lateral colour: image size about the principal point, by wavelength. Linear between the points, constant beyond them.
    pub struct LateralColour check(check_colour) {
        /// Two or more increasing wavelengths.
        required wavelength_nm: Vec<Placed<f64>> = list(number("nm").above(0.0), 1);
        /// Image size over that at 587.56 nm; only ratios count. A good lens has 0.999 to 1.001.
        required magnification: Vec<Placed<f64>> = list(number("").above(0.0), 1);
    }
}

fn check_colour(table: &LateralColour, errors: &mut DescriptionErrors) {
    let (wavelengths, sizes) = (&table.wavelength_nm, &table.magnification);
    if wavelengths.len() != sizes.len() {
        let problem =
            format!("the numbers of wavelengths ({}) and magnifications ({}) differ", wavelengths.len(), sizes.len());
        errors.add(ErrorCode::WrongCount, &table.place, problem, "give equal numbers");
    }
    if let Some(pair) = wavelengths.windows(2).find(|pair| pair[1].value <= pair[0].value) {
        let problem = format!("{} is not above {}", pair[1].value, pair[0].value);
        errors.add(ErrorCode::WrongOrder, &pair[1].place, problem, "give increasing wavelengths");
    }
}
