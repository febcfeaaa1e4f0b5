//! A scene from arrays: a folded sheet made in code, and its depth as an array.
//!
//! `cargo run --release -p etendue --example scene_from_arrays`

// A program prints; the library does not.
#![allow(clippy::print_stdout)]

use etendue::{Error, JobRequest, MemoryFiles, MeshTriangles, NullObserver, RenderOptions};

/// Vertices along each side of the sheet.
const SIDE: u32 = 65;

/// The job: a sheet 4 m wide in folds 0.2 m high and 1 m apart, seen by a pinhole 5 m above it.
const JOB: &str = r#"
format = 1

[[scene.materials]]
name = "clay"
type = "diffuse"
reflectance = 0.4

[[scene.meshes]]
name = "sheet"
file = "sheet.obj"
up_axis = "z"

[[scene.objects]]
name = "sheet"
mesh = "sheet"
material = "clay"

[scene.environment]
type = "uniform"
luminance_cd_m2 = 1000
illuminant = "D65"

[[cameras]]
name = "above"
position_m = [0, 0, 5]
look_at_m = [0, 0, 0]
up = [0, 1, 0]

[cameras.lens]
type = "pinhole"
focal_length_mm = 4
f_number = 8

[cameras.sensor]
width_px = 64
height_px = 64
pixel_pitch_um = 40

[render]
spp = 4
"#;

/// Depth of the middle row of pixels, m.
pub(crate) fn run() -> Result<Vec<f32>, Error> {
    let place = |i: u32| 4.0 * (i as f32 / (SIDE - 1) as f32) - 2.0;
    let vertex = |i: u32| {
        let (x, y) = (place(i % SIDE), place(i / SIDE));
        // Up and down along x: 0 at the lower edges of the folds, 0.2 on their ridges.
        [x, y, 0.2 * (1.0 - 2.0 * (x.rem_euclid(1.0) - 0.5).abs())]
    };
    let positions: Vec<[f32; 3]> = (0..SIDE * SIDE).map(vertex).collect();
    let cells = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column));
    let triangles: Vec<[u32; 3]> =
        cells.flat_map(|i| [[i, i + 1, i + SIDE + 1], [i, i + SIDE + 1, i + SIDE]]).collect();

    let mut files = MemoryFiles::new();
    files.add_text("job.toml", JOB);
    let mesh = MeshTriangles { positions: &positions, triangles: &triangles, ..MeshTriangles::default() };
    files.add_mesh("sheet.obj", &mesh)?;
    let results = JobRequest::new("job.toml").open_in(&files)?.render(&RenderOptions::default(), &NullObserver)?;
    let depth = results.cameras()[0].ground_truth().depth;
    Ok(depth.samples()[32 * 64..33 * 64].to_vec())
}

fn main() -> Result<(), Error> {
    run()?.chunks(8).for_each(|row| println!("{row:.3?}"));
    Ok(())
}
