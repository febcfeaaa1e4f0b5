//! Lenses as published by their makers: tables over the field and ray-transfer functions determine a camera, and invalid ones are reported.

use crate::support::{etendue, root, text};
use etendue_io::exr::{ExrSamples, read_exr};
use serde_json::Value;
use std::path::Path;

/// A uniform surround of 1 W/(m²·sr·nm), with objects in front of it and a camera that looks along +x.
pub(crate) fn job(objects: &str, sensor: &str, lens: &str, spp: u32) -> String {
    format!(
        "format = 1\n[scene]\nenvironment = {{ type = \"uniform\", radiance_w_m2_sr_nm = 1 }}\n{objects}[[cameras]]\nname = \"eye\"\n\
         position_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\nsensor = {{ {sensor} }}\n[cameras.lens]\n{lens}\n[render]\nspp = {spp}\nreplicates = 2\n\
         wavelength_range_nm = [540, 560]\nband_width_nm = 20\n[output]\nirradiance = true\n"
    )
}

/// The irradiance of each pixel, W/(m²·nm).
pub(crate) fn irradiance(folder: &Path, job: &str) -> Vec<f64> {
    std::fs::write(folder.join("job.toml"), job).expect("written");
    let out = folder.join("out");
    etendue(["render", &text(&folder.join("job.toml")), "-o", &text(&out), "--overwrite"]).ok();
    let file = read_exr(&out.join("eye/irradiance.exr")).expect("readable");
    let band = file.channels.iter().find(|channel| channel.name.starts_with("S0.")).expect("the one band");
    let ExrSamples::Float(samples) = &band.samples else { panic!("not of 32-bit floats") };
    samples.iter().map(|v| f64::from(*v)).collect()
}

pub(crate) fn plan(folder: &Path, job: &str) -> crate::support::CommandOutput {
    std::fs::write(folder.join("job.toml"), job).expect("written");
    etendue(["plan", &text(&folder.join("job.toml"))])
}

/// An export of relative illumination, with fields in degrees and either sign convention, as written by OpticStudio.
fn export(rows: &str) -> String {
    format!(
        "Relative Illumination Data\r\n\r\nFile : C:\\lenses\\made for a test.zmx\r\nTitle: made for a test\r\nDate : 1/1/2026\r\n\r\n\
         Wavelength: 0.587562 µm\r\nField values are in degrees.\r\n\r\n     Field       Rel. Ill.     Eff. F/#\r\n{rows}"
    )
}

const FIELDS: [(f64, f64); 5] = [(0.0, 1.0), (10.0, 0.93), (20.0, 0.78), (30.0, 0.52), (40.0, 0.31)];

fn rows(sign: f64, on_axis: f64) -> String {
    FIELDS
        .iter()
        .map(|(field, ratio)| format!("  {:.6E}  {:.6E}  2.1E+00\r\n", field * sign, ratio * on_axis))
        .collect()
}

fn utf16(text: &str) -> Vec<u8> {
    core::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
}

const CALIBRATED: &str = "type = \"calibrated\"\nf_number = 2\nprojection = { type = \"equidistant\", focal_length_mm = 6 }\n\
                          relative_illumination = { file = \"ri.txt\" }";
const SENSOR: &str = "width_px = 121, height_px = 1, pixel_pitch_um = 60";

#[test]
fn a_camera_falls_off_as_zemax_s_export_says() {
    let folder = tempfile::tempdir().expect("a folder");
    for (sign, on_axis, wide) in [(1.0, 1.0, false), (-1.0, 0.97, true)] {
        let listing = export(&rows(sign, on_axis));
        let bytes = if wide { utf16(&listing) } else { listing.into_bytes() };
        std::fs::write(folder.path().join("ri.txt"), bytes).expect("written");
        let actual = irradiance(folder.path(), &job("", SENSOR, CALIBRATED, 64));
        for (i, value) in actual.iter().enumerate() {
            let angle = ((i as f64 - 60.0) * 0.06 / 6.0).abs().to_degrees();
            let after = FIELDS.iter().position(|(field, _)| *field >= angle).expect("within the table").max(1);
            let [(a, from), (b, to)] = [FIELDS[after - 1], FIELDS[after]];
            let expected = from + (to - from) * (angle - a) / (b - a);
            // A pixel is 0.6° wide: at a kink of the table its mean deviates by up to 0.1 %.
            assert!((value / actual[60] - expected).abs() < 0.002, "{angle}°: {} for {expected}", value / actual[60]);
        }
    }
    let output = plan(folder.path(), &job("", SENSOR, CALIBRATED, 64)).ok().out;
    assert!(
        output.contains("ri.txt") && output.contains("computed for 587.562 nm, used for all wavelengths"),
        "{output}"
    );
}

