//! Reader of a stage, prim by prim.

use std::{collections::BTreeMap, path::Path};

use etendue_io::{Error, Sandbox, error::guarded};
use etendue_scene::limits;
use openusd::sdf::{Specifier, Value};
use openusd::usd::{Attribute, Prim, Relationship, Stage, TimeCode};
use openusd::usda::parser::Parser;

use super::layers::Layers;
use super::tree::{UsdAttribute, UsdAxis, UsdPrim, UsdRelation, UsdStage};
use super::values::{bytes_of, plain};

/// Maximum prims of a stage, counting each instance: `openusd` keeps some kilobytes for each.
const MAX_PRIMS: usize = 100_000;
/// Maximum depth of prims.
const MAX_DEPTH: usize = 64;
/// Maximum number of notes on content that could not be composed.
const MAX_NOTES: usize = 50;
/// Memory of a composed prim, and of each arc that contributes to it, bytes.
const PRIM: u64 = 4096;
const NODE: u64 = 16_384;
/// Overhead of an attribute in addition to its value, bytes.
const OVERHEAD: u64 = 256;

/// Reads a scene with all layers that it names, which must lie in `sandbox`.
///
/// # Errors
/// If the file, or a layer of it, cannot be read or is damaged; missing layers are listed in the stage's notes.
pub fn read_usd(file: &Path, sandbox: &Sandbox) -> Result<UsdStage, Error> {
    // Existence and kind of the file are reported in our own words.
    sandbox.check(file).map_err(|problem| Error::new(file, problem))?;
    if !file.is_file() {
        etendue_io::source::read_bytes(file, "USD")?;
    }
    let real = std::path::absolute(file).map_err(|cause| Error::missing(file, cause.to_string()))?;
    guarded(file, || UsdReader { file, layers: Layers::new(sandbox), time: 0.0, prims: 0, bytes: 0 }.stage(&real))
}

struct UsdReader<'a> {
    file: &'a Path,
    layers: Layers,
    time: f64,
    prims: usize,
    bytes: u64,
}

impl UsdReader<'_> {
    fn scene_error(&self, problem: impl std::fmt::Display) -> Error {
        Error::new(self.file, format!("the scene cannot be read: {problem}"))
    }

    fn stage(mut self, real: &Path) -> Result<UsdStage, Error> {
        let opened = Stage::builder().resolver(self.layers.clone()).open(&real.to_string_lossy());
        let stage = opened.map_err(|cause| {
            let place = self.layers.first_error().or_else(|| self.error_place(real));
            place.unwrap_or_else(|| self.scene_error(format!("{cause:#}")))
        })?;
        self.time = stage.start_time_code();
        let metres = number(&stage, "metersPerUnit");
        if let Some(wrong) = metres.filter(|m| !(*m > 0.0 && m.is_finite())) {
            let message = format!("\"metersPerUnit\" is {wrong}; expected a finite number above 0");
            return Err(Error::new(self.file, message));
        }
        let up = match stage.stage_metadata("upAxis") {
            Ok(Some(Value::Token(axis))) if axis.as_str() == "Z" => UsdAxis::Z,
            Ok(Some(Value::String(axis))) if axis == "Z" => UsdAxis::Z,
            _ => UsdAxis::Y,
        };
        let roots = self.children(&stage.prim("/"), 0);
        if let Some(first) = self.layers.first_error() {
            return Err(first);
        }
        let metres_per_unit = metres.unwrap_or(0.01);
        let errors = stage.composition_errors();
        let mut notes: Vec<String> =
            errors.iter().take(MAX_NOTES).map(|error| format!("not composed: {error}")).collect();
        if errors.len() > MAX_NOTES {
            notes.push(format!("not composed: {} others", errors.len() - MAX_NOTES));
        }
        Ok(UsdStage { metres_per_unit, says_metres: metres.is_some(), up, start_time: self.time, roots: roots?, notes })
    }

    /// Line of the error in a text that is not parsed.
    fn error_place(&self, real: &Path) -> Option<Error> {
        let text = String::from_utf8(etendue_io::source::read_bytes(real, "USD").ok()?).ok()?;
        let mut parser = Parser::new(&text);
        let cause = parser.parse().err()?;
        let line = parser.last_error_highlight()?.line;
        Some(Error::at(self.file, line, format!("invalid USD text: {cause:#}")))
    }

    fn children(&mut self, prim: &Prim, depth: usize) -> Result<Vec<UsdPrim>, Error> {
        if depth > MAX_DEPTH {
            return Err(self.scene_error(format!("prims are nested more than {MAX_DEPTH} levels deep")));
        }
        let children = prim.children().map_err(|cause| self.scene_error(words(cause)))?;
        let mut list = Vec::new();
        for child in children {
            list.extend(self.prim(&child, depth)?);
        }
        Ok(list)
    }

    /// `None` if it is no prim of the scene.
    fn prim(&mut self, prim: &Prim, depth: usize) -> Result<Option<UsdPrim>, Error> {
        let path = prim.path().as_str().to_owned();
        let Some(mut converted) =
            self.plain_prim(prim).map_err(|problem| self.scene_error(format!("{path}: {problem}")))?
        else {
            return Ok(None);
        };
        self.prims += 1;
        if self.prims > MAX_PRIMS {
            return Err(self.scene_error(format!(
                "it has more than {MAX_PRIMS} prims, counting each instance; make it smaller, or import parts of it"
            )));
        }
        converted.children = self.children(prim, depth + 1)?;
        Ok(Some(converted))
    }

    /// Prim without children; `None` if it is no prim of the scene.
    fn plain_prim(&mut self, prim: &Prim) -> Result<Option<UsdPrim>, String> {
        if prim.specifier().map_err(words)? != Some(Specifier::Def) || !prim.is_active().map_err(words)? {
            return Ok(None);
        }
        let kind = prim.type_name().map_err(words)?.map(|kind| kind.as_str().to_owned()).unwrap_or_default();
        let schemas = prim.api_schemas().map_err(words)?.iter().map(|schema| schema.as_str().to_owned()).collect();
        let nodes = prim.prim_index().graph().map_err(words)?.all_nodes().count().saturating_sub(1);
        self.spend(PRIM + NODE * nodes as u64)?;
        let mut relations = BTreeMap::new();
        for relation in prim.relationships().map_err(words)? {
            relations.insert(last(relation.path().as_str()).to_owned(), read_relation(&relation)?);
        }
        let mut attributes = BTreeMap::new();
        for attribute in prim.attributes().map_err(words)? {
            let name = last(attribute.path().as_str()).to_owned();
            let read = self.attribute(&attribute, &name)?;
            self.spend(OVERHEAD + name.len() as u64 + read.value.as_ref().map_or(0, bytes_of))?;
            attributes.insert(name, read);
        }
        let path = prim.path().as_str().to_owned();
        let inactive_ids = inactive_ids(prim)?;
        self.spend(8 * inactive_ids.len() as u64)?;
        Ok(Some(UsdPrim { path, kind, schemas, attributes, relations, inactive_ids, children: Vec::new() }))
    }

    /// Charges the budget for a part of the tree, including the memory of `openusd`.
    fn spend(&mut self, bytes: u64) -> Result<(), String> {
        self.bytes += bytes;
        limits::MESH.check_unpacked(self.bytes).map_err(|problem| problem.words)
    }

    fn attribute(&self, attribute: &Attribute, name: &str) -> Result<UsdAttribute, String> {
        let value = attribute.get_at::<Value>(TimeCode::new(self.time)).map_err(words)?;
        let mut result =
            UsdAttribute { value: value.and_then(|value| plain(value, &self.layers)), ..UsdAttribute::default() };
        result.varies = attribute.num_time_samples().map_err(words)? > 1;
        if name.starts_with("inputs:") || name.starts_with("outputs:") {
            result.connections =
                attribute.connections().map_err(words)?.iter().map(|path| path.as_str().to_owned()).collect();
        }
        if name.starts_with("primvars:") || name == "normals" {
            result.interpolation = word(attribute.get_metadata::<Value>("interpolation").map_err(words)?);
        }
        Ok(result)
    }
}

