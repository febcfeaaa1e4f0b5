//! Tables exported by lens programs, of distortion and of modulation, determine a camera, and invalid ones are reported.

use crate::black_boxes::{irradiance, job, plan};
use crate::support::{etendue, text};
use etendue_core::maths::f64::{atan2, exp, tan};
use etendue_io::exr::{ExrSamples, read_exr};
use std::path::Path;

const FOCAL_MM: f64 = 6.0;

/// Modelled distortion: a barrel of 0.08 tan² θ, or of 0.1 θ².
fn distortion(theta: bool, angle: f64) -> f64 {
    if theta { -0.1 * angle * angle } else { -0.08 * tan(angle) * tan(angle) }
}

fn radius_mm(theta: bool, angle: f64) -> f64 {
    FOCAL_MM * if theta { angle } else { tan(angle) } * (1.0 + distortion(theta, angle))
}

/// An export of field curvature and distortion as written by OpticStudio: two wavelengths, the second without distortion.
fn export(theta: bool, says_focal_length: bool) -> String {
    let kind = if theta { "F-Theta" } else { "F-Tan(Theta)" };
    let table = |um: f64, weight: f64, focal_mm: f64| {
        let focal_length =
            if says_focal_length { format!("Distortion focal length = {focal_mm:.6}\r\n") } else { String::new() };
        let row = |degrees: u32| {
            let degrees = f64::from(degrees);
            let angle = degrees.to_radians();
            let reference = FOCAL_MM * if theta { angle } else { tan(angle) };
            let percent = 100.0 * weight * distortion(theta, angle);
            let real = reference * (1.0 + 0.01 * percent);
            format!(" {degrees:.8}E+000  -1.0E-002  -2.0E-002  {real:.8}  {reference:.8}  {percent:.8} %\r\n")
        };
        let rows: String = (0..=40).map(row).collect();
        format!(
            "Data for wavelength : {um:.6} µm.\r\n{focal_length}\r\n Y Angle (deg)   Tan Shift   Sag Shift   Real Height   Ref. Height   Distortion\r\n{rows}\r\n"
        )
    };
    format!(
        "Field Curvature and {kind} Distortion Data\r\n\r\nFile : C:\\lenses\\made for a test.zmx\r\nDate : 1/1/2026\r\n\r\nMaximum field is 40.000 Degrees.\r\n\r\n{}{}",
        table(0.6563, 0.0, 1.01 * FOCAL_MM),
        table(0.55, 1.0, FOCAL_MM)
    )
}

const SENSOR: &str = "width_px = 121, height_px = 3, pixel_pitch_um = 60";

fn calibrated(projection: &str) -> String {
    format!("type = \"calibrated\"\nf_number = 2\nprojection = {{ type = \"table\", {projection} }}")
}

/// Viewing angle of each pixel of the middle row from the axis, rad, and its position, mm.
fn angles(folder: &Path, job: &str) -> Vec<(f64, f64)> {
    std::fs::write(folder.join("job.toml"), job).expect("written");
    let out = folder.join("out");
    etendue(["render", &text(&folder.join("job.toml")), "-o", &text(&out), "--overwrite"]).ok();
    let file = read_exr(&out.join("eye/rays.exr")).expect("readable");
    let axis = |name: &str| {
        let channel = file.channels.iter().find(|channel| channel.name == name).expect("a direction");
        let ExrSamples::Float(samples) = &channel.samples else { panic!("not of 32-bit floats") };
        samples[121..242].iter().map(|v| f64::from(*v)).collect::<Vec<_>>()
    };
    let [x, y, z] = ["direction.X", "direction.Y", "direction.Z"].map(axis);
    (0..121).map(|i| (atan2((x[i] * x[i] + y[i] * y[i]).sqrt(), z[i]), (i as f64 - 60.0).abs() * 0.06)).collect()
}

