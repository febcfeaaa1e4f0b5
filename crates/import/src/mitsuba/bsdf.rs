//! Surfaces, including an approximation of Disney's principled one.

use std::rc::Rc;

use etendue_io::Error;
use etendue_scene::record::material::{
    CoatedDiffuse, Conductor, Dielectric, Diffuse, Factor, Material, Metal, Mix, NormalMap, Surface, ThinSheet,
};
use etendue_scene::record::{Colour, Reflectance};
use etendue_scene::{record::material::factor::FactorTexture, record::material::surface::Distribution};
use etendue_spectra::{Spectrum, metal};

use super::importer::{Importer, MAX_DEPTH};
use super::{access::text, transform::TextureUsage, value::MitsubaValue};
use crate::scenery::{INTERFACE, KnownTexture, grey, plain};
use crate::syntax::mitsuba::MitsubaElement;

/// Result of the conversion of a surface.
pub(super) struct ConvertedSurface {
    /// `None` for an invisible surface.
    pub(super) surface: Option<Surface>,
    pub(super) opacity: Option<Factor>,
    pub(super) normal_map: Option<NormalMap>,
}

impl From<Surface> for ConvertedSurface {
    fn from(surface: Surface) -> Self {
        Self { surface: Some(surface), opacity: None, normal_map: None }
    }
}

