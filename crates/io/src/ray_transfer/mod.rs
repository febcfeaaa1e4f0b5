//! Ray-transfer functions of lenses, as ISET's JSON files state them ("…-raytransfer.json").
//!
//! Goossens et al., Optics Express 30 (2022) 24031; their readers are the cameras "raytransfer" and "rtf" of ISET's forks of pbrt.
//!
//! | key | is |
//! | --- | --- |
//! | `thickness`, `planeoffsetinput`, `planeoffsetoutput` | mm; `planeoffset` of older files is both offsets |
//! | `useDZpolynomial` | true if the sign of dz is that of `outdz`; otherwise all rays travel forwards |
//! | `polynomials` | one per wavelength |
//! | `wavelength_nm` | nm |
//! | `passnopass` or `raypass` | the ray-pass function, by its `method`: `minimalellipse` (`positions`, `radiiX`, `radiiY`, `centersX`, `centersY`) or `circles` (`radii`, `sensitivities`), and `intersectPlaneDistance` |
//! | `circleRadii`, `circleSensitivities`, `circlePlaneZ` | circles in older files |
//! | `poly` | `outputname` (`outx`, `outy`, `outz`, `outdx` or `outu`, `outdy` or `outv`, `outdz` or `outw`), `coeff` and its powers `termr`, `termdx` or `termu`, `termdy` or `termv` |
//!
//! Without `outz` rays leave from the output plane. Other keys are ignored, and the notes name them.

mod functions;

use std::path::Path;

use etendue_scene::asset::RayTransferAsset;

use crate::source::{decode_text, read_description_bytes};
use crate::tree::{self, TreeError, TreeNode, TreeResult, passed_over};
use crate::{Error, ErrorCode, hash};

const KEYS: [&str; 8] = [
    "name",
    "description",
    "thickness",
    "planeoffset",
    "planeoffsetinput",
    "planeoffsetoutput",
    "useDZpolynomial",
    "polynomials",
];

/// Maximum wavelengths of a file: some hundred times the number in real files.
const MAX_WAVELENGTHS: usize = 512;

/// Reads a ray-transfer file.
///
/// # Errors
/// The first error of the file, with its line.
pub fn read_ray_transfer(file: &Path) -> Result<RayTransferAsset, Error> {
    let bytes = read_description_bytes(file, "ray-transfer")?;
    let text = decode_text(file, &bytes)?;
    let asset = read(text).map_err(|error| error.in_file(file))?;
    Ok(RayTransferAsset { hash: hash::hash_bytes(&bytes), ..asset })
}

fn read(text: &str) -> TreeResult<RayTransferAsset> {
    let root = tree::parse(text)?;
    let thickness_mm = root.key("thickness")?.number()?;
    let input_offset_mm = root.any(&["planeoffsetinput", "planeoffset"])?.number()?;
    let output_offset_mm = root.any(&["planeoffsetoutput", "planeoffset"])?.number()?;
    let with_dz = root.find("useDZpolynomial").map_or(Ok(false), flag)?;
    let polynomials = root.key("polynomials")?;
    let mut notes = passed_over(&root.others(&KEYS));
    // Some programs write a list of one as its only item.
    let items = polynomials.items().unwrap_or(std::slice::from_ref(polynomials));
    let read = |node: &TreeNode| functions::read(node, output_offset_mm, with_dz);
    let mut transfers = items.iter().map(read).collect::<TreeResult<Vec<_>>>()?;
    if transfers.len() > MAX_WAVELENGTHS {
        let message = format!("contains {} wavelengths; expected at most {MAX_WAVELENGTHS}", transfers.len());
        return Err(TreeError::at(polynomials.line, message));
    }
    if transfers.is_empty() {
        return Err(TreeError::coded(
            ErrorCode::Empty,
            polynomials.line,
            "contains no wavelength; expected at least one",
        ));
    }
    transfers.sort_by(|a, b| a.0.wavelength_nm.total_cmp(&b.0.wavelength_nm));
    if let Some(pair) = transfers.windows(2).find(|pair| pair[0].0.wavelength_nm == pair[1].0.wavelength_nm) {
        return Err(TreeError::coded(
            ErrorCode::Duplicate,
            polynomials.line,
            format!("the wavelength {} nm appears twice", pair[0].0.wavelength_nm),
        ));
    }
    for note in transfers.iter().flat_map(|(_, notes)| notes) {
        if !notes.contains(note) {
            notes.push(note.clone());
        }
    }
    let transfers = transfers.into_iter().map(|(transfer, _)| transfer).collect();
    let name = root.find("name").map_or(Ok(""), TreeNode::text)?.to_owned();
    Ok(RayTransferAsset { name, thickness_mm, input_offset_mm, transfers, notes, hash: [0; 32] })
}

fn flag(node: &TreeNode) -> TreeResult<bool> {
    match node.text()? {
        "true" => Ok(true),
        "false" => Ok(false),
        other => Err(TreeError::at(node.line, format!("found \"{other}\"; expected true or false"))),
    }
}
