//! Disney's principled surface, approximately.

use super::importer::Importer;
use super::value::Value;
use crate::syntax::mitsuba::MitsubaElement;
use etendue_io::Error;
use etendue_scene::record::material::factor::FactorTexture;
use etendue_scene::record::material::{Coated, Conductor, Dielectric, Factor, Material, Mix, Surface};
use etendue_scene::record::{Colour, Reflectance};

/// The index that reflects as a "specular" of this at normal incidence: 0.5 is 1.5.
fn index_of(specular: f64) -> f64 {
    let root = (0.08 * specular.clamp(0.0, 1.0)).sqrt();
    (1.0 + root) / (1.0 - root)
}

impl<'a> Importer<'a> {
    /// As glTF's surfaces: no metal is coated, a metal has the index that reflects its colour, between is a mix; what lets most light through is glass.
    pub(super) fn principled(&mut self, element: &'a MitsubaElement) -> Result<Surface, Error> {
        self.scenery.report.note(
            "a \"principled\" surface is approximate: base colour, roughness, metallic, specular and eta are used",
        );
        let roughness = self.factor(element, "roughness", 0.5)?;
        let alpha = match roughness {
            Factor::Number(r) => Factor::Number((r.value * r.value).into()),
            Factor::Texture(texture) => {
                self.scenery.report.note("a picture of \"roughness\" is taken as α itself, not as its root");
                Factor::Texture(FactorTexture { ..texture })
            }
        };
        let metallic = self.factor(element, "metallic", 0.0)?;
        let stated = match self.value(element, "eta")? {
            Some(Value::Number(eta)) => eta,
            _ => match self.value(element, "specular")? {
                Some(Value::Number(specular)) => index_of(specular),
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
        let coated =
            || Surface::Coated(Coated { index: Some(index.into()), ..Coated::new(base.clone(), alpha.clone()) });
        if matches!(&metallic, Factor::Number(m) if m.value == 0.0) {
            return Ok(coated());
        }
        let colour = match &base {
            Reflectance::Plain(Colour::Grey(v)) => [v.value; 3],
            Reflectance::Plain(Colour::LinearSrgb(v)) => v.value,
            _ => {
                self.scenery.report.note("a picture or table of a metal's colour is 0.5");
                [0.5; 3]
            }
        };
        let metal = self.metal_of_rgb(colour);
        let metal = Surface::Conductor(Conductor::new(metal, alpha.clone()));
        if matches!(&metallic, Factor::Number(m) if m.value == 1.0) {
            return Ok(metal);
        }
        let [a, b] = [("plain", coated()), ("metal", metal)].map(|(word, surface)| {
            let wish = format!("{}-{word}", element.attribute("id").unwrap_or("principled"));
            let own = self.scenery.names.take(&wish, "part");
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
