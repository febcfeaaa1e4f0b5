//! Materials of mesh files in layers: metal, coat and base, sheen, transparent substances, mixed.

use super::super::context::Context;
use super::super::spectrum::scaled_to_luminance;
use super::builder::MaterialTableBuilder;
use super::texels::TexelInterpretation;
use etendue_scene::Place;
use etendue_scene::asset::{
    SlotColour, SlotEmission, SlotLayers, SlotMaterial, SlotNumber, SlotPicture, SlotTopLayer, SlotTransmission,
    SlotWrap,
};
use etendue_spectra::colour::BT709;
use etendue_spectra::{metal, upsample};
use etendue_tracer::materials::{
    Cloth, CoatedDiffuse, Conductor, Dielectric, Emission, EmissionSides, Factor, GreenDirection, Material, Mix,
    NormalMap, Reflectance, Surface, ThinSheet, absorption_of,
};
use etendue_tracer::textures::{Channel, Sampling, TextureId, Wrap};

/// A surface of a mix, with the name of its part.
struct NamedSurface {
    surface: Surface,
    name: &'static str,
}

impl NamedSurface {
    fn new(surface: Surface, name: &'static str) -> Self {
        Self { surface, name }
    }
}

/// Context of the compilation of one material.
struct Layering<'l, 'c, 'a> {
    builder: &'l mut MaterialTableBuilder,
    context: &'c mut Context<'a>,
    slot: &'l SlotMaterial,
    place: &'l Place,
    uses_image: bool,
}

impl MaterialTableBuilder {
    /// A material in layers.
    pub(super) fn add_layers(
        &mut self,
        layers: &SlotLayers,
        slot: &SlotMaterial,
        place: &Place,
        context: &mut Context<'_>,
    ) -> Option<Material> {
        let uses_image = layers.has_picture();
        Layering { builder: self, context, slot, place, uses_image }.material(layers)
    }
}

