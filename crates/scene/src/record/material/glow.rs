//! Emission of a surface.

use crate::asset::file_list::{FileList, NamesFiles};
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::Placed;
use crate::reader::{choice, name_of, record, words};
use crate::record::light::{Emission, Modulation};

record! {
    /// Emission of a surface.
    pub struct SurfaceEmission check(check_emission) {
        /// Strength and colour.
        inside light: Emission;
        /// Sides that emit; the front is outwards, +z of a quad, or by triangle winding. Default: "front".
        optional sides: Placed<Sides> = choice();
        /// Texture of factors on the emission; the stated level holds at 1, 1, 1.
        optional texture: Placed<String> = name_of(NameKind::Texture);
        /// Strength over time. Default: constant.
        optional modulation: Modulation = record();
    }
}

impl NamesFiles for SurfaceEmission {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, light, sides: _, texture: _, modulation } = self;
        light.name_files(files);
        modulation.name_files(files);
    }
}

words! {
    /// Sides of a surface.
    pub enum Sides {
        /// The side of the normal.
        "front" => Front,
        /// Both, each with the stated radiance; a flux is the sum of both.
        "both" => Both,
    }
}

fn check_emission(emission: &SurfaceEmission, errors: &mut DescriptionErrors) {
    if let (Some((key, place)), Some(_)) = (emission.light.level.flux(), &emission.texture) {
        let problem = format!(
            "\"{key}\" cannot be used with an emission texture: the flux of a textured surface is not determined"
        );
        errors.add(
            ErrorCode::Contradiction,
            place,
            problem,
            "give \"luminance_cd_m2\" or \"radiance_w_m2_sr_nm\" of the texture's white",
        );
    }
}
