//! Lenses from files on disk, their results, and unusable lenses: each is reported with file, line and key.

use crate::bad_input::ModifiedJob;
use crate::support::{contents, etendue, text};
use etendue_io::exr::{ExrFile, ExrSamples, read_exr};
use serde_json::Value;
use std::path::Path;

/// The lens of the small job, replaced by tests.
const THIN: &str = "type = \"thin\"\nfocal_length_mm = 6\nf_number = 2\nfocus_distance_m = 5\ntransmittance = 0.9\n\
                    distortion = { k1 = -0.1, k2 = 0.01, direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\" }\n";

/// A biconvex singlet behind its stop, as written by Zemax, CODE V and this project.
const ZMX: &str = "MODE SEQ\nNAME singlet\nUNIT MM X W X CM MR CPMM\nENPD 2.0\nWAVM 1 5.875618E-1 1\nPWAV 1\n\
SURF 0\n  TYPE STANDARD\n  CURV 0.0\n  DISZ INFINITY\n\
SURF 1\n  STOP\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 1.0\n  DIAM 1 1 0 0 1 \"\"\n\
SURF 2\n  TYPE STANDARD\n  CURV 0.05\n  DISZ 2.0\n  GLAS N-BK7 0 0 1.5 4.0E+1 0 0 0 0 0 0\n  DIAM 5 1 0 0 1 \"\"\n\
SURF 3\n  TYPE STANDARD\n  CURV -0.05\n  DISZ 18.0\n  DIAM 5 1 0 0 1 \"\"\n\
SURF 4\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 0\n";
const SEQ: &str = "RDM;LEN       \"VERSION: 11.5\"\nTITLE 'singlet'\nEPD 2.0\nDIM M\nWL 587.5618\nREF 1\nYAN 0.0\n\
SO 0.0 0.1e14\nS 0.0 1.0\n  STO\n  CIR 1\nS 20.0 2.0 NBK7_SCHOTT\n  CIR 5\nS -20.0 18.0\n  CIR 5\nSI 0.0 0.0\nGO\n";
const SURFACES: &str = "surfaces = [\n{ thickness_mm = 1, semi_aperture_mm = 1, stop = true },\n\
{ radius_mm = 20, thickness_mm = 2, semi_aperture_mm = 5, glass = \"N-BK7\" },\n{ radius_mm = -20, semi_aperture_mm = 5 },\n]";

fn prescription(source: &str) -> String {
    format!("type = \"prescription\"\nfocus_distance_m = 2\n{source}\n")
}

fn calibrated(source: &str) -> String {
    format!("type = \"calibrated\"\nf_number = 2\n{source}\n")
}

/// The small job with another lens, without a spectrum, which files of tests do not need.
fn with_lens(lens: &str) -> ModifiedJob {
    let job = ModifiedJob::new();
    job.replace_first("small.toml", THIN, lens);
    for product in ["radiance", "irradiance", "variance"] {
        job.replace_first("small.toml", &format!("{product} = true\n"), "");
    }
    job.replace_first("small.toml", "band_width_nm = 50\n", "");
    job
}

/// The plan's line on a job's lens.
fn lens_line(job: &ModifiedJob) -> String {
    let plan = etendue(["plan", &job.job()]).ok().out;
    plan.lines().find(|line| line.starts_with("  lens ")).expect("a lens").to_owned()
}

#[test]
fn a_prescription_in_a_file_is_the_lens_of_its_surfaces() {
    let in_place = lens_line(&with_lens(&prescription(SURFACES)));
    assert!(in_place.contains("prescription, 19.") && in_place.contains(" at 587.56 nm"), "{in_place}");
    for (name, file) in [("lens.zmx", ZMX), ("lens.seq", SEQ)] {
        // The image distance of the file would otherwise apply.
        let job = with_lens(&prescription(&format!("file = \"{name}\"\ndefocus_mm = 0")));
        job.write(name, file);
        // The files state the d line to four decimals.
        assert_eq!(lens_line(&job).replace(" at 587.5618 nm", " at 587.56 nm"), in_place, "{name}");
    }
}

