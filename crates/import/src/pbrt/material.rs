//! Materials.

use std::rc::Rc;

use etendue_scene::asset::COAT_INDICES;
use etendue_scene::record::material::{
    CoatedDiffuse, Conductor, Dielectric, Diffuse, Factor, Leaf, Material, Metal, Mix, Surface, ThinSheet,
};
use etendue_spectra::{Extrapolation, Spectrum, metal};

use super::colour::{points, three};
use super::parameters::Parameters;
use super::spectrum::metal_of_names;
use crate::scenery::{INTERFACE, SceneBuilder, TextureBase, TextureUse, plain};
use crate::syntax::pbrt::{PbrtParameter, PbrtValues};

/// Thickness of a coat that states none.
const DEFAULT_COAT_THICKNESS: f64 = 0.01;

impl SceneBuilder {
    /// Creates one of our materials; returns its name. `named` is its name in the file.
    pub(super) fn material(
        &mut self,
        kind: &str,
        parameters: Parameters<'_>,
        named: Option<&str>,
    ) -> Result<Rc<str>, String> {
        let image_count = self.known.placed_images.len();
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
        if let Some(base) = self.common_base(image_count) {
            self.known.texture_bases.insert(result.clone(), base);
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
                let base = self.known.texture_bases.get(&own).cloned();
                self.known.placed_images.extend(base);
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

    /// Source of the texture coordinates of the images placed after the first `count`; `None` without an image. A mesh has only one set of coordinates.
    pub(super) fn common_base(&mut self, count: usize) -> Option<TextureBase> {
        let bases = &self.known.placed_images[count..];
        let first = bases.first()?.clone();
        if bases.iter().any(|base| *base != first) {
            self.report.note("the images of a material have different mappings: that of the first is used for all");
        }
        Some(first)
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
                let scale = parameters.number("scale", 1.0)?;
                let reflectance = self.scaled_reflectance(parameters, "reflectance", 0.25, scale)?;
                Surface::Leaf(Leaf::new(
                    reflectance,
                    self.scaled_reflectance(parameters, "transmittance", 0.25, scale)?,
                ))
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
        // pbrt's roughness is α², unless it is not remapped.
        let is_remapped = parameters.flag("remaproughness", true)?;
        let usage = if is_remapped { TextureUse::SquareRoots } else { TextureUse::Numbers };
        let [u, v] = ["uroughness", "vroughness"].map(|name| format!("{prefix}{name}"));
        let both = format!("{prefix}roughness");
        match (parameters.find(&u).is_some(), parameters.find(&v).is_some()) {
            (false, false) => self.factor(parameters, &both, 0.0, usage),
            _ => {
                let [a, b] = [self.factor(parameters, &u, 0.0, usage)?, self.factor(parameters, &v, 0.0, usage)?];
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
        let spectrum = self.index_spectrum(eta)?;
        if spectrum.constant.is_none() {
            self.report.note(
                "a spectral refractive index is replaced by its value at 587.6 nm: dielectrics are not dispersive",
            );
        }
        let index = spectrum.at_d_line();
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
        let thickness = parameters.number("thickness", DEFAULT_COAT_THICKNESS)?;
        if thickness > 0.0 {
            self.report.note(format!(
                "a coat of \"thickness\" {thickness} absorbs light in pbrt, all but exp(−{thickness}/cos θ) in each crossing, and none here: the surface is brighter"
            ));
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
            Some(_) if ["eta", "k"].iter().any(|name| parameters.find(&format!("{prefix}{name}")).is_some()) => {
                return Err("\"reflectance\" contradicts \"eta\" and \"k\"; remove one of them".to_owned());
            }
            Some(reflectance) => self.metal_from_reflectance(reflectance)?,
            None => self.metal_from_index(parameters, prefix)?,
        };
        Ok(Conductor::new(metal, alpha))
    }

    fn metal_from_reflectance(&mut self, parameter: &PbrtParameter) -> Result<Metal, String> {
        let rgb = match self.texture_of(parameter, true)? {
            Some(tree) => {
                if tree.constant().is_none() {
                    self.report.note("the reflectance of a metal from an image is replaced by its mean");
                }
                Self::texture_mean(&tree)?
            }
            None => match (&*parameter.kind, &parameter.values) {
                ("spectrum", values) => {
                    let pairs = match values {
                        PbrtValues::Numbers(numbers) => points(&parameter.name, numbers)?,
                        PbrtValues::Texts(texts) => self.named_points(&parameter.name, texts)?,
                        PbrtValues::Flags(_) => return Err("\"reflectance\": expected a spectrum".to_owned()),
                    };
                    let spectrum = Spectrum::from_points(&pairs, Extrapolation::Zero);
                    return Ok(self.metal_from_spectrum(&spectrum.map_err(|e| format!("\"reflectance\": {e}"))?));
                }
                ("rgb" | "color", PbrtValues::Numbers(numbers)) => three(&parameter.name, numbers)?,
                (_, PbrtValues::Numbers(numbers)) if numbers.len() == 1 => [numbers[0]; 3],
                (kind, _) => return Err(format!("\"{kind} reflectance\": expected an rgb, a spectrum or a texture")),
            },
        };
        let legal = rgb.map(|v| self.limit_to_unit(&parameter.name, v));
        Ok(self.metal_from_rgb(legal))
    }

    /// Metal of pbrt's `eta` and `k`, each of which is copper's by default.
    fn metal_from_index(&mut self, parameters: Parameters<'_>, prefix: &str) -> Result<Metal, String> {
        let [eta, k] = ["eta", "k"].map(|name| parameters.find(&format!("{prefix}{name}")));
        if eta.is_none() && k.is_none() {
            return Ok(Metal::Named("Cu".into()));
        }
        if let (Some(PbrtValues::Texts(eta)), Some(PbrtValues::Texts(k))) =
            (eta.map(|p| &p.values), k.map(|p| &p.values))
            && let (Some(eta), Some(k)) = (eta.first(), k.first())
            && let Some(symbol) = metal_of_names(eta, k)
        {
            return Ok(Metal::Named(symbol.into()));
        }
        let copper = metal::by_name("Cu").ok_or("copper has no table")?;
        let n = eta.map(|eta| self.index_spectrum(eta)).transpose()?.map_or(copper.n.clone(), |n| n.spectrum);
        let k = k.map(|k| self.index_spectrum(k)).transpose()?.map_or(copper.k.clone(), |k| k.spectrum);
        Ok(self.index_file(|nm| f64::from(n.at(nm)), |nm| f64::from(k.at(nm))))
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
        let weight = self.factor(parameters, "amount", 0.5, TextureUse::Numbers)?;
        Ok(Surface::Mix(Mix::new(a.as_str(), b.as_str(), weight)))
    }
}
