//! Materials.

use std::rc::Rc;

use etendue_scene::record::material::{
    CoatedDiffuse, Conductor, Dielectric, Diffuse, Factor, Leaf, Material, Metal, Mix, Surface, ThinSheet,
};
use etendue_scene::{asset::COAT_INDICES, record::Colour};
use etendue_spectra::{Extrapolation, Spectrum, metal};

use super::{colour::table, parameters::Parameters};
use crate::scenery::{INTERFACE, KnownTexture, SceneBuilder, plain};
use crate::syntax::pbrt::PbrtValues;

/// pbrt's α for a roughness.
fn remapped(roughness: f64) -> f64 {
    roughness.max(0.0).sqrt()
}

fn unmapped(roughness: f64) -> f64 {
    roughness
}

impl SceneBuilder {
    /// Creates one of our materials; returns its name. `named` is its name in the file.
    pub(super) fn material(
        &mut self,
        kind: &str,
        parameters: Parameters<'_>,
        named: Option<&str>,
    ) -> Result<Rc<str>, String> {
        let image_count = self.known.placed_images;
        let result: Rc<str> = match self.surface_of(kind, parameters)? {
            None => INTERFACE.into(),
            Some(surface) => {
                let own: Rc<str> = self.names.take(named.unwrap_or(kind), "material").into();
                for unread in ["displacement", "normalmap"] {
                    if parameters.find(unread).is_some() {
                        self.report.note(format!("\"{unread}\" of a material is not used"));
                    }
                }
                self.scene.materials.push(Material::new(&*own, surface));
                own
            }
        };
        if self.known.placed_images > image_count {
            self.known.with_images.insert(result.clone());
        }
        if let Some(name) = named {
            self.known.materials.insert(name.to_owned(), result.clone());
        }
        Ok(result)
    }

    /// Our material for a name of the file; grey if it is undefined.
    pub(super) fn named_material(&mut self, name: &str) -> Rc<str> {
        match self.known.materials.get(name) {
            Some(own) => {
                let own = own.clone();
                self.known.placed_images += usize::from(self.known.with_images.contains(&own));
                own
            }
            None => {
                self.report.note(format!(
                    "the material \"{name}\" is not defined before its use: a diffuse grey of 0.5 is used instead"
                ));
                "".into()
            }
        }
    }

    fn surface_of(&mut self, kind: &str, parameters: Parameters<'_>) -> Result<Option<Surface>, String> {
        Ok(Some(match kind {
            "diffuse" => Surface::Diffuse(Diffuse::new(self.reflectance(parameters, "reflectance", 0.5)?)),
            "coateddiffuse" => Surface::CoatedDiffuse(self.coated(parameters)?),
            "conductor" => Surface::Conductor(self.conductor(parameters, "")?),
            "coatedconductor" => {
                self.report.note("the coat of a \"coatedconductor\" is not used: only its metal is");
                Surface::Conductor(self.conductor(parameters, "conductor.")?)
            }
            "dielectric" => {
                let alpha = self.alpha(parameters, "")?;
                let index = self.index(parameters)?;
                let alpha = Some(alpha).filter(|a| !matches!(a, Factor::Number(n) if n.value == 0.0));
                Surface::Dielectric(Dielectric { alpha, ..Dielectric::new(index) })
            }
            "thindielectric" => {
                let index = self.index(parameters)?;
                Surface::ThinSheet(ThinSheet { index: Some(index.into()), ..ThinSheet::default() })
            }
            "diffusetransmission" => {
                if parameters.number("scale", 1.0)? != 1.0 {
                    self.report.note("\"scale\" of a \"diffusetransmission\" is set to 1");
                }
                let reflectance = self.reflectance(parameters, "reflectance", 0.25)?;
                Surface::Leaf(Leaf::new(reflectance, self.reflectance(parameters, "transmittance", 0.25)?))
            }
            "mix" => self.mix(parameters)?,
            "interface" | "none" | "" => return Ok(None),
            other => {
                self.report
                    .note(format!("the material \"{other}\" is not supported: a diffuse grey of 0.5 is used instead"));
                parameters.0.iter().for_each(|p| p.used.set(true));
                Surface::Diffuse(Diffuse::new(plain(0.5)))
            }
        }))
    }

