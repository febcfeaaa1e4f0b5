//! A wheel that turns, under both shutters.
//!
//! It lies flat and rolls along with the camera above it, so that the camera sees it turn about a point that stands still: φ = v t / r. The
//! mark is a bar through its hub, 4 px by 48 px; at φ = 0 it points up in the picture, and it turns to the left.

use crate::motion::{SIZE, electrons, falloff, job};
use core::f64::consts::PI;
use etendue_core::Plane;
use etendue_core::quantity::MeanElectrons;
use etendue_pipeline::truth::ground_truth;
use etendue_tests::Job;
use etendue_tracer::accel::Simd;
use glam::DVec2;

/// Radius (m) on which the wheel rolls.
const RADIUS_M: f64 = 0.1;
/// 10 π rad/s: at 1 000 s, 1 s after the first key, five whole turns are done.
const RATE: f64 = 10.0 * PI;
/// The hub, px.
const HUB: DVec2 = DVec2::new(50.0, 30.0);

fn wheel(sensor: &str, spp: u32) -> Job {
    let way_m = RATE * RADIUS_M;
    let bar = "shape = { type = \"quad\", size_m = [0.096, 0.008] }\nframe = \"wheel\"\nrotation_deg = [0, 0, -90]";
    let frames = format!(
        "[[scene.frames]]\nname = \"car\"\nkeys = [{{ time_s = 999, position_m = [{}, 0, 0] }}, \
         {{ time_s = 1001, position_m = [{way_m}, 0, 0] }}]\n\
         [[scene.frames]]\nname = \"wheel\"\nparent = \"car\"\nrotation_deg = [0, 0, 90]\nrolls = {{ radius_m = {RADIUS_M} }}\n",
        -way_m
    );
    job(bar, sensor, spp).replaced("[[cameras]]\n", &format!("{frames}[[cameras]]\nframe = \"car\"\n"))
}

/// The angle of a picture's place about the hub, from up to the left, as one near `about` that differs by half turns: the bar has two ends.
fn angle_near(at_px: DVec2, reference_angle: f64) -> f64 {
    let from = at_px - HUB;
    let angle = etendue_core::maths::f64::atan2(-from.x, -from.y);
    angle - PI * ((angle - reference_angle) / PI).round()
}

/// Mean and variance of the angle of a picture's light in a ring about the hub, the mean near `about`.
fn angles(light: &Plane<MeanElectrons>, reference_angle: f64) -> (f64, f64) {
    let mut sums = [0.0; 3];
    for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
        let at_px = DVec2::new(x as f64, y as f64) + 0.5;
        if (10.0..22.0).contains(&(at_px - HUB).length()) {
            let (weight, angle) =
                (f64::from(light.at(x, y)) / falloff(x, y), angle_near(at_px, reference_angle) - reference_angle);
            sums[0] += weight;
            sums[1] += weight * angle;
            sums[2] += weight * angle * angle;
        }
    }
    let mean = sums[1] / sums[0];
    (reference_angle + mean, sums[2] / sums[0] - mean * mean)
}

/// Within 20 ms the mark turns by 0.628 rad: its mean angle is that of the middle, and its variance that of the mark at rest and that of an even
/// arc, (ωT)²/12 = 0.0329 rad². In the ring lie some 96 px of the mark, met by 24 000 samples that scatter by 0.18 rad: the mean is right
/// to 1.2·10⁻³ rad, the variance to 2·10⁻⁴ rad² (of an even arc 0.9 times itself over the root of their number); three of these and more are
/// granted. Pixels' middles stand for their samples, which adds the same to the variance of the mark at rest, 3·10⁻⁴ rad².
#[test]
fn a_global_shutter_shows_the_angle_and_the_arc_of_a_turning_mark() {
    let shot =
        |exposure_s: f64| wheel(&format!("exposure_s = {exposure_s}\nshutter = {{ type = \"global\" }}"), 256).shot();
    let (turning, frozen) = (electrons(&shot(0.02), 0), electrons(&shot(1e-6), 0));
    let middle = RATE * 0.01;
    let ((mean, variance), (still, own)) = (angles(&turning, middle), angles(&frozen, 0.0));
    assert!((mean - middle).abs() < 4e-3, "{mean} for {middle}");
    assert!(still.abs() < 4e-3, "{still} at the first moment");
    let arc = (RATE * 0.02) * (RATE * 0.02) / 12.0;
    assert!((variance - own - arc).abs() < 1e-3, "{variance} − {own} for {arc}");
}

/// Rows begin 300 µs after each other, and the mark turns by 9.4 mrad meanwhile: a bent bar, in light and in truth. A frame later it has turned by half a
/// turn, and shows the same.
#[test]
fn rows_of_a_rolling_shutter_see_the_angle_of_their_own_time() {
    let (exposure_s, row_time_s) = (0.001, 300e-6);
    let sensor =
        format!("exposure_s = {exposure_s}\nshutter = {{ type = \"rolling\", row_time_us = {} }}", row_time_s * 1e6);
    let shot = wheel(&sensor, 512).shot();
    let truth = ground_truth(&shot.plan, shot.camera(), 0, Simd::Auto).instance;
    for frame in [0, 1] {
        let light = electrons(&shot, frame);
        let (mut rows, mut max_bend_px) = (0, 0.0_f64);
        for y in 0..SIZE[1] {
            let above_px = HUB.y - (y as f64 + 0.5);
            let angle = RATE * (row_time_s * y as f64 + 0.5 * exposure_s);
            // The mark's ends are not upright: rows that they do not cut.
            if !(4.0..18.0).contains(&above_px.abs()) {
                continue;
            }
            let expected = HUB.x - above_px * etendue_core::maths::f64::tan(angle);
            let centre = |weight: &dyn Fn(usize) -> f64| {
                let sum: f64 = (0..SIZE[0]).map(weight).sum();
                (0..SIZE[0]).map(|x| (x as f64 + 0.5) * weight(x)).sum::<f64>() / sum
            };
            let actual = centre(&|x| f64::from(light.at(x, y)) / falloff(x, y));
            // A row has 2 000 samples of the mark, which scatter by 1.3 px: 0.03 px, three of these; and the mean of the tangent over exposure
            // and row differs from the tangent of the mean by h (ωT)²/12 tan″/2 < 0.003 px.
            assert!((actual - expected).abs() < 0.1, "row {y}: {actual} for {expected}");
            let truth_centre = centre(&|x| f64::from(truth.at(x, y).min(1)));
            assert!(
                (truth_centre - expected).abs() < 0.51,
                "row {y}: {truth_centre} for {expected}, by pixels' middles"
            );
            rows += 1;
            max_bend_px = max_bend_px.max((expected - HUB.x).abs());
        }
        assert!(rows == 28 && max_bend_px > 4.0, "{rows} rows, bent by {max_bend_px} px");
    }
}
