//! Cryptomatte (Friedman and Jones 2015; Psyop's specification, version 1.2.0): identities of a pixel with their coverage, ranked.
//!
//! - An identity is MurmurHash3 (32 bits for x86, seed 0; Appleby 2011) of its name in UTF-8, read as the bits of a 32-bit float. If these are not a normal
//!   number, an exponent of 0 or of 255, the lowest bit of the exponent is flipped.
//! - Ranks lie in pairs in layers of four channels: `CryptoObject00.R` the identity with the largest coverage and `.G` its coverage, `.B` and `.A` the second;
//!   `CryptoObject01` the third and the fourth, and so on. Unused ranks are 0 in both. [`RANKS`] ranks are written; smaller coverages are omitted.
//! - The header states, under the first seven digits of the hash of the layer's own name, `name`, `hash`, `conversion` and `manifest`: names and hashes as
//!   JSON, in ASCII.
//!
//! The format cannot distinguish two names with the same hash.

use std::{collections::BTreeMap, fmt::Write as _};

use super::encode::ExrImage;
use crate::Provenance;

/// Ranks written per pixel: three layers, the usual default of renderers.
const RANKS: usize = 6;

/// One kind of identities, such as objects.
#[derive(Clone, Copy, Debug)]
pub struct CryptomatteLayer<'a> {
    /// Name of its layers: `CryptoObject`.
    pub name: &'a str,
    /// Names of the identities by their numbers.
    pub names: &'a BTreeMap<u32, &'a str>,
    /// Numbers and coverages of each pixel, largest first; pixels row by row from the top left.
    pub pixels: &'a [Vec<(u32, f32)>],
}

/// File of some layers of `width` × `height` pixels.
#[must_use]
pub fn cryptomatte_image(
    width: usize,
    height: usize,
    layers: &[CryptomatteLayer<'_>],
    provenance: &Provenance,
) -> ExrImage<'static> {
    let mut image = ExrImage::new(width, height, provenance);
    image.state("quantity", "coverage of identities");
    image.state("units", "1");
    for layer in layers {
        add(&mut image, layer);
    }
    image
}

fn add(image: &mut ExrImage<'static>, layer: &CryptomatteLayer<'_>) {
    let ids: BTreeMap<u32, f32> = layer.names.iter().map(|(number, name)| (*number, cryptomatte_id(name))).collect();
    let rank_values = |rank: usize, take: &dyn Fn((u32, f32)) -> f32| -> Vec<f32> {
        layer.pixels.iter().map(|shares| shares.get(rank).map_or(0.0, |entry| take(*entry))).collect()
    };
    for rank in 0..RANKS {
        let [id, coverage] = if rank % 2 == 0 { ["R", "G"] } else { ["B", "A"] };
        let stem = format!("{}{:02}", layer.name, rank / 2);
        image.float(format!("{stem}.{id}"), rank_values(rank, &|(number, _)| ids.get(&number).copied().unwrap_or(0.0)));
        image.float(format!("{stem}.{coverage}"), rank_values(rank, &|(_, coverage)| coverage));
    }
    let key = format!("{:08x}", murmur3_32(layer.name.as_bytes()));
    let facts = [
        ("name", layer.name.to_owned()),
        ("hash", "MurmurHash3_32".to_owned()),
        ("conversion", "uint32_to_float32".to_owned()),
        ("manifest", manifest(layer.names)),
    ];
    for (fact, text) in facts {
        image.facts.insert(format!("cryptomatte/{}/{fact}", &key[..7]), text);
    }
}

/// Identity of a name, as the float stored in pixels.
#[must_use]
pub fn cryptomatte_id(name: &str) -> f32 {
    let hash = murmur3_32(name.as_bytes());
    let exponent = hash >> 23 & 255;
    f32::from_bits(if exponent == 0 || exponent == 255 { hash ^ 1 << 23 } else { hash })
}

/// Names and the bits of their identities.
fn manifest(names: &BTreeMap<u32, &str>) -> String {
    let names: BTreeMap<&str, u32> = names.values().map(|name| (*name, cryptomatte_id(name).to_bits())).collect();
    let entries: Vec<String> = names.iter().map(|(name, id)| format!("{}:\"{id:08x}\"", ascii(name))).collect();
    format!("{{{}}}", entries.join(","))
}

