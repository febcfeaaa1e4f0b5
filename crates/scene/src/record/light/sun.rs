//! The sun.

use super::emission::{LightColour, check_colour};
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{flag, keyed, number, record, text};

record! {
    /// The sun: a disc at infinity.
    pub struct Sun check(check) {
        /// Name of the light.
        required name: Placed<String> = text("the name of the light");
        /// Elevation of its centre above the horizon, degrees, −90 … 90.
        required elevation_deg: Placed<f64> = number("°").at_least(-90.0).at_most(90.0);
        /// Azimuth of its centre, degrees from +x (forward) towards +y (left), −360 … 360.
        required azimuth_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
        /// Strength.
        inside level: SunLevel;
        /// Colour; given already by "turbidity".
        group colour: LightColour;
        /// Diameter of the disc, degrees, above 0 and at most 20. The stated irradiance does not change; the disc's radiance follows. Default:
        /// 0.5338.
        optional angular_diameter_deg: Placed<f64> = number("°").above(0.0).at_most(20.0);
        /// Limb darkening: the disc is darker and redder towards its edge (Hosek and Wilkie 2013). The stated irradiance does not change. Default:
        /// true with "turbidity", else false.
        optional limb_darkening: Placed<bool> = flag();
    }
}

keyed! {
    /// Strength of the sunlight, on a plane perpendicular to the beam.
    pub enum SunLevel {
        /// Irradiance normal to the beam, summed over 300 … 1 100 nm, W/m², 0 or more.
        irradiance_w_m2 => Irradiance(Placed<f64>) = number("W/m²").at_least(0.0);
        /// Illuminance normal to the beam, lx, 0 or more.
        illuminance_lx => Illuminance(Placed<f64>) = number("lx").at_least(0.0);
        /// Strength and colour by the solar model of Hosek and Wilkie (2013) through air of this turbidity, 1 … 10; the elevation must be above 0.
        turbidity => Turbidity(Placed<f64>) = number("").at_least(1.0).at_most(10.0);
    }
}

fn check(sun: &Sun, faults: &mut Faults) {
    match (&sun.level, &sun.colour) {
        (SunLevel::Turbidity(_), Some(colour)) => faults.add(
            ErrorCode::Contradiction,
            colour.place(),
            "\"turbidity\" already determines the sun's spectrum; the colour contradicts it",
            "remove the colour, or give \"illuminance_lx\" instead of the turbidity",
        ),
        (SunLevel::Irradiance(v) | SunLevel::Illuminance(v), None) => faults.add(
            ErrorCode::MissingKey,
            &v.place,
            "the level does not state the colour of the sun",
            "add one of \"illuminant\", \"temperature_k\", \"rgb\", \"spectrum\"",
        ),
        _ => {}
    }
    if let (SunLevel::Turbidity(_), true) = (&sun.level, sun.elevation_deg.value <= 0.0) {
        faults.add(
            ErrorCode::OutOfRange,
            &sun.elevation_deg.place,
            format!("found {}; the solar model has no sun at or below the horizon", sun.elevation_deg.value),
            "give an elevation above 0, or state \"illuminance_lx\" instead of \"turbidity\"",
        );
    }
    sun.colour.iter().for_each(|c| check_colour(c, faults));
}
