//! Six views against direct: wide cameras by the route at the pupil and through the lens.
//!
//! In a room of glowing walls, turned against the cube's faces, both must show the same light and the same distances.

use etendue_core::Plane;
use etendue_core::quantity::Length;
use etendue_pipeline::plan::Route;
use etendue_pipeline::pupil_depth::pupil_depth;
use etendue_pipeline::stored::StoredRadianceImage;
use etendue_stats::chi_square::sidak_level;
use etendue_stats::{ReplicateEstimate, student};
use etendue_testkit::judge::SIGNIFICANCE;
use etendue_tests::{Job, Shot};
use etendue_tracer::accel::Simd;

const WIDTH: usize = 48;
const HEIGHT: usize = 24;

const CAMERAS: [&str; 2] = [
    "greatest_angle_deg = 90, projection = { type = \"equidistant\", fx_px = 15.28 }",
    "projection = { type = \"equirectangular\", field_of_view_deg = 360 }",
];

/// Walls 2 m away on all sides, each with its own instance, their light growing from one corner to the other.
fn room() -> String {
    let walls = [
        ("front", "[2, 0, 0]", "[0, -90, 0]"),
        ("back", "[-2, 0, 0]", "[0, 90, 0]"),
        ("left", "[0, 2, 0]", "[0, 0, 90]"),
        ("right", "[0, -2, 0]", "[0, 0, -90]"),
        ("floor", "[0, 0, -2]", "[0, 0, 0]"),
        ("ceiling", "[0, 0, 2]", "[0, 0, 180]"),
    ];
    let wall = |(name, position, rotation)| {
        format!(
            "[[scene.objects]]\nname = \"{name}\"\nshape = {{ type = \"quad\", size_m = [4, 4] }}\nmaterial = \"wall\"\n\
             position_m = {position}\nrotation_deg = {rotation}\n"
        )
    };
    walls.map(wall).concat()
}

fn job(lens: &str, route: &str) -> Job {
    let grey = |i: usize| 0.6 + 0.4 * ((i % 32) + (i / 32)) as f32 / 62.0;
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0.3, -0.2, 0.1]
        rotation_deg = [25, 10, 5]
        lens = {{ type = "calibrated", f_number = 4, {lens} }}
        sensor = {{ width_px = {WIDTH}, height_px = {HEIGHT}, pixel_pitch_um = 100 }}
        [render]
        spp = 64
        replicates = 16
        integrator = "direct"
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        route = "{route}"
        [output]
        irradiance = true
        [scene]
        textures = [{{ name = "ramp", file = "ramp.hdr", encoding = "linear", wrap = "clamp" }}]
        materials = [{{ name = "wall", type = "emitter", emission = {{ luminance_cd_m2 = 1000, illuminant = "E", texture = "ramp" }} }}]
        {}
        "#,
        room()
    ))
    .with_image("ramp.hdr", 32, 32, (0..1024).map(|i| [grey(i); 3]).collect())
}

fn irradiance(shot: &Shot) -> Vec<f64> {
    let cube = shot.light().irradiance.expect("a cube is kept");
    cube.plane(0).expect("in memory").samples().iter().map(|v| f64::from(*v)).collect()
}

/// Pixels whose neighbours, too, look at one and the same wall.
fn inside_a_wall(shot: &Shot) -> Vec<usize> {
    let walls = shot.truth().instance;
    let same = |x: usize, y: usize| {
        let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
        walls.at(x, y) > 0 && around.into_iter().all(|(i, j)| walls.at(i, j) == walls.at(x, y))
    };
    let inner = (1..HEIGHT - 1).flat_map(|y| (1..WIDTH - 1).map(move |x| (x, y)));
    inner.filter(|(x, y)| same(*x, *y)).map(|(x, y)| y * WIDTH + x).collect()
}

#[test]
fn six_views_show_the_light_that_the_lens_sees() {
    const PICTURES: u64 = 4;
    for lens in CAMERAS {
        let truth = job(lens, "lens").shot();
        let pixels = inside_a_wall(&truth);
        assert!(pixels.len() > 200, "{lens}: {} pixels", pixels.len());
        let samples: Vec<_> = (1..=PICTURES)
            .map(|seed| {
                let image = |route: &str, seed: u64| irradiance(&job(lens, route).with_seed(seed).shot());
                (image("lens", seed), image("pupil", seed + PICTURES))
            })
            .collect();
        let critical = student::critical(sidak_level(SIGNIFICANCE, pixels.len()), (PICTURES - 1) as f64);
        let mut sum = 0.0;
        for pixel in &pixels {
            let ratios: Vec<f64> = samples.iter().map(|(a, b)| b[*pixel] / a[*pixel] - 1.0).collect();
            let ratio = ReplicateEstimate::from_replicates(&ratios).expect("four pictures");
            // A wall's light changes by 0.4 over 5.7 m: at the distance of 2 m to 3.5 m by at most 0.3 of itself a radian, seen
            // as steeply as here. Stored pixels (0.065 rad) count as uniform: an eighth of one's step on two axes, 5e-3; the
            // light's fall-off over a pixel of 0.065 rad (or 0.131 rad of a panorama): (p²/24) · 3 = 2e-3.
            let allowed = 7e-3 + critical * ratio.standard_error();
            assert!(ratio.mean.abs() < allowed, "{lens}, pixel {pixel}: {ratio:?}");
            sum += ratio.mean;
        }
        // Over many pixels the steps of stored pixels cancel and the curvature is left.
        let mean = sum / pixels.len() as f64;
        assert!(mean.abs() < 2e-3, "{lens}: {mean}");
    }
}

#[test]
fn stored_distances_are_those_that_the_lens_sees() {
    for lens in CAMERAS {
        let plan = job(lens, "pupil").plan();
        let camera = &plan.cameras[0];
        let Route::Pupil(projection) = &camera.settings.route else { panic!("the route at the pupil") };
        assert!(projection.views().count() >= 5);
        let depth = pupil_depth(&plan, camera, 0, Simd::Auto).expect("at the pupil");
        let bands = camera.settings.bands.expect("a cube");
        let radiance = etendue_core::SpectralCube::new(projection.width(), projection.height(), bands);
        let stored = StoredRadianceImage { projection, radiance: &radiance, distance: Some(&depth.distance) };
        let resampled = stored.resample(&camera.body, [0, 0]).expect("covered").distance.expect("stored");
        let direct = etendue_pipeline::truth::ground_truth(&plan, camera, 0, Simd::Auto).distance;
        for y in 1..HEIGHT - 1 {
            for x in 1..WIDTH - 1 {
                let d = resampled.at(x, y);
                if direct.at(x, y).is_nan() {
                    assert!(d.is_nan(), "{lens} ({x}, {y}): {d}");
                    continue;
                }
                let [near, far] = range(&direct, x, y);
                // The stored pixel looks less than a pixel of the picture away, so what it sees lies within what the
                // neighbours see; in a corner of the room, where three walls meet, a little beyond.
                assert!(d >= near * 0.99 && d <= far * 1.03, "{lens} ({x}, {y}): {d} m, not {near} to {far} m");
            }
        }
    }
}

/// The least and the greatest distance among a pixel and its neighbours that have one.
fn range(distance: &Plane<Length>, x: usize, y: usize) -> [f32; 2] {
    let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
    let distances = around.map(|(i, j)| distance.at(i, j)).filter(|d| !d.is_nan());
    distances.fold([f32::INFINITY, 0.0], |[near, far], d| [near.min(d), far.max(d)])
}
