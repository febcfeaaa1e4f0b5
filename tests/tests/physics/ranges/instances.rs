//! A million instances of one mesh, each at a height of its own, seen from above: every pixel sees the right one.

use etendue_pipeline::truth::ground_truth;
use etendue_testkit::page::{Row, check};
use etendue_testkit::skip::skipped;
use etendue_tests::Job;
use etendue_tracer::accel::Simd;
use std::fmt::Write as _;

/// Instances on a side of the square, a metre each.
const SIDE: usize = 1000;
const CAMERA_M: f64 = 1000.0;
const WIDTH: usize = 64;
/// Half the width of what is seen, as a tangent.
const HALF_WIDTH: f64 = 0.45;

/// Height of an instance, m: to a metre, neighbours apart.
fn height_m(i: usize, j: usize) -> f64 {
    ((i * 367 + j * 733) % SIDE) as f64 / SIDE as f64
}

/// A camera above the middle of the square that looks down, rows along x.
fn job() -> Job {
    let mut objects = String::new();
    for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
        let middle = [i, j].map(|at| at as f64 + 0.5 - SIDE as f64 / 2.0);
        let (x, y, z) = (middle[0], middle[1], height_m(i, j));
        let named = format!("name = \"{i} {j}\"\nmesh = \"cell\"\nmaterial = \"matt\"");
        writeln!(objects, "[[scene.objects]]\n{named}\nposition_m = [{x}, {y}, {z}]").expect("memory");
    }
    let corners = [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]];
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, {CAMERA_M}]
        rotation_deg = [0, 90, 0]
        lens = {{ type = "pinhole", focal_length_mm = 10, f_number = 8 }}
        sensor = {{ width_px = {WIDTH}, height_px = {WIDTH}, pixel_pitch_um = {pitch:?} }}
        [render]
        spp = 1
        wavelength_range_nm = [500, 600]
        [scene]
        materials = [{{ name = "matt", type = "diffuse", reflectance = 0.5 }}]
        environment = {{ type = "uniform", radiance_w_m2_sr_nm = 1 }}
        [[scene.meshes]]
        name = "cell"
        file = "cell.obj"
        up_axis = "z"
        {objects}
        "#,
        pitch = 2e4 * HALF_WIDTH / WIDTH as f64,
    ))
    .with_triangles("cell.obj", &corners, &[[0, 1, 2], [0, 2, 3]])
}

/// The nearest of the instances that the ray down with these slopes meets, by all near where it comes down; infinite where it passes between two.
fn depth_m([along_x, along_y]: [f64; 2]) -> f64 {
    let cell = |slope: f64| (slope * CAMERA_M + SIDE as f64 / 2.0).floor() as usize;
    let around = |at: usize| at.saturating_sub(2)..(at + 3).min(SIDE);
    let hit = |(i, j): (usize, usize)| {
        let depth = CAMERA_M - height_m(i, j);
        let is_in = |slope: f64, at: usize| (slope * depth + SIDE as f64 / 2.0 - at as f64 - 0.5).abs() < 0.5;
        (is_in(along_x, i) && is_in(along_y, j)).then_some(depth)
    };
    around(cell(along_x))
        .flat_map(|i| around(cell(along_y)).map(move |j| (i, j)))
        .filter_map(hit)
        .fold(f64::INFINITY, f64::min)
}

/// Whether the test is asked for.
fn is_requested() -> bool {
    std::env::var_os("ETENDUE_INSTANCES").is_some_and(|value| value == "1")
}

/// Most memory that this process has held, GB, where the system tells.
fn max_gb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|kb| kb.trim().strip_suffix(" kB")?.parse::<f64>().ok()).map_or(0.0, |kb| kb / 1e6)
}

#[test]
fn instances() {
    const MAX_GB: f64 = 8.0;
    if !is_requested() {
        return skipped("10^6 instances", "minutes and 4 GB: just extremes runs it (ETENDUE_INSTANCES=1)");
    }
    let plan = job().plan();
    let truth = ground_truth(&plan, &plan.cameras[0], 0, Simd::Auto);
    let wrong = |(row, column): (usize, usize)| {
        let slope = |at: usize| HALF_WIDTH * (1.0 - (2 * at + 1) as f64 / WIDTH as f64);
        let (actual, expected) = (f64::from(truth.depth.at(column, row)), depth_m([slope(row), slope(column)]));
        !(actual == expected || (actual / expected - 1.0).abs() <= 1e-6)
    };
    let pixels = (0..WIDTH).flat_map(|row| (0..WIDTH).map(move |column| (row, column)));
    let missed = pixels.filter(|pixel| wrong(*pixel)).count();
    let row = Row::at_most(
        "10⁶ instances of one mesh at different heights, from above",
        "the correct one in every pixel, depth error ≤ 10⁻⁶, in less than 8 GB (pixels without)",
        missed as f64,
        0.0,
    );
    let rows = [Row { holds: row.holds && max_gb() < MAX_GB, ..row }];
    check("Many instances", "Memory and time by number: docs/robustness.md.", &rows);
}
