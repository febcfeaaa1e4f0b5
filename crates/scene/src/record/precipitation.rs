//! `[precipitation]`: rain or snow.

use crate::place::{Place, Placed};
use crate::reader::{choice, flag, number, record, variants, vector, whole, words};

variants! {
    /// What falls all over the scene below a height. Near a camera drops and flakes are modelled one by one, farther away as a medium of
    /// the same extinction; where they are depends on seed and time alone. Ground truth does not see them.
    pub enum Precipitation by "type" {
        /// Rain, by Marshall and Palmer's law of sizes (1948) with Atlas's terminal speeds (1973).
        "rain" => Rain(Rain),
        /// Snow, by Sekhon and Srivastava's law of sizes (1970).
        "snow" => Snow(Snow),
    }
}

impl Precipitation {
    /// Where its table stands.
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
        /// How much falls, mm/h, 0.1 … 150: 1 is light, 10 heavy, 50 a cloudburst. The law was measured up to some 25.
        required rate_mm_h: Placed<f64> = number("mm/h").above(0.0);
        /// Whether the number of drops is rescaled so that with their speeds they bring `rate_mm_h`. The law itself brings 5 to 18 % more.
        /// Default: false.
        optional rescaled: Placed<bool> = flag();
        /// Where it falls, and how it is modelled.
        inside fall: Fall;
    }
}

record! {
    /// Snow.
    pub struct Snow {
        /// How much falls, mm/h of molten water, 0.1 … 3: 0.5 is light, 2.5 heavy.
        required rate_mm_h: Placed<f64> = number("mm/h").above(0.0);
        /// What the flakes are made of. Default: "aggregates".
        optional crystals: Placed<Crystals> = choice();
        /// Whether the number of flakes is rescaled so that with their speeds they bring `rate_mm_h`. Default: false.
        optional rescaled: Placed<bool> = flag();
        /// Where it falls, and how it is modelled.
        inside fall: Fall;
    }
}

words! {
    /// What flakes are made of: their density, by which flakes of the same water are large and slow or small and quick.
    pub enum Crystals {
        /// Dry, feathery crystals: half the density of aggregates.
        "dendrites" => Dendrites,
        /// Flakes of many crystals (Brandes et al. 2007).
        "aggregates" => Aggregates,
        /// Flakes covered by frozen droplets: twice the density.
        "rimed" => Rimed,
        /// Soft hail: four times the density.
        "graupel" => Graupel,
    }
}

record! {
    /// Where something falls, and how it is modelled.
    pub struct Fall {
        /// Velocity of the air, m/s, with which all drops or flakes drift. Default: none.
        optional wind_m_s: Placed<[f64; 3]> = vector::<3>(number("m/s").at_least(-100.0).at_most(100.0));
        /// Height in the world from which they fall, m. Default: 500.
        optional top_m: Placed<f64> = number("m");
        /// Distance from the camera within which nothing falls, m, 0 … 100: under a roof, or behind a wind-screen. Default: 0.
        optional clear_m: Placed<f64> = number("m").at_least(0.0).at_most(100.0);
        /// Which drops and flakes of all that may be. Default: 0.
        optional seed: Placed<u64> = whole(0, 4_294_967_295);
        /// From which part of a pixel's width on a drop or flake is modelled by itself, above 0 … 10. Default: 0.25.
        optional smallest_px: Placed<f64> = number("").above(0.0).at_most(10.0);
        /// How many are modelled at most in what a camera sees during an exposure, 0 … 5 000 000; where there would be more, they are modelled less far. Default: 200 000.
        optional most: Placed<u64> = whole(0, 5_000_000);
    }
}
