use super::*;

/// A wall at 4 m on the left half, 30 m on the right, sky above.
fn truth() -> Image {
    let depth = |x: usize, y: usize| match (x, y) {
        (_, 0..8) => f32::INFINITY,
        (0..32, _) => 4.0,
        _ => 30.0,
    };
    Image::from_samples(64, 64, (0..64 * 64).map(|i| depth(i % 64, i / 64)).collect()).expect("a square")
}

#[test]
fn errors_are_reported_by_range_and_without_edges() {
    let truth = truth();
    // 10 cm too near on the left, 3 m too far on the right, the border blurred, one pixel missing.
    let samples = truth.samples().iter().enumerate().map(|(i, d)| match i % 64 {
        30..34 => 15.0,
        0 if i / 64 == 40 => f32::NAN,
        0..30 => d - 0.1,
        _ => d + 3.0,
    });
    let estimate = Image::from_samples(64, 64, samples.collect()).expect("a square");
    let settings = DepthSettings { focal_baseline_px_m: Some(300.0), ..DepthSettings::default() };
    let report = measure_depth(&estimate, &truth, &settings).expect("depths");
    let near = report.ranges[0].2;
    // Rows 11 to 63 avoid the sky, columns 0 to 28 the jump, less the missing pixel.
    assert_eq!((near.pixels, near.missing), (53 * 29 - 1, 1));
    assert!((near.bias_m.value + 0.1).abs() < 1e-6 && (near.rmse_m.value - 0.1).abs() < 1e-6);
    assert_eq!((near.outliers.value, near.within[0].value), (0.0, 1.0));
    // Constant: no spread of logarithms, and 300 px m (1/3.9 − 1/4) of disparity, below 3 px.
    let [d1, disparity] = near.disparity.expect("a rig");
    assert!(near.scale_invariant.value < 1e-4 && d1.value == 0.0);
    assert!((disparity.value - 300.0 * (1.0 / 3.9 - 0.25)).abs() < 1e-5, "{disparity:?}");
    assert!((near.inverse_rmse_per_km.value - 1e3 * (1.0 / 3.9 - 0.25)).abs() < 1e-3);
    let far = report.ranges[3].2;
    assert!(
        (far.bias_m.value - 3.0).abs() < 1e-5 && far.outliers.value == 1.0 && (far.relative.value - 0.1).abs() < 1e-6
    );
    assert!((far.squared_relative_m.value - 0.3).abs() < 1e-6 && (far.mean_m.value - 3.0).abs() < 1e-5);
    assert!(report.edges.rmse_m.value > 5.0 && report.ranges[1].2.pixels == 0);
    assert_eq!(report.all.pixels, near.pixels + far.pixels);
}

#[test]
fn a_factor_is_removed_on_request() {
    let truth = truth();
    let estimate = truth.map(|d| 0.25 * d);
    let settings = DepthSettings { alignment: Alignment::Median, ..DepthSettings::default() };
    let report = measure_depth(&estimate, &truth, &settings).expect("depths");
    assert!((report.scale - 4.0).abs() < 1e-6 && report.all.rmse_m.value < 1e-5, "{report:?}");
    let plain = measure_depth(&estimate, &truth, &DepthSettings::default()).expect("depths");
    // ln 4 everywhere: a pure factor.
    assert!((plain.all.rmse_log.value - core::f64::consts::LN_2 * 2.0).abs() < 1e-6);
    assert!(plain.all.scale_invariant.value < 1e-4, "{:?}", plain.all.scale_invariant);
}

#[test]
fn holes_of_the_truth_are_no_edges() {
    // Ground truth of a scanner: one pixel in sixteen.
    let sparse = truth()
        .samples()
        .iter()
        .enumerate()
        .map(|(i, d)| if i % 4 == 0 && i / 64 % 4 == 0 { *d } else { 0.0 })
        .collect();
    let sparse = Image::from_samples(64, 64, sparse).expect("a square");
    let estimate = truth().map(|d| d + 0.1);
    let report = measure_depth(&estimate, &sparse, &DepthSettings::default()).expect("depths");
    assert_eq!((report.all.pixels, report.edges.pixels), (14 * 16, 0));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let truth = truth();
    let near = truth.map(|d| d - 0.1);
    let measure = |estimate: &Image, ranges: &[f64]| {
        let settings = DepthSettings { ranges_m: ranges.to_vec(), ..DepthSettings::default() };
        measure_depth(estimate, &truth, &settings)
    };
    assert!(matches!(measure(&Image::new(64, 32), &[0.0, 9.0]), Err(DepthError::Size { .. })));
    assert_eq!(measure(&Image::new(64, 64), &[0.0, 9.0]), Err(DepthError::Nothing));
    assert_eq!(measure(&near, &[9.0, 1.0]), Err(DepthError::Ranges));
    assert_eq!(measure(&truth, &[0.0, 9.0]), Err(DepthError::Same));
    for bad in [f64::NAN, -0.1, f64::INFINITY] {
        let default_settings = DepthSettings::default;
        let all = [
            DepthSettings { outlier_ratio: bad, ..default_settings() },
            DepthSettings { min_outlier_m: bad, ..default_settings() },
            DepthSettings { edge_ratio: bad, ..default_settings() },
            DepthSettings { focal_baseline_px_m: Some(bad), ..default_settings() },
        ];
        for settings in all {
            let result = measure_depth(&near, &truth, &settings);
            assert!(matches!(result, Err(DepthError::Setting { .. })), "{settings:?}");
        }
    }
}
