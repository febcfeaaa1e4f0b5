//! Ground under water.

use super::factor::FactorTexture;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::place::Placed;
use crate::reader::{number, record};
use crate::record::reflectance::{Reflectance, any_reflectance};

record! {
    /// A diffuse base under water of index 1.333. Internal reflection in the water darkens it (Lekner and Dorf 1988).
    pub struct WetGround {
        /// Reflectance of the dry ground.
        required reflectance: Reflectance = any_reflectance();
        /// Roughness α of the film over the grains. Default: 0.06.
        optional film_alpha: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Standing water.
        optional puddles: Box<Puddles> = record();
    }
}

record! {
    /// Water in the low parts of the ground, flat except for the rings of falling drops.
    pub struct Puddles {
        /// Height of the ground, from 0 (lowest) to 1.
        required height: FactorTexture = record();
        /// Height of the highest point above the lowest.
        required relief_mm: Placed<f64> = number("mm").above(0.0).at_most(1000.0);
        /// Water level above the lowest point.
        required level_mm: Placed<f64> = number("mm").at_least(0.0).at_most(1000.0);
        /// Grain height; deeper water is flat. Default: 2.
        optional grain_mm: Placed<f64> = number("mm").above(0.0).at_most(100.0);
        /// Rain rate on the water, which roughens it. Default: 0.
        optional rain_mm_h: Placed<f64> = number("mm/h").at_least(0.0).at_most(150.0);
    }
}

impl NamesFiles for WetGround {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, film_alpha: _, puddles: _ } = self;
        reflectance.name_files(files);
    }
}
