//! Composed stage in plain types; check of class inheritance.
//!
//! `openusd` follows circular inheritance without end, and long chains on the stack. The check covers all layers together, as a class of one layer may be one
//! of another; prims of the same path count as one, whatever their layer.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::{cell::Cell, path::PathBuf, rc::Rc};

use openusd::sdf::{AbstractData, SpecType, Value};

/// Up axis of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UsdAxis {
    /// +y, the default.
    Y,
    /// +z.
    Z,
}

/// A composed stage.
#[derive(Debug)]
pub struct UsdStage {
    /// Metres per unit of length; 0.01 by default.
    pub metres_per_unit: f64,
    /// True if the file states it.
    pub says_metres: bool,
    /// Up axis.
    pub up: UsdAxis,
    /// Time code of all values.
    pub start_time: f64,
    /// Root prims.
    pub roots: Vec<UsdPrim>,
    /// Notes on content that could not be composed.
    pub notes: Vec<String>,
}

/// Prim: defined, active, no class.
#[derive(Debug, Default)]
pub struct UsdPrim {
    /// Path, `/World/Chair`.
    pub path: String,
    /// Type, `Mesh`; empty if it has none.
    pub kind: String,
    /// Applied API schemas.
    pub schemas: Vec<String>,
    /// Attributes by name.
    pub attributes: BTreeMap<String, UsdAttribute>,
    /// Relationships by name.
    pub relations: BTreeMap<String, UsdRelation>,
    /// For an instancer: `inactiveIds`, the instances that are never drawn.
    pub inactive_ids: Vec<i64>,
    /// Child prims.
    pub children: Vec<UsdPrim>,
}

/// Relationship.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UsdRelation {
    /// Paths of prims and properties.
    pub targets: Vec<String>,
    /// For a material binding: `bindMaterialAs = "strongerThanDescendants"`.
    pub is_stronger: bool,
    /// True once it has been used.
    pub used: Cell<bool>,
}

#[derive(Debug, Default)]
pub struct UsdAttribute {
    /// Value at the stage's start; `None` if it has none, or is blocked.
    pub value: Option<UsdValue>,
    /// Paths of connected properties.
    pub connections: Vec<String>,
    /// Interpolation of a primvar on a mesh: `constant`, `uniform`, `varying`, `vertex`, `faceVarying`; empty if not stated.
    pub interpolation: String,
    /// True if it has more than one value over time.
    pub varies: bool,
    /// True once it has been used.
    pub used: Cell<bool>,
}

/// Value; all numbers have 64 bits.
#[derive(Clone, Debug, PartialEq)]
pub enum UsdValue {
    /// Boolean.
    Flag(bool),
    Number(f64),
    /// Tuple: vectors; quaternions with their real part first; matrices row by row, for multiplication of row vectors.
    Tuple(Vec<f64>),
    /// An array of numbers.
    Numbers(Vec<f64>),
    /// Array of tuples, concatenated, with the number of components first.
    Tuples(usize, Vec<f64>),
    /// A token or a text.
    Text(String),
    /// Array of tokens or texts.
    Texts(Vec<String>),
    /// File.
    Asset(UsdAsset),
    /// Other type.
    Other,
}

/// File that a stage names.
#[derive(Clone, Debug, PartialEq)]
pub struct UsdAsset {
    /// As written.
    pub stated: String,
    /// Location; `None` if it does not exist.
    pub file: Option<UsdFile>,
}

/// Location of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum UsdFile {
    /// Separate file.
    Plain(PathBuf),
    /// In a package: its name there, and its bytes.
    Packed(String, Rc<[u8]>),
}

impl UsdPrim {
    /// Last part of its path.
    #[must_use]
    pub fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or_default()
    }

    /// Returns the value of an attribute and marks it as used.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<&UsdValue> {
        let attribute = self.attributes.get(name)?;
        attribute.used.set(true);
        attribute.value.as_ref()
    }

    /// Returns a relationship with targets and marks it as used.
    #[must_use]
    pub fn relation(&self, name: &str) -> Option<&UsdRelation> {
        let relation = self.relations.get(name)?;
        relation.used.set(true);
        Some(relation).filter(|relation| !relation.targets.is_empty())
    }

    /// Returns true if an API schema is applied to it.
    #[must_use]
    pub fn has_schema(&self, schema: &str) -> bool {
        self.schemas.iter().any(|own| own == schema)
    }
}

