//! Inputs of shaders and their connections.

use super::importer::Importer;
use crate::syntax::usd::{UsdPrim, UsdValue};

/// Maximum length of a chain of connections.
const MAX_STEPS: usize = 32;

/// Source of an input.
pub(super) enum NodeInput<'a> {
    Value(&'a UsdValue),
    /// The output of a shader, `r` or `rgb`.
    Shader(&'a UsdPrim, String),
}

impl<'a> Importer<'a> {
    /// Source of an input, through the interfaces of materials and node graphs; `None` without one.
    pub(super) fn input(&self, prim: &'a UsdPrim, name: &str) -> Option<NodeInput<'a>> {
        let (mut prim, mut name) = (prim, name.to_owned());
        for _ in 0..MAX_STEPS {
            let attribute = prim.attributes.get(&name);
            let attribute = attribute.inspect(|attribute| attribute.used.set(true))?;
            let next = attribute.connections.first().and_then(|path| self.paths.property(path));
            let Some((source, property)) = next else { return attribute.value.as_ref().map(NodeInput::Value) };
            if source.kind == "Shader" {
                let output = property.strip_prefix("outputs:")?;
                return Some(NodeInput::Shader(source, output.to_owned()));
            }
            (prim, name) = (source, property.to_owned());
        }
        None
    }

    /// Number of an input that is not connected to a shader.
    pub(super) fn plain_number(&self, prim: &'a UsdPrim, name: &str) -> Option<f64> {
        match self.input(prim, name)? {
            NodeInput::Value(UsdValue::Number(v)) if v.is_finite() => Some(*v),
            _ => None,
        }
    }

    /// Tuple of such an input.
    pub(super) fn plain_tuple<const N: usize>(&self, prim: &'a UsdPrim, name: &str) -> Option<[f64; N]> {
        match self.input(prim, name)? {
            NodeInput::Value(UsdValue::Tuple(list)) if list.iter().all(|v| v.is_finite()) => {
                list.as_slice().try_into().ok()
            }
            _ => None,
        }
    }

    /// Text of an input that is not connected to a shader.
    pub(super) fn plain_text(&self, prim: &'a UsdPrim, name: &str) -> Option<&'a str> {
        match self.input(prim, name)? {
            NodeInput::Value(UsdValue::Text(text)) => Some(text),
            _ => None,
        }
    }
}
