//! Wavefront OBJ and MTL text, in whole millimetres.

use crate::mesh::{Corner, Mesh, key};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// What an MTL file says of a material: a name and a display colour, for viewers. The scene's TOML says what the
/// surface is.
#[derive(Clone, Copy, Debug)]
pub struct Swatch {
    /// The slot's name.
    pub name: &'static str,
    /// Its diffuse colour, linear.
    pub colour: [f64; 3],
}

/// The OBJ text of a mesh. Normals are written when a face is smooth, texture coordinates when one is not zero.
#[must_use]
pub fn obj(mesh: &Mesh, library: &str) -> String {
    let mut writer = Writer::new(mesh);
    let mut faces = String::new();
    for (slot, name) in mesh.slots.iter().enumerate() {
        let _ = writeln!(faces, "usemtl {name}");
        writer.faces_of(mesh, slot, &mut faces);
    }
    format!("mtllib {library}\n{}{}{}{faces}", writer.positions.text, writer.uvs.text, writer.normals.text)
}

/// The MTL text of the materials that a mesh uses.
#[must_use]
pub fn mtl(swatches: &[Swatch]) -> String {
    let mut text = String::from("# Display colours only; the scene's TOML describes the surfaces.\n");
    for Swatch { name, colour: [r, g, b] } in swatches {
        let _ = writeln!(text, "newmtl {name}\nKd {} {} {}", number(*r), number(*g), number(*b));
    }
    text
}

struct Writer {
    positions: Table,
    uvs: Table,
    normals: Table,
    corner_normals: Option<Vec<Vec<DVec3>>>,
    has_uvs: bool,
}

impl Writer {
    fn new(mesh: &Mesh) -> Self {
        let corners = || mesh.polygons.iter().flat_map(|polygon| &polygon.corners);
        Self {
            positions: Table::new("v"),
            uvs: Table::new("vt"),
            normals: Table::new("vn"),
            corner_normals: mesh.polygons.iter().any(|polygon| polygon.smooth).then(|| mesh.corner_normals()),
            has_uvs: corners().any(|corner| corner.uv != DVec2::ZERO),
        }
    }

    fn faces_of(&mut self, mesh: &Mesh, slot: usize, text: &mut String) {
        for (index, polygon) in mesh.polygons.iter().enumerate().filter(|(_, polygon)| polygon.slot == slot) {
            text.push('f');
            for (at, corner) in polygon.corners.iter().enumerate() {
                let normal = self.corner_normals.as_ref().map(|normals| normals[index][at]);
                self.corner(corner, normal, text);
            }
            text.push('\n');
        }
    }

    fn corner(&mut self, corner: &Corner, normal: Option<DVec3>, text: &mut String) {
        let v = self.positions.index(&key(corner.position));
        let vt = self.has_uvs.then(|| self.uvs.index(&corner.uv.to_array().map(thousandths)));
        let vn = normal.map(|normal| self.normals.index(&normal.to_array().map(thousandths)));
        let _ = match (vt, vn) {
            (None, None) => write!(text, " {v}"),
            (Some(vt), None) => write!(text, " {v}/{vt}"),
            (None, Some(vn)) => write!(text, " {v}//{vn}"),
            (Some(vt), Some(vn)) => write!(text, " {v}/{vt}/{vn}"),
        };
    }
}

/// Lines of numbers, each written once.
struct Table {
    word: &'static str,
    known: BTreeMap<Vec<i64>, usize>,
    text: String,
}

impl Table {
    fn new(word: &'static str) -> Self {
        Self { word, known: BTreeMap::new(), text: String::new() }
    }

    fn index(&mut self, thousandths: &[i64]) -> usize {
        if let Some(&index) = self.known.get(thousandths) {
            return index;
        }
        self.known.insert(thousandths.to_vec(), self.known.len() + 1);
        self.text.push_str(self.word);
        for &value in thousandths {
            let _ = write!(self.text, " {}", number(value as f64 / 1000.0));
        }
        self.text.push('\n');
        self.known.len()
    }
}

fn thousandths(x: f64) -> i64 {
    (x * 1000.0).round() as i64
}

/// A number with at most three decimals, without trailing zeros.
#[must_use]
pub fn number(x: f64) -> String {
    let text = format!("{x:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { String::from("0") } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([1.0, -0.0001, 0.25, -12.3456].map(number), ["1", "0", "0.25", "-12.346"]);
    }

    #[test]
    fn a_block_shares_its_corners() {
        let mut mesh = Mesh::default();
        mesh.block("stone", DVec3::ZERO, DVec3::ONE);
        let text = obj(&mesh, "a.mtl");
        assert_eq!(text.lines().filter(|line| line.starts_with("v ")).count(), 8);
        assert_eq!(text.lines().filter(|line| line.starts_with("f ")).count(), 6);
    }
}
