//! Scenes of Universal Scene Description: text (`.usda`), crate (`.usdc`), either (`.usd`), packages (`.usdz`).
//!
//! Source: openusd.org, "USD Terms and Concepts", the schemas of UsdGeom, UsdLux and UsdShade, "Usdz File Format Specification", and the AOUSD Core
//! Specification 1.0.1 for the binary encoding. The crate `openusd` parses and composes. The result is a tree of prims with the values at the stage's start
//! time, in plain types. The caller interprets the prims.
//!
//! The composition includes sublayers, references, payloads, inherits, specialises, variants (as selected in the files) and instances, which are copies here.
//! Classes, overs without a definition, and inactive prims are not in the tree.
//!
//! A file may state false sizes, and `openusd` trusts them. Therefore crates are checked before they are parsed (`crate_bounds`), so are texts (`text_bounds`),
//! packages are parsed here and must not be compressed, as their specification requires (`package`), and inheritance of classes must not be circular (`arcs`).
//! The decompressed size of layers, and of values of the tree, is limited by `mesh-mib`; there are at most 100 000 prims, 64 deep. If `openusd` panics on
//! damaged data, the file is refused.

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
