//! Coverage of pixels compared with geometry.

use super::*;
use crate::{Choices, compile};
use etendue_scene::asset::Assets;
use etendue_scene::{Description, Overrides};
use std::path::Path;

/// A camera at the origin that looks along +x at a sheet 10 m away, with its upper edge `edge_m` above the axis; 0.1 m of it correspond to one pixel.
fn plan(lens: &str, edge_m: f64, camera: &str, motion: &str) -> Plan {
    let place = if motion.is_empty() { format!("position_m = [10, 0, {}]", edge_m - 2.0) } else { motion.to_owned() };
    let text = format!(
        "format = 1\n[[cameras]]\nname = \"eye\"\nposition_m = [0, 0, 0]\nrotation_deg = [0, 0, 0]\nlens = {lens}\n{camera}\n[render]\nspp = 256\nreplicates = 1\n\
         [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[scene.objects]]\nname = \"sheet\"\nmaterial = \"grey\"\nshape = {{ type = \"box\", size_m = [0.01, 40, 4] }}\n{place}\n"
    );
    let read = |_: &Path| Ok(text.clone());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).unwrap_or_else(|f| panic!("{f}"));
    compile(&job, &Assets::default(), &Choices::default()).unwrap_or_else(|f| panic!("{f:?}"))
}

const PINHOLE: &str = "{ type = \"pinhole\", focal_length_mm = 6, f_number = 8 }";
const SENSOR: &str = "sensor = { width_px = 4, height_px = 8, pixel_pitch_um = 60 }";

fn coverage_of_plan(plan: &Plan) -> IdentityCoverage {
    identity_coverage(plan, &plan.cameras[0], 0, Simd::Auto)
}

/// Coverage by the sheet in the rows of a column.
fn column(coverage: &IdentityCoverage) -> Vec<f32> {
    (0..coverage.height)
        .map(|row| coverage.instances[row * coverage.width + 1].first().map_or(0.0, |coverage_of| coverage_of.coverage))
        .collect()
}

#[test]
fn an_edge_covers_its_part_of_a_pixel() {
    // A third of the row above the axis: 0.0333 m of 0.1 m at 9.995 m, the box's near face.
    let coverage = coverage_of_plan(&plan(PINHOLE, 0.1 / 3.0, SENSOR, ""));
    assert_eq!((coverage.width, coverage.height), (4, 8));
    let column = column(&coverage);
    // With 64 stratified samples the error of a straight edge is 1/64, that of its face's distance 5e-4.
    assert_eq!(column[..3], [0.0; 3]);
    assert!((column[3] - 1.0 / 3.0).abs() < 0.02, "{column:?}");
    assert_eq!(column[4..], [1.0; 4]);
    assert_eq!(coverage.materials[3 * 4 + 1][0].coverage, column[3]);
    assert!(coverage.instances[0].is_empty(), "the sky is no identity");
    assert_eq!(coverage, coverage_of_plan(&plan(PINHOLE, 0.1 / 3.0, SENSOR, "")));
}

#[test]
fn blur_and_motion_spread_an_edge_over_pixels() {
    // An aperture of 100 mm focused at 5 m: a point at 10 m blurs over 100 mm there, one pixel. Above the edge, over a radius R of half a pixel, the mean of
    // the disc's coverage beyond d is 2R/3π of the pixel: 0.106.
    let blurred = "{ type = \"thin\", focal_length_mm = 60, f_number = 0.6, focus_distance_m = 5 }";
    let sensor = SENSOR.replace("60", "607");
    let column_of = |plan: &Plan| column(&coverage_of_plan(plan));
    let blurred = column_of(&plan(blurred, 0.0, &sensor, ""));
    // 64 points of pixel and pupil: a standard deviation of at most √(0.106 · 0.894/64) = 0.04 for independent points.
    assert!((blurred[3] - 0.106).abs() < 0.06, "light passes above the edge out of focus: {blurred:?}");
    assert!((blurred[4] - 0.894).abs() < 0.06, "and is missing below: {blurred:?}");
    // The edge rises from the axis by a pixel during the exposure: half of the row on average.
    let motion = "keys = [{ time_s = 0, position_m = [10, 0, -2] }, { time_s = 0.1, position_m = [10, 0, -1.9] }]";
    let sensor = SENSOR.replace(" }", ", shutter = { type = \"global\", exposure_s = 0.1 } }");
    let in_motion = column_of(&plan(PINHOLE, 0.0, &sensor, motion));
    // 64 points of the pixel and the exposure together: a standard deviation of at most 0.5/8 for independent points.
    assert!((in_motion[3] - 0.5).abs() < 0.1, "{in_motion:?}");
    assert_eq!((in_motion[2], in_motion[4]), (0.0, 1.0));
}

#[test]
fn the_largest_share_comes_first_and_ids_break_ties() {
    let mut tally = Tally::default();
    for (id, weight) in [(7, 1.0), (0, 2.0), (3, 1.0), (5, 4.0)] {
        tally.add(id, weight);
    }
    let coverage_of = |id, coverage| IdentityFraction { id, coverage };
    assert_eq!(tally.into_fractions(), [coverage_of(5, 0.5), coverage_of(3, 0.125), coverage_of(7, 0.125)]);
    assert!(Tally::default().into_fractions().is_empty(), "a pixel that no ray leaves has none");
}
