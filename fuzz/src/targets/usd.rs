//! Stages of Universal Scene Description.

use super::assets::text_target;
use super::scenes::imported;
use super::seeds::{repository, write};
use super::target::{TREE, Target};
use std::path::Path;

const USD_WORDS: &[&str] = &[
    "#usda 1.0",
    "PXR-USDC",
    "def Mesh \"Card\" {",
    "def PointInstancer \"p\" { rel prototypes = </World/Fence> }",
    "(prepend references = @./kinds-prop.usda@)",
    "(prepend references = </World>)",
    "(prepend payload = @a.usd@)",
    "(inherits = </World/Turned>)",
    "subLayers = [@a.usd@]",
    "instanceable = true",
    "active = false",
    "over \"World\" {",
    "class \"World\" {",
    "variantSet \"size\" = { \"large\" { } }",
    "int[] faceVertexCounts = [4, -1, 2147483647]",
    "token visibility = \"invisible\"",
    "uniform token[] xformOpOrder = [\"!invert!xformOp:scale\"]",
    "double3 xformOp:translate = (1e308, nan, inf)",
    ".timeSamples = { 1: (1, 2, 3), 0: None }",
    "token outputs:surface.connect = </World/Materials/Plain.outputs:surface>",
    "string inputs:varname = \"`${A}`\"",
    "upAxis = \"Z\"",
    "metersPerUnit = 0",
];

fn usd_seeds(folder: &Path) -> Vec<Vec<u8>> {
    let neighbours = ["kinds-prop.usda", "letter.png"];
    let contents = repository(["scenes/import/kinds-prop.usda", "scenes/import/letter.png"]);
    neighbours.iter().zip(contents).for_each(|(name, bytes)| write(folder, name, bytes));
    repository(["scenes/import/kinds.usda", "scenes/import/kinds.usdc", "scenes/import/table.usda"])
}

/// What is composed of it, and what is written, with all instances; a layer beside it counts with it.
pub(super) const USD: Target =
    Target { times: TREE, is_text: false, ..text_target("usd", "a.usd", usd_seeds, imported, USD_WORDS) };

/// The same of packages.
pub(super) const USDZ: Target = Target {
    times: TREE,
    is_text: false,
    ..text_target(
        "usdz",
        "a.usdz",
        |_| repository(["scenes/import/kinds.usdz"]),
        imported,
        &["PK\x05\x06", "PK\x01\x02"],
    )
};