const KANNALA: &str = "projection = { type = \"kannala_brandt\", fx_px = 25, fy_px = 26, cx_px = 23, cy_px = 14.5, k = [0.01, 0.002, 0, 0] }";
const KALIBR: &str = "cam0:\n  camera_model: pinhole\n  distortion_model: equidistant\n  distortion_coeffs: [0.01, 0.002, 0, 0]\n  \
intrinsics: [25, 26, 22.5, 14]\n  resolution: [46, 30]\n";
const EUROC: &str = "sensor_type: camera\nresolution: [46, 30]\ncamera_model: pinhole\nintrinsics: [25, 26, 22.5, 14]\n\
distortion_model: equidistant\ndistortion_coefficients: [0.01, 0.002, 0, 0]\n";
const CAMODOCAL: &str = "%YAML:1.0\n---\nmodel_type: KANNALA_BRANDT\nimage_width: 46\nimage_height: 30\nprojection_parameters:\n   k2: 0.01\n   \
k3: 0.002\n   mu: 25\n   mv: 26\n   u0: 22.5\n   v0: 14.\n";
const OPENCV: &str = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<fisheye_model>1</fisheye_model>\n<K type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols>\
<dt>d</dt><data>25. 0. 22.5 0. 26. 14. 0. 0. 1.</data></K>\n<D type_id=\"opencv-matrix\"><rows>4</rows><cols>1</cols><dt>d</dt><data>0.01 0.002 0. 0.</data></D>\n\
</opencv_storage>\n";
const ROS: &str = "header:\n  frame_id: front\nheight: 30\nwidth: 46\ndistortion_model: equidistant\nd: [0.01, 0.002, 0, 0]\n\
k: [25, 0, 22.5, 0, 26, 14, 0, 0, 1]\n---\n";
const COLMAP: &str = "1 OPENCV_FISHEYE 46 30 25 26 23 14.5 0.01 0.002 0 0\n";
const F_THETA: &str = "{\"Model\": \"ftheta\", \"width\": 46, \"height\": 30, \"cx\": 22.5, \"cy\": 14, \"polynomial\": \"0 0.04\", \
\"polynomial-type\": \"pixeldistance-to-angle\"}";

/// Renders; returns the side-car and the folder.
fn rendered(job: &ModifiedJob) -> (Value, std::path::PathBuf) {
    let out = job.folder().join("rendered");
    etendue(["render", &job.job(), "-o", &text(&out)]).ok();
    let sidecar = contents(&out)["front/camera.json"].clone();
    (serde_json::from_slice(&sidecar).expect("JSON"), out.join("front"))
}

#[test]
fn a_calibration_in_a_file_is_the_camera_of_its_numbers_and_the_side_car_says_them() {
    let in_place = lens_line(&with_lens(&calibrated(KANNALA)));
    let files = [
        ("camera.yaml", "kalibr", KALIBR),
        ("cameras.txt", "colmap", COLMAP),
        ("sensor.yaml", "euroc", EUROC),
        ("front.yaml", "camodocal", CAMODOCAL),
        ("out_camera_data.xml", "opencv", OPENCV),
        ("message.txt", "ros", ROS),
    ];
    for (name, format, file) in files {
        let job = with_lens(&calibrated(&format!("calibration = {{ file = \"{name}\", format = \"{format}\" }}")));
        job.write(name, file);
        assert_eq!(lens_line(&job), in_place, "{name}");
        let calibration = rendered(&job).0["optics"]["calibration"].clone();
        let projection = &calibration["projection"];
        assert_eq!((projection["type"].as_str(), projection["k"][1].as_f64()), (Some("kannala_brandt"), Some(0.002)));
        assert_eq!((projection["fy_px"].as_f64(), projection["cx_px"].as_f64()), (Some(26.0), Some(23.0)));
        assert!(calibration["convention"].as_str().is_some_and(|text| text.contains("pixel centres at +0.5")));
    }
    let job = with_lens(&calibrated("calibration = { file = \"camera.xml\", format = \"opencv\" }"));
    job.write("camera.xml", OPENCV);
    let plan = etendue(["plan", &job.job()]).ok().out;
    assert!(plan.contains("states no image size; that of the sensor, 46 × 30 px, is assumed"), "{plan}");
    job.write("camera.xml", OPENCV.replace("22.5", "222.5"));
    let rig = etendue(["rig", &job.job(), "-o", &text(&job.folder().join("rig"))]).ok();
    assert!(rig.err.contains("the principal point (223.0, 14.5) px is outside the image"), "{}", rig.err);
    let job = with_lens(&calibrated("calibration = { file = \"rig.json\", format = \"f_theta\" }"));
    job.write("rig.json", F_THETA);
    let line = lens_line(&job);
    assert!(line.contains("calibrated camera, 3 mm"), "25 px per rad of 120 µm: {line}");
}

/// Three channels of a file, pixel by pixel.
fn vectors(file: &ExrFile, names: [&str; 3]) -> Vec<[f64; 3]> {
    let channel = |name: &str| {
        let exr_channel = file.channels.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("no {name}"));
        let ExrSamples::Float(samples) = &exr_channel.samples else { panic!("{name} is not of 32-bit floats") };
        samples.iter().map(|v| f64::from(*v)).collect::<Vec<f64>>()
    };
    let [x, y, z] = names.map(channel);
    x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect()
}

