//! Emission of a surface.

use crate::asset::file_list::{FileList, NamesFiles};
use crate::fault::{ErrorCode, Faults, Named};
use crate::place::Placed;
use crate::reader::{choice, name_of, record, words};
use crate::record::light::{Emission, Modulation};

record! {
    /// Emission of a surface.
    pub struct SurfaceEmission check(check_glow) {
        /// Strength and colour.
        inside light: Emission;
        /// Sides that emit. The front is the side of the normal: by the winding of triangles, outwards for a box or a sphere, +z for a quad. Default:
        /// "front".
        optional sides: Placed<Sides> = choice();
        /// Name of a texture whose colours are factors on the emission. The stated level holds where the texture is 1, 1, 1, so that an image in
        /// physical units (HDR, EXR) with level 1 gives its own values. Default: none.
        optional texture: Placed<String> = name_of(Named::Texture);
        /// Variation of its strength over time. Default: constant.
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

fn check_glow(emission: &SurfaceEmission, faults: &mut Faults) {
    if let (Some((key, place)), Some(_)) = (emission.light.level.flux(), &emission.texture) {
        let problem = format!("\"{key}\" cannot be used with an emission texture: the flux of a textured surface is not determined");
        faults.add(
            ErrorCode::Contradiction,
            place,
            problem,
            "give \"luminance_cd_m2\" or \"radiance_w_m2_sr_nm\" of the texture's white",
        );
    }
}
