//! Scenes of Universal Scene Description: text (`.usda`), crate (`.usdc`), either (`.usd`), packages (`.usdz`).
//!
//! Source: openusd.org, "USD Terms and Concepts", the schemas of UsdGeom, UsdLux and UsdShade, "Usdz File Format Specification", and the AOUSD Core
//! Specification 1.0.1 where bytes are concerned. The crate `openusd` parses and composes; what comes out of it is a tree of prims with the values at the
//! stage's start time, in plain types. What prims mean is for whoever takes them.
//!
//! Composed are sublayers, references, payloads, inherits, specialises, variants (as selected in the files) and instances, which are copies here. Classes,
//! overs without a definition, and what is inactive are no prims of the tree.
//!
//! Limits, as a file may lie about its sizes and `openusd` believes it: crates are walked before they are parsed (`crate_bounds`), texts are measured
//! (`text_bounds`), packages are told apart here and must not be compressed, as their specification has it (`package`), and classes
//! must not inherit from one another in a circle (`arcs`). What layers, and values of the
//! tree, unpack to is limited by `mesh-mib`; prims are at most 100 000, 64 deep. Where `openusd` panics over what is damaged, the file is refused.

mod bytes;
mod crate_bounds;
mod crate_values;
mod layers;
mod package;
mod read;
mod text_bounds;
mod tree;
mod values;

pub use read::read_usd;
pub use tree::{UsdAsset, UsdAttribute, UsdAxis, UsdFile, UsdPrim, UsdRelation, UsdStage, UsdValue};
