//! The sun.

use super::emission::{LightColour, check_colour};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{flag, keyed, number, record, text};

record! {
    /// The sun: a disc at infinity.
    pub struct Sun check(check) {
        /// Name of the light.
        required name: Placed<String> = text("the name of the light");
        /// Elevation of its centre.
        required elevation_deg: Placed<f64> = number("°").at_least(-90.0).at_most(90.0);
        /// Azimuth of its centre, from +x towards +y.
        required azimuth_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
        /// Strength.
        inside level: SunLevel;
        /// Colour; given already by "turbidity".
        group colour: LightColour;
        /// Diameter of the disc, at constant irradiance. Default: 0.5338.
        optional angular_diameter_deg: Placed<f64> = number("°").above(0.0).at_most(20.0);
        /// Limb darkening (Hosek and Wilkie 2013), at constant irradiance. Default: true with "turbidity", else false.
        optional limb_darkening: Placed<bool> = flag();
    }
}

keyed! {
    /// Strength of the sunlight, on a plane perpendicular to the beam.
    pub enum SunLevel {
        /// Normal irradiance, 300 … 1 100 nm.
        irradiance_w_m2 => Irradiance(Placed<f64>) = number("W/m²").at_least(0.0);
        /// Normal illuminance.
        illuminance_lx => Illuminance(Placed<f64>) = number("lx").at_least(0.0);
        /// Turbidity of the solar model of Hosek and Wilkie (2013), for elevations above 0.
        turbidity => Turbidity(Placed<f64>) = number("").at_least(1.0).at_most(10.0);
    }
}

fn check(sun: &Sun, errors: &mut DescriptionErrors) {
    match (&sun.level, &sun.colour) {
        (SunLevel::Turbidity(_), Some(colour)) => errors.add(
            ErrorCode::Contradiction,
            colour.place(),
            "\"turbidity\" already determines the sun's spectrum; the colour contradicts it",
            "remove the colour, or give \"illuminance_lx\" instead of the turbidity",
        ),
        (SunLevel::Irradiance(v) | SunLevel::Illuminance(v), None) => errors.add(
            ErrorCode::MissingKey,
            &v.place,
            "the level does not state the colour of the sun",
            "add one of \"illuminant\", \"temperature_k\", \"rgb\", \"spectrum\"",
        ),
        _ => {}
    }
    if let (SunLevel::Turbidity(_), true) = (&sun.level, sun.elevation_deg.value <= 0.0) {
        errors.add(
            ErrorCode::OutOfRange,
            &sun.elevation_deg.place,
            format!("found {}; the solar model has no sun at or below the horizon", sun.elevation_deg.value),
            "give an elevation above 0, or state \"illuminance_lx\" instead of \"turbidity\"",
        );
    }
    sun.colour.iter().for_each(|c| check_colour(c, errors));
}