/// Converts every pixel to space by its ray and its distance; returns the number of pixels with a surface.
fn count_surface_points(folder: &Path, pose: &Value) -> usize {
    let (rays, truth) = (read_exr(&folder.join("rays.exr")), read_exr(&folder.join("ground_truth.exr")));
    let (rays, truth) = (rays.expect("readable"), truth.expect("readable"));
    let origins = vectors(&rays, ["origin.X", "origin.Y", "origin.Z"]);
    let directions = vectors(&rays, ["direction.X", "direction.Y", "direction.Z"]);
    let positions = vectors(&truth, ["P.X", "P.Y", "P.Z"]);
    let distances = vectors(&truth, ["distance.Z", "depth.Z", "distance.Z"]);
    let number = |i: usize, j: usize| pose["camera_to_world"][i][j].as_f64().expect("a number");
    let mut surfaces = 0;
    for (((origin, direction), position), distance) in origins.iter().zip(&directions).zip(&positions).zip(&distances) {
        if !distance[0].is_finite() {
            continue;
        }
        surfaces += 1;
        let point: [f64; 3] = std::array::from_fn(|i| origin[i] + distance[0] * direction[i]);
        for (i, position) in position.iter().enumerate() {
            let world = number(i, 3) + (0..3).map(|j| number(i, j) * point[j]).sum::<f64>();
            // Direction, distance and position have a relative rounding of 6e-8.
            assert!((world - position).abs() < 4e-7 * (1.0 + distance[0]), "{world} for {position}");
        }
    }
    surfaces
}

#[test]
fn rays_and_distances_reproduce_every_pixel_also_of_the_rectified_camera() {
    for lens in [calibrated(KANNALA), prescription(SURFACES), THIN.to_owned()] {
        let job = with_lens(&lens);
        job.replace_first("small.toml", "depth_png = true", "depth_png = true\nrays = true\nundistorted = true");
        let (facts, folder) = rendered(&job);
        let of_lens = count_surface_points(&folder, &facts["pose"]);
        let rectified_points = count_surface_points(&folder.join("undistorted"), &facts["pose"]);
        assert!(of_lens > 400 && rectified_points > 400, "{of_lens} and {rectified_points} pixels see a surface");
        let matrix = &facts["undistorted"]["camera_matrix"];
        let principal = facts["sensor"]["principal_point_px"].clone();
        assert_eq!((&matrix[0][2], &matrix[1][2]), (&principal[0], &principal[1]));
        assert!(folder.join("undistorted/picture.0000.png").exists());
    }
}

/// Asserts that the job with such a lens is refused at the line of `key` in the job, with all of `phrases`.
#[track_caller]
fn refused(lens: &str, key: &str, phrases: &[&str]) {
    let job = with_lens(lens);
    let place = job.replace_first("small.toml", key, key);
    let phrases: Vec<&str> =
        [place.as_str(), "cameras.front.lens"].into_iter().chain(phrases.iter().copied()).collect();
    job.render(&[]).refused(&phrases);
}

#[test]
fn surfaces_that_overlap() {
    let lens = prescription(&SURFACES.replace("thickness_mm = 2", "thickness_mm = 0.5"));
    refused(&lens, "{ radius_mm = -20", &["surfaces", "overlap"]);
}

#[test]
fn a_glass_that_no_catalogue_has() {
    refused(&prescription(&SURFACES.replace("N-BK7", "N-BK8")), "{ radius_mm = 20", &["glass", "N-BK8"]);
    let job = with_lens(&prescription("file = \"lens.zmx\""));
    job.write("lens.zmx", ZMX.replace("N-BK7", "N-BK8"));
    job.render(&[]).refused(&["lens.zmx", "N-BK8"]);
}

#[test]
fn total_reflection_of_the_axial_bundle() {
    // A hemisphere of high index, flat side to the light: rays beyond 1/n of the radius are not transmitted.
    let ball = SURFACES
        .replace("semi_aperture_mm = 1, stop", "semi_aperture_mm = 4.5, stop")
        .replace("radius_mm = 20, thickness_mm = 2", "thickness_mm = 6")
        .replace("radius_mm = -20", "radius_mm = -5.5")
        .replace("\"N-BK7\"", "{ index = 1.9 }");
    refused(&prescription(&ball), "{ radius_mm = -5.5", &["totally reflects"]);
}

#[test]
fn a_focus_distance_of_zero_where_infinity_is_legal() {
    for lens in [prescription(SURFACES), calibrated(&format!("focus_distance_m = 2\n{KANNALA}"))] {
        refused(&lens.replace("focus_distance_m = 2", "focus_distance_m = 0"), "focus_distance_m = 0", &["above 0"]);
        let endless = with_lens(&lens.replace("focus_distance_m = 2", "focus_distance_m = \"infinity\""));
        etendue(["plan", &endless.job()]).ok();
    }
}

