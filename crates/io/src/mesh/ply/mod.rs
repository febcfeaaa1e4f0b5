//! Meshes of PLY files: text, and binary of either byte order.
//!
//! Source: G. Turk, "The PLY Polygon File Format", 1994, with the names that writers gave to properties since. Read: places and normals of
//! `vertex`, texture coordinates of its vertices (`u v`, `s t`, `texture_u texture_v`, `texture_s texture_t`) or of the corners of its faces
//! (`texcoord`), polygons of `face`, and `tristrips`. All other elements and properties are passed over, and said in the report. A file names
//! no material: it has one slot, without a name.
//!
//! Refused: numbers that are not finite, indices out of range, faces of fewer than three corners, polygons that cross themselves, and
//! elements that the bytes of the file cannot hold, before memory is taken for them.

mod assemble;
mod encode;
mod faces;
mod header;
mod input;
mod vertices;

pub use encode::{PlacedTriangles, encode_obj, encode_ply};

use std::path::Path;

use etendue_scene::asset::MeshAsset;

use self::header::Header;
use self::input::Input;
use crate::source::{name_notes, read_bytes};
use crate::{Error, Problem, hash};

/// Whether a file is a PLY file by its ending.
pub(crate) fn is_ply(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ply"))
}

/// Reads a PLY file.
pub(super) fn read_ply(file: &Path) -> Result<MeshAsset, Error> {
    let bytes = read_bytes(file, "mesh")?;
    let told = |line: Option<usize>, problem: Problem| match line {
        Some(line) => Error::at(file, line, problem),
        None => Error::new(file, problem),
    };
    let header = Header::read(&bytes).map_err(|(line, what)| Error::at(file, line, what))?;
    let mut input = Input::new(&header, &bytes);
    let mut mesh = assemble::mesh(&header, &mut input).map_err(|what| told(input.line(), what))?;
    mesh.hash = hash::of_bytes(&bytes);
    name_notes(file, &mut mesh.report);
    Ok(mesh)
}
