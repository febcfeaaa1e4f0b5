//! `[[materials]]`: what surfaces do with light.

use super::light::Emission;
use super::reflectance::{Reflectance, reflectance};
use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{Number, number, record, text, variants};

record! {
    /// What a surface does with light.
    pub struct Material check(check) {
        /// The name by which objects call it.
        required name: Placed<String> = text("the name of the material");
        /// How it reflects.
        inside surface: Surface;
        /// Light that the surface gives of its own, from its front: a table with "luminance_cd_m2" or
        /// "radiance_w_m2_sr_nm". Default: none.
        optional emission: Emission = record();
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
        /// Reflects nothing, gives light.
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
        required metal: Placed<String> = text("the symbol of a metal");
        /// Roughness α of the GGX distribution (not its square root), 0.001 … 1.
        required alpha: Placed<f64> = alpha();
    }
}

record! {
    /// A diffuse base under a dielectric coat with a GGX distribution of microfacets.
    pub struct Coated {
        /// Share of light that the base reflects, as for "diffuse".
        required reflectance: Reflectance = reflectance();
        /// Refractive index of the coat, above 1 and at most 3. Default: 1.5.
        optional index: Placed<f64> = number("").above(1.0).at_most(3.0);
        /// Roughness α of the coat's GGX distribution (not its square root), 0.001 … 1.
        required alpha: Placed<f64> = alpha();
    }
}

record! {
    /// A surface that reflects nothing.
    pub struct Emitter {}
}

fn alpha() -> Number {
    number("").at_least(0.001).at_most(1.0)
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
