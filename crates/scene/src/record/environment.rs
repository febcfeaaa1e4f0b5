//! `[environment]`: the light that comes from infinitely far.

use std::path::PathBuf;

use super::light::Emission;
use crate::place::Placed;
use crate::reader::{choice, number, path, record, variants};

variants! {
    /// The light from infinitely far.
    pub enum Environment by "type" {
        /// The same radiance from everywhere, with the keys of an emission.
        "uniform" => Uniform(Emission),
        /// A picture of the whole sphere.
        "image" => Image(EnvironmentImage),
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

choice! {
    /// What becomes of texels below 0.
    pub enum NegativeTexels {
        /// They become 0; the plan says how many there are.
        "zero" => Zero,
    }
}
