//! The scene: inks as materials, uniform light from all directions or none.

use etendue_core::ExactTime;
use etendue_scene::record::light::modulation::{ModulationTiming, PwmModulation};
use etendue_scene::record::material::{Diffuse, Emitter};
use etendue_scene::record::texture::{Encoding, Wrap};
use etendue_scene::record::{
    self, Body, Colour, Emission, Environment, Level, LightColour, Material, Mesh, Object, Reflectance, Scene, Surface,
    SurfaceEmission, Transform,
};
use etendue_scene::{record::light::Modulation, record::mesh::Axis, written::File};
use etendue_spectra::Spectrum;
use glam::DVec2;

use crate::drawing::{Drawing, Texture};
use crate::ink::{Ink, Paint};
use crate::light::{Light, Panel};
use crate::shape::Fill;

/// The scene file.
pub(super) fn scene(drawing: &Drawing, light: &Light) -> String {
    let texture = |texture: &Texture| self::texture(texture, drawing);
    let scene = Scene {
        meshes: drawing.panels.iter().map(mesh).collect(),
        textures: drawing.textures.iter().map(texture).collect(),
        materials: drawing.inks.iter().map(|ink| material(ink, drawing, light)).collect(),
        objects: drawing.panels.iter().map(|panel| object(panel, drawing)).collect(),
        environment: drawing.is_illuminated.then(|| Environment::Uniform(emission(light, 1.0))),
        ..Scene::default()
    };
    let comment = "Equal from all directions: a diffuse surface of reflectance R has R times this luminance.";
    File::new(scene.to_table()).above("environment", comment).to_string()
}

fn texture(texture: &Texture, drawing: &Drawing) -> record::Texture {
    let (scale, offset) =
        mapping(drawing.panels[texture.panel].sheet.size_mm, texture.position_mm.0, texture.position_mm.1);
    record::Texture {
        wrap: Some(Wrap::Mirror.into()),
        uv_scale: Some(scale.into()),
        uv_offset: Some(offset.into()),
        ..record::Texture::new(texture.name.as_str(), texture.file.as_str(), Encoding::Linear)
    }
}

fn mesh(panel: &Panel) -> Mesh {
    let file = format!("{}.obj", panel.name);
    Mesh { up_axis: Some(Axis::Z.into()), ..Mesh::new(panel.name.as_str(), file.as_str()) }
}

fn object(panel: &Panel, drawing: &Drawing) -> Object {
    let position_m = Some(panel.position_m.to_array().into());
    let transform = Transform { position_m, ..Transform::default() };
    let materials = shown(drawing, panel).map(|name| (name.into(), name.into())).collect();
    Object { materials, ..Object::new(panel.name.as_str(), Body::Mesh(panel.name.as_str().into()), transform) }
}

/// Number of repetitions of an image along a sheet's u and v, and position of the sheet's lower left corner in the image.
fn mapping(size_mm: DVec2, low: DVec2, high: DVec2) -> ([f64; 2], [f64; 2]) {
    let scale = size_mm / (high - low);
    // The sheet's left and lower edges relative to the image's; y points down.
    let corner = DVec2::new(-size_mm.x / 2.0 - low.x, high.y - size_mm.y / 2.0);
    (scale.to_array(), (corner / (high - low)).to_array())
}

/// Emission of a fraction of the light.
fn emission(light: &Light, fraction: f64) -> Emission {
    let level = Level::Luminance((fraction * light.luminance_cd_m2()).into());
    Emission { colour: Some(LightColour::Illuminant(light.name().into())), ..Emission::new(level) }
}

fn material(ink: &Ink, drawing: &Drawing, light: &Light) -> Material {
    let name = ink.name.as_str();
    let diffuse = |reflectance| Material::new(name, Surface::Diffuse(Diffuse::new(reflectance)));
    match &ink.paint {
        Paint::Grey(reflectance) => diffuse(Reflectance::Plain(Colour::Grey((*reflectance).into()))),
        Paint::Spectral(_) => diffuse(Reflectance::Plain(Colour::Spectrum(spectrum_file(ink).as_str().into()))),
        Paint::Texture { texture, .. } => {
            diffuse(Reflectance::Texture { name: drawing.textures[*texture].name.as_str().into(), scale: None })
        }
        Paint::Luminous(fraction) => glowing(name, SurfaceEmission::new(emission(light, *fraction))),
        Paint::Pulses { fraction, frequency_hz, duty, delay_s } => {
            let timing =
                ModulationTiming { delay_s: Some(ExactTime::from(*delay_s).into()), ..ModulationTiming::default() };
            let modulation = Some(Modulation::Pwm(PwmModulation::new(*frequency_hz, *duty, timing)));
            glowing(name, SurfaceEmission { modulation, ..SurfaceEmission::new(emission(light, *fraction)) })
        }
    }
}

fn glowing(name: &str, emission: SurfaceEmission) -> Material {
    Material { emission: Some(emission), ..Material::new(name, Surface::Emitter(Emitter::default())) }
}

/// The names of the inks that a panel shows, mapped to themselves.
fn shown<'a>(drawing: &'a Drawing, panel: &Panel) -> impl Iterator<Item = &'a str> {
    let number = drawing.panels.iter().position(|p| p.name == panel.name);
    let is_shown = |i: &usize| {
        let printed = panel.sheet.pieces.iter().any(|piece| piece.fill == Fill::Ink(*i));
        printed || drawing.cavities.iter().any(|c| Some(c.panel) == number && c.ink == *i)
    };
    let shown: Vec<usize> = (0..drawing.inks.len()).filter(is_shown).collect();
    shown.into_iter().map(|i| drawing.inks[i].name.as_str())
}

/// The files of measured reflectances.
pub(super) fn spectra(drawing: &Drawing) -> Vec<(String, String)> {
    let spectrum_entry = |ink: &Ink| match &ink.paint {
        Paint::Spectral(reflectance) => Some((spectrum_file(ink), csv(reflectance))),
        _ => None,
    };
    drawing.inks.iter().filter_map(spectrum_entry).collect()
}

fn spectrum_file(ink: &Ink) -> String {
    format!("{}.csv", ink.name)
}

/// One row per nanometre that the table covers; its end values apply beyond.
fn csv(reflectance: &Spectrum) -> String {
    let (first, last) = reflectance.covered_nm();
    let rows = (first.ceil() as u32..=last.floor() as u32).map(|nm| format!("{nm},{}\n", reflectance.at(nm as f32)));
    std::iter::once("wavelength_nm,reflectance\n".to_owned()).chain(rows).collect()
}
