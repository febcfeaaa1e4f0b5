//! Default parameters of later directives (`Attribute`).

use std::rc::Rc;

use crate::syntax::pbrt::PbrtParameter;

/// Kinds of directives with default parameters.
const KINDS: [&str; 5] = ["shape", "light", "material", "medium", "texture"];

/// Default parameters of each kind of directive; the newest come first.
#[derive(Clone, Default)]
pub(super) struct Attributes([Rc<Vec<PbrtParameter>>; KINDS.len()]);

impl Attributes {
    /// Adds the parameters of a directive `Attribute`.
    pub(super) fn add(&mut self, kind: &str, parameters: Vec<PbrtParameter>) -> Result<(), String> {
        let Some(index) = KINDS.iter().position(|known| *known == kind) else {
            return Err(format!("`Attribute \"{kind}\"`: expected {}", KINDS.join(", ")));
        };
        // Not every directive of the kind has the parameter, so it counts as used.
        parameters.iter().for_each(|p| p.used.set(true));
        let all = parameters.into_iter().rev().chain(self.0[index].iter().cloned());
        self.0[index] = Rc::new(all.collect());
        Ok(())
    }

    /// Parameters of a directive, or of a texture, followed by the default ones.
    pub(super) fn extend(&self, directive: &str, parameters: Vec<PbrtParameter>) -> Vec<PbrtParameter> {
        let kind = match directive {
            "Shape" => "shape",
            "LightSource" | "AreaLightSource" => "light",
            "Material" | "MakeNamedMaterial" => "material",
            "MakeNamedMedium" => "medium",
            "texture" => "texture",
            _ => return parameters,
        };
        let index = KINDS.iter().position(|known| *known == kind).unwrap_or_default();
        let defaults = self.0[index].iter().filter(|p| parameters.iter().all(|own| own.name != p.name)).cloned();
        let defaults: Vec<PbrtParameter> = defaults.collect();
        parameters.into_iter().chain(defaults).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::syntax::pbrt::PbrtValues;

    fn radius(value: f64) -> PbrtParameter {
        let (kind, name) = ("float".to_owned(), "radius".to_owned());
        PbrtParameter { kind, name, values: PbrtValues::Numbers(vec![value]), used: Cell::new(false) }
    }

    #[test]
    fn own_parameters_come_first_and_newer_defaults_before_older_ones() {
        let mut attributes = Attributes::default();
        attributes.add("shape", vec![radius(1.0)]).expect("a kind");
        attributes.add("shape", vec![radius(2.0)]).expect("a kind");
        let first = |directive, own| {
            let parameters = attributes.extend(directive, own);
            parameters.first().map(|p| p.values.clone())
        };
        assert_eq!(first("Shape", vec![]), Some(PbrtValues::Numbers(vec![2.0])));
        assert_eq!(first("Shape", vec![radius(3.0)]), Some(PbrtValues::Numbers(vec![3.0])));
        assert_eq!(first("Material", vec![]), None);
        assert!(attributes.add("film", vec![]).is_err());
    }
}
