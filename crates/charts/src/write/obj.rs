//! A panel's mesh, Wavefront OBJ, and its print, SVG. The mesh is in metres, with the axes of the world about the panel's centre,
//! one `usemtl` per ink.

use std::{collections::BTreeMap, fmt::Write as _};

use etendue_spectra::colour::encode;
use glam::DVec2;

use crate::drawing::{Cavity, Drawing};
use crate::ink::{Ink, Paint};
use crate::light::Panel;
use crate::shape::{Fill, Piece, Sheet};

/// The mesh of a panel, with the boxes behind its holes.
pub(super) fn mesh(drawing: &Drawing, panel: usize) -> String {
    let mut mesh = ChartMesh { textured: !drawing.textures.is_empty(), ..ChartMesh::default() };
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
struct ChartMesh {
    textured: bool,
    known: BTreeMap<[u64; 3], usize>,
    points: String,
    places: String,
    faces: String,
}

impl ChartMesh {
    /// Adds a piece of the sheet. Seen from its front, faces turn anticlockwise.
    fn piece(&mut self, panel: &Panel, outline: &[DVec2]) {
        let corners: Vec<usize> = outline.iter().rev().map(|point| self.corner(panel, *point, 0.0)).collect();
        self.face(&corners);
    }

    /// Adds a box behind a hole, seen from inside: its walls and its bottom.
    fn cavity(&mut self, panel: &Panel, cavity: &Cavity) {
        let opening: Vec<usize> = cavity.opening_mm.iter().map(|p| self.corner(panel, *p, 0.0)).collect();
        let deep: Vec<usize> = cavity.opening_mm.iter().map(|p| self.corner(panel, *p, cavity.depth_mm)).collect();
        for i in 0..opening.len() {
            let next = (i + 1) % opening.len();
            self.face(&[opening[i], opening[next], deep[next], deep[i]]);
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

    /// Returns the number of a corner, `behind_mm` behind the sheet's plane.
    fn corner(&mut self, panel: &Panel, point_mm: DVec2, behind_mm: f64) -> usize {
        // Adding zero makes −0 and 0 the same corner.
        let key = [point_mm.x + 0.0, point_mm.y + 0.0, behind_mm].map(f64::to_bits);
        let next = self.known.len() + 1;
        let number = *self.known.entry(key).or_insert(next);
        if number == next {
            let at = panel.local_m(point_mm) + panel.rotation.z_axis * (behind_mm / 1e3);
            // Meshes are stored in 32 bits. Adding zero removes the sign of zeros.
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

/// The first sheet as SVG in sRGB. Its first ink covers all of it and the others are on top, each as one path: no seams between
/// pieces of one ink.
pub(super) fn svg(drawing: &Drawing) -> String {
    let sheet = &drawing.panels[0].sheet;
    let DVec2 { x: w, y: h } = sheet.size_mm;
    let (left, top) = (-w / 2.0, -h / 2.0);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"{left} {top} {w} {h}\">\n\
         <rect x=\"{left}\" y=\"{top}\" width=\"{w}\" height=\"{h}\" fill=\"{}\"/>\n",
        colour(&drawing.inks[0])
    );
    for (i, ink) in drawing.inks.iter().enumerate().skip(1) {
        path(&mut text, sheet, Fill::Ink(i), &colour(ink));
    }
    path(&mut text, sheet, Fill::Hole, "#000000");
    for (i, ink) in drawing.inks.iter().enumerate() {
        if let Paint::Texture { texture, .. } = ink.paint {
            svg_images(&mut text, sheet, i, &super::print_name(&drawing.textures[texture]));
        }
    }
    text.push_str("</svg>\n");
    text
}

fn colour(ink: &Ink) -> String {
    let [r, g, b] = ink.print_rgb().map(|v| (encode(v as f32) * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// All pieces of a fill.
fn path(text: &mut String, sheet: &Sheet, fill: Fill, colour: &str) {
    let mut data = String::new();
    for piece in sheet.pieces.iter().filter(|piece| piece.fill == fill) {
        for (n, corner) in piece.outline.iter().enumerate() {
            let _ = write!(data, "{}{:.5} {:.5}", if n == 0 { 'M' } else { 'L' }, corner.x, corner.y);
        }
        data.push('Z');
    }
    if !data.is_empty() {
        let _ = writeln!(text, "<path fill=\"{colour}\" d=\"{data}\"/>");
    }
}

/// A texture over the whole sheet, visible where its ink is; textured pieces are rectangles.
fn svg_images(text: &mut String, sheet: &Sheet, ink: usize, file: &str) {
    for piece in sheet.pieces.iter().filter(|piece| piece.fill == Fill::Ink(ink)) {
        let (low, high) = crate::shape::bounds(&piece.outline);
        let DVec2 { x: w, y: h } = high - low;
        let _ = writeln!(
            text,
            "<image href=\"{file}\" x=\"{}\" y=\"{}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\"/>",
            low.x, low.y
        );
    }
}
