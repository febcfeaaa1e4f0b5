//! The noise that adaptive sampling leaves, beside what is measured of a sensor on such frames.
//!
//! Frames whose light has a seed each have it in their temporal variance: photon transfer then tells a gain that is too high by the ratio of
//! both variances, f². Frames of one light have it as a fixed pattern: the standard deviation of pixels' responses (PRNU) is then told too high by
//! half of its variance over that of the pattern. Both are seen here without the sensor's own noise, which would hide them: in mean electrons of
//! independent seeds.

use etendue_tests::{Job, Shot, quad};

const SIDE: usize = 16;
const READ_NOISE_E: f64 = 4.0;
const GAIN_DN_PER_E: f64 = 0.05;
/// Relative standard deviation of pixels' responses.
const PRNU: f64 = 0.01;

/// A white wall in the light of a lamp and of the walls about it.
fn wall(threshold: f64, seed: u64) -> Shot {
    let room = [
        quad("wall", [4.0, 4.0], [2.0, 0.0, 1.0], [0.0, -90.0, 0.0], "white"),
        quad("floor", [4.0, 4.0], [0.0, 0.0, -1.0], [0.0, 0.0, 0.0], "white"),
        quad("lamp", [1.0, 1.0], [0.0, 0.0, 3.0], [0.0, 0.0, 180.0], "lamp"),
    ];
    Job::new(format!(
        r#"
        [[scene.materials]]
        name = "white"
        type = "diffuse"
        reflectance = 0.8
        [[scene.materials]]
        name = "lamp"
        type = "emitter"
        emission = {{ luminance_cd_m2 = 3000, illuminant = "D65" }}
        {}
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 1]
        look_at_m = [2, 0, 1]
        lens = {{ type = "thin", focal_length_mm = 12, f_number = 2, focus_distance_m = 2 }}
        [cameras.sensor]
        width_px = {SIDE}
        height_px = {SIDE}
        pixel_pitch_um = 100
        exposure_s = 1.5e-6
        cfa = "mono"
        quantum_efficiency = 0.5
        full_well_e = 1e5
        read_noise_e = {READ_NOISE_E}
        dark_current_e_s = 0
        gain_dn_per_e = {GAIN_DN_PER_E}
        black_level_dn = 64
        bits = 14
        [render]
        noise_threshold = {threshold}
        min_spp = 16
        max_spp = 65536
        max_bounces = 4
        "#,
        room.concat()
    ))
    .with_seed(seed)
    .shot()
}

/// Variance that the light adds in the mean over pixels, by two seeds, over the sensor's temporal variance and over that of the pattern.
fn added(threshold: f64) -> (f64, f64) {
    let [a, b] = [1, 2].map(|seed| wall(threshold, seed).electrons());
    let pixels = (SIDE * SIDE) as f64;
    let (mut light, mut temporal, mut pattern) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(&b) {
        let (a, b) = (f64::from(*a), f64::from(*b));
        let mean = 0.5 * (a + b);
        light += 0.5 * (a - b) * (a - b) / pixels;
        temporal += (mean + READ_NOISE_E * READ_NOISE_E + 1.0 / (12.0 * GAIN_DN_PER_E * GAIN_DN_PER_E)) / pixels;
        pattern += PRNU * PRNU * mean * mean / pixels;
    }
    assert!(temporal > 1000.0, "an exposure to measure: {temporal} e⁻²");
    (light / temporal, light / pattern)
}

/// The variance of 256 differences is known to √(2/256), 9 %; four of these.
const SCATTER: f64 = 1.36;

#[test]
fn gain_and_non_uniformity_are_off_by_the_square_of_the_limit() {
    for threshold in [0.07, 0.5] {
        let (temporal, pattern) = added(threshold);
        let limit = threshold * threshold;
        assert!(temporal <= SCATTER * limit, "{threshold}: {temporal}");
        assert!(temporal > 0.05 * limit, "the limit decides: {threshold}: {temporal}");
        if threshold < 0.1 {
            assert!(temporal < 0.005 && 0.5 * pattern < 0.005, "{temporal} {pattern}");
        }
    }
}
