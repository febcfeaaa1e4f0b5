//! Lamps with an opening, from the description to light and ground truth: what files state, where openings lie, masks, and what is
//! refused.
//!
//! All lights have a flat spectrum, so nothing scatters but a pixel's place on what it sees (0.1 mrad).

use etendue_core::maths::f64::tan;
use etendue_io::photometry::read_photometry;
use etendue_scene::asset::PhotometryAsset;
use etendue_tests::{FLAT, Job, ONE_BAND, eye, flat_per_lux};
use glam::DVec3;
use std::path::Path;

/// A lamp and eyes of one pixel, each from a place to another.
fn job_seen_by(lamp: &str, eyes: &[(DVec3, DVec3)]) -> Job {
    let eyes: String = eyes.iter().enumerate().map(|(i, (from, at))| eye(&format!("eye{i}"), *from, *at)).collect();
    Job::new(format!(
        "{eyes}\n[render]\nspp = 4\nreplicates = 1\n{ONE_BAND}\n[[scene.lights]]\nname = \"lamp\"\n{FLAT}\n{lamp}\n"
    ))
}

/// Luminance that each eye sees, cd/m².
fn luminances(job: &Job) -> Vec<f64> {
    job.shots().iter().map(|shot| f64::from(shot.radiance().mean[0]) / flat_per_lux()).collect()
}

fn assert_near(actual: f64, expected: f64, subject: &str) {
    // Radiances in f32, and directions within 0.1 mrad.
    assert!((actual - expected).abs() <= 5e-4 * expected, "{subject}: {actual} for {expected}");
}

