//! Lens files as written by other programs: `measure lens` of each, against the correct first-order values.

use crate::support::{etendue, text};
use serde_json::Value;

/// A biconvex singlet of N-BK7 as written by Zemax: 49.04 mm, f/9.81.
pub(crate) fn zmx(front: &str, glass: &str) -> String {
    format!(
        "VERS 140124 258 36214\nMODE SEQ\nUNIT MM X W X CM MR CPMM\nENPD 5\nGCAT SCHOTT\nFTYP 0 0 2 1 0 0 0\nYFLN 0 10\nXFLN 0 0\n\
         WAVM 1 0.58756 1\nPWAV 1\nSURF 0\n  TYPE STANDARD\n  CURV 0.0\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 \"\"\n{front}\
         SURF 1\n  STOP\n  TYPE STANDARD\n  CURV 0.02 0 0 0 0 \"\"\n  DISZ 4\n  GLAS {glass} 0 0 0 0 0 0\n  DIAM 6 1 0 0 1 \"\"\n\
         SURF 2\n  TYPE STANDARD\n  CURV -0.02 0 0 0 0 \"\"\n  DISZ 47\n  DIAM 6 1 0 0 1 \"\"\n\
         SURF 3\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 0\n  DIAM 10 0 0 0 1 \"\"\n"
    )
}

pub(crate) const BK7: &str = "N-BK7 0 0 1.5168 64.17";

struct LensFileReport {
    report: Value,
}

impl LensFileReport {
    fn number(&self, key: &str) -> f64 {
        self.report[key].as_f64().unwrap_or_else(|| panic!("no {key} in {}", self.report))
    }

    fn remarks(&self) -> String {
        let list = self.report["remarks"].as_array().expect("remarks");
        list.iter().filter_map(Value::as_str).collect::<Vec<_>>().join("\n")
    }

    /// Asserts a key's value to the last stated digit.
    #[track_caller]
    fn assert_value(&self, key: &str, right: f64, digit: f64) {
        let actual = self.number(key);
        assert!((actual - right).abs() <= 0.51 * digit, "{key}: {actual} for {right}");
    }
}

fn arguments(name: &str, file: &str, further: &[&str]) -> (tempfile::TempDir, Vec<String>) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, file).expect("written");
    let words = ["measure".to_owned(), "lens".to_owned(), text(&path), "--fields".to_owned(), "2".to_owned()];
    (folder, words.into_iter().chain(further.iter().map(|word| (*word).to_owned())).collect())
}

fn measure_lens(name: &str, file: &str) -> LensFileReport {
    let (_folder, words) = arguments(name, file, &["--json"]);
    LensFileReport { report: serde_json::from_str(&etendue(words).ok().out).expect("JSON") }
}

#[test]
fn a_catalogue_glass_is_its_successor_and_not_what_is_left_over_on_its_line() {
    measure_lens("plain.zmx", &zmx("", BK7)).assert_value("focal_length_mm", 49.043, 1e-3);
    measure_lens("today.zmx", &zmx("", "N-SK2 0 0 1.5 40")).assert_value("focal_length_mm", 41.7920, 1e-4);
    measure_lens("sk2.zmx", &zmx("", "SK2 0 0 1.61765 5.514E+1")).assert_value("focal_length_mm", 41.7920, 1e-4);
    let ohara = measure_lens("lah66.zmx", &zmx("", "LAH66 0 0 1.7762 4.94E+1"));
    ohara.assert_value("focal_length_mm", 32.9367, 1e-4);
    assert!(!ohara.remarks().contains("1.7762"), "{}", ohara.remarks());
    let schott = measure_lens("lak8.zmx", &zmx("", "LAK8 0 0 1.7762 4.94E+1"));
    assert!(schott.remarks().contains("its successor N-LAK8 is used, not n_d 1.7762"), "{}", schott.remarks());
}

