//! A panel's mesh: Wavefront OBJ, metres, axes of the world about the panel's middle, one `usemtl` an ink.

use crate::drawing::{Cavity, Drawing};
use crate::panel::Panel;
use crate::shape::{Fill, Piece};
use glam::DVec2;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The mesh of a panel, with the boxes behind its holes.
pub(super) fn mesh(drawing: &Drawing, panel: usize) -> String {
    let mut mesh = Mesh { textured: !drawing.textures.is_empty(), ..Mesh::default() };
    let own = &drawing.panels[panel];
    for (ink, name) in drawing.inks.iter().map(|ink| &ink.name).enumerate() {
        let pieces: Vec<&Piece> = own.sheet.pieces.iter().filter(|piece| piece.fill == Fill::Ink(ink)).collect();
        let boxes: Vec<&Cavity> = drawing.cavities.iter().filter(|c| c.panel == panel && c.ink == ink).collect();
        if !pieces.is_empty() || !boxes.is_empty() {
            let _ = writeln!(mesh.faces, "usemtl {name}");
        }
        pieces.iter().for_each(|piece| mesh.piece(own, &piece.outline));
        boxes.iter().for_each(|cavity| mesh.cavity(own, cavity));
    }
    format!("# {}: metres, x forward, y left, z up\n{}{}{}", own.name, mesh.points, mesh.places, mesh.faces)
}

#[derive(Default)]
struct Mesh {
    textured: bool,
    known: BTreeMap<[u64; 3], usize>,
    points: String,
    places: String,
    faces: String,
}

impl Mesh {
    /// A piece of the sheet. As seen from its front, faces turn anticlockwise.
    fn piece(&mut self, panel: &Panel, outline: &[DVec2]) {
        let corners: Vec<usize> = outline.iter().rev().map(|point| self.corner(panel, *point, 0.0)).collect();
        self.face(&corners);
    }

    /// A box behind a hole, seen from inside: its walls and its bottom.
    fn cavity(&mut self, panel: &Panel, cavity: &Cavity) {
        let rim: Vec<usize> = cavity.opening_mm.iter().map(|p| self.corner(panel, *p, 0.0)).collect();
        let deep: Vec<usize> = cavity.opening_mm.iter().map(|p| self.corner(panel, *p, cavity.depth_mm)).collect();
        for i in 0..rim.len() {
            let next = (i + 1) % rim.len();
            self.face(&[rim[i], rim[next], deep[next], deep[i]]);
        }
        let bottom: Vec<usize> = deep.iter().rev().copied().collect();
        self.face(&bottom);
    }

    fn face(&mut self, corners: &[usize]) {
        self.faces.push('f');
        for corner in corners {
            let _ = match self.textured {
                true => write!(self.faces, " {corner}/{corner}"),
                false => write!(self.faces, " {corner}"),
            };
        }
        self.faces.push('\n');
    }

    /// The number of a corner, `behind_mm` behind the sheet's plane.
    fn corner(&mut self, panel: &Panel, point_mm: DVec2, behind_mm: f64) -> usize {
        // Adding zero makes −0 and 0 the same corner.
        let key = [point_mm.x + 0.0, point_mm.y + 0.0, behind_mm].map(f64::to_bits);
        let next = self.known.len() + 1;
        let number = *self.known.entry(key).or_insert(next);
        if number == next {
            let at = panel.local_m(point_mm) + panel.rotation.z_axis * (behind_mm / 1e3);
            // Meshes are kept in 32 bits. Adding zero takes the sign from zeros.
            let [x, y, z] = at.as_vec3().to_array().map(|v| v + 0.0);
            let _ = writeln!(self.points, "v {x} {y} {z}");
            if self.textured {
                let place = point_mm / panel.sheet.size_mm + 0.5;
                let _ = writeln!(self.places, "vt {} {}", place.x as f32, (1.0 - place.y) as f32);
            }
        }
        number
    }
}
