//! Conversion of UsdPreviewSurface.

use std::ops::RangeInclusive;

use etendue_scene::record::material::{
    Channel, CoatedDiffuse, Conductor, Diffuse, Factor, Green, Material, Mix, NormalMap, Sides, Surface, ThinSheet,
};
use etendue_scene::record::{Emission, Level, LightColour, Reflectance, SurfaceEmission};
use etendue_scene::{asset::COAT_INDICES, record::material::factor::FactorTexture};
use etendue_spectra::colour::BT709;

use super::texture::{ColourRule, ImageInput};
use super::{binding::BoundMaterial, importer::Importer, network::NodeInput};
use crate::scenery::{KnownTexture, grey};
use crate::syntax::usd::{UsdPrim, UsdValue};

/// Refractive index of a given reflectance at normal incidence.
fn index_of(reflectance: f64) -> f64 {
    let root = reflectance.clamp(0.0, 0.36).sqrt();
    (1.0 + root) / (1.0 - root)
}

impl<'a> Importer<'a> {
    /// Material at a path.
    pub(super) fn material(&mut self, path: &str) -> Result<BoundMaterial, String> {
        if let Some(known) = self.materials.get(path) {
            return Ok(known.clone());
        }
        let bound = self.paths.prim(path).map(|prim| self.material_of(prim)).transpose()?.unwrap_or_default();
        self.materials.insert(path.to_owned(), bound.clone());
        Ok(bound)
    }

    fn material_of(&mut self, prim: &'a UsdPrim) -> Result<BoundMaterial, String> {
        self.black_outside.clear();
        let named = prim.attributes.keys().filter(|name| name.starts_with("outputs:") && name.ends_with("surface"));
        // The output for all renderers comes first.
        let outputs = std::iter::once("outputs:surface").chain(named.map(String::as_str));
        let surface_shader = outputs.filter_map(|name| self.input(prim, name)).find_map(|input| match input {
            NodeInput::Shader(shader, _) => Some(shader),
            NodeInput::Value(_) => None,
        });
        let id = surface_shader.and_then(|shader| self.plain_text(shader, "info:id")).unwrap_or_default();
        let (Some(shader), "UsdPreviewSurface") = (surface_shader, id) else {
            self.scenery.report.at(prim.path.clone());
            let message = match id {
                "" => "a material without a surface becomes a diffuse grey of 0.5".to_owned(),
                id => format!("the surface \"{id}\" is not supported: a diffuse grey of 0.5 is used instead"),
            };
            self.scenery.report.note(message);
            return Ok(BoundMaterial::default());
        };
        self.scenery.report.at(shader.path.clone());
        let primvar = self.primvar_of(shader);
        let name = self.scenery.names.take(prim.name(), "material");
        let surface = self.surface(shader, &name)?;
        let normal_map = self.normal_map(shader)?;
        if normal_map.is_some() && matches!(surface, Surface::Mix(_)) {
            self.scenery.report.note("the normal map of a surface between dielectric and metal is not used");
        }
        let material = Material {
            emission: self.emission(shader)?,
            opacity: self.opacity(shader, &surface)?,
            normal_map: normal_map.filter(|_| !matches!(surface, Surface::Mix(_))),
            ..Material::new(name.as_str(), surface)
        };
        self.shines |= material.emission.is_some();
        self.scenery.scene.materials.push(material);
        self.note_left_out(shader);
        Ok(BoundMaterial::new(&name, primvar, std::mem::take(&mut self.black_outside)))
    }

    fn note_left_out(&mut self, shader: &'a UsdPrim) {
        let stands = |importer: &Self, name: &str, usual: f64| match importer.input(shader, name) {
            None => false,
            Some(NodeInput::Value(UsdValue::Number(v))) => *v != usual,
            Some(_) => true,
        };
        if stands(self, "inputs:clearcoat", 0.0) {
            self.scenery.report.note("clearcoat is not used");
        }
        let _ = stands(self, "inputs:clearcoatRoughness", 0.01);
        for (name, usual) in [("displacement", 0.0), ("occlusion", 1.0)] {
            if stands(self, &format!("inputs:{name}"), usual) {
                self.scenery.report.note(format!("UsdPreviewSurface: \"{name}\" is not used"));
            }
        }
        self.note_unused(shader);
    }

