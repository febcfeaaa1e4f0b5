//! Depth.

use super::{normals, test_image};
use crate::coverage::assert_coverage;
use etendue_metrology::depth::{DepthSettings, measure_depth};

/// A plane at 10 m, measured 0.05 m too far with noise of 0.2 m shared by neighbours over squares of this many pixels.
fn measured(seed: u64, shared_px: usize) -> crate::coverage::CoverageRun {
    const SIZE: usize = 160;
    let truth = test_image(SIZE, SIZE, |_| 10.0);
    let mut normal = normals(seed, 0);
    let noise: Vec<f64> = (0..SIZE * SIZE).map(|_| 0.2 * normal()).collect();
    let at = |i: usize| noise[i / SIZE / shared_px * SIZE + i % SIZE / shared_px];
    let estimate = test_image(SIZE, SIZE, |i| 10.05 + at(i));
    let report = measure_depth(&estimate, &truth, &DepthSettings::default()).expect("depths");
    vec![
        ("bias", report.all.bias_m, 0.05),
        ("RMSE", report.all.rmse_m, (0.05_f64 * 0.05 + 0.04).sqrt()),
        ("RMSE of a range", report.ranges[2].2.rmse_m, (0.05_f64 * 0.05 + 0.04).sqrt()),
    ]
}

#[test]
fn depth_errors() {
    assert_coverage("depth", |seed| measured(seed, 1));
}

#[test]
fn depth_errors_that_neighbours_share() {
    assert_coverage("depth, noise in squares of 4 px", |seed| measured(seed, 4));
}
