//! The scene: inks as materials, even light from everywhere or none.

use crate::drawing::Drawing;
use crate::ink::{Ink, Paint};
use crate::light::Light;
use etendue_spectra::Spectrum;
use glam::DVec2;
use std::fmt::Write as _;

/// The scene file.
pub(super) fn scene(drawing: &Drawing, light: &Light) -> String {
    let mut text = String::from("format = 1\n");
    if drawing.lit {
        let _ = write!(
            text,
            "\n# The same from everywhere: a matt surface of reflectance R has the luminance R times this.\n[environment]\ntype = \
             \"uniform\"\n{}",
            level(light, 1.0, "\n")
        );
        text.push('\n');
    }
    for texture in &drawing.textures {
        let (scale, offset) = mapping(drawing.panels[texture.panel].sheet.size_mm, texture.place_mm);
        let _ = write!(
            text,
            "\n[[textures]]\nname = \"{}\"\nfile = \"{}\"\nencoding = \"linear\"\nwrap = \"mirror\"\nuv_scale = {scale:?}\nuv_offset = {offset:?}\n",
            texture.name, texture.file
        );
    }
    for ink in &drawing.inks {
        let _ = write!(text, "\n[[materials]]\nname = \"{}\"\n{}\n", ink.name, material(ink, drawing, light));
    }
    for panel in &drawing.panels {
        let (name, [x, y, z]) = (&panel.name, panel.position_m.to_array());
        let _ = write!(
            text,
            "\n[[meshes]]\nname = \"{name}\"\nfile = \"{name}.obj\"\nup_axis = \"z\"\n\n[[objects]]\nname = \"{name}\"\nmesh = \
             \"{name}\"\nposition_m = [{x}, {y}, {z}]\nmaterials = {{ {} }}\n",
            materials(drawing, panel)
        );
    }
    text
}

/// How often a picture stands along a sheet's u and v, and where in the picture the sheet's lower left corner lies.
fn mapping(size_mm: DVec2, (low, high): (DVec2, DVec2)) -> ([f64; 2], [f64; 2]) {
    let scale = size_mm / (high - low);
    // The sheet's left and lower edges, from the picture's left and lower ones; y runs down.
    let corner = DVec2::new(-size_mm.x / 2.0 - low.x, high.y - size_mm.y / 2.0);
    (scale.to_array(), (corner / (high - low)).to_array())
}

/// A luminance in the light's colour, its keys parted by `between`.
fn level(light: &Light, share: f64, between: &str) -> String {
    format!("luminance_cd_m2 = {}{between}illuminant = \"{}\"", share * light.luminance_cd_m2(), light.name())
}

fn material(ink: &Ink, drawing: &Drawing, light: &Light) -> String {
    match &ink.paint {
        Paint::Grey(reflectance) => format!("type = \"diffuse\"\nreflectance = {reflectance}"),
        Paint::Spectral(_) => format!("type = \"diffuse\"\nreflectance = {{ spectrum = \"{}\" }}", spectrum_file(ink)),
        Paint::Texture { texture, .. } => {
            format!("type = \"diffuse\"\nreflectance = {{ texture = \"{}\" }}", drawing.textures[*texture].name)
        }
        Paint::Glow(share) => format!("type = \"emitter\"\nemission = {{ {} }}", level(light, *share, ", ")),
    }
}

/// The inks that a panel shows, each as itself.
fn materials(drawing: &Drawing, panel: &crate::panel::Panel) -> String {
    use crate::shape::Fill;
    let number = drawing.panels.iter().position(|p| p.name == panel.name);
    let shown = |i: &usize| {
        let printed = panel.sheet.pieces.iter().any(|piece| piece.fill == Fill::Ink(*i));
        printed || drawing.cavities.iter().any(|c| Some(c.panel) == number && c.ink == *i)
    };
    let names = (0..drawing.inks.len()).filter(shown).map(|i| &drawing.inks[i].name);
    names.map(|name| format!("\"{name}\" = \"{name}\"")).collect::<Vec<_>>().join(", ")
}

/// The files of measured reflectances.
pub(super) fn spectra(drawing: &Drawing) -> Vec<(String, String)> {
    let of = |ink: &Ink| match &ink.paint {
        Paint::Spectral(reflectance) => Some((spectrum_file(ink), csv(reflectance))),
        _ => None,
    };
    drawing.inks.iter().filter_map(of).collect()
}

fn spectrum_file(ink: &Ink) -> String {
    format!("{}.csv", ink.name)
}

/// Every nanometre that the table covers; its end values hold beyond.
fn csv(reflectance: &Spectrum) -> String {
    let (first, last) = reflectance.covered_nm();
    let rows = (first.ceil() as u32..=last.floor() as u32).map(|nm| format!("{nm},{}\n", reflectance.at(nm as f32)));
    std::iter::once("wavelength_nm,reflectance\n".to_owned()).chain(rows).collect()
}
