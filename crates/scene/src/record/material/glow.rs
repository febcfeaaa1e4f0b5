//! Light that a surface gives.

use crate::asset::file_list::{FileList, NamesFiles};
use crate::fault::{ErrorCode, Faults, Named};
use crate::place::Placed;
use crate::reader::{choice, name_of, record, words};
use crate::record::light::{Emission, Modulation};

record! {
    /// Light that a surface gives.
    pub struct SurfaceEmission check(check_glow) {
        /// How much, of which colour.
        inside light: Emission;
        /// Which sides give it. The front is where the normal points: by the winding of triangles, outwards for a box or a
        /// sphere, +z for a quad. Default: "front".
        optional sides: Placed<Sides> = choice();
        /// The name of a texture whose colours are factors on the light: the stated level holds where the picture is 1, 1, 1,
        /// so that a picture in units (HDR, EXR) with level 1 gives its own numbers. Default: none.
        optional texture: Placed<String> = name_of(Named::Texture);
        /// How its strength changes over time. Default: not at all.
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
        /// The side that the normal points to.
        "front" => Front,
        /// Both, each with the stated radiance; a flux is that of both together.
        "both" => Both,
    }
}

fn check_glow(emission: &SurfaceEmission, faults: &mut Faults) {
    if let (Some((key, place)), Some(_)) = (emission.light.level.flux(), &emission.texture) {
        let problem = format!("\"{key}\" is no flux of a surface whose light a texture changes from place to place");
        faults.add(
            ErrorCode::Contradiction,
            place,
            problem,
            "give \"luminance_cd_m2\" or \"radiance_w_m2_sr_nm\" of the texture's white",
        );
    }
}
