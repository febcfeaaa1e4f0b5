//! Irradiance behind lenses: finite apertures, principal planes, vignetting.

use core::f64::consts::PI;
use etendue_core::maths::f64::{atan, cos, pow, tan};
use etendue_testkit::form_factor::{by_sum, foote, lens_area};
use etendue_testkit::judge::compare_with_truth;
use etendue_tests::{Job, Samples, Shot};

const COLUMNS: usize = 41;
const FOCAL_MM: f64 = 10.0;

/// A row of nearly point-like pixels whose tangents run evenly from the axis to 40°, before a wall of radiance 1.
fn wall(lens: &str) -> Shot {
    let pitch_um = 1000.0 * FOCAL_MM * tan(40_f64.to_radians()) / (COLUMNS - 1) as f64;
    Job::new(format!(
        r#"
        [scene]
        materials = [{{ name = "wall", type = "emitter", emission = {{ radiance_w_m2_sr_nm = 1 }} }}]
        [[scene.objects]]
        name = "wall"
        shape = {{ type = "quad", size_m = [50, 50] }}
        material = "wall"
        position_m = [3, 0, 0]
        rotation_deg = [0, -90, 0]
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        lens = {{ focal_length_mm = {FOCAL_MM}, {lens} }}
        # A thousandth of the pixel's side: the mean over it is the value at its centre to 1e-9.
        sensor = {{ width_px = {COLUMNS}, height_px = 1, pixel_pitch_um = {pitch_um}, fill_factor = 1e-6, principal_point_px = [0.5, 0.5] }}
        [render]
        spp = 4096
        replicates = 16
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        [output]
        irradiance = true
        "#
    ))
    .shot()
}

fn tangent(column: usize) -> f64 {
    tan(40_f64.to_radians()) * column as f64 / (COLUMNS - 1) as f64
}

#[test]
fn a_wall_through_a_thin_lens_follows_the_finite_aperture() {
    for n in [1.4, 2.0, 2.8, 4.0, 8.0, 16.0] {
        let row = wall(&format!("type = \"thin\", f_number = {n}, focus_distance_m = \"infinity\"")).irradiance();
        for (column, mean) in row.mean.iter().enumerate() {
            let truth = PI * foote(tangent(column), 0.5 / n);
            let error = f64::from(*mean) / truth - 1.0;
            // The bound of the specification; scatter of 4096 points of the pupil is far below it.
            assert!(error.abs() < 3e-3, "f/{n}, column {column}: {error:e}");
        }
        let comparison = compare_with_truth(
            row.estimate(),
            |i| PI * foote(tangent(i), 0.5 / n),
            |i| {
                // Sampled irradiance is stored as f32.
                1e-6 * PI * foote(tangent(i), 0.5 / n)
            },
        );
        assert!(comparison.is_ok(), "f/{n}: {comparison:?}");
    }
}

#[test]
fn a_slow_lens_follows_the_fourth_power_of_the_cosine() {
    let row = wall("type = \"thin\", f_number = 100, focus_distance_m = \"infinity\"").irradiance();
    for (column, mean) in row.mean.iter().enumerate() {
        // A pupil of radius 1/200 departs from cos⁴ by the order of its square, 2.5e-5 times a number below 6.
        let relative = f64::from(mean / row.mean[0]);
        assert!((relative / pow(cos(atan(tangent(column))), 4.0) - 1.0).abs() < 2e-4, "column {column}");
    }
}

#[test]
fn close_focus_costs_light_by_the_bellows() {
    // f = 10 mm focused at 110 mm: the sensor stands at 11 mm, m = −0.1, and E = π/(1 + 4 N² 1.1²) on the axis.
    let row = wall("type = \"thin\", f_number = 4, focus_distance_m = 0.11").irradiance();
    let truth = PI / (1.0 + 4.0 * 16.0 * 1.21);
    // f32 storage, and scatter over the pupil (the weight varies by 1 %, drawn 4096 times).
    assert!((f64::from(row.mean[0]) / truth - 1.0).abs() < 1e-4, "{} {truth}", row.mean[0]);
}

/// A scene with depth and edges, seen through a wide aperture.
fn still_life(lens: &str) -> Samples {
    Job::new(format!(
        r#"
        [scene]
        materials = [
            {{ name = "red", type = "diffuse", reflectance = [0.8, 0.2, 0.1] }},
            {{ name = "metal", type = "conductor", metal = "Cu", alpha = 0.2 }},
        ]
        objects = [
            {{ name = "floor", shape = {{ type = "quad", size_m = [20, 20] }}, material = "red" }},
            {{ name = "ball", shape = {{ type = "sphere", radius_m = 0.5 }}, material = "metal", position_m = [4, 0.3, 0.5] }},
        ]
        environment = {{ type = "uniform", radiance_w_m2_sr_nm = 1 }}
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 1]
        look_at_m = [4, 0, 0.5]
        lens = {{ focal_length_mm = 20, f_number = 1.4, focus_distance_m = 3, transmittance = 0.9, {lens} }}
        sensor = {{ width_px = 16, height_px = 12, pixel_pitch_um = 600 }}
        [render]
        spp = 64
        replicates = 16
        band_width_nm = 50
        wavelength_range_nm = [400, 700]
        [output]
        irradiance = true
        "#
    ))
    .shot()
    .irradiance()
}