#[test]
fn a_polynomial_that_folds_inside_the_picture() {
    let folds = KANNALA.replace("[0.01, 0.002, 0, 0]", "[-0.5, 0, 0, 0]");
    refused(&calibrated(&folds), "[cameras.lens]", &["folds the image over at a radius of"]);
    let job = with_lens(&calibrated("calibration = { file = \"camera.yaml\", format = \"kalibr\" }"));
    job.write("camera.yaml", KALIBR.replace("[0.01, 0.002, 0, 0]", "[-0.5, 0, 0, 0]"));
    job.render(&[]).refused(&["small.toml:", "calibration.file", "folds the image over at a radius of"]);
}

#[test]
fn an_impossible_rectified_camera() {
    let with_output = |lens: &str, keys: &str| {
        let job = with_lens(lens);
        job.replace_first("small.toml", "depth_png = true", keys);
        job.render(&[])
    };
    let wide = calibrated("projection = { type = \"equidistant\", fx_px = 12 }");
    with_output(&wide, "undistorted = true").refused(&["small.toml:", "output.undistorted", "85°"]);
    with_output(THIN, "undistorted_scale = 0.5").refused(&["output.undistorted_scale", "undistorted = true"]);
}

/// The report of `measure lens` on a lens file, as JSON.
fn measure_lens(name: &str, file: &str, arguments: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, file).expect("written");
    let path = text(&path);
    let all: Vec<&str> =
        ["measure", "lens", &path, "--fields", "2", "--json"].into_iter().chain(arguments.iter().copied()).collect();
    serde_json::from_str(&etendue(all).ok().out).expect("JSON")
}

fn remarks(report: &Value) -> String {
    report["remarks"].as_array().expect("remarks").iter().filter_map(Value::as_str).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_lens_file_s_image_aperture_and_glasses_are_used_and_reported() {
    for (name, file) in [("lens.zmx", ZMX), ("lens.seq", SEQ)] {
        let report = measure_lens(name, file, &[]);
        assert_eq!(report["sensor_from_last_vertex_mm"].as_f64(), Some(18.0), "{name}");
        assert!(
            remarks(&report).contains("18.0000 mm behind the last vertex, as the file states: -"),
            "{}",
            remarks(&report)
        );
        let focused = measure_lens(name, file, &["--set", "lens.defocus_mm=0"]);
        let paraxial_mm = focused["back_focus_from_last_vertex_mm"].as_f64().expect("a number");
        let sensor_mm = focused["sensor_from_last_vertex_mm"].as_f64().expect("a number");
        assert!(
            (sensor_mm - paraxial_mm).abs() < 1e-9 && remarks(&focused).contains("the file's image is at 18.0000 mm")
        );
    }
    // The entrance pupil opens the stop beyond the radius for drawing, and closes it.
    for (enpd, pupil_mm) in [("ENPD 2.4", 2.4), ("ENPD 1.0", 1.0), ("FLOA", 2.0)] {
        let report = measure_lens("lens.zmx", &ZMX.replace("ENPD 2.0", enpd), &[]);
        let actual = report["entrance_pupil_diameter_mm"].as_f64().expect("a number");
        assert!((actual - pupil_mm).abs() < 1e-9, "{enpd}: {actual}");
        assert_eq!(remarks(&report).contains("its aperture opens the stop"), enpd != "FLOA", "{}", remarks(&report));
    }
    let old = measure_lens("lens.zmx", &ZMX.replace("N-BK7 0 0 1.5 4.0E+1", "SK16 0 0 1.62041 60.32"), &[]);
    assert!(remarks(&old).contains("SK16 is discontinued: its successor N-SK16 is used"), "{}", remarks(&old));
    let closed = measure_lens("lens.zmx", ZMX, &["--f-number", "16"]);
    assert!((closed["f_number"].as_f64().expect("a number") - 16.0).abs() < 1e-9);
    assert!(remarks(&closed).contains("f/16 of the description"), "{}", remarks(&closed));
}

#[test]
fn only_a_file_says_what_is_in_focus() {
    let job = with_lens(&prescription("file = \"lens.zmx\"").replace("focus_distance_m = 2\n", ""));
    job.write("lens.zmx", ZMX);
    let plan = etendue(["plan", &job.job()]).ok().out;
    assert!(plan.contains("lens.zmx: the sensor is 18.0000 mm behind the last vertex, as the file states"), "{plan}");
    refused(
        &prescription(SURFACES).replace("focus_distance_m = 2\n", ""),
        "[cameras.lens]",
        &["focus_distance_m", "missing"],
    );
}
