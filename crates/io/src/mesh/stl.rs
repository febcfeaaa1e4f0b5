//! STL files, binary and ASCII.
//!
//! Source: StereoLithography Interface Specification, 3D Systems 1989. Vertices of equal coordinates become one. The stated normals are not used: they are those
//! of the facets, which follow from the corners. Attribute bytes and colours are not used.
//!
//! A binary file is known by its length, 84 bytes plus 50 per facet: the header of some begins with `solid` as an ASCII file does.

use std::collections::HashMap;
use std::path::Path;

use etendue_scene::asset::{MeshAsset, SlotMaterial};

use super::statement::number;
use super::vertex::{check_corners, check_range, middle_of_far, relative};
use crate::source::{name_notes, read_bytes};
use crate::{Error, Problem, hash};

const HEAD: usize = 84;
const FACET: usize = 50;

/// Returns true if the file name has the extension of STL.
pub(crate) fn is_stl(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("stl"))
}

/// Reads an STL file.
pub(super) fn read_stl(file: &Path) -> Result<MeshAsset, Error> {
    let bytes = read_bytes(file, "mesh")?;
    let mut builder = StlBuilder::default();
    let count = facet_count(&bytes);
    let is_binary =
        count.is_some_and(|count| count.checked_mul(FACET).and_then(|n| n.checked_add(HEAD)) == Some(bytes.len()));
    if is_binary || !begins_as_text(&bytes) {
        builder.binary(&bytes, count).map_err(|problem| Error::new(file, problem))?;
    } else {
        builder.text(&bytes).map_err(|(line, problem)| Error::at(file, line, problem))?;
    }
    let mut mesh = builder.finish().map_err(|problem| Error::new(file, problem))?;
    mesh.hash = hash::hash_bytes(&bytes);
    name_notes(file, &mut mesh.report);
    Ok(mesh)
}

fn facet_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    usize::try_from(u32::from_le_bytes([count[0], count[1], count[2], count[3]])).ok()
}

/// Returns true for an ASCII file: `solid`, and no byte that a text lacks in its first part.
fn begins_as_text(bytes: &[u8]) -> bool {
    let begin = bytes.trim_ascii_start();
    let is_solid = begin.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    is_solid && !bytes[..bytes.len().min(1024)].contains(&0)
}

/// Mesh under construction.
#[derive(Default)]
struct StlBuilder {
    positions: Vec<[f64; 3]>,
    /// Index of each position, by its bits.
    places: HashMap<[u64; 3], u32>,
    triangles: Vec<[u32; 3]>,
    has_attributes: bool,
    notes: Vec<String>,
}

impl StlBuilder {
    fn binary(&mut self, bytes: &[u8], count: Option<usize>) -> Result<(), Problem> {
        let stated = count.ok_or("not an STL file: it has fewer than 84 bytes and does not begin with `solid`")?;
        let (facets, rest) = bytes[HEAD..].as_chunks::<FACET>();
        if facets.len() < stated {
            let has = facets.len();
            return Err(
                format!("has {has} facets, but {stated} are stated: it is truncated, or not an STL file").into()
            );
        }
        check_corners(3 * stated as u64)?;
        for (number, facet) in facets[..stated].iter().enumerate() {
            let corner = |i: usize| -> [f64; 3] {
                std::array::from_fn(|axis| {
                    let at = 12 * (i + 1) + 4 * axis;
                    f64::from(f32::from_le_bytes([facet[at], facet[at + 1], facet[at + 2], facet[at + 3]]))
                })
            };
            let corners = [corner(0), corner(1), corner(2)];
            if corners.iter().flatten().any(|v| !v.is_finite()) {
                return Err(format!("facet {number}: a coordinate is not finite (NaN or infinity): correct the mesh in the modelling program").into());
            }
            self.facet(corners);
            self.has_attributes |= facet[FACET - 2..] != [0, 0];
        }
        let further = (facets.len() - stated) * FACET + rest.len();
        if further > 0 {
            self.notes.push(format!("{further} bytes after the last facet are not used"));
        }
        Ok(())
    }

    /// Reads an ASCII file: the lines `vertex` of each `facet`. Other lines are names and normals.
    fn text(&mut self, bytes: &[u8]) -> Result<(), (usize, Problem)> {
        let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        let mut corners: Vec<[f64; 3]> = Vec::new();
        for (index, line) in bytes.split(|byte| *byte == end).enumerate() {
            let line = String::from_utf8_lossy(line);
            self.line(&line, &mut corners).map_err(|problem| (index + 1, problem))?;
        }
        match corners.is_empty() {
            true => Ok(()),
            false => Err((1 + bytes.iter().filter(|byte| **byte == end).count(), truncated())),
        }
    }