impl Layering<'_, '_, '_> {
    fn material(&mut self, layers: &SlotLayers) -> Option<Material> {
        let surface = self.surface(layers)?;
        let mut material = self.with_normals(surface, layers)?;
        if let Some(emission) = &layers.emission {
            material.emission = Some(self.emission(emission)?);
        }
        if let Some(opacity) = &layers.opacity {
            material.opacity = Some(self.number(opacity)?);
        }
        Some(material)
    }

    /// A surface with the normal map of the material; a mix has none, but its parts do.
    fn with_normals(&mut self, surface: Surface, layers: &SlotLayers) -> Option<Material> {
        let is_mix = matches!(surface, Surface::Mix(_));
        let mut material = Material::new(surface);
        if let (Some((image, strength)), false) = (&layers.normals, is_mix) {
            let texture = self.texture(image)?;
            material.normal_map =
                Some(self.context.accept(self.place, NormalMap::new(texture, GreenDirection::Up, *strength))?);
        }
        Some(material)
    }

    fn surface(&mut self, layers: &SlotLayers) -> Option<Surface> {
        match layers.metal {
            SlotNumber::Number(metalness) if metalness <= 0.0 => self.non_metal(layers),
            SlotNumber::Number(metalness) if metalness >= 1.0 => self.metal(layers),
            _ => {
                let (a, b) = (self.non_metal(layers)?, self.metal(layers)?);
                self.mix(NamedSurface::new(a, "no metal"), NamedSurface::new(b, "metal"), &layers.metal, layers)
            }
        }
    }

    fn metal(&mut self, layers: &SlotLayers) -> Option<Surface> {
        let alpha = self.number(&layers.alpha)?;
        let metal = match &layers.base {
            SlotColour::LinearSrgb(rgb) => {
                let reflectance = upsample::reflectance_spectrum(rgb.map(|v| v as f32));
                Conductor::new(metal::from_reflectance(&reflectance), alpha)
            }
            SlotColour::Picture(image) => Conductor::from_texture(self.texture(image)?, alpha),
        };
        self.context.accept(self.place, metal).map(|metal| metal.with_interreflection().into())
    }

    fn non_metal(&mut self, layers: &SlotLayers) -> Option<Surface> {
        let Some(clear) = &layers.transmission else { return self.opaque(layers) };
        let transmission = self.transmissive(clear, layers)?;
        match clear.fraction {
            SlotNumber::Number(fraction) if fraction >= 1.0 => Some(transmission),
            _ => {
                let opaque = self.opaque(layers)?;
                self.mix(
                    NamedSurface::new(opaque, "opaque"),
                    NamedSurface::new(transmission, "clear"),
                    &clear.fraction,
                    layers,
                )
            }
        }
    }

    fn opaque(&mut self, layers: &SlotLayers) -> Option<Surface> {
        let base = self.reflectance(&layers.base)?;
        let alpha = self.number(&layers.alpha)?;
        match &layers.top_layer {
            SlotTopLayer::Nothing => Some(base.into()),
            SlotTopLayer::Coat { index } => {
                self.context.accept(self.place, CoatedDiffuse::new(base, *index, alpha)).map(Surface::from)
            }
            SlotTopLayer::Sheen { colour, alpha } => {
                let sheen = upsample::reflectance_spectrum(colour.map(|v| v as f32));
                self.context.accept(self.place, Cloth::new(base, sheen, *alpha)).map(Surface::from)
            }
            SlotTopLayer::TwoCoats { index, fraction, alpha: second } => {
                let own = self.context.accept(self.place, CoatedDiffuse::new(base.clone(), *index, alpha))?;
                let clear = self.context.accept(self.place, CoatedDiffuse::new(base, *index, *second))?;
                if *fraction >= 1.0 {
                    return Some(clear.into());
                }
                self.mix(
                    NamedSurface::new(own.into(), "own coat"),
                    NamedSurface::new(clear.into(), "clear coat"),
                    &SlotNumber::Number(*fraction),
                    layers,
                )
            }
        }
    }

    fn transmissive(&mut self, clear: &SlotTransmission, layers: &SlotLayers) -> Option<Surface> {
        let Some(solid) = &clear.solid else {
            let tint = match clear.tint {
                Some(rgb) => self.reflectance(&SlotColour::LinearSrgb(rgb))?,
                None => self.reflectance(&layers.base)?,
            };
            return self.context.accept(self.place, ThinSheet::new(clear.index, tint)).map(Surface::from);
        };
        let absorption = match solid.distance_m {
            None => None,
            Some(distance_m) => {
                let left = upsample::reflectance_spectrum(solid.colour.map(|v| v as f32));
                Some(self.context.accept(self.place, absorption_of(&left, distance_m))?)
            }
        };
        let alpha = self.number(&layers.alpha)?;
        self.context.accept(self.place, Dielectric::new(clear.index, alpha, absorption)).map(Surface::from)
    }

    /// A mix of two surfaces.
    fn mix(&mut self, a: NamedSurface, b: NamedSurface, weight: &SlotNumber, layers: &SlotLayers) -> Option<Surface> {
        let weight = self.number(weight)?;
        let mut part = |NamedSurface { surface, name }: NamedSurface| -> Option<_> {
            let material = self.with_normals(surface, layers)?;
            let name = format!("{}, {name}", self.slot.name);
            Some(self.builder.add_part(material, &name, self.place, self.uses_image))
        };
        Some(Surface::Mix(Mix { a: part(a)?, b: part(b)?, weight }))
    }

    fn emission(&mut self, emission: &SlotEmission) -> Option<Emission> {
        let rgb = emission.rgb_cd_m2;
        let luminance: f64 = rgb.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
        let largest = rgb.iter().copied().fold(0.0, f64::max);
        let relative = upsample::emission_spectrum(rgb.map(|v| (v / largest) as f32));
        let radiance = scaled_to_luminance(&relative, luminance, self.place, self.context)?;
        let factor = match &emission.picture {
            Some(image) => Some(self.texture(image)?),
            None => None,
        };
        let sides = if emission.both_sides { EmissionSides::Both } else { EmissionSides::Front };
        Some(Emission { radiance, factor, sides, modulation: None })
    }

    fn reflectance(&mut self, colour: &SlotColour) -> Option<Reflectance> {
        match colour {
            SlotColour::LinearSrgb(rgb) => {
                Some(Reflectance::Spectrum(upsample::reflectance_spectrum(rgb.map(|v| v as f32))))
            }
            SlotColour::Picture(image) => self.texture(image).map(Reflectance::Texture),
        }
    }

    fn number(&mut self, number: &SlotNumber) -> Option<Factor> {
        match number {
            SlotNumber::Number(value) => Some(Factor::Number(*value as f32)),
            SlotNumber::Picture(image) => Some(Factor::Texture(self.texture(image)?, Channel::Red)),
        }
    }

    fn texture(&mut self, image: &SlotPicture) -> Option<TextureId> {
        let wrap = image.wrap.map(|wrap| match wrap {
            SlotWrap::Repeat => Wrap::Repeat,
            SlotWrap::Clamp => Wrap::Clamp,
            SlotWrap::Mirror => Wrap::Mirror,
        });
        let sampling = Sampling { wrap, ..Sampling::default() };
        let reading =
            TexelInterpretation { encoded: image.is_encoded, alpha: false, colour: image.is_encoded, scale: 1.0 };
        self.builder.pictures.picture(&image.file, self.place, reading, sampling, self.context)
    }
}
