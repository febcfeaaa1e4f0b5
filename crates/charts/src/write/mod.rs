//! A drawing as files: meshes, scene, cameras, job, ground truth, print.

mod job;
mod obj;
mod picture;
mod scene;
mod truth;

use job::{print_name, print_of};

pub use job::{ChartFile, ChartSpecification, Contents, camera_file};
pub use picture::chart_image;

/// The files of a chart.
#[must_use]
pub fn files(request: &ChartSpecification<'_>) -> Vec<ChartFile> {
    let text = |name: &str, text: String| ChartFile { name: name.to_owned(), contents: Contents::Text(text) };
    let drawing = request.drawing;
    let mut files = vec![
        text("job.toml", job::job(request)),
        text("scene.toml", scene::scene(drawing, request.light)),
        text("truth.json", truth::truth(request)),
    ];
    if drawing.is_flat() {
        files.push(text("chart.svg", obj::svg(drawing)));
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
