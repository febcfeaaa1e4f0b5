//! `[environment]`: the light that comes from infinitely far.

use std::path::PathBuf;

use super::light::Emission;
use super::moment::{Date, TimeOfDay, date, time_of_day};
use crate::fault::{ErrorCode, Faults};
use crate::place::{Place, Placed};
use crate::reader::{choice, flag, number, path, record, variants, words};

variants! {
    /// The light from infinitely far.
    pub enum Environment by "type" {
        /// The same radiance from everywhere, with the keys of an emission.
        "uniform" => Uniform(Emission),
        /// A picture of the whole sphere.
        "image" => Image(EnvironmentImage),
        /// The clear sky of Hosek and Wilkie (2012), with the sun of theirs (2013) unless told otherwise; the world's z axis
        /// points to the zenith.
        "sky" => Sky(Box<Sky>),
    }
}

record! {
    /// A picture of the whole sphere in equirectangular projection: its middle column is seen along +x, columns to the
    /// left of it towards +y, its top row upwards.
    pub struct EnvironmentImage {
        /// The picture, in linear sRGB.
        required file: Placed<PathBuf> = path(&["hdr", "exr"]);
        /// Luminance of a pixel (1, 1, 1), cd/m², above 0.
        required luminance_cd_m2_per_unit: Placed<f64> = number("cd/m²").above(0.0);
        /// The picture turned about the vertical, degrees, positive to the left. Default: 0.
        optional rotation_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
        /// What becomes of texels below 0, which no light has but lossy compression makes. Default: they are refused.
        optional negative_texels: Placed<NegativeTexels> = choice();
    }
}

words! {
    /// What becomes of texels below 0.
    pub enum NegativeTexels {
        /// They become 0; the plan says how many there are.
        "zero" => Zero,
    }
}

record! {
    /// A clear sky.
    pub struct Sky check(check_sky) {
        /// How hazy the air is, 1 … 10: 1 is pure air, 2 to 3 a clear day, 6 and more haze.
        required turbidity: Placed<f64> = number("").at_least(1.0).at_most(10.0);
        /// Share of light that the ground far around throws back into the sky, 0 … 1. Default: 0.2.
        optional ground_albedo: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Whether the sun's disc is there too, with limb darkening; without it the sky alone shines. Default: true.
        optional sun: Placed<bool> = flag();
        /// Where the sun stands, by angles.
        group angles: SunAngles;
        /// Where the sun stands, by when and where on the Earth.
        group moment: SunMoment;
    }
}

record! {
    /// Where the sun stands.
    pub struct SunAngles {
        /// Height of the sun's centre above the horizon, degrees, −90 … 90. Exactly one of the two: the angles, or "date",
        /// "time_utc", "latitude_deg" and "longitude_deg".
        required sun_elevation_deg: Placed<f64> = number("°").at_least(-90.0).at_most(90.0);
        /// Azimuth of the sun's centre, degrees from +x (forward) towards +y (left), −360 … 360.
        required sun_azimuth_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
    }
}

record! {
    /// When and where on the Earth.
    pub struct SunMoment {
        /// The day, by UTC: `2026-06-21`, 1950 … 2099.
        required date: Placed<Date> = date();
        /// The time, UTC: `09:30:00`.
        required time_utc: Placed<TimeOfDay> = time_of_day();
        /// Latitude, degrees, positive to the north.
        required latitude_deg: Placed<f64> = number("°").at_least(-90.0).at_most(90.0);
        /// Longitude, degrees, positive to the east.
        required longitude_deg: Placed<f64> = number("°").at_least(-180.0).at_most(180.0);
        /// Azimuth of true north in the world, degrees from +x (forward) towards +y (left), −360 … 360. Default: 0, north is
        /// forward.
        optional north_azimuth_deg: Placed<f64> = number("°").at_least(-360.0).at_most(360.0);
    }
}

impl Sky {
    /// The keys that say where the sun stands.
    #[must_use]
    pub fn sun_place(&self) -> &Place {
        match (&self.angles, &self.moment) {
            (Some(angles), _) => &angles.sun_elevation_deg.place,
            (None, Some(moment)) => &moment.date.place,
            (None, None) => &self.place,
        }
    }
}

fn check_sky(sky: &Sky, faults: &mut Faults) {
    match (&sky.angles, &sky.moment) {
        (Some(angles), Some(moment)) => faults.add(ErrorCode::Contradiction,
            &moment.date.place,
            format!("\"date\" and \"sun_elevation_deg\" ({}) both say where the sun stands", angles.sun_elevation_deg.place),
            "keep the angles, or the date with its time and place",
        ),
        (None, None) => faults.add(ErrorCode::MissingKey,
            &sky.place,
            "it is not said where the sun stands, which decides the sky",
            "add \"sun_elevation_deg\" and \"sun_azimuth_deg\", or \"date\", \"time_utc\", \"latitude_deg\" and \"longitude_deg\"",
        ),
        _ => {}
    }
}