#[test]
fn pixels_look_where_zemax_s_distortion_says() {
    let folder = tempfile::tempdir().expect("a folder");
    for (theta, says_focal_length) in [(false, true), (false, false), (true, true)] {
        std::fs::write(folder.path().join("d.txt"), export(theta, says_focal_length)).expect("written");
        let job = job("", SENSOR, &calibrated("file = \"d.txt\""), 2) + "rays = true\n";
        for (angle, place_mm) in angles(folder.path(), &job) {
            let expected = radius_mm(theta, angle);
            // Directions are 32-bit floats, which represent small angles from the axis by their components.
            assert!((place_mm - expected).abs() < 2e-5 * FOCAL_MM, "{angle}: {place_mm} for {expected}");
        }
        let output = plan(folder.path(), &job).ok().out;
        for phrase in ["d.txt", "distortion computed for 550 nm", "1 other wavelengths", "field curvature is not used"]
        {
            assert!(output.contains(phrase), "no {phrase} in\n{output}");
        }
    }
    // The same table inline.
    let list = |of: &dyn Fn(u32) -> f64| (1..=40).map(|d| format!("{:.12}", of(d))).collect::<Vec<_>>().join(", ");
    let radii = list(&|degrees| radius_mm(false, f64::from(degrees).to_radians()));
    let keys = format!("angle_deg = [{}], radius_mm = [{radii}]", list(&f64::from));
    let job = job("", SENSOR, &calibrated(&keys), 2) + "rays = true\n";
    for (angle, place_mm) in angles(folder.path(), &job) {
        assert!((place_mm - radius_mm(false, angle)).abs() < 2e-5 * FOCAL_MM, "{angle}: {place_mm}");
    }
}

#[test]
fn unusable_distortion_exports_are_reported_with_their_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let export_text = export(false, true);
    let five = " 5.00000000E+000";
    for (listing, phrases) in [
        (
            export_text.replace("Distortion", "Astigmatism").replace("distortion", "astigmatism"),
            &["d.txt", "not a distortion export"][..],
        ),
        (export_text.replace("(deg)", "(mm)").replace("Degrees", "mm"), &["d.txt", "not angles"]),
        (export_text.replace(five, " 3.50000000E+000"), &["d.txt:63", "follows 4; expected increasing"]),
        (export_text.replace(" 0.00000000E+000", " 0.50000000E+000"), &["d.txt:58", "expected 0, the axis"]),
    ] {
        std::fs::write(folder.path().join("d.txt"), &listing).expect("written");
        plan(folder.path(), &job("", SENSOR, &calibrated("file = \"d.txt\""), 2)).refused(phrases);
    }
    std::fs::write(folder.path().join("d.txt"), &export_text).expect("written");
    for (keys, phrases) in [
        ("file = \"d.txt\", radius_mm = [1, 2]", &["job.toml", "\"radius_mm\" has no effect here"][..]),
        ("angle_deg = [10, 20]", &["job.toml", "\"radius_mm\" is missing"]),
        (
            "angle_deg = [10, 20], radius_mm = [1, 2, 3]",
            &["job.toml", "the numbers of angles (2) and radii (3) differ"],
        ),
        ("angle_deg = [10, 20], radius_mm = [1, 2], focal_length_mm = 6", &["\"focal_length_mm\" has no effect here"]),
        ("angle_deg = [10, 20], radius_mm = [2, 1]", &["job.toml", "radii that increase"]),
        ("angle_deg = [20, 10], radius_mm = [1, 2]", &["job.toml", "angles that increase"]),
    ] {
        plan(folder.path(), &job("", SENSOR, &calibrated(keys), 2)).refused(phrases);
    }
}

/// The shipped camera with both tables.
#[test]
fn the_shipped_camera_is_measured_as_its_tables_say() {
    let camera = text(&crate::support::root().join("scenes/cameras/measured-lens.toml"));
    let output = etendue(["measure", "lens", &camera]).ok().out;
    let line = output.lines().find_map(|line| line.strip_prefix("calibrated camera,"));
    let number = |word: &str| word.trim().parse::<f64>().unwrap_or_else(|_| panic!("{word}: {output}"));
    let words: Vec<&str> = line.unwrap_or_else(|| panic!("{output}")).split(',').collect();
    let (focal_mm, f_number) = (words[0].trim_end_matches("mm"), words[1].trim().trim_start_matches("f/"));
    // The table's focal length on the axis: that of the lens, whose radii have four digits.
    assert!((number(focal_mm) - 6.0).abs() < 1e-3, "{output}");
    assert_eq!(number(f_number), 2.0, "{output}");
}

