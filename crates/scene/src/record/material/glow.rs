//! Light that a surface gives.

use crate::fault::Named;
use crate::place::Placed;
use crate::reader::{choice, name_of, record};
use crate::record::light::Emission;

record! {
    /// Light that a surface gives.
    pub struct SurfaceEmission {
        /// How much, of which colour.
        inside light: Emission;
        /// Which sides give it. The front is where the normal points: by the winding of triangles, outwards for a box or a
        /// sphere, +z for a quad. Default: "front".
        optional sides: Placed<Sides> = choice();
        /// The name of a texture whose colours are factors on the light: the stated level holds where the picture is 1, 1, 1,
        /// so that a picture in units (HDR, EXR) with level 1 gives its own numbers. Default: none.
        optional texture: Placed<String> = name_of(Named::Texture);
    }
}

choice! {
    /// Sides of a surface.
    pub enum Sides {
        /// The side that the normal points to.
        "front" => Front,
        /// Both, each with the stated radiance.
        "both" => Both,
    }
}