#[test]
fn an_aperture_on_a_plane_in_air_clips() {
    let plane = |aperture: &str| {
        zmx(&format!("SURF 1\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 20\n  DIAM 2 1 0 0 1 \"\"\n{aperture}"), BK7)
    };
    // The drawing size of a plane is no aperture.
    let rendered_report = measure_lens("drawn.zmx", &plane(""));
    rendered_report.assert_value("f_number", 9.81, 1e-2);
    for aperture in ["  CLAP 0 2 0\n", "  FLAP 0 2 0\n"] {
        let clipped = measure_lens("baffle.zmx", &plane(aperture));
        clipped.assert_value("f_number", 12.26, 1e-2);
        clipped.assert_value("focal_length_mm", 49.043, 1e-3);
        clipped.assert_value("entrance_pupil_diameter_mm", 4.0, 1e-6);
        let message = "surface 1 (line 16), not the stop, limits the bundle on the axis: f/12.261, where the stop alone would give f/9.809";
        assert!(clipped.remarks().contains(message), "{}", clipped.remarks());
    }
    // A larger aperture exists, and clips nothing on the axis.
    let wide = measure_lens("wide.zmx", &plane("  CLAP 0 4 0\n"));
    wide.assert_value("f_number", 9.81, 1e-2);
    // The stop's own aperture also clips.
    let stop = zmx("", BK7).replacen("DIAM 6 1", "CLAP 0 2 0\n  DIAM 6 1", 1);
    let stop = measure_lens("stop.zmx", &stop);
    stop.assert_value("f_number", 12.26, 1e-2);
    assert!(
        stop.remarks().contains("limits the stop to 2.0000 mm; the lens would open it to 2.5000 mm"),
        "{}",
        stop.remarks()
    );
}

#[test]
fn a_clear_aperture_smaller_than_the_bundle_clips_it() {
    let file = zmx("", BK7).replace("ENPD 5", "ENPD 25").replacen("DIAM 6 ", "DIAM 12.5 ", 1).replacen(
        "DIAM 6 ",
        "DIAM 12.0 ",
        1,
    );
    let lens = measure_lens("rim.zmx", &file);
    // The ray that meets the edge of the rear surface at 12 mm from the axis enters at 12.09 mm: it falls by 0.087 over the remaining 1 mm of glass.
    lens.assert_value("f_number", 2.03, 1e-2);
    lens.assert_value("entrance_pupil_diameter_mm", 24.18, 2e-2);
    assert!(lens.remarks().contains("surface 2 (line 23), not the stop, limits"), "{}", lens.remarks());
}

/// A biconvex singlet of N-BK7 as written by CODE V: 49.04 mm.
fn seq(front: &str, rear: &str, edits: &str) -> String {
    format!(
        "RDM;LEN\nEPD 5.0\nDIM M\nWL 656.3 587.6 486.1\nREF 2\nYAN 0 7 10\nSO 0.0 1e13\nS {front}\n STO\n CIR 6\nS {rear}\n CIR 6\n\
         SI 0 0\n{edits}\nGO\n"
    )
}

#[test]
fn edits_of_codev_files_are_followed() {
    let (front, rear) = ("50 4 NBK7_SCHOTT", "-50 47");
    for (file, right) in [
        (seq(front, rear, ""), 49.043),
        (seq(front, rear, "RDY S1 25\nRDY S2 -25"), 24.865),
        (seq(front, rear, "THI S1 8\nGLA S1 SF6_SCHOTT"), 32.198),
        (seq(front, rear, "SCA 2.0"), 98.086),
        (seq("0 4 NBK7_SCHOTT\n CUY 0.02", "0 47\n CUY -0.02", ""), 49.043),
    ] {
        measure_lens("lens.seq", &file).assert_value("focal_length_mm", right, 1e-3);
    }
    // The term of r¹⁸ is 15 µm at the edge of the bundle, and moves its rays.
    let spot = |h: &str| {
        let front = format!("{front}\n ASP\n K 0.0\n A 0;B 0;C 0;D 0;E 0;F 0;G 0;H {h};J 0");
        measure_lens("lens.seq", &seq(&front, rear, "")).report["fields"][0]["spot_radius_mm"].as_f64().expect("a spot")
    };
    assert!(spot("-1e-9") - spot("0") > 0.5, "{} for {}", spot("-1e-9"), spot("0"));
}