const SIDE: usize = 40;
const PIXEL_MM: f64 = 0.005;
/// Position of the edge, rows from the top.
const EDGE_PX: f64 = 20.3;
/// Modelled spread: two Gaussians, their fractions and widths, mm.
const SPREADS: [(f64, f64); 2] = [(0.7, 0.0055), (0.3, 0.012)];

fn modulation(f: f64) -> f64 {
    let of = |sigma: f64| std::f64::consts::PI * sigma * f;
    SPREADS.iter().map(|(weight, sigma)| weight * exp(-2.0 * of(*sigma) * of(*sigma))).sum()
}

/// An export of modulation: the diffraction limit, the axis with tangential and sagittal 0.02 apart, and another field.
fn mtf_export() -> String {
    let table = |title: &str, of: &dyn Fn(f64) -> [f64; 2]| {
        let row = |i: u32| {
            let f = 10.0 * f64::from(i);
            let [t, s] = of(f);
            format!("  {f:.6}  {t:.6}  {s:.6}\r\n")
        };
        let rows: String = (0..=12).map(row).collect();
        format!("Field: {title}\r\n Spatial frequency   Tangential   Sagittal\r\n{rows}\r\n")
    };
    let axis = |f: f64| if f == 0.0 { [1.0; 2] } else { [modulation(f) + 0.005, modulation(f) - 0.005] };
    format!(
        "Polychromatic Diffraction MTF\r\n\r\nFile : C:\\lenses\\made for a test.zmx\r\n\r\nData for 0.4861 to 0.6563 µm.\r\nSpatial Frequency units are cycles per mm.\r\n\r\n{}{}{}",
        table("Diffraction limit", &|f| [1.0 - f / 500.0; 2]),
        table("0.00 (deg)", &axis),
        table("14.00 (deg)", &|f| [1.0 - f / 200.0; 2])
    )
}

/// Light of each row next to an edge between black above and light below.
fn edge(folder: &Path, effects: &str) -> Vec<f64> {
    let (far_m, size_m) = (1e6, 2e6);
    let above = size_m / 2.0 - (EDGE_PX - 0.5 * SIDE as f64) * PIXEL_MM / 8.0 * far_m;
    let black = format!(
        "[[scene.materials]]\nname = \"black\"\ntype = \"diffuse\"\nreflectance = 0\n[[scene.objects]]\nname = \"sky\"\n\
         shape = {{ type = \"quad\", size_m = [{size_m:.1}, {size_m:.1}] }}\nposition_m = [{far_m:.1}, 0, {above:.6}]\n\
         rotation_deg = [0, -90, 0]\nmaterial = \"black\"\n"
    );
    let sensor = format!("width_px = {SIDE}, height_px = {SIDE}, pixel_pitch_um = 5");
    let lens = format!("type = \"pinhole\"\nfocal_length_mm = 8\nf_number = 4\n{effects}");
    let [lit, unobstructed] = [&black[..], ""].map(|objects| irradiance(folder, &job(objects, &sensor, &lens, 128)));
    // Away from the sides, beyond which nothing is rendered. Displaced samples are noisy: the mean over columns.
    let mean = |of: &[f64], row: usize| of[row * SIDE + 8..(row + 1) * SIDE - 8].iter().sum::<f64>();
    (0..SIDE).map(|row| mean(&lit, row) / mean(&unobstructed, row)).collect()
}

