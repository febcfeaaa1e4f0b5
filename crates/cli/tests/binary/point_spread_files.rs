//! Zemax's listings of point spreads over the field determine a camera, and invalid ones are reported.

use crate::black_boxes::{irradiance, job, plan};
use crate::support::{etendue, root, text};
use etendue_core::maths::f64::exp;
use std::path::Path;

const LENS: &str = "type = \"pinhole\"\nfocal_length_mm = 8\nf_number = 4\n[cameras.effects]\npsf = { files = [";
const PIXEL_MM: f64 = 0.005;
/// Samples of a listing, and their spacing, µm.
const SIDE: usize = 64;
const SPACING_UM: f64 = 2.0;

/// A listing of "Huygens PSF": irradiance at an offset outwards of the point and across it, µm, for a field of y.
fn listing(y_mm: f64, light_um: &str, light: impl Fn(f64, f64) -> f64) -> String {
    let outwards = if y_mm < 0.0 { -1.0 } else { 1.0 };
    let value = |row: usize, column: usize| {
        // The 33rd row from the last is the 32nd from the first.
        let (x, y) = (SPACING_UM * (column as f64 - 32.0), SPACING_UM * (31.0 - row as f64));
        light(y * outwards, x * outwards)
    };
    let row =
        |row: usize| (0..SIDE).map(|column| format!("  {:.4E}", value(row, column))).collect::<Vec<_>>().join("\t");
    let rows: String = (0..SIDE).map(|r| row(r) + "\r\n").collect();
    format!(
        "Listing of Huygens PSF Data\r\n\r\nFile : C:\\lenses\\made for a test.zmx\r\nTitle: made for a test\r\nDate : 1/1/2026\r\n\r\n\r\n\
         {light_um} µm at 0.0000, {:.4} (deg).\r\nData spacing is {SPACING_UM:.3} µm.\r\nData area is 128.000 by 128.000 µm.\r\n\
         Strehl ratio: 0.1\r\nPupil grid size: 64 by 64\r\nImage grid size: 64 by 64\r\nCenter point is: 33, 33\r\n\
         Center coordinates  :   0.00000000E+00,   {y_mm:.8E} Millimeters\r\n\r\nValues are relative intensity.\r\n\r\n{rows}",
        etendue_core::maths::f64::atan2(y_mm, 8.0).to_degrees()
    )
}

fn gaussian(away_um: f64, width_um: f64) -> f64 {
    exp(-0.5 * away_um * away_um / (width_um * width_um))
}

/// Writes a listing for each field and names them as the key does.
fn write(folder: &Path, listings: impl IntoIterator<Item = String>) -> String {
    let names = listings.into_iter().enumerate().map(|(i, listing)| {
        let name = format!("psf-{i}.txt");
        std::fs::write(folder.join(&name), listing).expect("written");
        format!("\"{name}\"")
    });
    names.collect::<Vec<_>>().join(", ")
}

/// Modelled widths along the radius and across it, µm, at a distance from the axis, mm.
fn widths_um(radius_mm: f64) -> [f64; 2] {
    [7.0 + 6.0 * radius_mm * radius_mm, 7.0 + 2.0 * radius_mm]
}

/// Height of images near the end of the field, at this distance from the axis, rows.
const ROWS: usize = 40;
const AXIS_ROW: f64 = -160.0;
const EDGE_PX: f64 = 20.3;

/// Light of each row next to an edge between black above and light below.
fn edge(folder: &Path, lens: &str, axis_row: f64) -> Vec<f64> {
    let (far_m, size_m) = (1e6, 2e6);
    let above = size_m / 2.0 - (EDGE_PX - axis_row) * PIXEL_MM / 8.0 * far_m;
    let black = format!(
        "[[scene.materials]]\nname = \"black\"\ntype = \"diffuse\"\nreflectance = 0\n[[scene.objects]]\nname = \"sky\"\n\
         shape = {{ type = \"quad\", size_m = [{size_m:.1}, {size_m:.1}] }}\nposition_m = [{far_m:.1}, 0, {above:.6}]\n\
         rotation_deg = [0, -90, 0]\nmaterial = \"black\"\n"
    );
    let sensor =
        format!("width_px = {ROWS}, height_px = {ROWS}, pixel_pitch_um = 5, principal_point_px = [20, {axis_row:.1}]");
    let [lit, unobstructed] = [&black[..], ""].map(|objects| irradiance(folder, &job(objects, &sensor, lens, 128)));
    let mean = |of: &[f64], row: usize| of[row * ROWS + 16..row * ROWS + 24].iter().sum::<f64>();
    (0..ROWS).map(|row| mean(&lit, row) / mean(&unobstructed, row)).collect()
}

