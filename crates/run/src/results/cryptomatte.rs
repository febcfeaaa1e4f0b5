//! Coverage as a Cryptomatte, by the names of a plan.

use etendue_io::Provenance;
use etendue_io::exr::{CryptomatteLayer, ExrImage, cryptomatte_image};
use etendue_pipeline::identity_coverage::{IdentityCoverage, Share};
use etendue_pipeline::plan::Plan;
use std::collections::BTreeMap;

/// Layers of objects and of materials.
pub(super) fn cryptomatte_image_of(
    coverage: &IdentityCoverage,
    plan: &Plan,
    provenance: &Provenance,
) -> ExrImage<'static> {
    let objects = numbered(plan.identities.iter().map(|identity| identity.name.as_str()));
    let materials = numbered(plan.materials.iter().map(String::as_str));
    let (seen_objects, seen_materials) = (pixels(&coverage.instances), pixels(&coverage.materials));
    let layers = [
        CryptomatteLayer { name: "CryptoObject", names: &objects, pixels: &seen_objects },
        CryptomatteLayer { name: "CryptoMaterial", names: &materials, pixels: &seen_materials },
    ];
    cryptomatte_image(coverage.width, coverage.height, &layers, provenance)
}

/// Ids count from 1 in the order of the plan.
fn numbered<'a>(names: impl Iterator<Item = &'a str>) -> BTreeMap<u32, &'a str> {
    (1..).zip(names).collect()
}

fn pixels(shares: &[Vec<Share>]) -> Vec<Vec<(u32, f32)>> {
    shares.iter().map(|pixel| pixel.iter().map(|share| (share.id, share.coverage)).collect()).collect()
}
