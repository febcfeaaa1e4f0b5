//! Runs the examples and checks their documented results.

#[path = "../../examples/another_lens.rs"]
#[allow(dead_code)]
mod another_lens;
#[path = "../../examples/first_picture.rs"]
#[allow(dead_code)]
mod first_picture;
#[path = "../../examples/measure_chart.rs"]
#[allow(dead_code)]
mod measure_chart;
#[path = "../../examples/own_camera.rs"]
#[allow(dead_code)]
mod own_camera;
#[path = "../../examples/scene_from_arrays.rs"]
#[allow(dead_code)]
mod scene_from_arrays;

#[test]
fn a_first_picture_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = first_picture::run(folder.path()).unwrap_or_else(|error| panic!("{error}"));
    assert!(files.iter().any(|file| file.ends_with("front/picture.0000.png")), "{files:?}");
    assert!(files.iter().all(|file| file.is_file()));
}

#[test]
fn another_lens_photographs_stored_radiance() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = another_lens::run(folder.path()).unwrap_or_else(|error| panic!("{error}"));
    let images: Vec<Vec<u8>> = ["f2.8", "f11"]
        .map(|f| std::fs::read(folder.path().join(f).join("web/picture.0000.png")).expect("a picture"))
        .to_vec();
    assert_ne!(images[0], images[1]);
    assert!(files.iter().all(|file| file.is_file()));
}

#[test]
fn electrons_grow_with_the_area_of_pixels() {
    let electrons = own_camera::run(&[4.0, 8.0]).unwrap_or_else(|error| panic!("{error}"));
    // Uniform illumination: four times the area; 64 samples of a furnace have an error well below a percent.
    let ratio = electrons[1] / electrons[0];
    assert!((ratio / 4.0 - 1.0).abs() < 0.01, "{electrons:?}");
}

#[test]
fn a_chart_gives_the_distortion_that_the_camera_declares() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = measure_chart::run(folder.path()).unwrap_or_else(|error| panic!("{error}"));
    let k1 = report.value("forward_k1").expect("a fit of k1");
    // scenes/cameras/automotive.toml declares k1 = −0.12 in focal lengths of 4.6 mm; the report's unit is the half diagonal.
    let half_diagonal2_mm2 = 0.003 * 0.003 * (960.0 * 960.0 + 600.0 * 600.0);
    let declared = -0.12 * half_diagonal2_mm2 / (4.6 * 4.6);
    let off = (k1.value - declared).abs();
    assert!(off < 4.0 * k1.standard_uncertainty, "{k1:?}, declared {declared}");
    assert!(off < 0.05 * declared.abs(), "{k1:?}, declared {declared}");
}

#[test]
fn a_sheet_from_arrays_has_the_depth_of_its_folds() {
    let depth = scene_from_arrays::run().unwrap_or_else(|error| panic!("{error}"));
    let depths: Vec<f32> = depth.into_iter().filter(|d| d.is_finite()).collect();
    // 5 m minus 0 … 0.2 m: vertices lie on lower edges and ridges, so facets are exact except for roundings of f32.
    assert!(depths.iter().all(|d| (4.799..=5.001).contains(d)), "{depths:?}");
    assert!(depths.iter().any(|d| *d < 4.81) && depths.iter().any(|d| *d > 4.99), "{depths:?}");
}
