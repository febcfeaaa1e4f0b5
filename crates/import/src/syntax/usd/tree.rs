//! A composed stage in plain types.
//!
//! Who inherits from whom: `openusd` follows classes that inherit from one another in a circle without end, and long chains on the stack.
//!
//! Looked at of all layers together, as a class of one layer may be one of another; prims of the same path count as one, whatever layer they are of.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::{cell::Cell, path::PathBuf, rc::Rc};

use openusd::sdf::{AbstractData, SpecType, Value};

/// What stands upright in a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UsdAxis {
    /// +y, as where nothing is said.
    Y,
    /// +z.
    Z,
}

/// A composed stage.
#[derive(Debug)]
pub struct UsdStage {
    /// Metres of a length of 1; 0.01 where nothing is said.
    pub metres_per_unit: f64,
    /// Whether the file says it.
    pub says_metres: bool,
    /// What is up.
    pub up: UsdAxis,
    /// The time code of all values.
    pub start_time: f64,
    /// The prims of the root.
    pub roots: Vec<UsdPrim>,
    /// What could not be composed, in words.
    pub notes: Vec<String>,
}

/// A prim: defined, active, no class.
#[derive(Debug, Default)]
pub struct UsdPrim {
    /// Its path, `/World/Chair`.
    pub path: String,
    /// Its type, `Mesh`; empty where it has none.
    pub kind: String,
    /// The API schemas that are applied to it.
    pub schemas: Vec<String>,
    /// Its attributes by their names.
    pub attributes: BTreeMap<String, UsdAttribute>,
    /// Its relationships by their names.
    pub relations: BTreeMap<String, UsdRelation>,
    /// Of an instancer: `inactiveIds`, the instances that are left out at all times.
    pub inactive_ids: Vec<i64>,
    /// The prims within it.
    pub children: Vec<UsdPrim>,
}

/// A relationship.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UsdRelation {
    /// Paths of prims and properties.
    pub targets: Vec<String>,
    /// Of one that binds a material: `bindMaterialAs = "strongerThanDescendants"`.
    pub is_stronger: bool,
    /// Whether anyone has looked at it.
    pub used: Cell<bool>,
}

/// An attribute.
#[derive(Debug, Default)]
pub struct UsdAttribute {
    /// Its value at the stage's start; `None` where it has none, or is blocked.
    pub value: Option<UsdValue>,
    /// Paths of the properties that it is connected to.
    pub connections: Vec<String>,
    /// How a primvar lies on a mesh: `constant`, `uniform`, `varying`, `vertex`, `faceVarying`; empty where nothing is said.
    pub interpolation: String,
    /// Whether it has more values than one over time.
    pub varies: bool,
    /// Whether anyone has looked at it.
    pub used: Cell<bool>,
}

/// A value; every kind of number is one of 64 bits.
#[derive(Clone, Debug, PartialEq)]
pub enum UsdValue {
    /// True or false.
    Flag(bool),
    /// A number.
    Number(f64),
    /// A tuple: vectors; quaternions with their real part first; matrices row by row, as row vectors are multiplied by them.
    Tuple(Vec<f64>),
    /// An array of numbers.
    Numbers(Vec<f64>),
    /// An array of tuples, one after the other, and how many numbers each has.
    Tuples(usize, Vec<f64>),
    /// A token or a text.
    Text(String),
    /// Several.
    Texts(Vec<String>),
    /// A file.
    Asset(UsdAsset),
    /// What is none of these.
    Other,
}

/// A file that a stage names.
#[derive(Clone, Debug, PartialEq)]
pub struct UsdAsset {
    /// As it is written.
    pub stated: String,
    /// Where it lies; `None` of one that is not there.
    pub file: Option<UsdFile>,
}

/// Where a file lies.
#[derive(Clone, Debug, PartialEq)]
pub enum UsdFile {
    /// By itself.
    Plain(PathBuf),
    /// In a package: its name there, and its bytes.
    Packed(String, Rc<[u8]>),
}

impl UsdPrim {
    /// The last part of its path.
    #[must_use]
    pub fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or_default()
    }

    /// The value of an attribute, which counts as looked at.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<&UsdValue> {
        let attribute = self.attributes.get(name)?;
        attribute.used.set(true);
        attribute.value.as_ref()
    }

    /// A relationship with targets, which counts as looked at.
    #[must_use]
    pub fn relation(&self, name: &str) -> Option<&UsdRelation> {
        let relation = self.relations.get(name)?;
        relation.used.set(true);
        Some(relation).filter(|relation| !relation.targets.is_empty())
    }

    /// Whether an API schema is applied to it.
    #[must_use]
    pub fn has_schema(&self, schema: &str) -> bool {
        self.schemas.iter().any(|own| own == schema)
    }
}

/// Classes that inherit from one another in a row.
const MAX_CHAIN: usize = 64;

/// Inheritance, and specialisation, of the layers so far.
#[derive(Default)]
pub(super) struct Arcs(BTreeMap<String, BTreeSet<String>>);

impl Arcs {
    /// Adds those of a layer; refuses circles, and chains that are too long.
    pub(super) fn add(&mut self, layer: &dyn AbstractData) -> Result<(), String> {
        let mut is_new = false;
        for path in layer.spec_paths().iter().filter(|path| layer.spec_type(path) == Some(SpecType::Prim)) {
            for field in ["inheritPaths", "specializes"] {
                let found = layer.try_field(path, field).map_err(|cause| cause.to_string())?;
                let Some(Value::PathListOp(list)) = found.as_deref() else { continue };
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

    /// The prims whose inheritance counts for a prim: itself, and those that it stands in.
    fn about<'a>(&'a self, path: &'a str) -> impl Iterator<Item = &'a str> {
        let ends = path.match_indices('/').map(|(at, _)| at).filter(|at| *at > 0).chain([path.len()]);
        ends.map(move |end| &path[..end]).filter_map(|path| self.0.get_key_value(path).map(|(own, _)| own.as_str()))
    }

    fn check(&self) -> Result<(), String> {
        // How long the chain from a prim is; 0 while it is being walked.
        let mut known: HashMap<&str, usize> = HashMap::new();
        for start in self.0.keys() {
            self.chain(start, 0, &mut known)?;
        }
        Ok(())
    }

    fn chain<'a>(&'a self, own: &'a str, depth: usize, known: &mut HashMap<&'a str, usize>) -> Result<usize, String> {
        match known.get(own) {
            Some(0) => return Err(format!("<{own}> inherits from itself in a circle")),
            Some(length) if depth + length <= MAX_CHAIN => return Ok(*length),
            None if depth < MAX_CHAIN => {}
            _ => return Err(format!("more than {MAX_CHAIN} classes in a row inherit from one another at <{own}>")),
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
