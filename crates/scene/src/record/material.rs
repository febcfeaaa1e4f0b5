//! `[[materials]]`: what surfaces do with light.

use super::light::Emission;
use super::reflectance::{Reflectance, reflectance};
use crate::asset::COAT_INDICES;
use crate::fault::{Faults, Named};
use crate::place::Placed;
use crate::reader::{Number, choice, known, name_of, number, record, text, variants};
use etendue_spectra::metal;

record! {
    /// What a surface does with light.
    pub struct Material check(check) {
        /// The name by which objects call it.
        required name: Placed<String> = text("the name of the material");
        /// How it reflects.
        inside surface: Surface;
        /// Light that the surface gives of its own, the same in all directions. Default: none.
        optional emission: SurfaceEmission = record();
    }
}

record! {
    /// Light that a surface gives.
    pub struct SurfaceEmission {
        /// How much, of which colour.
        inside light: Emission;
        /// Which sides give it. The front is where the normal points: by the winding of triangles, outwards for a box or a
        /// sphere, +z for a quad. Default: "front".
        optional sides: Placed<Sides> = choice();
        /// The name of a texture whose colours are factors on the light. Default: none.
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

variants! {
    /// How a surface reflects.
    pub enum Surface by "type" {
        /// Lambert's law.
        "diffuse" => Diffuse(Diffuse),
        /// A bare metal, smooth or rough.
        "conductor" => Conductor(Conductor),
        /// A diffuse base under a clear dielectric coat.
        "coated" => Coated(Coated),
        /// Reflects nothing, gives light: needs "emission".
        "emitter" => Emitter(Emitter),
    }
}

record! {
    /// Lambert's law.
    pub struct Diffuse {
        /// Share of light reflected: a number, `[r, g, b]` (linear sRGB), `{ srgb = [r, g, b] }`,
        /// `{ spectrum = file }` or `{ texture = name, scale = … }`; 0 … 1.
        required reflectance: Reflectance = reflectance();
    }
}

record! {
    /// A metal with a GGX distribution of microfacets.
    pub struct Conductor {
        /// The metal, whose complex refractive index is tabulated: "Al", "Ag", "Au", "Cu", "Cr", "Fe".
        required metal: Placed<String> = known("a metal", metal::names());
        /// Roughness α of the GGX distribution (not its square root), 0 … 1; below 0.0001 it is a mirror.
        required alpha: Placed<f64> = alpha();
    }
}

record! {
    /// A diffuse base under a dielectric coat with a GGX distribution of microfacets.
    pub struct Coated {
        /// Share of light that the base reflects, as for "diffuse".
        required reflectance: Reflectance = reflectance();
        /// Refractive index of the coat, 1.1 … 4. Default: 1.5.
        optional index: Placed<f64> = number("").at_least(*COAT_INDICES.start()).at_most(*COAT_INDICES.end());
        /// Roughness α of the coat's GGX distribution (not its square root), 0 … 1; below 0.0001 it is a mirror.
        required alpha: Placed<f64> = alpha();
    }
}

record! {
    /// A surface that reflects nothing.
    pub struct Emitter {}
}

fn alpha() -> Number {
    number("").at_least(0.0).at_most(1.0)
}

fn check(material: &Material, faults: &mut Faults) {
    if matches!(material.surface, Surface::Emitter(_)) && material.emission.is_none() {
        faults.add(
            &material.place,
            "an \"emitter\" without \"emission\" is black",
            "add \"emission\", or make it \"diffuse\" with reflectance 0",
        );
    }
}
