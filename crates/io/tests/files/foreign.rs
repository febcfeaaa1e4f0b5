//! Files that trimesh and Pillow wrote (`tests/oracles/foreign_files.py`), compared with what these programs read.

use std::fs;
use std::path::{Path, PathBuf};

use etendue_io::mesh::read_mesh;
use etendue_io::picture::read_image;
use etendue_scene::asset::ImagePixels;
use glam::DVec3;
use serde_json::Value;

fn oracle(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/foreign").join(name)
}

fn figures(kind: &str) -> serde_json::Map<String, Value> {
    let figures: Value = serde_json::from_slice(&fs::read(oracle("figures.json")).expect("figures")).expect("JSON");
    figures[kind].as_object().expect("an object").clone()
}

/// Coordinates of up to 31 mm have 32 bits: 2e-6 mm of rounding, over areas of 6200 mm² and a volume of 30 000 mm³ with sides of 50 mm.
#[test]
fn stl_files_have_the_figures_of_trimesh() {
    for (name, figures) in figures("meshes") {
        let mesh = read_mesh(&oracle(&name)).unwrap_or_else(|error| panic!("{error}"));
        let number = |key: &str| figures[key].as_f64().expect("a figure");
        assert_eq!(
            (mesh.positions.len() as f64, mesh.triangles.len() as f64),
            (number("vertices"), number("triangles"))
        );
        let place = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from));
        let corners: Vec<[DVec3; 3]> = mesh.triangles.iter().map(|t| t.map(place)).collect();
        let area: f64 = corners.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum();
        let volume: f64 = corners.iter().map(|[a, b, c]| a.cross(*b).dot(*c) / 6.0).sum();
        assert!(
            (area - number("area")).abs() < 1e-2 && (volume - number("volume")).abs() < 0.1,
            "{name}: {area} {volume}"
        );
        for (i, pick) in [DVec3::min as fn(DVec3, DVec3) -> DVec3, DVec3::max].into_iter().enumerate() {
            let bound = corners.iter().flatten().copied().reduce(pick).expect("corners").to_array();
            for (axis, coordinate) in bound.into_iter().enumerate() {
                let expected = figures["bounds"][i][axis].as_f64().expect("a bound");
                assert!((coordinate - expected).abs() < 1e-5, "{name}: {coordinate} for {expected}");
            }
        }
    }
}

#[test]
fn images_have_the_pixels_of_pillow() {
    for (name, figures) in figures("images") {
        let image = read_image(&oracle(&name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(figures["size"], serde_json::json!([image.width, image.height]), "{name}");
        let actual: Vec<Vec<u8>> = match image.pixels {
            ImagePixels::Gray8(pixels) => pixels.iter().map(|g| vec![*g; 3]).collect(),
            ImagePixels::Rgb8(pixels) => pixels.iter().map(|p| p.to_vec()).collect(),
            ImagePixels::Rgba8(pixels) => pixels.iter().map(|p| p.to_vec()).collect(),
            other => panic!("{name}: {other:?}"),
        };
        assert_eq!(figures["pixels"], serde_json::json!(actual), "{name}");
    }
}