/// Fraction of a Gaussian below a position, in its widths.
fn normal(x: f64) -> f64 {
    let step = (x.clamp(-8.0, 8.0) + 8.0) / 4000.0;
    let at = |i: i32| step * (f64::from(i) + 0.5) - 8.0;
    (0..4000).map(|i| exp(-0.5 * at(i) * at(i))).sum::<f64>() * step / (2.0 * std::f64::consts::PI).sqrt()
}

#[test]
fn edges_are_as_wide_as_the_files_say_of_their_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let radii = (0..=12).map(|i| -0.1 * f64::from(i));
    let files = write(
        folder.path(),
        radii.map(|y_mm| {
            let [along_um, across_um] = widths_um(y_mm.abs());
            listing(y_mm, "0.5500", |sagittal, across| gaussian(sagittal, along_um) * gaussian(across, across_um))
        }),
    );
    let lens = format!("{LENS}{files}] }}");
    // Below the axis the edge is perpendicular to the radius; on it functions are narrower.
    for axis_row in [AXIS_ROW, EDGE_PX] {
        let edge_widths = edge(folder.path(), &lens, axis_row);
        let width_um = |row: usize| widths_um((row as f64 + 0.5 - axis_row).abs() * PIXEL_MM)[0];
        let expected = |row: usize| {
            let at = |part: usize| (row as f64 + (part as f64 + 0.5) / 20.0 - EDGE_PX) * 1e3 * PIXEL_MM;
            (0..20).map(|part| normal(at(part) / width_um(row))).sum::<f64>() / 20.0
        };
        for (row, edge_widths) in edge_widths.iter().enumerate().take(ROWS - 4).skip(4) {
            let off = edge_widths - expected(row);
            assert!(off.abs() < 0.01, "axis at {axis_row}, row {row}: {edge_widths} for {}", expected(row));
        }
    }
}

const WIDE: usize = 241;
/// Lamps, columns and rows from the axis.
const LAMPS: [[i32; 2]; 9] = [[0, 0], [75, 75], [-75, 75], [-75, -75], [75, -75], [80, 0], [-80, 0], [0, 80], [0, -80]];

/// Outward distance of a blob with a seventh of the light, by distance from the axis.
fn blob_um(radius_mm: f64) -> f64 {
    20.0 * radius_mm
}

/// For each lamp its light and the displacement of the centroid from its position, µm.
fn lamps(folder: &Path, lens: &str) -> Vec<(f64, [f64; 2])> {
    let px_m = 100.0 * PIXEL_MM / 8.0;
    let lamp = |(i, [x, y]): (usize, &[i32; 2])| {
        let [left, up] = [x, y].map(|v| -f64::from(*v) * px_m);
        format!(
            "[[scene.objects]]\nname = \"l{i}\"\nshape = {{ type = \"sphere\", radius_m = 0.09 }}\nposition_m = [100, {left:.6}, {up:.6}]\nmaterial = \"lamp\"\n"
        )
    };
    let material = "[[scene.materials]]\nname = \"lamp\"\ntype = \"diffuse\"\nreflectance = 0\nemission = { luminance_cd_m2 = 1e8, illuminant = \"E\" }\n";
    let objects: String = std::iter::once(material.to_owned()).chain(LAMPS.iter().enumerate().map(lamp)).collect();
    let sensor = format!("width_px = {WIDE}, height_px = {WIDE}, pixel_pitch_um = 5");
    let light = irradiance(folder, &job(&objects, &sensor, lens, 16));
    // Far from every lamp and from the sides.
    let dark = light[155 * WIDE + 155];
    let of = |[x, y]: &[i32; 2]| {
        let (mut sum, mut moment) = (0.0, [0.0; 2]);
        for dy in -20..=20 {
            for dx in -20..=20 {
                let [column, row] = [120 + x + dx, 120 + y + dy].map(|v| usize::try_from(v).expect("in the picture"));
                let value = light[row * WIDE + column] - dark;
                sum += value;
                moment[0] += value * f64::from(dx);
                moment[1] += value * f64::from(dy);
            }
        }
        (sum, moment.map(|m| m / sum * 1e3 * PIXEL_MM))
    };
    LAMPS.iter().map(of).collect()
}