/// Token or text; empty for other values.
fn word(value: Option<Value>) -> String {
    match value {
        Some(Value::Token(word)) => word.as_str().to_owned(),
        Some(Value::String(word)) => word,
        _ => String::new(),
    }
}

/// Metadata of a prim or a property.
fn metadata(stage: &Stage, path: &openusd::sdf::Path, name: &str) -> Result<Option<Value>, String> {
    // `openusd` provides this only through the handle of an attribute, whatever the path is.
    stage.attribute(path.clone()).get_metadata(name).map_err(words)
}

/// Metadata `inactiveIds` of a prim, from the strongest layer with an opinion: those of weaker layers are not merged.
fn inactive_ids(prim: &Prim) -> Result<Vec<i64>, String> {
    Ok(match metadata(prim.stage(), prim.path(), "inactiveIds")? {
        Some(Value::Int64ListOp(list)) => list.iter().copied().collect(),
        Some(Value::Int64Vec(list)) => list,
        Some(Value::Int64(id)) => vec![id],
        _ => Vec::new(),
    })
}

fn read_relation(relation: &Relationship) -> Result<UsdRelation, String> {
    let targets = relation.targets().map_err(words)?;
    let strength = word(metadata(relation.stage(), relation.path(), "bindMaterialAs")?);
    Ok(UsdRelation {
        targets: targets.iter().map(|target| target.as_str().to_owned()).collect(),
        is_stronger: strength == "strongerThanDescendants",
        ..UsdRelation::default()
    })
}

/// Error text with its causes.
fn words(cause: impl std::fmt::Display) -> String {
    format!("{cause:#}")
}

/// Property name of a path, `/World.size`.
fn last(path: &str) -> &str {
    path.split_once('.').map_or(path, |(_, name)| name)
}

/// Number in the metadata of the stage.
fn number(stage: &Stage, name: &str) -> Option<f64> {
    match stage.stage_metadata(name).ok()?? {
        Value::Double(v) => Some(v),
        Value::Float(v) => Some(v.into()),
        Value::Int(v) => Some(v.into()),
        _ => None,
    }
}