#[test]
fn a_thick_lens_with_coincident_principal_planes_is_a_thin_lens() {
    let thin = still_life("type = \"thin\"");
    for pupil in ["entrance", "exit"] {
        let thick = still_life(&format!("type = \"thick\", constant_pupil = \"{pupil}\""));
        let largest = thin.mean.iter().copied().fold(0.0, f32::max);
        for (i, (a, b)) in thin.mean.iter().zip(&thick.mean).enumerate() {
            // The lenses do the same in another order of f64 operations; a ray's f32 direction can then differ by one
            // unit in the last place (6e-8), which moves what is seen by as much, and a sum of 64 samples by less than 1e-5.
            assert!((a - b).abs() <= 1e-5 * largest, "{pupil}, sample {i}: {a} {b}");
        }
    }
}

#[test]
fn vignetting_is_the_common_area_of_two_discs() {
    // A slow lens, so that every point of the pupil counts nearly the same; a front rim as wide as the pupil, 20 pupil
    // radii ahead of it, leaves the common area of two equal discs at a distance of 20 tan θ radii. (Infinity focus.)
    let (n, pupil_mm) = (100.0, FOCAL_MM / 200.0);
    let aperture = format!("front_aperture = {{ position_mm = {}, radius_mm = {pupil_mm} }}", -5.0 * pupil_mm);
    let lens =
        format!("type = \"thick\", constant_pupil = \"entrance\", f_number = {n}, focus_distance_m = \"infinity\"");
    let row = wall(&format!("{lens}, {aperture}")).irradiance();
    let open = |t: f64| lens_area(1.0, 1.0, 5.0 * t) / PI;
    let full_aperture = |t: f64| PI * foote(t, 0.5 / n);
    let comparison = compare_with_truth(
        row.estimate(),
        |i| full_aperture(tangent(i)) * open(tangent(i)),
        |i| {
            // The weight varies over the pupil by 4 sin θ cos θ a ≤ 2 a = 1 % from side to side, and the centroid of the open
            // part lies off the centre by up to its radius: 0.5 % of the light left is the bound of what the area leaves out.
            // Where nearly all is shut no point of 4096 may meet the rest, and the scatter knows nothing: 7 points that were
            // expected are all missed once in e⁷ = 1100 times.
            full_aperture(tangent(i)) * (5e-3 * open(tangent(i)) + 7.0 / 4096.0)
        },
    );
    assert!(comparison.is_ok(), "{comparison:?}");
    assert!(row.mean[COLUMNS / 4] > 0.0 && row.mean[COLUMNS - 1] == 0.0, "from half open to shut within the row");
}

#[test]
fn vignetting_of_a_fast_lens_is_the_sum_over_what_is_open() {
    // At f/2 the weight varies over the pupil: each point counts by cos⁴. A rear rim clips on the side of the sensor.
    let pupil_mm = FOCAL_MM / 4.0;
    let apertures = [
        (format!("front_aperture = {{ position_mm = -6, radius_mm = {} }}", 1.2 * pupil_mm), 6.0, 1.2, 1.0, 1.0),
        (format!("rear_aperture = {{ position_mm = 5, radius_mm = {} }}", 0.75 * pupil_mm), 5.0, 0.75, -1.0, 0.5),
    ];
    for (aperture, distance_mm, radius, side, scale) in apertures {
        let lens = "type = \"thick\", constant_pupil = \"exit\", f_number = 2, focus_distance_m = \"infinity\"";
        let row = wall(&format!("{lens}, {aperture}")).irradiance();
        // A ray from the pupil's point q (in units of its radius, x along the sensor point) meets the front rim at
        // q − t d/a, and the rear rim, half way to the sensor, at q/2 + t d/a (t d is half the sensor point's distance).
        let truth = |column: usize| {
            let shift = tangent(column) * distance_mm / pupil_mm;
            PI * by_sum(tangent(column), 0.25, 300, |[x, y]| {
                let (x, y) = (scale * x - side * shift, scale * y);
                x * x + y * y <= radius * radius
            })
        };
        // The sum over 300 rings cuts the rim's points to about 1/300 of the edge's share: 5e-4 of the open pupil.
        let comparison = compare_with_truth(row.estimate(), truth, |i| 5e-4 * PI * foote(tangent(i), 0.25));
        assert!(comparison.is_ok(), "{aperture}: {comparison:?}");
    }
}