#[test]
fn tails_of_lamps_point_away_from_the_axis_as_in_the_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let sharp = lamps(folder.path(), "type = \"pinhole\"\nfocal_length_mm = 8\nf_number = 4");
    // Stated above the axis and below it, with and without coordinates on the sensor.
    for (sign, coordinates) in [(1.0, true), (-1.0, true), (-1.0, false)] {
        let listings = (0..=6).map(|i| {
            let radius_mm = 0.15 * f64::from(i);
            let blob = blob_um(radius_mm);
            let listing_text = listing(sign * radius_mm, "0.5500", |sagittal, across| {
                gaussian(across, 6.0) * (6.0 * gaussian(sagittal, 6.0) + gaussian(sagittal - blob, 6.0))
            });
            if coordinates { listing_text } else { listing_text.replace("Center coordinates", "Kept to itself") }
        });
        let files = write(folder.path(), listings);
        // Without a margin the film's samples are those of the image without effects.
        let lens = LENS.replace("psf", "margin = 0\npsf");
        let spots = lamps(folder.path(), &format!("{lens}{files}] }}"));
        for ((lamp, before), after) in LAMPS.iter().zip(&sharp).zip(&spots) {
            let [x, y] = lamp.map(f64::from);
            let radius_px = (x * x + y * y).sqrt();
            let [e, n] = if radius_px > 0.0 { [x / radius_px, y / radius_px] } else { [1.0, 0.0] };
            let moved = [after.1[0] - before.1[0], after.1[1] - before.1[1]];
            let (out, sideways) = (moved[0] * e + moved[1] * n, moved[1] * e - moved[0] * n);
            let expected = blob_um(radius_px * PIXEL_MM) / 7.0;
            assert!((after.0 / before.0 - 1.0).abs() < 0.01, "{lamp:?}: {} of {}", after.0, before.0);
            // 5 µm is a pixel; the widths are 7 µm.
            assert!(
                (out - expected).abs() < 0.15 && sideways.abs() < 0.05,
                "{sign} {lamp:?}: {out} for {expected}, {sideways}"
            );
        }
    }
    let output = plan(folder.path(), &job("", SMALL, &format!("{LENS}{}] }}", names(7)), 2)).ok().out;
    for phrase in
        ["a table of 7 functions at 7 distances from the axis (0 to 0.9 mm)", "computed for 550 nm", "patches"]
    {
        assert!(output.contains(phrase), "no {phrase} in\n{output}");
    }
}

const SMALL: &str = "width_px = 16, height_px = 16, pixel_pitch_um = 5";

fn names(count: usize) -> String {
    (0..count).map(|i| format!("\"psf-{i}.txt\"")).collect::<Vec<_>>().join(", ")
}

