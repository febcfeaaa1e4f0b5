//! A composed stage in plain types.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;

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