#[test]
fn edges_have_the_modulation_of_the_table() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("mtf.txt"), mtf_export()).expect("written");
    let (frequencies, modulations): (Vec<String>, Vec<String>) =
        (1..=12).map(|i| 10.0 * f64::from(i)).map(|f| (format!("{f:.1}"), format!("{:.9}", modulation(f)))).unzip();
    let by_hand = format!("cycles_per_mm = [{}], modulation = [{}]", frequencies.join(", "), modulations.join(", "));
    // Light of the edge over a pixel: a normal distribution integrated in steps of a hundredth.
    let normal = |x: f64| {
        let steps = 4000;
        let step = (x + 8.0) / f64::from(steps);
        let at = |i: i32| step * (f64::from(i) + 0.5) - 8.0;
        let density = |i: i32| exp(-0.5 * at(i) * at(i));
        (0..steps).map(density).sum::<f64>() * step / (2.0 * std::f64::consts::PI).sqrt()
    };
    let expected = |row: usize| {
        let at = |part: usize| (row as f64 + (part as f64 + 0.5) / 20.0 - EDGE_PX) * PIXEL_MM;
        let light =
            |x: f64| SPREADS.iter().map(|(weight, sigma)| weight * normal((x / sigma).clamp(-8.0, 8.0))).sum::<f64>();
        (0..20).map(|part| light(at(part))).sum::<f64>() / 20.0
    };
    for keys in ["file = \"mtf.txt\"", &by_hand] {
        let actual = edge(folder.path(), &format!("[cameras.effects]\npsf = {{ mtf = {{ {keys} }} }}"));
        for (row, actual) in actual.iter().enumerate() {
            assert!((actual - expected(row)).abs() < 0.01, "{keys}: row {row}: {actual} for {}", expected(row));
        }
    }
    let sharp = edge(folder.path(), "");
    assert!((sharp[19] - expected(19)).abs() > 0.05, "an edge without the table is another");
    let lens = "type = \"pinhole\"\nfocal_length_mm = 8\nf_number = 4\n[cameras.effects]\npsf = { mtf = { file = \"mtf.txt\" } }";
    let output = plan(folder.path(), &job("", "width_px = 8, height_px = 8, pixel_pitch_um = 5", lens, 2)).ok().out;
    for phrase in
        ["table of modulation", "modulation error at most 0.00", "mean of tangential and sagittal", "1 other fields"]
    {
        assert!(output.contains(phrase), "no {phrase} in\n{output}");
    }
}

#[test]
fn unusable_modulation_tables_are_reported_with_their_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let export_text = mtf_export();
    let lens = |keys: &str| {
        format!("type = \"pinhole\"\nfocal_length_mm = 8\nf_number = 4\n[cameras.effects]\npsf = {{ {keys} }}")
    };
    let sensor = "width_px = 8, height_px = 8, pixel_pitch_um = 5";
    for (listing, phrases) in [
        (export_text.replace("cycles per mm", "cycles per mrad"), &["mtf.txt", "in cycles per mm"][..]),
        (export_text.replace("MTF", "spots"), &["mtf.txt", "not a table of modulation"]),
        (
            export_text.replace("0.00 (deg)", "diffraction limit").replace("14.00 (deg)", "diffraction limit"),
            &["only the diffraction limit"],
        ),
        (export_text.replace("  20.000000  0.", "  20.000000  1."), &["mtf.txt:28", "expected 0 … 1"]),
    ] {
        std::fs::write(folder.path().join("mtf.txt"), &listing).expect("written");
        plan(folder.path(), &job("", sensor, &lens("mtf = { file = \"mtf.txt\" }"), 2)).refused(phrases);
    }
    for (keys, phrases) in [
        ("mtf = { cycles_per_mm = [10, 20] }", &["job.toml", "\"modulation\" is missing"][..]),
        ("mtf = { cycles_per_mm = [10, 20], modulation = [1] }", &["job.toml", "modulation"]),
        ("mtf = { cycles_per_mm = [20, 10], modulation = [0.9, 0.8] }", &["job.toml", "10 is not above 20"]),
        ("mtf = { cycles_per_mm = [10, 20], modulation = [0.2, 0.9] }", &["job.toml", "not a sum of Gaussians"]),
        (
            "mtf = { cycles_per_mm = [10, 20], modulation = [0.9, 0.8] }, blades = 6",
            &["\"blades\" contradicts \"mtf\""],
        ),
        (
            "mtf = { cycles_per_mm = [10, 20], modulation = [0.9, 0.8] }, image_pitch_um = 1",
            &["\"image_pitch_um\" has no effect"],
        ),
    ] {
        plan(folder.path(), &job("", sensor, &lens(keys), 2)).refused(phrases);
    }
}