/// First-order values refer to the file's primary wavelength, state it, and refer to another on request.
#[test]
fn first_order_figures_are_of_the_primary_wavelength() {
    let (front, rear) = ("50 4 NBK7_SCHOTT", "-50 47");
    // The thick biconvex lens of N-BK7: n by its Sellmeier equation.
    let focal = |nm: f64| {
        let (b, c, l) =
            ([1.03961212, 0.231792344, 1.01046945], [0.00600069867, 0.0200179144, 103.560653], nm * nm * 1e-6);
        let n = (1.0 + (0..3).map(|i| b[i] * l / (l - c[i])).sum::<f64>()).sqrt();
        let power = (n - 1.0) * (2.0 / 50.0 - (n - 1.0) * 4.0 / (n * 50.0 * 50.0));
        1.0 / power
    };
    for (reference, nm) in [(1, 656.3), (2, 587.6), (3, 486.1)] {
        let file = seq(front, rear, "").replace("REF 2", &format!("REF {reference}"));
        let lens = measure_lens("lens.seq", &file);
        lens.assert_value("first_order_wavelength_nm", nm, 1e-9);
        lens.assert_value("focal_length_mm", focal(nm), 2e-8);
        let (_folder, words) = arguments("lens.seq", &file, &[]);
        let message = etendue(words).ok().out;
        assert!(message.contains(&format!("first order at         {nm} nm (fields at 587.56 nm)")), "{message}");
    }
    let zemax = zmx("", BK7)
        .replace("WAVM 1 0.58756 1\nPWAV 1", "WAVM 1 0.58756 1\nWAVM 2 0.55 1\nPWAV 2")
        .replace("0 0 2 1 0 0 0", "0 0 2 2 0 0 0");
    measure_lens("lens.zmx", &zemax).assert_value("focal_length_mm", focal(550.0), 2e-8);
    // An f-number also refers to that wavelength.
    let fast = measure_lens("lens.zmx", &zemax.replace("ENPD 5", "FNUM 10 0"));
    fast.assert_value("entrance_pupil_diameter_mm", focal(550.0) / 10.0, 2e-8);
    let (_folder, words) = arguments("lens.zmx", &zemax, &["--json", "--wavelength-nm", "486.1"]);
    let requested = LensFileReport { report: serde_json::from_str(&etendue(words).ok().out).expect("JSON") };
    requested.assert_value("focal_length_mm", focal(486.1), 2e-8);
    requested.assert_value("first_order_wavelength_nm", 486.1, 1e-9);
    let (_folder, words) = arguments("lens.zmx", &zemax.replace("PWAV 2", "PWAV 3"), &[]);
    etendue(words).refused(&["lens.zmx", "the primary wavelength has number 3; expected 1 to 2"]);
    let (_folder, words) = arguments("lens.zmx", &zemax, &["--wavelength-nm", "2000"]);
    etendue(words).refused(&["--wavelength-nm", "300 to 1100"]);
}

#[test]
fn what_a_codev_file_changes_in_an_unknown_way_is_refused_with_its_line() {
    for (edit, message) in [("RDY S1 Z2 25", "RDY of a zoom position"), ("INS S2", "INS is not supported")] {
        let (_folder, words) = arguments("lens.seq", &seq("50 4 NBK7_SCHOTT", "-50 47", edit), &[]);
        etendue(words).refused(&["lens.seq", ":14", message]);
    }
}

/// An unread keyword of a surface is noted once, with its first line; drawing keywords are not noted.
#[test]
fn keywords_of_a_surface_that_are_not_read_are_noted() {
    let lens = zmx("", BK7).replace("  CURV", "  COMM front\n  COAT AR\n  CURV");
    let remarks = measure_lens("coated.zmx", &lens).remarks();
    assert_eq!(remarks.matches("COAT of a surface is ignored").count(), 1, "{remarks}");
    assert!(!remarks.contains("COMM"), "{remarks}");
}

#[test]
fn a_coordinate_break_of_zeros_is_a_plane_and_an_ideal_lens_has_no_aberrations() {
    let zeros: String = (1..=6).map(|i| format!("  PARM {i} 0\n")).collect();
    let plane = format!("SURF 1\n  TYPE COORDBRK\n  CURV 0.0\n{zeros}  DISZ 3\n  DIAM 0 0 0 0 1 \"\"\n");
    measure_lens("dummy.zmx", &zmx(&plane, BK7)).assert_value("focal_length_mm", 49.043, 1e-3);
    let ideal = zmx("", BK7).replacen(
        "TYPE STANDARD\n  CURV 0.02 0 0 0 0 \"\"\n  DISZ 4",
        "TYPE PARAXIAL\n  CURV 0.0\n  PARM 1 50\n  PARM 2 1\n  DISZ 50",
        1,
    );
    let glass = format!("  GLAS {BK7} 0 0 0 0 0 0\n");
    let (lens, rest) = ideal.split_once(&glass).expect("a glass");
    let second = rest.find("SURF 2").expect("a surface")..rest.find("SURF 3").expect("an image");
    let ideal = format!("{lens}{}{}", &rest[..second.start], &rest[second.end..]);
    let report = measure_lens("ideal.zmx", &ideal);
    report.assert_value("focal_length_mm", 50.0, 1e-9);
    report.assert_value("f_number", 10.0, 1e-9);
    for field in report.report["fields"].as_array().expect("fields") {
        assert!(field["spot_radius_mm"].as_f64().expect("a spot") < 1e-9, "{field}");
    }
}

