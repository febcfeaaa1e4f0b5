//! The print: one sheet in real millimetres.

use crate::drawing::Drawing;
use crate::ink::{Ink, Paint};
use crate::shape::{Fill, Sheet};
use etendue_spectra::colour::encode;
use glam::DVec2;
use std::fmt::Write as _;

/// The first sheet as SVG in sRGB. Its first ink covers all of it and the others lie on it, each as one path: where pieces
/// of an ink meet there is no seam.
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
            pictures(&mut text, sheet, i, &super::print_name(&drawing.textures[texture]));
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

/// A texture over all of the sheet, shown where its ink is; textured pieces are rectangles.
fn pictures(text: &mut String, sheet: &Sheet, ink: usize, file: &str) {
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
