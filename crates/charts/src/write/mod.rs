//! A drawing as files: meshes, scene, cameras, job, truth, print.

mod job;
mod obj;
mod picture;
mod scene;
mod svg;
mod truth;

use crate::design::Chart;
use crate::drawing::{Drawing, Texture};
use crate::eye::{Eye, Footprint};
use crate::light::{Light, Meter};
use crate::station::Station;
use etendue_spectra::colour::encode;

pub use picture::picture;

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Contents {
    /// Text.
    Text(String),
    /// A grey picture of 16 bits: columns, rows, values row by row.
    Grey16(usize, usize, Vec<u16>),
}

/// A file and its name below the chart's folder.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartFile {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub contents: Contents,
}

/// Everything that decides a chart's files.
pub struct Request<'a> {
    /// The chart.
    pub chart: &'a Chart,
    /// Its drawing.
    pub drawing: &'a Drawing,
    /// What the camera sees of its plane.
    pub seen: Footprint,
    /// The camera's rays.
    pub eye: &'a Eye<'a>,
    /// What the camera makes of light; `None` without electronics.
    pub meter: Option<&'a Meter<'a>>,
    /// The light.
    pub light: &'a Light,
    /// The cameras of the job.
    pub stations: &'a [Station],
    /// The camera file that the job's cameras build on, as a path from the chart's folder.
    pub camera: &'a str,
    /// Keys that are taken out of it.
    pub remove: &'a [&'a str],
    /// The specimen that all cameras of a series share, where the camera file does not say one.
    pub specimen: Option<u64>,
    /// The seed.
    pub seed: u64,
}

/// The files of a chart.
#[must_use]
pub fn files(request: &Request<'_>) -> Vec<ChartFile> {
    let text = |name: &str, text: String| ChartFile { name: name.to_owned(), contents: Contents::Text(text) };
    let drawing = request.drawing;
    let mut files = vec![
        text("job.toml", job::job(request)),
        text("scene.toml", scene::scene(drawing, request.light)),
        text("truth.json", truth::truth(request)),
    ];
    if drawing.is_flat() {
        files.push(text("chart.svg", svg::svg(drawing)));
    }
    let meshes = drawing.panels.iter().enumerate();
    files.extend(meshes.map(|(i, panel)| text(&format!("{}.obj", panel.name), obj::mesh(drawing, i))));
    files.extend(scene::spectra(drawing).into_iter().map(|(name, csv)| text(&name, csv)));
    if drawing.is_flat() {
        files.extend(drawing.textures.iter().map(print_of));
    }
    for texture in &drawing.textures {
        if files.iter().all(|file| file.name != texture.file) {
            let contents = Contents::Grey16(texture.width, texture.height, texture.values.clone());
            files.push(ChartFile { name: texture.file.clone(), contents });
        }
    }
    let lit = request.stations.iter().filter(|station| !station.dark);
    for station in lit {
        let name = job::camera_file(station);
        if files.iter().all(|file| file.name != name) {
            files.push(text(&name, job::camera(request, station)));
        }
    }
    files
}

/// A texture encoded as sRGB, for the print.
fn print_of(texture: &Texture) -> ChartFile {
    let encoded = |v: &u16| (encode(f32::from(*v) / 65_535.0) * 65_535.0).round() as u16;
    let values = texture.values.iter().map(encoded).collect();
    ChartFile { name: print_name(texture), contents: Contents::Grey16(texture.width, texture.height, values) }
}

/// The file's name of a texture for the print.
fn print_name(texture: &Texture) -> String {
    format!("{}-print.png", texture.name)
}