/// A Cassegrain of 50 mm diameter, f/8, whose secondary with its holder hides a disc of radius 10 mm.
fn cassegrain(disc: &str) -> String {
    format!(
        "VERS 140124 258 36214\nMODE SEQ\nUNIT MM X W X CM MR CPMM\nENPD 50\nFTYP 0 0 2 1 0 0 0\nYFLN 0 0.2\nWAVM 1 0.55 1\nPWAV 1\n\
         SURF 0\n  TYPE STANDARD\n  CURV 0.0\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 \"\"\n\
         SURF 1\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 150\n{disc}  DIAM 10 1 0 0 1 \"\"\n\
         SURF 2\n  STOP\n  TYPE STANDARD\n  CURV -0.0025\n  CONI -1\n  GLAS MIRROR 0 0 1.5 40\n  DISZ -150\n  DIAM 25 1 0 0 1 \"\"\n\
         SURF 3\n  TYPE STANDARD\n  CURV -0.005\n  CONI -9\n  GLAS MIRROR 0 0 1.5 40\n  DISZ 100\n  DIAM 9 1 0 0 1 \"\"\n\
         SURF 4\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 0\n  DIAM 10 0 0 0 1 \"\"\n"
    )
}

#[test]
fn a_telescope_is_measured_with_its_obscuration() {
    // Paraboloid and hyperboloid with a common focus: 200 mm, doubled by the secondary.
    let open = measure_lens("open.zmx", &cassegrain(""));
    open.assert_value("focal_length_mm", 400.0, 1e-9);
    open.assert_value("back_focus_from_last_vertex_mm", 100.0, 1e-9);
    open.assert_value("obscured_ratio", 0.0, 1e-12);
    assert!(open.remarks().contains("it states no central obscuration"), "{}", open.remarks());
    let disc = measure_lens("disc.zmx", &cassegrain("  OBSC 0 10 0\n"));
    disc.assert_value("f_number", 8.0, 1e-9);
    disc.assert_value("obscured_ratio", 0.4, 1e-9);
    for lens in [open, disc] {
        let axis = &lens.report["fields"][0];
        assert!(axis["spot_radius_mm"].as_f64().expect("a spot") < 1e-9, "{axis}");
        assert!(axis["other_bundles"].as_array().expect("a list").is_empty(), "{axis}");
    }
}

/// K16: a fast plastic asphere (f/1.4) whose only field is the axis. Without a requested radius its image ends where half of the axis's light arrives: cos⁴ and
/// vignetting leave 0.494 at 9.6 mm and 0.69 at 7.2 mm.
#[test]
fn a_lens_file_without_fields_is_measured_as_far_as_half_of_the_light() {
    let lens = "RDM;LEN\nEPD 11.0\nDIM M\nWL 656.3 587.6 486.1\nREF 2\nYAN 0\nSO 0 1e13\nS 9.5 3.5 531158.560\n STO\n CIR 5.6\n ASP\n K -0.7\n \
                A -1.6e-5;B -2.7e-7;C -1.2e-9;D 0\nS -50 13\n CIR 5.6\nSI 0 0\nGO\n";
    let measured = measure_lens("fast.seq", lens);
    let edge = measured.report["fields"].as_array().and_then(|fields| fields.last()).expect("fields").clone();
    let number = |key: &str| edge[key].as_f64().unwrap_or_else(|| panic!("no {key} in {edge}"));
    // The search ends within 1/64 of a step of 25 %, over which the light falls by 0.003.
    assert!((number("relative_illumination") - 0.5).abs() < 4e-3, "{edge}");
    assert!((7.2..9.6).contains(&number("height_mm")), "{edge}");
    assert!(measured.remarks().contains("the file states no field"), "{}", measured.remarks());
}