#[test]
fn files_that_make_no_table_are_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let round = |y_mm: f64, um: &str| listing(y_mm, um, |a, b| gaussian(a, 6.0) * gaussian(b, 6.0));
    let assert_refused = |listings: &[String], keys: &str, phrases: &[&str]| {
        let files = write(folder.path(), listings.to_owned());
        plan(folder.path(), &job("", SMALL, &format!("{LENS}{files}]{keys} }}"), 2)).refused(phrases);
    };
    let [axis, off] = [round(0.0, "0.5500"), round(0.5, "0.5500")];
    let polychromatic = round(0.5, "0.4861 to 0.6563");
    assert_refused(
        &[axis.clone(), off.clone(), round(0.0, "0.4800")],
        "",
        &["effects.psf.files", "no file is for 480 nm at the field (0°, 3.5763°) of psf-1.txt"],
    );
    assert_refused(
        &[axis.clone(), polychromatic],
        "",
        &["effects.psf.files", "486.1 to 656.3 nm", "polychromatic files of the same range"],
    );
    assert_refused(
        &[axis.clone(), off.clone(), round(-0.5, "0.5500")],
        "",
        &["psf-2.txt has the same distance", "psf-1.txt", "remove one"],
    );
    assert_refused(
        &[axis.replace("2.000 µm", "5.100 µm")],
        "",
        &["effects.psf.files", "5.100 µm apart", "smaller spacing"],
    );
    assert_refused(
        &[axis.replace("Data spacing is 2.000 µm", "")],
        "",
        &["psf-0.txt", "does not state the sample spacing"],
    );
    assert_refused(&[axis.replace("PSF", "MTF")], "", &["psf-0.txt", "not a listing of a point-spread function"]);
    assert_refused(
        &[axis.clone(), off.replace("Center coordinates", "X").replace("3.5763 (deg)", "95.0 (deg)")],
        "",
        &["effects.psf.files", "forms no image at the field (0°, 95°)"],
    );
    assert_refused(std::slice::from_ref(&axis), ", blades = 6", &["\"blades\" contradicts \"files\""]);
    assert_refused(std::slice::from_ref(&axis), ", reach_mm = 1", &["\"reach_mm\" contradicts \"files\""]);
    assert_refused(
        std::slice::from_ref(&axis),
        ", image = \"a.png\", image_pitch_um = 1",
        &["\"files\" contradicts \"image\""],
    );
    assert_refused(
        std::slice::from_ref(&axis),
        ", spread_by = \"samples\"",
        &["effects.psf.spread_by", "falls close enough for displaced"],
    );
    let lens = format!("{LENS}\"absent.txt\"] }}");
    plan(folder.path(), &job("", SMALL, &lens, 2)).refused(&[
        "effects.psf.files",
        "absent.txt",
        "no such point spread file",
    ]);
    // With two wavelengths and all fields, on the route at the pupil and through `expose`.
    let files = write(folder.path(), [axis, off, round(0.0, "0.4800"), round(0.5, "0.4800")]);
    let job = job("", SMALL, &format!("{LENS}{files}], patches = [3, 3] }}"), 2)
        .replace("[output]", "route = \"pupil\"\n[output]\nradiance = true");
    let output = plan(folder.path(), &job).ok().out;
    assert!(output.contains("2 wavelengths (480 to 550 nm), in 3 × 3 patches"), "{output}");
    let [out, exposed, camera] = ["out", "taken", "camera.toml"].map(|name| text(&folder.path().join(name)));
    etendue(["render", &text(&folder.path().join("job.toml")), "-o", &out]).ok();
    let lens = LENS.replace("[cameras.effects]", "[effects]");
    let body = format!("format = 1\nsensor = {{ {SMALL} }}\n[lens]\n{lens}{files}] }}\n");
    std::fs::write(&camera, body).expect("written");
    etendue(["expose", &format!("{out}/eye/radiance.exr"), "--camera", &camera, "-o", &exposed]).ok();
}

/// The shipped camera with listings renders its dots with all of them.
#[test]
fn the_shipped_camera_has_its_point_spreads() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let chart = text(&folder.path().join("dots"));
    let camera = text(&root().join("scenes/cameras/zemax-point-spread.toml"));
    etendue(["chart", "dots", "--columns", "9", "--camera", &camera, "-o", &chart]).ok();
    let output = etendue(["plan", &format!("{chart}/job.toml")]).ok().out;
    let expected = "a table of 3 functions at 3 distances from the axis (0, 11, 22 mm), computed for 550 nm, the same at all wavelengths";
    assert!(
        output.contains(expected) && !output.contains("the value at its border") && !output.contains("too fast"),
        "{output}"
    );
}
