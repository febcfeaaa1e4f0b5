//! Identities of Cryptomatte compared with mmh3 (tests/oracles/cryptomatte.py).

use etendue_io::exr::cryptomatte_id;
use serde_json::Value;
use std::path::Path;

#[test]
fn identities_are_those_of_mmh3_bit_by_bit() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/cryptomatte.json");
    let figures: Value = serde_json::from_str(&std::fs::read_to_string(file).expect("figures")).expect("JSON");
    let identities = figures["identities"].as_object().expect("names and bits");
    assert!(identities.len() > 1200);
    for (name, bits) in identities {
        assert_eq!(format!("{:08x}", cryptomatte_id(name).to_bits()), bits.as_str().expect("digits"), "{name}");
    }
}
