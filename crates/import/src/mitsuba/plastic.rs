//! Coats, and refractive indices.

use etendue_io::Error;
use etendue_scene::asset::COAT_INDICES;
use etendue_scene::record::material::{CoatedDiffuse, Factor};

use super::access::{find, flag, number_of};
use super::importer::Importer;
use super::value::{inner_reflectance, linear_base};
use crate::syntax::mitsuba::MitsubaElement;

/// Refractive indices of the substances that Mitsuba knows by name.
const SUBSTANCES: &[(&str, f64)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

impl<'a> Importer<'a> {
    fn ior(element: &'a MitsubaElement, name: &str, default: &str) -> Result<f64, Error> {
        let parameter = find(element, name);
        let word = parameter.and_then(|p| p.attribute("value")).unwrap_or(default);
        let known =
            SUBSTANCES.iter().find(|(substance, _)| substance.eq_ignore_ascii_case(word)).map(|(_, index)| *index);
        match known.map_or_else(|| number_of(word), Ok) {
            Ok(index) if index > 0.0 => Ok(index),
            _ => Err(element
                .error(format!("\"{name}\" is \"{word}\"; expected a refractive index or a material such as bk7"))),
        }
    }

    /// Interior refractive index relative to the exterior.
    fn ratio(element: &'a MitsubaElement, inside: &str) -> Result<f64, Error> {
        Ok(Self::ior(element, "int_ior", inside)? / Self::ior(element, "ext_ior", "air")?)
    }

    pub(super) fn index(&mut self, element: &'a MitsubaElement, inside: &str) -> Result<f64, Error> {
        let ratio = Self::ratio(element, inside)?;
        let legal = ratio.clamp(1.0, 4.0);
        if legal != ratio {
            self.scenery.report.note(format!("the relative refractive index {ratio} is limited to {legal}"));
        }
        Ok(legal)
    }

    pub(super) fn coat_index(&mut self, stated: f64) -> f64 {
        let index = stated.clamp(*COAT_INDICES.start(), *COAT_INDICES.end());
        if index != stated {
            self.scenery.report.note(format!("the refractive index {stated} of a coat is limited to {index}"));
        }
        index
    }

    pub(super) fn plastic(&mut self, element: &'a MitsubaElement) -> Result<CoatedDiffuse, Error> {
        let stated = Self::ratio(element, "polypropylene")?;
        let index = self.coat_index(stated);
        let is_rough = element.kind() == "roughplastic";
        let alpha = if is_rough { self.alpha(element)? } else { Factor::Number(0.0.into()) };
        if is_rough {
            self.note_slopes(element)?;
            self.scenery.report.note(
                "the base of a \"roughplastic\" is brighter than in Mitsuba, whose rough interfaces lose energy: by a tenth at α = 0.2",
            );
        }
        let gloss = self.reflectance(element, "specular_reflectance", 1.0, &|v| v)?;
        if !matches!(&gloss, etendue_scene::record::Reflectance::Plain(etendue_scene::record::Colour::Grey(v)) if v.value == 1.0)
        {
            self.scenery.report.note("\"specular_reflectance\" of a plastic is set to 1");
        }
        let inner = inner_reflectance(index);
        let base = match flag(element, "nonlinear", false)? {
            true => self.reflectance(element, "diffuse_reflectance", 0.5, &|a| a)?,
            false => self.reflectance(element, "diffuse_reflectance", 0.5, &|a| linear_base(a, inner))?,
        };
        Ok(CoatedDiffuse { index: Some(index.into()), ..CoatedDiffuse::new(base, alpha) })
    }
}