    /// α of an isotropic surface.
    fn alpha(&mut self, parameters: Parameters<'_>, prefix: &str) -> Result<Factor, String> {
        let map = if parameters.flag("remaproughness", true)? { remapped } else { unmapped };
        let [u, v] = ["uroughness", "vroughness"].map(|name| format!("{prefix}{name}"));
        let both = format!("{prefix}roughness");
        match (parameters.find(&u).is_some(), parameters.find(&v).is_some()) {
            (false, false) => self.factor(parameters, &both, 0.0, map),
            _ => {
                let [a, b] = [self.factor(parameters, &u, 0.0, map)?, self.factor(parameters, &v, 0.0, map)?];
                if let (Factor::Number(a), Factor::Number(b)) = (&a, &b)
                    && a.value != b.value
                {
                    self.report.note("anisotropic roughness becomes isotropic: α is the geometric mean");
                    return Ok(Factor::Number((a.value * b.value).sqrt().into()));
                }
                Ok(a)
            }
        }
    }

    fn index(&mut self, parameters: Parameters<'_>) -> Result<f64, String> {
        let Some(eta) = parameters.find("eta") else { return Ok(1.5) };
        let index = match &eta.values {
            PbrtValues::Numbers(numbers) if numbers.len() == 1 => numbers[0],
            PbrtValues::Numbers(numbers) => {
                self.report.note(
                    "a spectral refractive index is replaced by its value at 587.6 nm: dielectrics are not dispersive",
                );
                f64::from(table("eta", numbers, Extrapolation::Hold)?.at(587.56))
            }
            PbrtValues::Texts(texts) => {
                let name = texts.first().map_or("", String::as_str);
                let known = [
                    ("glass-BK7", 1.5168),
                    ("glass-BAF10", 1.67003),
                    ("glass-FK51A", 1.48656),
                    ("glass-LASF9", 1.85025),
                    ("glass-F5", 1.60342),
                    ("glass-SF5", 1.67271),
                    ("glass-SF10", 1.72828),
                    ("glass-SF11", 1.78472),
                ];
                let matching = known.iter().find(|(glass, _)| *glass == name);
                match matching {
                    Some(_) => self.report.note(
                        "a glass is replaced by its refractive index at 587.6 nm: dielectrics are not dispersive",
                    ),
                    None => {
                        self.report.note(format!(
                            "the glass \"{name}\" is unknown: a refractive index of 1.5 is used instead"
                        ));
                    }
                }
                matching.map_or(1.5, |(_, index)| *index)
            }
            PbrtValues::Flags(_) => return Err("\"eta\": expected a number".to_owned()),
        };
        let legal = index.clamp(1.0, 4.0);
        if legal != index {
            self.report.note(format!("the refractive index {index} is limited to {legal}"));
        }
        Ok(legal)
    }

    fn coated(&mut self, parameters: Parameters<'_>) -> Result<CoatedDiffuse, String> {
        if parameters.numbers("albedo")?.is_some_and(|a| a.iter().any(|v| *v != 0.0)) {
            self.report.note("scattering in a coat (\"albedo\") is not used");
        }
        // Scattering within the coat matters only with an albedo, and the number of bounces is our own.
        ["g", "maxdepth", "nsamples"].iter().for_each(|name| {
            parameters.find(name);
        });
        if parameters.find("thickness").is_some() {
            self.report.note("the \"thickness\" of a coat is not used: light leaves it at the point of entry");
        }
        let reflectance = self.reflectance(parameters, "reflectance", 0.5)?;
        let stated = self.index(parameters)?;
        let index = stated.clamp(*COAT_INDICES.start(), *COAT_INDICES.end());
        if index != stated {
            self.report.note(format!("the refractive index {stated} of a coat is limited to {index}"));
        }
        let alpha = self.alpha(parameters, "")?;
        Ok(CoatedDiffuse { index: Some(index.into()), ..CoatedDiffuse::new(reflectance, alpha) })
    }

