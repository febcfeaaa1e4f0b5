//! `[precipitation]`: rain or snow.

use crate::place::{Place, Placed};
use crate::reader::{choice, flag, integer, number, record, variants, vector, words};

variants! {
    /// Precipitation over the whole scene below a height. Near a camera drops and flakes are modelled individually, farther away as a medium of the
    /// same extinction. Their positions depend only on seed and time. Ground truth ignores them.
    pub enum Precipitation by "type" {
        /// Rain: sizes of Marshall and Palmer (1948), terminal speeds of Atlas (1973).
        "rain" => Rain(Rain),
        /// Snow: sizes of Sekhon and Srivastava (1970).
        "snow" => Snow(Snow),
    }
}

impl Precipitation {
    /// Place of its table.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Rain(rain) => &rain.place,
            Self::Snow(snow) => &snow.place,
        }
    }
}

record! {
    /// Rain.
    pub struct Rain {
        /// Rain rate, 0.1 … 150: 1 light, 10 heavy, 50 a cloudburst. Sizes were measured up to about 25.
        required rate_mm_h: Placed<f64> = number("mm/h").above(0.0);
        /// Scales the number of drops to give `rate_mm_h`; otherwise 5 to 18 % more. Default: false.
        optional rescaled: Placed<bool> = flag();
        /// Extent, and modelling.
        inside fall: PrecipitationSettings;
    }
}

record! {
    /// Snow.
    pub struct Snow {
        /// Snow rate, melted, 0.1 … 3: 0.5 light, 2.5 heavy.
        required rate_mm_h: Placed<f64> = number("mm/h").above(0.0);
        /// Type of the flakes. Default: "aggregates".
        optional crystals: Placed<Crystals> = choice();
        /// Scales the number of flakes to give `rate_mm_h`. Default: false.
        optional rescaled: Placed<bool> = flag();
        /// Extent, and modelling.
        inside fall: PrecipitationSettings;
    }
}

words! {
    /// Type of flakes, which sets their density: for equal water they are large and slow or small and fast.
    pub enum Crystals {
        /// Dry, feathery crystals: half the density of aggregates.
        "dendrites" => Dendrites,
        /// Flakes of many crystals (Brandes et al. 2007).
        "aggregates" => Aggregates,
        /// Flakes covered with frozen droplets: twice the density.
        "rimed" => Rimed,
        /// Soft hail: four times the density.
        "graupel" => Graupel,
    }
}

record! {
    /// Extent and modelling of precipitation.
    pub struct PrecipitationSettings {
        /// Air velocity. Default: 0.
        optional wind_m_s: Placed<[f64; 3]> = vector::<3>(number("m/s").at_least(-100.0).at_most(100.0));
        /// Height from which precipitation falls. Default: 500.
        optional top_m: Placed<f64> = number("m");
        /// Distance from the camera within which nothing falls. Default: 0.
        optional clear_m: Placed<f64> = number("m").at_least(0.0).at_most(100.0);
        /// Seed. Default: 0.
        optional seed: Placed<u64> = integer(0, 4_294_967_295);
        /// Width on the image, px, from which drops are modelled individually. Default: 0.25.
        optional smallest_px: Placed<f64> = number("").above(0.0).at_most(10.0);
        /// Maximum number modelled individually per camera and exposure; more shorten their range. Default: 200 000.
        optional most: Placed<u64> = integer(0, 5_000_000);
    }
}