#[test]
fn unusable_exports_are_reported_with_their_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let listing_text = export(&rows(1.0, 1.0));
    for (listing, phrases) in [
        (listing_text.replace("5.2", "-5.2"), &["ri.txt:14", "0 or more"][..]),
        (
            listing_text.replace("3.000000E1", "1.500000E1"),
            &["ri.txt:14", "expected increasing distances from the axis"],
        ),
        (listing_text.replace("0.000000E0 ", "1.000000E0 "), &["ri.txt:11", "expected 0, the axis"]),
        (listing_text.replace("degrees", "furlongs"), &["ri.txt", "does not state the unit of the fields"]),
        (listing_text.replace("in degrees", "object height in millimeters"), &["ri.txt:8", "object heights"]),
        (
            listing_text.replace("Relative Illumination", "Spots").replace("Rel. Ill.", "Size"),
            &["ri.txt", "not an export of relative illumination"],
        ),
        (listing_text.replace("  2.1E+00\r\n  2", "\r\n  2"), &["ri.txt:12", "the number of values is 2; expected 3"]),
        (format!("{listing_text}\r\nsecond\r\n{}", rows(1.0, 1.0)), &["ri.txt:18", "second table"]),
        (listing_text[..200].to_owned(), &["ri.txt", "no row of numbers"]),
        (export(&rows(0.5, 1.0)), &["job.toml", "given up to 20° from the axis", "extend it"]),
    ] {
        std::fs::write(folder.path().join("ri.txt"), &listing).expect("written");
        plan(folder.path(), &job("", SENSOR, CALIBRATED, 1)).refused(phrases);
    }
    let both = CALIBRATED.replace("\"ri.txt\"", "\"ri.txt\", ratio = [1]");
    plan(folder.path(), &job("", SENSOR, &both, 1)).refused(&["job.toml", "\"ratio\" has no effect here"]);
    let half = CALIBRATED.replace("file = \"ri.txt\"", "radius_mm = [0, 9]");
    plan(folder.path(), &job("", SENSOR, &half, 1)).refused(&["job.toml", "\"ratio\" is missing"]);
}