    fn conductor(&mut self, parameters: Parameters<'_>, prefix: &str) -> Result<Conductor, String> {
        let alpha = self.alpha(parameters, prefix)?;
        let metal = match parameters.find("reflectance") {
            Some(_) => self.metal_from_reflectance(parameters)?,
            None => self.metal_from_index(parameters, prefix)?,
        };
        Ok(Conductor::new(metal, alpha))
    }

    fn metal_from_reflectance(&mut self, parameters: Parameters<'_>) -> Result<Metal, String> {
        let parameter = parameters.find("reflectance").ok_or("\"reflectance\" is missing")?;
        let rgb = match self.texture_of(parameter, true)? {
            Some(KnownTexture::Even(rgb)) => rgb,
            Some(KnownTexture::Picture { .. }) => {
                self.report.note("the reflectance of a metal from an image is set to 0.5");
                [0.5; 3]
            }
            None => match self.reflectance_colour(parameter)? {
                Colour::Grey(v) => [v.value; 3],
                Colour::LinearSrgb(rgb) => rgb.value,
                _ => {
                    self.report.note("the reflectance of a metal from a table is set to 0.5");
                    [0.5; 3]
                }
            },
        };
        Ok(self.metal_from_rgb(rgb))
    }

    fn metal_from_index(&mut self, parameters: Parameters<'_>, prefix: &str) -> Result<Metal, String> {
        let [eta, k] = ["eta", "k"].map(|name| parameters.find(&format!("{prefix}{name}")));
        match (eta.map(|p| &p.values), k.map(|p| &p.values)) {
            (None, None) => Ok(Metal::Named("Cu".into())),
            (Some(PbrtValues::Texts(texts)), _) => {
                let name = texts.first().map_or("", String::as_str);
                let symbol = name.strip_prefix("metal-").and_then(|rest| rest.strip_suffix("-eta")).unwrap_or(name);
                if metal::names().contains(&symbol) {
                    return Ok(Metal::Named(symbol.into()));
                }
                self.report.note(format!("the metal \"{name}\" is unknown: aluminium is used instead"));
                Ok(Metal::Named("Al".into()))
            }
            (Some(PbrtValues::Numbers(n)), Some(PbrtValues::Numbers(k))) => {
                // A single number is constant over wavelength.
                let index_value = |name: &str, numbers: &[f64]| match numbers {
                    [even] => Ok(Spectrum::from_fn(|_| *even)),
                    // An exterior index of 0, as in pbrt, is not physical.
                    pairs => table(name, pairs, Extrapolation::Hold),
                };
                let [n, k] = [index_value("eta", n)?, index_value("k", k)?];
                Ok(self.index_file(|nm| f64::from(n.at(nm)), |nm| f64::from(k.at(nm))))
            }
            _ => Err("\"eta\" and \"k\": expected the name of a metal, or a table of both".to_owned()),
        }
    }

    fn mix(&mut self, parameters: Parameters<'_>) -> Result<Surface, String> {
        let names = parameters.texts("materials")?.ok_or("the mix has no \"materials\"")?;
        let [a, b] = names else {
            return Err(format!("the number of materials in a mix is {}; expected two", names.len()));
        };
        let [a, b] = [a, b].map(|name| {
            let own = self.named_material(name);
            self.known_material(if &*own == INTERFACE { "" } else { &own })
        });
        let weight = self.factor(parameters, "amount", 0.5, unmapped)?;
        Ok(Surface::Mix(Mix::new(a.as_str(), b.as_str(), weight)))
    }
}