    /// As for glTF: dielectrics are coated, a metal has the index that reflects its colour, values between give a mix.
    fn surface(&mut self, shader: &'a UsdPrim, name: &str) -> Result<Surface, String> {
        let alpha = self.factor(shader, "inputs:roughness", 0.5, &|v| v * v)?;
        let metallic = self.factor(shader, "inputs:metallic", 0.0, &|v| v)?;
        let base = self.reflectance(shader, "inputs:diffuseColor", [0.18; 3])?;
        let stated = self.plain_number(shader, "inputs:ior").unwrap_or(1.5);
        if self.is_clear(shader) {
            self.scenery.report.note(
                "a surface with an opacity of at most 0.5 becomes a thin sheet, which transmits light without refraction; for a refracting solid set type \
                    = \"dielectric\"",
            );
            let index = self.index_within("ior", stated, 1.0..=4.0);
            return Ok(Surface::ThinSheet(ThinSheet { index: Some(index.into()), ..ThinSheet::default() }));
        }
        if self.plain_number(shader, "inputs:useSpecularWorkflow").unwrap_or(0.0) != 0.0 {
            return self.specular(shader, base, alpha);
        }
        let coated = self.coated(base, "ior", stated, &alpha);
        if matches!(&metallic, Factor::Number(m) if m.value == 0.0) {
            return Ok(coated);
        }
        let colour = self.mean_colour(shader, "inputs:diffuseColor", [0.18; 3])?;
        let metal = Surface::Conductor(Conductor::new(self.scenery.metal_from_rgb(colour), alpha));
        if matches!(&metallic, Factor::Number(m) if m.value == 1.0) {
            return Ok(metal);
        }
        let [a, b] = [("plain", coated), ("metal", metal)].map(|(word, surface)| {
            let own = self.scenery.names.take(&format!("{name}-{word}"), "part");
            self.scenery.scene.materials.push(Material::new(own.as_str(), surface));
            own
        });
        Ok(Surface::Mix(Mix::new(a.as_str(), b.as_str(), metallic)))
    }

    /// Surface with a stated reflectance at normal incidence.
    fn specular(&mut self, shader: &'a UsdPrim, base: Reflectance, alpha: Factor) -> Result<Surface, String> {
        let colour = self.mean_colour(shader, "inputs:specularColor", [0.0; 3])?;
        let mean_reflectance: f64 = colour.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
        if mean_reflectance > 0.25 {
            self.scenery.report.note("a surface with a specular reflectance above 0.25 becomes a metal of this colour");
            return Ok(Surface::Conductor(Conductor::new(self.scenery.metal_from_rgb(colour), alpha)));
        }
        if grey(colour).is_none() {
            self.scenery.report.note("the specular colour (specularColor) becomes white of the same luminance");
        }
        Ok(self.coated(base, "specularColor", index_of(mean_reflectance), &alpha))
    }

    /// Base under a coat. An index within its range is used as stated; an index of 1 reflects nothing and leaves the base alone.
    fn coated(&mut self, base: Reflectance, name: &str, index: f64, alpha: &Factor) -> Surface {
        if index == 1.0 {
            return Surface::Diffuse(Diffuse::new(base));
        }
        let index = self.index_within(name, index, COAT_INDICES);
        Surface::CoatedDiffuse(CoatedDiffuse { index: Some(index.into()), ..CoatedDiffuse::new(base, alpha.clone()) })
    }

    /// Nearest index within a range.
    fn index_within(&mut self, name: &str, stated: f64, range: RangeInclusive<f64>) -> f64 {
        let legal = stated.clamp(*range.start(), *range.end());
        if legal != stated {
            let [low, high] = [range.start(), range.end()];
            self.scenery.report.note(format!(
                "the refractive index {stated} of \"{name}\" is limited to {legal}: expected {low} … {high}"
            ));
        }
        legal
    }

    /// Returns true if opacity means presence of the surface, not transmission.
    fn is_presence(&self, shader: &'a UsdPrim) -> bool {
        self.plain_text(shader, "inputs:opacityMode") == Some("presence")
    }

    /// Returns true if most light is transmitted.
    fn is_clear(&self, shader: &'a UsdPrim) -> bool {
        if self.is_presence(shader) {
            return false;
        }
        let opacity = self.plain_number(shader, "inputs:opacity");
        let threshold = self.plain_number(shader, "inputs:opacityThreshold").unwrap_or(0.0);
        opacity.is_some_and(|opacity| opacity <= 0.5) && threshold <= 0.0
    }

    fn opacity(&mut self, shader: &'a UsdPrim, surface: &Surface) -> Result<Option<Factor>, String> {
        if matches!(surface, Surface::ThinSheet(_)) {
            return Ok(None);
        }
        let threshold = self.plain_number(shader, "inputs:opacityThreshold").unwrap_or(0.0);
        let opacity = match threshold > 0.0 {
            true => self.factor(shader, "inputs:opacity", 1.0, &move |v| f64::from(v >= threshold))?,
            false => self.factor(shader, "inputs:opacity", 1.0, &|v| v)?,
        };
        let is_whole = matches!(&opacity, Factor::Number(v) if v.value == 1.0);
        if !is_whole && threshold <= 0.0 && !self.is_presence(shader) {
            self.scenery
                .report
                .note("opacity is the fraction of the surface that is present, including its specular reflection");
        }
        Ok(Some(opacity).filter(|_| !is_whole))
    }