/// A published file, and the results of tests/oracles/ray_transfer.py for it.
fn published() -> (String, Value) {
    let figures = root().join("tests/oracles/figures/ray_transfer.json");
    let figures = std::fs::read_to_string(figures).expect("stored figures");
    let file = text(&root().join("scenes/lenses/dgauss28deg-zemax-poly6-raytransfer.json"));
    (file, serde_json::from_str(&figures).expect("JSON"))
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

fn transferred(file: &str, film_mm: f64) -> String {
    format!("type = \"ray_transfer\"\nfile = \"{file}\"\nsensor_distance_mm = {film_mm}")
}

#[test]
fn a_camera_falls_off_as_published_ray_transfer_functions_say() {
    let (folder, (file, figures)) = (tempfile::tempdir().expect("a folder"), published());
    let lens = transferred(&file, figures["film_mm"].as_f64().expect("mm"));
    // Pixels of 0.2 mm along a column, from the axis outwards.
    let sensor = "width_px = 1, height_px = 143, pixel_pitch_um = 200, principal_point_px = [0.5, 0.5]";
    let actual = irradiance(folder.path(), &job("", sensor, &lens, 4096));
    for (height, expected) in
        numbers(&figures["heights_mm"]).into_iter().zip(numbers(&figures["relative_illumination"]))
    {
        let at = (height / 0.2).round() as usize;
        let near = &actual[at.saturating_sub(2)..at + 3];
        let axis = &actual[..3];
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        // Eight hundredths of the samples are blocked: 0.2 % of noise; the fall-off is averaged over half a millimetre.
        assert!(
            (mean(near) / mean(axis) - expected).abs() < 0.01,
            "{height} mm: {} for {expected}",
            mean(near) / mean(axis)
        );
    }
    let output = plan(folder.path(), &job("", sensor, &lens, 2)).ok().out;
    for phrase in [
        "ray-transfer lens, 99.",
        "fitted to 550 nm, used for all wavelengths",
        "within 22.8 mm of the axis",
        "errors of the fit",
    ] {
        assert!(output.contains(phrase), "no {phrase} in\n{output}");
    }
}

/// The bright half lies below an edge at a distance of a thousand kilometres.
#[test]
fn edges_look_as_published_ray_transfer_functions_make_them() {
    let (folder, (file, figures)) = (tempfile::tempdir().expect("a folder"), published());
    let lens = transferred(&file, figures["film_mm"].as_f64().expect("mm"));
    let (far_m, size_m) = (1e6, 2e6);
    for edge in figures["edges"].as_array().expect("edges") {
        let expected = numbers(&edge["response"]);
        let number = |key: &str| edge[key].as_f64().expect("a number");
        let above = size_m / 2.0 - number("outward_slope") * far_m;
        let black = format!(
            "[[scene.materials]]\nname = \"black\"\ntype = \"diffuse\"\nreflectance = 0\n[[scene.objects]]\nname = \"sky\"\n\
             shape = {{ type = \"quad\", size_m = [{size_m:.1}, {size_m:.1}] }}\nposition_m = [{far_m:.1}, 0, {above:.6}]\n\
             rotation_deg = [0, -90, 0]\nmaterial = \"black\"\n"
        );
        let middle = 0.5 * expected.len() as f64 - number("height_mm") / figures["pixel_mm"].as_f64().expect("mm");
        let sensor = format!(
            "width_px = 1, height_px = {}, pixel_pitch_um = 5, principal_point_px = [0.5, {middle:.6}]",
            expected.len()
        );
        let [lit, unobstructed] =
            [&black[..], ""].map(|objects| irradiance(folder.path(), &job(objects, &sensor, &lens, 16384)));
        for (i, expected) in expected.iter().enumerate() {
            let actual = lit[i] / unobstructed[i];
            assert!((actual - expected).abs() < 0.01, "{} mm, pixel {i}: {actual} for {expected}", edge["height_mm"]);
        }
    }
}

#[test]
fn unusable_ray_transfer_files_are_reported() {
    let (folder, (file, _)) = (tempfile::tempdir().expect("a folder"), published());
    let file_text = std::fs::read_to_string(file).expect("the published file");
    let sensor = "width_px = 9, height_px = 9, pixel_pitch_um = 900";
    for (was, is, phrases) in [
        ("\"minimalellipse\"", "\"neural\"", &["lens.json:12", "expected \"minimalellipse\" or \"circles\""][..]),
        ("\"thickness\": 75.67388,", "", &["lens.json:1", "thickness"]),
        ("\"outy\"", "\"outq\"", &["unknown output \"outq\""]),
        ("\"termr\": [0]", "\"termr\": [0, 1]", &["coefficients (1) and of powers of r, dx and dy (2, 1, 1) differ"]),
        ("\"termr\": [0]", "\"termr\": [0.5]", &["the power 0.5"]),
        ("\"termr\": [0]", "\"termr\": [99]", &["the power 99"]),
        ("[0,0.6,1.2,", "[0,1.6,1.2,", &["positions that increase from 0"]),
        ("\"radiiX\": [6.01", "\"radiiX\": [-6.01", &["the first above 0"]),
        ("\"wavelength_nm\": 550", "\"wavelength_nm\": -1", &["above 0"]),
        ("\"wavelength_nm\": 550", "\"wavelength_nm\": 550, \"wavelength_nm\": 550", &["appears twice"]),
        ("\"outx\"", "\"outy\"", &["\"outy\" is defined twice"]),
        ("[5.315483154282251e-08", "[1e999", &["finite number"]),
        ("-0.01004348535911221", "0.01004348535911221", &["do not describe a lens that forms a real image"]),
    ] {
        assert!(file_text.contains(was), "{was}");
        std::fs::write(folder.path().join("lens.json"), file_text.replace(was, is)).expect("written");
        plan(folder.path(), &job("", sensor, &transferred("lens.json", 57.315), 1)).refused(phrases);
    }
    std::fs::write(folder.path().join("lens.json"), &file_text).expect("written");
    let near = plan(folder.path(), &job("", sensor, &transferred("lens.json", 0.005), 1));
    near.refused(&["job.toml", "sensor_distance_mm", "closer than the plane at 0.01 mm"]);
    let focus = transferred("lens.json", 1.0).replace("sensor_distance_mm = 1", "focus_distance_m = 0.001");
    plan(folder.path(), &job("", sensor, &focus, 1))
        .refused(&["job.toml", "no sensor position focuses the lens at 0.001 m"]);
    let none = "type = \"ray_transfer\"\nfile = \"lens.json\"";
    plan(folder.path(), &job("", sensor, none, 1)).refused(&["job.toml", "focus_distance_m", "sensor_distance_mm"]);
    let pupil = job("", sensor, &transferred("lens.json", 57.315), 1).replace("spp = 1", "route = \"pupil\"\nspp = 1");
    plan(folder.path(), &pupil).refused(&["route", "ray-transfer lens"]);
}

/// The published functions at two wavelengths.
#[test]
fn functions_of_several_wavelengths_are_read_in_any_order() {
    let (folder, (file, _)) = (tempfile::tempdir().expect("a folder"), published());
    let mut document: Value = serde_json::from_str(&std::fs::read_to_string(file).expect("the file")).expect("JSON");
    let published = document["polynomials"].clone();
    let published = if published.is_array() { published[0].clone() } else { published };
    let [mut blue, mut red] = [published.clone(), published];
    (blue["wavelength_nm"], red["wavelength_nm"]) = (450.into(), 650.into());
    let sensor = "width_px = 9, height_px = 9, pixel_pitch_um = 900";
    let mut plan_output = |first: &Value, second: &Value| {
        document["polynomials"] = serde_json::json!([first, second]);
        std::fs::write(folder.path().join("lens.json"), document.to_string()).expect("written");
        plan(folder.path(), &job("", sensor, &transferred("lens.json", 57.315), 2))
    };
    let orders = [plan_output(&red, &blue).ok().out, plan_output(&blue, &red).ok().out];
    for output in orders {
        let phrase = "fitted to 2 wavelengths from 450 to 650 nm, linear between them and constant beyond";
        assert!(output.contains(phrase), "no {phrase} in\n{output}");
    }
    plan_output(&red, &red).refused(&["lens.json:", "the wavelength 650 nm appears twice"]);
}

/// Shipped cameras with such lenses. ISET places this lens's film for infinity at 57.315 mm.
#[test]
fn shipped_cameras_are_measured_as_their_files_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera = root().join("scenes/cameras/ray-transfer.toml");
    let output = etendue(["measure", "lens", &text(&camera)]).ok().out;
    assert!(output.contains("ray-transfer lens, 99.56") && output.contains("f/2.99"), "{output}");
    let description = std::fs::read_to_string(&camera).expect("the camera file");
    assert!(description.contains("focus_distance_m = 25"), "{description}");
    let (file, _) = published();
    let far = description.replace("focus_distance_m = 25", "focus_distance_m = 1e9");
    let far = far.replace("../lenses/dgauss28deg-zemax-poly6-raytransfer.json", &file);
    std::fs::write(folder.path().join("far.toml"), far).expect("written");
    let output = etendue(["measure", "lens", &text(&folder.path().join("far.toml"))]).ok().out;
    assert!(output.contains("the sensor is 57.31"), "{output}");
    let output = etendue(["measure", "lens", &text(&root().join("scenes/cameras/zemax-fall-off.toml"))]).ok().out;
    assert!(output.contains("1.0000") && output.contains("relative-illumination.txt"), "{output}");
}
