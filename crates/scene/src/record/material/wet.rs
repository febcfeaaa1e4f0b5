//! Ground under water.

use super::factor::FactorTexture;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::place::Placed;
use crate::reader::{number, record};
use crate::record::reflectance::{Reflectance, any_reflectance};

record! {
    /// A diffuse base under water of index 1.333. What the water holds back darkens it (Lekner and Dorf 1988).
    pub struct WetGround {
        /// Share of light that the dry ground reflects, as for "diffuse".
        required reflectance: Reflectance = any_reflectance();
        /// Roughness α of a film over the ground's grains, 0 … 1. Default: 0.06.
        optional film_alpha: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Where water stands. Default: nowhere.
        optional puddles: Puddles = record();
    }
}

record! {
    /// Water that stands in the low parts of ground, flat but for the rings of falling drops.
    pub struct Puddles {
        /// The ground's height, from 0, the lowest, to 1: `{ texture = name, channel = "r" }`.
        required height: FactorTexture = record();
        /// How far the highest place lies above the lowest, mm, above 0 … 1000.
        required relief_mm: Placed<f64> = number("mm").above(0.0).at_most(1000.0);
        /// How far the water's level lies above the lowest place, mm, 0 … 1000.
        required level_mm: Placed<f64> = number("mm").at_least(0.0).at_most(1000.0);
        /// Height of the ground's grains, mm, above 0 … 100: water deeper than that is flat. Default: 2.
        optional grain_mm: Placed<f64> = number("mm").above(0.0).at_most(100.0);
        /// Rain that falls on it, mm/h, 0 … 150, whose rings make it rough. Default: 0.
        optional rain_mm_h: Placed<f64> = number("mm/h").at_least(0.0).at_most(150.0);
    }
}

impl NamesFiles for WetGround {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, film_alpha: _, puddles: _ } = self;
        reflectance.name_files(files);
    }
}