/// Maximum length of a chain of inheritance.
const MAX_CHAIN: usize = 64;

/// Inherits and specialises arcs of the layers so far.
#[derive(Default)]
pub(super) struct Arcs(BTreeMap<String, BTreeSet<String>>);

impl Arcs {
    /// Adds those of a layer; refuses circles, and chains that are too long.
    pub(super) fn add(&mut self, layer: &dyn AbstractData) -> Result<(), String> {
        let mut is_new = false;
        for path in layer.spec_paths().iter().filter(|path| layer.spec_type(path) == Some(SpecType::Prim)) {
            for field in ["inheritPaths", "specializes"] {
                let field_value = layer.try_field(path, field).map_err(|cause| cause.to_string())?;
                let Some(Value::PathListOp(list)) = field_value.as_deref() else { continue };
                let all = [&list.explicit_items, &list.added_items, &list.prepended_items, &list.appended_items];
                for target in all.into_iter().flatten() {
                    let own = path.strip_all_variant_selections();
                    is_new |= self.link(own.as_str(), target.strip_all_variant_selections().as_str());
                }
            }
        }
        if is_new { self.check() } else { Ok(()) }
    }

    fn link(&mut self, heir: &str, parent: &str) -> bool {
        self.0.entry(heir.to_owned()).or_default().insert(parent.to_owned())
    }

    /// Prims whose inheritance affects a prim: itself and its ancestors.
    fn about<'a>(&'a self, path: &'a str) -> impl Iterator<Item = &'a str> {
        let ends = path.match_indices('/').map(|(at, _)| at).filter(|at| *at > 0).chain([path.len()]);
        ends.map(move |end| &path[..end]).filter_map(|path| self.0.get_key_value(path).map(|(own, _)| own.as_str()))
    }

    fn check(&self) -> Result<(), String> {
        // Length of the chain from a prim; 0 while it is being walked.
        let mut known: HashMap<&str, usize> = HashMap::new();
        for start in self.0.keys() {
            self.chain(start, 0, &mut known)?;
        }
        Ok(())
    }

    fn chain<'a>(&'a self, own: &'a str, depth: usize, known: &mut HashMap<&'a str, usize>) -> Result<usize, String> {
        match known.get(own) {
            Some(0) => return Err(format!("<{own}> inherits from itself")),
            Some(length) if depth + length <= MAX_CHAIN => return Ok(*length),
            None if depth < MAX_CHAIN => {}
            _ => return Err(format!("the inheritance chain at <{own}> has more than {MAX_CHAIN} classes")),
        }
        known.insert(own, 0);
        let mut longest = 0;
        for parent in self.0.get(own).into_iter().flatten() {
            for next in self.about(parent) {
                longest = longest.max(self.chain(next, depth + 1, known)?);
            }
        }
        known.insert(own, longest + 1);
        Ok(longest + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(links: &[(&str, &str)]) -> Result<(), String> {
        let mut arcs = Arcs::default();
        links.iter().for_each(|(heir, parent)| {
            arcs.link(heir, parent);
        });
        arcs.check()
    }

    #[test]
    fn circles_are_found_through_what_prims_stand_in() {
        assert_eq!(checked(&[("/a", "/b"), ("/b", "/c"), ("/World/x", "/World/c")]), Ok(()));
        assert!(checked(&[("/a", "/b"), ("/b", "/a")]).is_err());
        assert!(checked(&[("/a", "/b/c"), ("/b", "/a")]).is_err());
        assert!(checked(&[("/a", "/a/b")]).is_err());
        let chain: Vec<(String, String)> = (0..80).map(|i| (format!("/c{i:02}"), format!("/c{:02}", i + 1))).collect();
        let links: Vec<(&str, &str)> = chain.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
        assert!(checked(&links[..60]).is_ok());
        assert!(checked(&links).is_err());
        let backwards: Vec<(&str, &str)> = links.iter().rev().copied().collect();
        assert!(checked(&backwards).is_err());
    }
}