/// Text as JSON in ASCII: readers agree on nothing else in EXR headers.
fn ascii(text: &str) -> String {
    let mut out = String::from("\"");
    for unit in text.encode_utf16() {
        match char::from_u32(unit.into()) {
            Some(c @ ('"' | '\\')) => out.extend(['\\', c]),
            Some(c @ ' '..='~') => out.push(c),
            _ => {
                let _ = write!(out, "\\u{unit:04x}");
            }
        }
    }
    out.push('"');
    out
}

/// MurmurHash3 for x86, 32 bits, seed 0 (Appleby 2011, public domain).
fn murmur3_32(bytes: &[u8]) -> u32 {
    let mixed = |block: u32| block.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let (blocks, rest) = bytes.as_chunks::<4>();
    let mut hash = blocks.iter().fold(0_u32, |hash, block| {
        (hash ^ mixed(u32::from_le_bytes(*block))).rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    let tail = rest.iter().rev().fold(0_u32, |tail, byte| tail << 8 | u32::from(*byte));
    hash ^= mixed(tail);
    // Lengths are taken modulo 2³².
    hash ^= bytes.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of mmh3 5.3.1 for Python (`tests/oracles/cryptomatte.py`).
    #[test]
    fn hashes_are_those_of_other_programs() {
        for (name, hash) in [
            ("", 0x0000_0000),
            ("a", 0x3c25_69b2),
            ("abcd", 0x43ed_676a),
            ("hello", 0x248b_fa47),
            ("sphere", 0x591e_9a8d),
            ("CryptoObject", 0x3ae3_9a58),
            ("Stra\u{df}e", 0x5d13_b5ee),
        ] {
            assert_eq!(murmur3_32(name.as_bytes()), hash, "{name}");
        }
    }

    /// The specification's own examples, to the digits that it prints.
    #[test]
    fn identities_are_those_of_the_specification() {
        for (name, id) in
            [("cube", -4.084_619_125_19e15), ("sphere", 2.790_186_043_83e15), ("plane", 3.665_576_175_93e-11)]
        {
            assert!((f64::from(cryptomatte_id(name)) / id - 1.0).abs() < 1e-11, "{name}");
        }
        assert!((f64::from(cryptomatte_id("hello")) / 6.070_562_710_24e-17 - 1.0).abs() < 1e-11);
    }

    #[test]
    fn identities_are_normal_numbers() {
        // The hash 0 has the exponent 0, whose lowest bit is then flipped: 2⁻¹²⁶.
        assert_eq!(cryptomatte_id("").to_bits(), 0x0080_0000);
        assert!((0..4096).all(|i| cryptomatte_id(&format!("object.{i}")).is_normal()));
    }

    #[test]
    fn ranks_lie_in_pairs_and_the_header_names_them() {
        let names = BTreeMap::from([(1, "car"), (2, "Stra\u{df}e \"2\"")]);
        let pixels = [vec![(2, 0.75), (1, 0.25)], vec![]];
        let layer = CryptomatteLayer { name: "CryptoObject", names: &names, pixels: &pixels };
        let image = cryptomatte_image(2, 1, &[layer], &Provenance::default());
        let key = format!("cryptomatte/{}", &format!("{:08x}", murmur3_32(b"CryptoObject"))[..7]);
        let manifest = &image.facts[&format!("{key}/manifest")];
        let read: BTreeMap<String, String> = serde_json::from_str(manifest).expect("JSON");
        assert!(manifest.is_ascii());
        let id = cryptomatte_id("Stra\u{df}e \"2\"");
        assert_eq!(read["Stra\u{df}e \"2\""], format!("{:08x}", id.to_bits()));
        assert_eq!(image.facts[&format!("{key}/conversion")], "uint32_to_float32");
        let bytes = image.into_bytes().expect("a small picture");
        let file = crate::exr::decode_exr(std::path::Path::new("c.exr"), &bytes).expect("an EXR");
        let samples = |name: &str| file.channel(name).expect("a channel").to_floats();
        assert_eq!(samples("CryptoObject00.R"), [id, 0.0]);
        assert_eq!((samples("CryptoObject00.G"), samples("CryptoObject00.A")), (vec![0.75, 0.0], vec![0.25, 0.0]));
        assert_eq!(samples("CryptoObject00.B")[0], cryptomatte_id("car"));
        assert_eq!(samples("CryptoObject02.A"), [0.0, 0.0]);
    }
}