    fn line(&mut self, line: &str, corners: &mut Vec<[f64; 3]>) -> Result<(), Problem> {
        let mut words = line.split_whitespace();
        match words.next().unwrap_or_default().to_ascii_lowercase().as_str() {
            "vertex" => {
                let numbers: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
                let [x, y, z] = numbers[..] else {
                    return Err(format!("`vertex` has {} numbers; expected 3", numbers.len()).into());
                };
                check_range(&numbers)?;
                corners.push([x, y, z]);
            }
            "endfacet" | "facet" if !corners.is_empty() => {
                let [a, b, c] = corners[..] else {
                    return Err(format!("the facet has {} corners; expected 3", corners.len()).into());
                };
                check_corners(3 * (self.triangles.len() as u64 + 1))?;
                self.facet([a, b, c]);
                corners.clear();
            }
            _ => {}
        }
        Ok(())
    }

    fn facet(&mut self, corners: [[f64; 3]; 3]) {
        let triangle = corners.map(|corner| self.vertex(corner));
        self.triangles.push(triangle);
    }

    /// Index of a vertex; −0 counts as 0.
    fn vertex(&mut self, position: [f64; 3]) -> u32 {
        let next = self.positions.len() as u32; // no more than corners, which are counted
        let place = *self.places.entry(position.map(|v| (v + 0.0).to_bits())).or_insert(next);
        if place == next {
            self.positions.push(position);
        }
        place
    }

    fn finish(self) -> Result<MeshAsset, Problem> {
        if self.triangles.is_empty() {
            return Err("has no facets; export it as a mesh".into());
        }
        let origin = middle_of_far(|axis| self.positions.iter().map(move |p| p[axis]));
        let mut report = self.notes;
        report.push(
            "an STL file states no unit: one unit is 1 m times the mesh's scale (0.001 for millimetres)".to_owned(),
        );
        if self.has_attributes {
            report.push("attributes of facets (colours) are not used: give the object a material".to_owned());
        }
        Ok(MeshAsset {
            origin,
            positions: self.positions.iter().map(|p| relative(*p, origin)).collect(),
            slots: vec![0; self.triangles.len()],
            triangles: self.triangles,
            slot_materials: vec![SlotMaterial { name: String::new(), surface: None }],
            report,
            ..MeshAsset::default()
        })
    }
}

fn truncated() -> Problem {
    "the file ends within a facet: it is truncated; export or copy it again".into()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLES: [[[f32; 3]; 3]; 2] =
        [[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.]], [[0., 0., 0.], [1., 1., 0.], [0., 1., -0.]]];

    fn binary(header: &[u8]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((TRIANGLES.len() as u32).to_le_bytes());
        for triangle in TRIANGLES {
            bytes.extend([0.0_f32, 0.0, 1.0].iter().chain(triangle.as_flattened()).flat_map(|v| v.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn text() -> String {
        let facet = |corners: &[[f32; 3]; 3]| {
            let vertices: String = corners.iter().map(|[x, y, z]| format!("   vertex {x} {y:e} {z}\n")).collect();
            format!(" facet normal 0 0 1\n  outer loop\n{vertices}  endloop\n endfacet\n")
        };
        format!("solid a\n{}endsolid a\n", TRIANGLES.iter().map(facet).collect::<String>())
    }

    fn read(bytes: &[u8]) -> Result<MeshAsset, String> {
        let place = tempfile::tempdir().expect("temporary folder");
        let file = place.path().join("a.STL");
        std::fs::write(&file, bytes).expect("written");
        read_stl(&file).map_err(|error| error.to_string().replace(&format!("{}/", place.path().display()), ""))
    }

    #[test]
    fn all_forms_are_one_mesh() {
        let square = [[0, 1, 2], [0, 2, 3]];
        let mut longer = binary(b"");
        longer.extend(b"tail");
        for bytes in
            [binary(b"x"), binary(b"solid exported"), text().into_bytes(), text().replace('\n', "\r\n").into(), longer]
        {
            let mesh = read(&bytes).expect("readable");
            assert_eq!((mesh.positions.len(), &mesh.triangles[..]), (4, &square[..]));
            assert!(mesh.report.iter().any(|note| note.contains("states no unit")), "{:?}", mesh.report);
        }
    }

    #[test]
    fn damage_is_named() {
        let complete = binary(b"x");
        let message = read(&complete[..complete.len() - 1]).expect_err("cut");
        assert_eq!(message, "a.STL: has 1 facets, but 2 are stated: it is truncated, or not an STL file");
        let mut infinite = binary(b"x");
        infinite[HEAD + 12..HEAD + 16].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(read(&infinite).expect_err("NaN").starts_with("a.STL: facet 0: a coordinate is not finite"));
        assert_eq!(
            read(text().replacen("vertex 1", "vertex nan", 1).as_bytes()),
            Err("a.STL:5: `nan` is not finite; expected a finite number".to_owned())
        );
        let cut = &text()[..text().find("endloop").expect("the end")];
        assert_eq!(
            read(cut.as_bytes()),
            Err("a.STL:7: the file ends within a facet: it is truncated; export or copy it again".to_owned())
        );
        assert!(read(b"solid a\nendsolid a\n").expect_err("empty").contains("no facets"));
    }
}
