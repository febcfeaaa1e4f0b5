//! Materials of glTF files: metal, coat and base, sheen, transparent substances, mixed.

use super::super::context::Context;
use super::super::spectrum::bright;
use super::builder::MaterialTableBuilder;
use super::texels::Reading;
use etendue_scene::Place;
use etendue_scene::asset::{
    SlotColour, SlotEmission, SlotLayers, SlotMaterial, SlotNumber, SlotOver, SlotPicture, SlotTransmission, SlotWrap,
};
use etendue_spectra::colour::BT709;
use etendue_spectra::{metal, upsample};
use etendue_tracer::materials::{
    Cloth, Coated, Conductor, Dielectric, Emission, EmissionSides, Factor, Green, Material, Mix, NormalMap,
    Reflectance, Surface, ThinSheet, absorption_of,
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
    has_picture: bool,
}

impl MaterialTableBuilder {
    /// A material of a glTF file.
    pub(super) fn of_layers(
        &mut self,
        layers: &SlotLayers,
        slot: &SlotMaterial,
        place: &Place,
        context: &mut Context<'_>,
    ) -> Option<Material> {
        let has_picture = layers.has_picture();
        Layering { builder: self, context, slot, place, has_picture }.material(layers)
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
        if let (Some((picture, strength)), false) = (&layers.normals, is_mix) {
            let texture = self.texture(picture)?;
            material.normal_map = Some(self.context.accept(self.place, NormalMap::new(texture, Green::Up, *strength))?);
        }
        Some(material)
    }

    fn surface(&mut self, layers: &SlotLayers) -> Option<Surface> {
        match layers.metal {
            SlotNumber::Number(share) if share <= 0.0 => self.no_metal(layers),
            SlotNumber::Number(share) if share >= 1.0 => self.metal(layers),
            _ => {
                let (a, b) = (self.no_metal(layers)?, self.metal(layers)?);
                self.mix(NamedSurface::new(a, "no metal"), NamedSurface::new(b, "metal"), &layers.metal, layers)
            }
        }
    }

    fn metal(&mut self, layers: &SlotLayers) -> Option<Surface> {
        let alpha = self.number(&layers.alpha)?;
        let made = match &layers.base {
            SlotColour::LinearSrgb(rgb) => {
                let reflectance = upsample::reflectance_spectrum(rgb.map(|v| v as f32));
                Conductor::new(metal::of_reflectance(&reflectance), alpha)
            }
            SlotColour::Picture(picture) => Conductor::of_texture(self.texture(picture)?, alpha),
        };
        self.context.accept(self.place, made).map(|made| made.with_interreflection().into())
    }

    fn no_metal(&mut self, layers: &SlotLayers) -> Option<Surface> {
        let Some(clear) = &layers.transmission else { return self.opaque(layers) };
        let through = self.clear(clear, layers)?;
        match clear.share {
            SlotNumber::Number(share) if share >= 1.0 => Some(through),
            _ => {
                let opaque = self.opaque(layers)?;
                self.mix(NamedSurface::new(opaque, "opaque"), NamedSurface::new(through, "clear"), &clear.share, layers)
            }
        }
    }

    fn opaque(&mut self, layers: &SlotLayers) -> Option<Surface> {
        let base = self.reflectance(&layers.base)?;
        let alpha = self.number(&layers.alpha)?;
        match &layers.over {
            SlotOver::Nothing => Some(base.into()),
            SlotOver::Coat { index } => {
                self.context.accept(self.place, Coated::new(base, *index, alpha)).map(Surface::from)
            }
            SlotOver::Sheen { colour, alpha } => {
                let sheen = upsample::reflectance_spectrum(colour.map(|v| v as f32));
                self.context.accept(self.place, Cloth::new(base, sheen, *alpha)).map(Surface::from)
            }
            SlotOver::TwoCoats { index, share, alpha: second } => {
                let own = self.context.accept(self.place, Coated::new(base.clone(), *index, alpha))?;
                let clear = self.context.accept(self.place, Coated::new(base, *index, *second))?;
                if *share >= 1.0 {
                    return Some(clear.into());
                }
                self.mix(
                    NamedSurface::new(own.into(), "own coat"),
                    NamedSurface::new(clear.into(), "clear coat"),
                    &SlotNumber::Number(*share),
                    layers,
                )
            }
        }
    }

    fn clear(&mut self, clear: &SlotTransmission, layers: &SlotLayers) -> Option<Surface> {
        let Some(solid) = &clear.solid else {
            let tint = self.reflectance(&layers.base)?;
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
            Some(self.builder.add_part(material, &name, self.place, self.has_picture))
        };
        Some(Surface::Mix(Mix { a: part(a)?, b: part(b)?, weight }))
    }

    fn emission(&mut self, emission: &SlotEmission) -> Option<Emission> {
        let rgb = emission.rgb_cd_m2;
        let luminance: f64 = rgb.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
        let largest = rgb.iter().copied().fold(0.0, f64::max);
        let relative = upsample::emission_spectrum(rgb.map(|v| (v / largest) as f32));
        let radiance = bright(&relative, luminance, self.place, self.context)?;
        let factor = match &emission.picture {
            Some(picture) => Some(self.texture(picture)?),
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
            SlotColour::Picture(picture) => self.texture(picture).map(Reflectance::Texture),
        }
    }

    fn number(&mut self, number: &SlotNumber) -> Option<Factor> {
        match number {
            SlotNumber::Number(value) => Some(Factor::Number(*value as f32)),
            SlotNumber::Picture(picture) => Some(Factor::Texture(self.texture(picture)?, Channel::Red)),
        }
    }

    fn texture(&mut self, picture: &SlotPicture) -> Option<TextureId> {
        let wrap = picture.wrap.map(|wrap| match wrap {
            SlotWrap::Repeat => Wrap::Repeat,
            SlotWrap::Clamp => Wrap::Clamp,
            SlotWrap::Mirror => Wrap::Mirror,
        });
        let sampling = Sampling { wrap, ..Sampling::default() };
        let reading = Reading { encoded: picture.is_encoded, alpha: false, colour: picture.is_encoded, scale: 1.0 };
        self.builder.pictures.picture(&picture.file, self.place, reading, sampling, self.context)
    }
}