impl<'a> Importer<'a> {
    /// Converts a `<bsdf>` to one of our materials; returns its name.
    pub(super) fn bsdf(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<Rc<str>, Error> {
        if let Some(known) = self.surfaces.get(&element.number) {
            return Ok(known.clone());
        }
        let ConvertedSurface { surface, opacity, normal_map } = self.convert(element, depth)?;
        let name: Rc<str> = match surface {
            None => INTERFACE.into(),
            Some(surface) => {
                let preferred = element.attribute("id").unwrap_or(element.kind());
                let own = self.scenery.names.take(preferred, "material");
                let normal_map = normal_map.filter(|_| !matches!(surface, Surface::Mix(_)));
                if normal_map.is_some() {
                    self.normal_mapped.insert(own.as_str().into(), None);
                }
                self.scenery.scene.materials.push(Material {
                    opacity,
                    normal_map,
                    ..Material::new(own.as_str(), surface)
                });
                own.as_str().into()
            }
        };
        self.surfaces.insert(element.number, name.clone());
        Ok(name)
    }

    fn convert(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<ConvertedSurface, Error> {
        if depth >= MAX_DEPTH {
            return Err(
                element.error(format!("surfaces are nested more than {MAX_DEPTH} levels deep, or form a cycle"))
            );
        }
        self.at(element);
        let converted = self.model(element, depth)?;
        self.note_unused(element);
        Ok(converted)
    }

    fn model(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<ConvertedSurface, Error> {
        let kind = element.kind();
        // The nested surface decides it, or both sides are equal.
        if !matches!(
            kind,
            "twosided"
                | "mask"
                | "blendbsdf"
                | "bumpmap"
                | "normalmap"
                | "null"
                | "dielectric"
                | "roughdielectric"
                | "thindielectric"
        ) && depth == 0
        {
            self.scenery
                .report
                .note("surfaces without \"twosided\" are black from behind in Mitsuba; here both sides are equal");
        }
        Ok(match kind {
            "diffuse" => {
                let reflectance = self.reflectance(element, "reflectance", 0.5, &|v| v)?;
                Surface::Diffuse(Diffuse::new(reflectance)).into()
            }
            "plastic" | "roughplastic" => Surface::CoatedDiffuse(self.plastic(element)?).into(),
            "conductor" | "roughconductor" => Surface::Conductor(self.conductor(element)?).into(),
            "dielectric" | "roughdielectric" => {
                let rough = if kind == "dielectric" { None } else { Some(self.alpha(element)?) };
                if rough.is_some() {
                    self.note_slopes(element)?;
                }
                let index = self.index(element, "bk7")?;
                Surface::Dielectric(Dielectric { alpha: rough, ..Dielectric::new(index) }).into()
            }
            "thindielectric" => {
                let index = self.index(element, "bk7")?;
                Surface::ThinSheet(ThinSheet { index: Some(index.into()), ..ThinSheet::default() }).into()
            }
            "principled" => self.principled(element)?.into(),
            "null" => ConvertedSurface { surface: None, opacity: None, normal_map: None },
            "twosided" => {
                let [inner, others @ ..] = &self.within(element, "bsdf")?[..] else {
                    return Err(element.error("the \"twosided\" has no <bsdf>"));
                };
                if others.iter().any(|other| other.number != inner.number) {
                    self.scenery.report.note("both sides of a \"twosided\" with two surfaces use the first");
                }
                self.convert(inner, depth + 1)?
            }
            "mask" => self.mask(element, depth)?,
            "blendbsdf" => self.blend(element, depth)?,
            "bumpmap" => {
                self.scenery.report.note("the bumps of a \"bumpmap\" are not used; only its surface is");
                element.children.iter().for_each(|child| child.used.set(true));
                self.only(element, depth)?
            }
            "normalmap" => self.normals(element, depth)?,
            other => {
                self.scenery
                    .report
                    .note(format!("the surface \"{other}\" is not supported: a diffuse grey of 0.5 is used instead"));
                element.children.iter().for_each(|child| child.used.set(true));
                Surface::Diffuse(Diffuse::new(plain(0.5))).into()
            }
        })
    }

    /// Converts the only nested surface.
    fn only(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<ConvertedSurface, Error> {
        match self.within(element, "bsdf")?[..] {
            [inner] => self.convert(inner, depth + 1),
            ref others => {
                let message = format!(
                    "the number of surfaces in a \"{}\" is {}; expected one <bsdf>",
                    element.kind(),
                    others.len()
                );
                Err(element.error(message))
            }
        }
    }

    fn mask(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<ConvertedSurface, Error> {
        let opacity = self.factor(element, "opacity", 0.5)?;
        let inner = self.only(element, depth)?;
        if inner.opacity.is_some() {
            self.scenery.report.note("of nested \"mask\" surfaces only the outer mask is used");
        }
        Ok(ConvertedSurface { opacity: Some(opacity), ..inner })
    }

    fn normals(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<ConvertedSurface, Error> {
        let textures = self.within(element, "texture")?;
        let inner = self.only(element, depth)?;
        let Some(texture) = textures.first() else {
            return Err(element.error("the \"normalmap\" has no <texture>"));
        };
        let normal_map = match self.texture(texture, TextureUsage::Data)? {
            KnownTexture::Picture { name, .. } => Some(NormalMap::new(name.as_str())),
            KnownTexture::Even(_) => None,
        };
        if matches!(inner.surface, Some(Surface::Mix(_))) {
            self.scenery.report.note("a \"normalmap\" over a blend of surfaces is not used");
        }
        Ok(ConvertedSurface { normal_map, ..inner })
    }

    fn blend(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<ConvertedSurface, Error> {
        let weight = self.factor(element, "weight", 0.5)?;
        let parts = self.within(element, "bsdf")?;
        let [a, b] = parts[..] else {
            return Err(
                element.error(format!("the number of surfaces in a \"blendbsdf\" is {}; expected two", parts.len()))
            );
        };
        let constant = |weight: f64| Some(Factor::Number(weight.into()));
        let [first, second] = [self.part(a, depth)?, self.part(b, depth)?];
        match (first, second, weight) {
            (None, None, _) => Ok(ConvertedSurface { surface: None, opacity: None, normal_map: None }),
            // A blend with an invisible surface is a partly transparent surface.
            (Some(_), None, Factor::Number(w)) => {
                Ok(ConvertedSurface { opacity: constant(1.0 - w.value), ..self.convert(a, depth + 1)? })
            }
            (None, Some(_), Factor::Number(w)) => {
                Ok(ConvertedSurface { opacity: constant(w.value), ..self.convert(b, depth + 1)? })
            }
            (None, Some(_), picture) => Ok(ConvertedSurface { opacity: Some(picture), ..self.convert(b, depth + 1)? }),
            (Some(_), None, _) => {
                self.scenery.report.note("a blend with an invisible second surface is replaced by its first surface");
                self.convert(a, depth + 1)
            }
            (Some(a), Some(b), weight) => Ok(Surface::Mix(Mix::new(&*a, &*b, weight)).into()),
        }
    }

    /// Name of a part of a blend, which has no opacity of its own.
    fn part(&mut self, element: &'a MitsubaElement, depth: usize) -> Result<Option<Rc<str>>, Error> {
        let name = self.bsdf(element, depth + 1)?;
        let materials = &self.scenery.scene.materials;
        let Some(base) = materials.iter().find(|m| m.name.value == *name) else { return Ok(None) };
        if base.normal_map.is_some() {
            self.scenery.report.note("the green channel of a \"normalmap\" in a blend points up in its image; set y = \"down\" where the image is mirrored");
        }
        if base.opacity.is_none() {
            return Ok(Some(name));
        }
        let own = self.scenery.names.take(&format!("{name}-whole"), "part");
        let opaque = Material { name: own.as_str().into(), opacity: None, ..base.clone() };
        self.scenery.report.note("a \"mask\" in a blend is not used; only its surface is");
        self.scenery.scene.materials.push(opaque);
        Ok(Some(own.as_str().into()))
    }

    /// α of an isotropic surface.
    pub(super) fn alpha(&mut self, element: &'a MitsubaElement) -> Result<Factor, Error> {
        let (both, u) = (self.factor(element, "alpha", 0.1)?, self.value(element, "alpha_u")?.is_some());
        if !u {
            return Ok(both);
        }
        let [u, v] = [self.factor(element, "alpha_u", 0.1)?, self.factor(element, "alpha_v", 0.1)?];
        match (&u, &v) {
            (Factor::Number(u), Factor::Number(v)) if u.value != v.value => {
                let message = "anisotropic roughness becomes isotropic: α is the geometric mean";
                self.scenery.report.note(message);
                Ok(Factor::Number((u.value * v.value).sqrt().into()))
            }
            _ => Ok(u),
        }
    }

    /// Returns true for the Beckmann distribution, the default.
    fn is_beckmann(element: &'a MitsubaElement) -> Result<bool, Error> {
        match text(element, "distribution")?.unwrap_or("beckmann") {
            "ggx" => Ok(false),
            "beckmann" => Ok(true),
            other => Err(element.error(format!("unknown \"distribution\" \"{other}\"; expected beckmann or ggx"))),
        }
    }

    /// Notes a slope distribution that our surfaces do not support.
    pub(super) fn note_slopes(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        if Self::is_beckmann(element)? {
            let message = format!(
                "the Beckmann distribution of a \"{}\" becomes GGX with the same α, which has longer tails",
                element.kind()
            );
            self.scenery.report.note(message);
        }
        Ok(())
    }

    fn conductor(&mut self, element: &'a MitsubaElement) -> Result<Conductor, Error> {
        let is_rough = element.kind() == "roughconductor";
        let alpha = if is_rough { self.alpha(element)? } else { Factor::Number(0.0.into()) };
        let is_beckmann = is_rough && Self::is_beckmann(element)?;
        let conductor = Conductor::new(self.metal(element)?, alpha);
        Ok(Conductor { distribution: is_beckmann.then(|| Distribution::Beckmann.into()), ..conductor })
    }

    fn metal(&mut self, element: &'a MitsubaElement) -> Result<Metal, Error> {
        let tint = self.reflectance(element, "specular_reflectance", 1.0, &|v| v)?;
        let tint = match tint {
            etendue_scene::record::Reflectance::Plain(etendue_scene::record::Colour::Grey(v)) => [v.value; 3],
            etendue_scene::record::Reflectance::Plain(etendue_scene::record::Colour::LinearSrgb(v)) => v.value,
            _ => {
                self.scenery.report.note("\"specular_reflectance\" from an image or a table is set to 1");
                [1.0; 3]
            }
        };
        let has_index = self.value(element, "eta")?.is_some() || self.value(element, "k")?.is_some();
        let named = text(element, "material")?;
        let is_mirror = !has_index && named.is_none_or(|name| name == "none");
        if is_mirror && grey(tint) == Some(1.0) {
            // Fresnel's formula gives at least 1 − 4·10⁻⁷.
            return Ok(self.scenery.index_file(|_| 1e-3, |_| 100.0));
        }
        if is_mirror {
            self.scenery.report.note("a coloured mirror becomes a metal that reflects this colour at normal incidence");
            return Ok(self.metal_of_rgb(tint));
        }
        if grey(tint) != Some(1.0) {
            self.scenery.report.note("\"specular_reflectance\" of a metal is set to 1");
        }
        if has_index {
            let (n, _) = self.coefficient(element, "eta", 0.0)?;
            let (k, _) = self.coefficient(element, "k", 1.0)?;
            let at = |s: &Spectrum, nm: f32| f64::from(s.at(nm));
            return Ok(self.scenery.index_file(|nm| at(&n, nm), |nm| at(&k, nm)));
        }
        let name = named.unwrap_or_default();
        if metal::names().contains(&name) {
            return Ok(Metal::Named(name.into()));
        }
        self.scenery.report.note(format!("the metal \"{name}\" is unknown: aluminium is used instead"));
        Ok(Metal::Named("Al".into()))
    }
}

/// Refractive index with the reflectance at normal incidence of this "specular": 0.5 gives 1.5.
fn index_of(specular: f64) -> f64 {
    let root = (0.08 * specular.clamp(0.0, 1.0)).sqrt();
    (1.0 + root) / (1.0 - root)
}

impl<'a> Importer<'a> {
    /// Converted like glTF's surfaces: dielectrics are coated, a metal has the index that reflects its colour, values between give a mix; surfaces that
    /// transmit most light are glass.
    fn principled(&mut self, element: &'a MitsubaElement) -> Result<Surface, Error> {
        self.scenery
            .report
            .note("a \"principled\" surface is approximated by its base colour, roughness, metallic, specular and eta");
        let roughness = self.factor(element, "roughness", 0.5)?;
        let alpha = match roughness {
            Factor::Number(r) => Factor::Number((r.value * r.value).into()),
            Factor::Texture(texture) => {
                self.scenery.report.note("an image of \"roughness\" is used as α directly, not as √α");
                Factor::Texture(FactorTexture { ..texture })
            }
        };
        let metallic = self.factor(element, "metallic", 0.0)?;
        let stated = match self.value(element, "eta")? {
            Some(MitsubaValue::Number(eta)) => eta,
            _ => match self.value(element, "specular")? {
                Some(MitsubaValue::Number(specular)) => index_of(specular),
                _ => 1.5,
            },
        };
        if let Factor::Number(through) = self.factor(element, "spec_trans", 0.0)?
            && through.value > 0.5
        {
            return Ok(Surface::Dielectric(Dielectric {
                alpha: Some(alpha),
                ..Dielectric::new(stated.clamp(1.0, 4.0))
            }));
        }
        let base = self.reflectance(element, "base_color", 0.5, &|v| v)?;
        let index = self.coat_index(stated);
        let coated = || {
            Surface::CoatedDiffuse(CoatedDiffuse {
                index: Some(index.into()),
                ..CoatedDiffuse::new(base.clone(), alpha.clone())
            })
        };
        if matches!(&metallic, Factor::Number(m) if m.value == 0.0) {
            return Ok(coated());
        }
        let colour = match &base {
            Reflectance::Plain(Colour::Grey(v)) => [v.value; 3],
            Reflectance::Plain(Colour::LinearSrgb(v)) => v.value,
            _ => {
                self.scenery.report.note("the colour of a metal from an image or a table is set to 0.5");
                [0.5; 3]
            }
        };
        let metal = self.metal_of_rgb(colour);
        let metal = Surface::Conductor(Conductor::new(metal, alpha.clone()));
        if matches!(&metallic, Factor::Number(m) if m.value == 1.0) {
            return Ok(metal);
        }
        let [a, b] = [("plain", coated()), ("metal", metal)].map(|(word, surface)| {
            let preferred = format!("{}-{word}", element.attribute("id").unwrap_or("principled"));
            let own = self.scenery.names.take(&preferred, "part");
            self.scenery.scene.materials.push(Material::new(own.as_str(), surface));
            own
        });
        Ok(Surface::Mix(Mix::new(a.as_str(), b.as_str(), metallic)))
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn specular_of_a_half_is_glass() {
        assert!((super::index_of(0.5) - 1.5).abs() < 1e-12);
    }
}