/// What is read of a file of these contents.
fn read(name: &str, text: &str) -> PhotometryAsset {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).expect("the folder of tests' files can be written");
    read_photometry(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// A file of LM-63-2002 of type 1 C, 2 B or 3 A: 500 cd everywhere, and an opening of this width, length and height, m.
fn lm63(kind: u8, opening: [f64; 3]) -> String {
    let [width, length, height] = opening;
    let (vertical, horizontal) = if kind == 1 { ("0 90 180", "0") } else { ("-90 0 90", "-90 0 90") };
    let columns = horizontal.split(' ').count();
    let candela = ["500 500 500"].repeat(columns).join("\n");
    format!(
        "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] None\nTILT=NONE\n1 -1 1 3 {columns} {kind} 2 {width} {length} {height}\n1 1 20\n\
         {vertical}\n{horizontal}\n{candela}\n"
    )
}

/// A file of EULUMDAT alike all around: 500 cd of 6 300 lm, and an opening of this length, width (0: round) and height, mm.
fn eulumdat(length: f64, width: f64, height: f64) -> String {
    let direct = ["0.5"; 10].join("\n");
    format!(
        "None\n1\n1\n1\n0\n3\n90\nreport\nlamp\n1\nlamp\n2024\n900\n800\n50\n{length}\n{width}\n{height}\n{height}\n{height}\n{height}\n\
         100\n100\n1\n0\n1\n1\nLED\n6300\n4000\n80\n20\n{direct}\n0\n0\n90\n180\n79.365\n79.365\n79.365\n"
    )
}

const FILE: &str = "opening = { shape = \"file\" }";

/// Eyes 3 m below a lamp that look straight up, these metres forward and to the left of it.
fn from_below(places: &[(f64, f64)]) -> Vec<(DVec3, DVec3)> {
    places.iter().map(|(x, y)| (DVec3::new(*x, *y, 0.0), DVec3::new(*x, *y, 3.0))).collect()
}

#[test]
fn rectangles_of_files_lie_along_and_across_the_photometric_horizontal() {
    // 0.2 m along C0 (x), 0.4 m across (y), flat: inside at 0.09 and 0.19 m, outside at 0.11 and 0.21 m.
    let eyes = from_below(&[(0.0, 0.0), (0.09, 0.19), (0.11, 0.0), (0.0, 0.21)]);
    let ies = read("flat_opening.ies", &lm63(1, [0.4, 0.2, 0.0]));
    let ldt = read("flat_opening.ldt", &eulumdat(400.0, 200.0, 0.0));
    for (name, asset) in [("lamp.ies", ies), ("lamp.ldt", ldt)] {
        let lamp = format!("type = \"measured\"\nfile = \"{name}\"\nposition_m = [0, 0, 3]\n{FILE}");
        let actual = luminances(&job_seen_by(&lamp, &eyes).with_lamp(name, asset));
        let expected = 500.0 / 0.08;
        assert_near(actual[0], expected, name);
        assert_near(actual[1], expected, name);
        assert_eq!(actual[2..], [0.0, 0.0], "{name}: beside the opening");
    }
}

#[test]
fn bodies_of_files_have_their_height() {
    // A box of 0.2 × 0.4 × 0.1 m: from the side it is seen under 0.4 × 0.1 m.
    let side = [(DVec3::new(-3.0, 0.15, 3.04), DVec3::new(0.0, 0.15, 3.04))];
    let ldt = read("box_opening.ldt", &eulumdat(400.0, 200.0, 100.0));
    let lamp = format!("type = \"measured\"\nfile = \"lamp.ldt\"\nposition_m = [0, 0, 3]\n{FILE}");
    assert_near(luminances(&job_seen_by(&lamp, &side).with_lamp("lamp.ldt", ldt))[0], 500.0 / 0.04, "a box");
    // An upright cylinder of 0.3 m across and 0.1 m: from below a disc; by EULUMDAT of width 0, by LM-63 of negative sizes.
    let area = core::f64::consts::PI * 0.15 * 0.15;
    let below = from_below(&[(0.1, 0.1), (0.12, 0.12)]);
    for (name, text) in [("round.ldt", eulumdat(300.0, 0.0, 100.0)), ("round.ies", lm63(1, [-0.3, -0.3, 0.1]))] {
        let lamp = format!("type = \"measured\"\nfile = \"{name}\"\nposition_m = [0, 0, 3]\n{FILE}");
        let actual = luminances(&job_seen_by(&lamp, &below).with_lamp(name, read(name, &text)));
        // The end of the prism of 48 sides is smaller than the circle by a third of (π/48)².
        assert!((actual[0] * area / 500.0 - 1.001_43).abs() < 3e-4, "{name}: {actual:?}");
        assert_eq!(actual[1], 0.0, "{name}: beside it");
    }
}

#[test]
fn openings_of_types_a_and_b_face_their_axes() {
    // A vertical circle that faces the photometric horizontal, +x of type A (LM-63-2002: width and height negative, no length); of type
    // B the photometric zero is +x, so that a flat opening lies across it.
    for (name, kind, size) in [("a.ies", 3, [-0.4, 0.0, -0.2]), ("b.ies", 2, [-0.4, -0.2, 0.0])] {
        let lamp = format!("type = \"measured\"\nfile = \"{name}\"\nposition_m = [0, 0, 0]\n{FILE}");
        let eyes = [(0.0, 0.0), (0.15, 0.0), (0.0, 0.09), (0.0, 0.11), (0.21, 0.0)]
            .map(|(y, z)| (DVec3::new(3.0, y, z), DVec3::new(0.0, y, z)));
        let actual = luminances(&job_seen_by(&lamp, &eyes).with_lamp(name, read(name, &lm63(kind, size))));
        let expected = 500.0 / (core::f64::consts::PI * 0.2 * 0.1);
        actual[..3].iter().for_each(|actual| assert_near(*actual, expected, name));
        assert_eq!(actual[3..], [0.0, 0.0], "{name}: 0.4 m wide and 0.2 m high");
    }
}

#[test]
fn what_no_opening_can_be_is_refused_where_it_stands() {
    let measured = |name: &str, text: &str| {
        let lamp = format!("type = \"measured\"\nfile = \"{name}\"\nposition_m = [0, 0, 3]\n{FILE}");
        let job = job_seen_by(&lamp, &from_below(&[(0.0, 0.0)])).with_lamp(name, read(name, text));
        job.compiled().map(|_| ()).expect_err("refused")
    };
    let message = measured("point.ies", &lm63(1, [0.0; 3]));
    assert!(message.contains("lights.lamp.opening: the photometric file states no luminous opening"), "{message}");
    let message = measured("point.ldt", &eulumdat(0.0, 0.0, 0.0));
    assert!(message.contains("states no luminous opening"), "{message}");
    let message = measured("line.ies", &lm63(1, [0.0, 1.2, 0.0]));
    assert!(message.contains("the opening is 1.2 × 0 × 0 m"), "{message}");
    let beam = "type = \"head_lamp\"\nbeam = \"high_beam\"\nposition_m = [0, 0, 0]\naim_down_deg = 1\n";
    let job =
        job_seen_by(&format!("{beam}opening = {{ shape = \"disc\", radius_m = 0.04 }}"), &from_below(&[(0.0, 0.0)]));
    assert!(job.compiled().is_ok(), "a head lamp's disc faces forward");
    let bright = "type = \"point\"\nintensity_cd = 1e33\nposition_m = [0, 0, 0]\nopening = { shape = \"sphere\", radius_m = 0.001 }";
    let message = job_seen_by(bright, &from_below(&[(0.0, 0.0)])).compiled().map(|_| ()).expect_err("refused");
    assert!(message.contains("more than the maximum of 1e30"), "{message}");
}

#[test]
fn ground_truth_knows_openings_as_it_knows_objects() {
    let lamp = "type = \"spot\"\nfield_angle_deg = 120\nintensity_cd = 10\n\
                opening = { shape = \"disc\", radius_m = 0.1 }\ninstances = [{ name = \"first\", position_m = [5, 0, 0], rotation_deg = \
                [180, 0, 0] }, { position_m = [5, 1, 0], rotation_deg = [180, 0, 0] }]";
    let eyes =
        [(DVec3::ZERO, DVec3::X), (DVec3::Y, DVec3::new(1.0, 1.0, 0.0)), (-DVec3::Y, DVec3::new(1.0, -1.0, 0.0))];
    let object = "[[scene.materials]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[scene.objects]]\nname = \"ball\"\n\
                  material = \"m\"\nposition_m = [5, -1, 0]\nshape = { type = \"sphere\", radius_m = 0.5 }\n";
    let shots = job_seen_by(&format!("{lamp}\n{object}"), &eyes).shots();
    let names: Vec<_> = shots[0].plan.identities.iter().map(|identity| identity.name.as_str()).collect();
    assert_eq!(names, ["ball", "first", "lamp 2"], "openings come after the objects");
    let truth: Vec<_> = shots.iter().map(etendue_tests::Shot::truth).collect();
    let ids: Vec<_> = truth.iter().map(|t| t.instance.at(0, 0)).collect();
    assert_eq!(ids, [2, 3, 1]);
    assert!((truth[0].depth.at(0, 0) - 5.0).abs() < 1e-5 && truth[0].semantic.at(0, 0) == 0);
    assert!((truth[0].normal.at(0, 0)[0] + 1.0).abs() < 1e-6, "towards the viewer");
}

#[test]
fn a_mask_shapes_what_leaves_the_opening() {
    // Left half white, right half black; seen from the left and from the right, 20 m away, the opening is bright and black.
    let image = (0..64).map(|i| if i % 8 < 4 { [1.0; 3] } else { [0.0; 3] }).collect();
    let lamp = "type = \"point\"\nposition_m = [0, 0, 0]\nrotation_deg = [0, 0, 0]\nintensity_cd = 800\n\
                mask = { file = \"mask.exr\", field_deg = [40, 30] }\nopening = { shape = \"rectangle\", width_m = 0.2, height_m = 0.1 }";
    let lateral_m = 20.0 * tan(10_f64.to_radians());
    let eyes = [lateral_m, -lateral_m].map(|y| (DVec3::new(20.0, y, 0.0), DVec3::ZERO));
    let actual = luminances(&job_seen_by(lamp, &eyes).with_image("mask.exr", 8, 8, image));
    assert_near(actual[0], 800.0 / (0.02 * etendue_core::maths::f64::cos(10_f64.to_radians())), "from the left");
    assert_eq!(actual[1], 0.0, "from the right");
}