    fn emission(&mut self, shader: &'a UsdPrim) -> Result<Option<SurfaceEmission>, String> {
        let name = "inputs:emissiveColor";
        let image = match self.input(shader, name) {
            Some(NodeInput::Shader(node, output)) => self.image_input(node, &output, name)?,
            _ => ImageInput::Even(self.plain_tuple(shader, name).unwrap_or([0.0; 3])),
        };
        let (rgb, texture) = match image {
            ImageInput::Even(rgb) => (rgb.map(|v| v.max(0.0)), None),
            ImageInput::Node(node) => match self.colours(&node, ColourRule::Light)? {
                KnownTexture::Even(rgb) => (rgb, None),
                KnownTexture::Picture { name, scale, .. } => ([scale; 3], Some(name)),
            },
        };
        let luminance: f64 = rgb.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
        if luminance <= 0.0 {
            return Ok(None);
        }
        self.scenery.report.at(shader.path.clone());
        self.scenery.report.note(format!("a surface emits on both sides, {luminance} cd/m²"));
        let colour = match grey(rgb) {
            Some(_) => LightColour::Illuminant("D65".into()),
            None => LightColour::Rgb(rgb.into()),
        };
        let light = Emission { colour: Some(colour), ..Emission::new(Level::Luminance(luminance.into())) };
        let texture = texture.map(|name| name.as_str().into());
        Ok(Some(SurfaceEmission { sides: Some(Sides::Both.into()), texture, ..SurfaceEmission::new(light) }))
    }

    fn normal_map(&mut self, shader: &'a UsdPrim) -> Result<Option<NormalMap>, String> {
        let Some(NodeInput::Shader(node, output)) = self.input(shader, "inputs:normal") else { return Ok(None) };
        let ImageInput::Node(node) = self.image_input(node, &output, "inputs:normal")? else { return Ok(None) };
        let is_down = node.scale[1] < 0.0;
        let expected = |i: usize| (node.scale[i].abs() - 2.0).abs() < 1e-6 && (node.bias[i].abs() - 1.0).abs() < 1e-6;
        if !(0..3).all(expected) {
            self.scenery.report.note("a normal map is read as 2 v − 1; its scale and bias are not used");
        }
        let y = is_down.then(|| Green::Down.into());
        let name = self.data_image(&node)?;
        Ok(name.map(|name| NormalMap { y, ..NormalMap::new(name.as_str()) }))
    }

    /// Reflectance over wavelength.
    fn reflectance(&mut self, shader: &'a UsdPrim, name: &str, usual: [f64; 3]) -> Result<Reflectance, String> {
        let image = match self.input(shader, name) {
            Some(NodeInput::Shader(node, output)) => self.image_input(node, &output, name)?,
            _ => ImageInput::Even(self.plain_tuple(shader, name).unwrap_or(usual)),
        };
        let known = match image {
            ImageInput::Even(rgb) => KnownTexture::Even(rgb),
            ImageInput::Node(node) => self.colours(&node, ColourRule::Share)?,
        };
        Ok(match known {
            KnownTexture::Even(rgb) => Reflectance::Plain(self.scenery.reflectance_from_rgb(name, rgb)),
            KnownTexture::Picture { name, scale, .. } => {
                Reflectance::Texture { name: name.as_str().into(), scale: (scale != 1.0).then(|| scale.into()) }
            }
        })
    }

    /// Mean of a colour where only one value is supported.
    fn mean_colour(&mut self, shader: &'a UsdPrim, name: &str, usual: [f64; 3]) -> Result<[f64; 3], String> {
        let rgb = match self.input(shader, name) {
            Some(NodeInput::Shader(node, output)) => match self.image_input(node, &output, name)? {
                ImageInput::Even(rgb) => rgb,
                ImageInput::Node(node) => {
                    self.scenery.report.note("the colour image of a metal is replaced by its mean");
                    self.mean(&node)?
                }
            },
            _ => self.plain_tuple(shader, name).unwrap_or(usual),
        };
        Ok(rgb.map(|v| self.scenery.limit_to_unit(name, v)))
    }

    /// Number, 0 … 1, after a rule.
    fn factor(
        &mut self,
        shader: &'a UsdPrim,
        name: &str,
        usual: f64,
        rule: &dyn Fn(f64) -> f64,
    ) -> Result<Factor, String> {
        let even = match self.input(shader, name) {
            Some(NodeInput::Shader(node, output)) => match self.image_input(node, &output, name)? {
                ImageInput::Even([v, ..]) => v,
                ImageInput::Node(node) => match self.numbers(&node, rule)? {
                    KnownTexture::Even([v, ..]) => return Ok(Factor::Number(v.into())),
                    KnownTexture::Picture { name, .. } => {
                        let channel = Some(Channel::Red.into());
                        return Ok(Factor::Texture(FactorTexture { channel, ..FactorTexture::new(name.as_str()) }));
                    }
                },
            },
            _ => self.plain_number(shader, name).unwrap_or(usual),
        };
        let limited = self.scenery.limit_to_unit(name, even);
        Ok(Factor::Number(rule(limited).into()))
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn four_percent_are_glass() {
        assert!((super::index_of(0.04) - 1.5).abs() < 1e-12);
    }
}
