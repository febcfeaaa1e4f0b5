//! `[environment]`: light from infinity.

use std::path::PathBuf;

use super::light::Emission;
use super::moment::{Date, TimeOfDay, date, time_of_day};
use super::texture::image_key;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{choice, flag, number, path, record, text, variants, words};

variants! {
    /// Light from infinity.
    pub enum Environment by "type" {
        /// Equal radiance from all directions, with the keys of an emission.
        "uniform" => Uniform(Emission),
        /// An image of the whole sphere.
        "image" => Image(EnvironmentImage),
        /// The clear sky of Hosek and Wilkie (2012), by default with their sun (2013).
        "sky" => Sky(Box<Sky>),
    }
}

record! {
    /// An image of the whole sphere in equirectangular projection. Its middle column lies along +x, columns to the left of it towards +y, its top row
    /// up.
    pub struct EnvironmentImage {
        /// The image, in linear sRGB.
        required file: Placed<PathBuf> = path(&["hdr", "exr"]);
        /// Layer of an EXR file. Default: the channels R, G, B without a layer.
        optional layer: Placed<String> = text("the name of a layer");
        /// Luminance of a pixel (1, 1, 1).
        required luminance_cd_m2_per_unit: Placed<f64> = number("cd/m²").above(0.0);
        /// Rotation about the vertical, positive to the left. Default: 0.
        optional rotation_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
        /// Treatment of negative texels. Default: an error.
        optional negative_texels: Placed<NegativeTexels> = choice();
    }
}

impl EnvironmentImage {
    /// Its image among the images of the assets.
    #[must_use]
    pub fn image_key(&self) -> PathBuf {
        image_key(&self.file.value, self.layer.as_ref())
    }
}

words! {
    /// Treatment of texels below 0.
    pub enum NegativeTexels {
        /// Set to 0; the plan states how many there are.
        "zero" => Zero,
    }
}

record! {
    /// A clear sky.
    pub struct Sky check(check_sky) {
        /// Turbidity: 1 pure air, 2 to 3 clear, 6 and more haze.
        required turbidity: Placed<f64> = number("").at_least(1.0).at_most(10.0);
        /// Albedo of the distant ground. Default: 0.2.
        optional ground_albedo: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Includes the sun's disc, with limb darkening. Default: true.
        optional sun: Placed<bool> = flag();
        /// Sun's position by angles.
        group angles: SunAngles;
        /// Sun's position by date, time and place on the Earth.
        group moment: SunMoment;
    }
}

record! {
    /// Sun's position by angles.
    pub struct SunAngles {
        /// Elevation of the sun's centre; angles, or date, time and place.
        required sun_elevation_deg: Placed<f64> = number("°").at_least(-90.0).at_most(90.0);
        /// Azimuth of the sun's centre, from +x towards +y.
        required sun_azimuth_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
    }
}

record! {
    /// Date, time and place on the Earth.
    pub struct SunMoment {
        /// Date, UTC, 1950 … 2099.
        required date: Placed<Date> = date();
        /// Time, UTC.
        required time_utc: Placed<TimeOfDay> = time_of_day();
        /// Latitude, positive to the north.
        required latitude_deg: Placed<f64> = number("°").at_least(-90.0).at_most(90.0);
        /// Longitude, positive to the east.
        required longitude_deg: Placed<f64> = number("°").at_least(-180.0).at_most(180.0);
        /// Azimuth of true north, from +x towards +y. Default: 0.
        optional north_azimuth_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
    }
}

impl Sky {
    /// Place of the keys that give the sun's position.
    #[must_use]
    pub fn sun_place(&self) -> &Place {
        match (&self.angles, &self.moment) {
            (Some(angles), _) => &angles.sun_elevation_deg.place,
            (None, Some(moment)) => &moment.date.place,
            (None, None) => &self.place,
        }
    }
}

fn check_sky(sky: &Sky, errors: &mut DescriptionErrors) {
    match (&sky.angles, &sky.moment) {
        (Some(angles), Some(moment)) => errors.add(ErrorCode::Contradiction,
            &moment.date.place,
            format!("\"date\" and \"sun_elevation_deg\" ({}) both state the position of the sun", angles.sun_elevation_deg.place),
            "keep the angles, or the date with its time and place",
        ),
        (None, None) => errors.add(ErrorCode::MissingKey,
            &sky.place,
            "the position of the sun is missing, which determines the sky",
            "add \"sun_elevation_deg\" and \"sun_azimuth_deg\", or \"date\", \"time_utc\", \"latitude_deg\" and \"longitude_deg\"",
        ),
        _ => {}
    }
}
